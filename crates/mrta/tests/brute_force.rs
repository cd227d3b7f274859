//! The optimum beside a search that looks at everything, and schedules by all policies.

use mrta::{Problem, cbba, dispatch, earliest, generate, optimum};

/// The least makespan of all orders of tasks with all groups that cover them, needless members included.
fn least(problem: &Problem, place: &[usize], ready: &[f64], ends: &[Option<f64>]) -> f64 {
    let robots = problem.robots.len();
    if ends.iter().all(Option::is_some) {
        let used = (0..robots).filter(|robot| place[*robot] != 0);
        return used.map(|r| ready[r] + problem.travel[place[r]][problem.last()]).fold(0.0, f64::max);
    }
    let mut best = f64::INFINITY;
    for (task, of) in problem.tasks.iter().enumerate().filter(|(task, _)| ends[*task].is_none()) {
        let Some(over) = of.after.iter().map(|first| ends[*first]).collect::<Option<Vec<f64>>>() else {
            continue;
        };
        for group in 1..1_u32 << robots {
            let members: Vec<usize> = (0..robots).filter(|robot| group >> robot & 1 == 1).collect();
            if of.requires & !members.iter().fold(0, |all, robot| all | problem.robots[*robot]) != 0 {
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
    problem.travel = Problem::distances(&problem.places);
    if seed.is_multiple_of(2) {
        problem.travel.iter_mut().flatten().for_each(|time| *time = (*time / 10.0).ceil() * 10.0);
    }
    problem
}

#[test]
fn the_optimum_of_300_problems_is_that_of_brute_force() {
    for seed in 0..300 {
        let problem = small(seed);
        let [robots, tasks] = [problem.robots.len(), problem.tasks.len()];
        let expected = least(&problem, &vec![0; robots], &vec![0.0; robots], &vec![None; tasks]);
        let found = optimum(&problem).unwrap();
        assert!((found - expected).abs() < 1e-9, "seed {seed}: {found}, brute force {expected}");
    }
}

#[test]
fn larger_problems_are_not_solved_exactly() {
    let mut problem = generate("large", 1);
    problem.robots = vec![1; 5];
    assert_eq!(optimum(&problem), None);
}

#[test]
fn no_schedule_is_shorter_than_the_optimum_and_all_policies_make_one() {
    let names =
        ["RANDOM", "DIS", "OPTIMAL", "GREEDY", "GRAPE", "SNAKE", "KMEANS", "SPECTRAL", "BANDIT", "RNE"];
    for seed in 0..100 {
        let problem = generate("drawn", seed);
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
