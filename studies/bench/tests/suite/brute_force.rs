//! The optimum beside a search that looks at everything, and schedules by all policies.

use mrta::{Problem, Robot, cbba, dispatch, earliest, generate, optimum};

/// The least makespan of all orders of tasks with all groups that cover them, needless members included.
fn least(problem: &Problem, place: &[usize], ready: &[f64], ends: &[Option<f64>]) -> f64 {
    let robots = problem.robots.len();
    if ends.iter().all(Option::is_some) {
        let of = |robot: &usize| problem.robots[*robot];
        let used = (0..robots).filter(|robot| place[*robot] != of(robot).start);
        return used.map(|r| ready[r] + problem.travel[place[r]][of(&r).end]).fold(0.0, f64::max);
    }
    let mut best = f64::INFINITY;
    for (task, of) in problem.tasks.iter().enumerate().filter(|(task, _)| ends[*task].is_none()) {
        let Some(over) = of.after.iter().map(|first| ends[*first]).collect::<Option<Vec<f64>>>() else {
            continue;
        };
        for group in 1..1_u32 << robots {
            let members: Vec<usize> = (0..robots).filter(|robot| group >> robot & 1 == 1).collect();
            if of.requires & !members.iter().fold(0, |all, robot| all | problem.robots[*robot].skills) != 0 {
                continue;
            }
            let arrivals = members.iter().map(|r| ready[*r] + problem.travel[place[*r]][task + 1]);
            let end = arrivals.chain(over.iter().copied()).fold(0.0, f64::max) + of.duration;
            let (mut place, mut ready, mut ends) = (place.to_vec(), ready.to_vec(), ends.to_vec());
            members.iter().for_each(|robot| (place[*robot], ready[*robot]) = (task + 1, end));
            ends[task] = Some(end);
            best = best.min(least(problem, &place, &ready, &ends));
        }
    }
    best
}

/// A drawn problem of few tasks; in every second one the ways are longer than straight.
fn small(seed: u64) -> Problem {
    let mut problem = generate("small", seed);
    let tasks = 2 + seed as usize % 4;
    let last = problem.last();
    problem.tasks.truncate(tasks);
    problem.tasks.iter_mut().for_each(|task| task.after.retain(|first| *first < tasks));
    let kept: Vec<usize> = (0..=tasks).chain([last]).collect();
    problem.places = kept.iter().map(|at| problem.places[*at]).collect();
    problem.robots.iter_mut().for_each(|robot| robot.end = tasks + 1);
    with_ways(problem, seed.is_multiple_of(2))
}

fn with_ways(mut problem: Problem, are_rounded_up: bool) -> Problem {
    problem.travel = Problem::distances(&problem.places);
    if are_rounded_up {
        problem.travel.iter_mut().flatten().for_each(|time| *time = (*time / 10.0).ceil() * 10.0);
    }
    problem
}

/// The same problem with own depots: each robot ends where it begins, or, in every third problem, where
/// another robot begins. Location 0 is used by no robot, and far away.
fn with_depots(mut problem: Problem, seed: u64) -> Problem {
    let drawn = generate("depots", seed + 1_000_000).places;
    let (first, robots) = (problem.places.len(), problem.robots.len());
    problem.places.extend(&drawn[..robots]);
    problem.places[0] = [-1000.0, -1000.0];
    for (at, robot) in problem.robots.iter_mut().enumerate() {
        let end = if seed.is_multiple_of(3) { (at + 1) % robots } else { at };
        *robot = Robot { start: first + at, end: first + end, ..*robot };
    }
    with_ways(problem, seed.is_multiple_of(2))
}

fn is_that_of_brute_force(problem: &Problem, seed: u64) {
    let places: Vec<usize> = problem.robots.iter().map(|robot| robot.start).collect();
    let expected = least(problem, &places, &vec![0.0; places.len()], &vec![None; problem.tasks.len()]);
    let found = optimum(problem).unwrap();
    assert!((found - expected).abs() < 1e-9, "seed {seed}: {found}, brute force {expected}");
}

#[test]
fn the_optimum_of_300_problems_is_that_of_brute_force() {
    (0..300).for_each(|seed| is_that_of_brute_force(&small(seed), seed));
}

#[test]
fn the_optimum_of_300_problems_with_depots_is_that_of_brute_force() {
    (0..300).for_each(|seed| is_that_of_brute_force(&with_depots(small(seed), seed), seed));
}

#[test]
fn larger_problems_and_those_with_detours_are_not_solved_exactly() {
    let mut problem = generate("large", 1);
    problem.robots = vec![problem.robots[0]; 5];
    assert_eq!(optimum(&problem), None);
    let mut problem = generate("with a detour", 1);
    assert!(optimum(&problem).is_some());
    problem.travel[1][2] = 2.0 * (problem.travel[1][3] + problem.travel[3][2]);
    assert_eq!(optimum(&problem), None);
}

#[test]
fn no_schedule_is_shorter_than_the_optimum_and_all_policies_make_one() {
    let names = [
        "RANDOM", "DIS", "OPTIMAL", "GREEDY", "GRAPE", "SNAKE", "BALANCE", "SIMILAR", "KMEANS", "SPECTRAL",
        "RNE",
    ];
    let drawn = (0..100).map(|seed| (seed, generate("drawn", seed)));
    let drawn =
        drawn.flat_map(|(seed, problem)| [(seed, problem.clone()), (seed, with_depots(problem, seed))]);
    for (seed, problem) in drawn {
        let least = optimum(&problem).unwrap() - 1e-9;
        assert!(earliest(&problem) >= least && cbba(&problem) >= least, "seed {seed}");
        for name in names {
            let policy = policies::standard().parse(name).unwrap();
            let play = || dispatch(&problem, &mut *policy.open().unwrap());
            let makespan = play().unwrap_or_else(|error| panic!("{name}, seed {seed}: {error}"));
            assert!(makespan >= least, "{name}, seed {seed}: {makespan}");
            assert_eq!(makespan.to_bits(), play().unwrap().to_bits(), "{name}, seed {seed}");
        }
    }
}
