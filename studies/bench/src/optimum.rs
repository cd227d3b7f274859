//! The least makespan of a small problem, exactly.
//!
//! Dynamic programming over sets of covered tasks: a state is the set, where each robot is, when it is
//! free, and when those tasks are over that others wait for. Of two states with the same set and places,
//! one that is nowhere later makes the other one needless, so that each set and places have a Pareto set of
//! times. Groups have no member that could be left out, which loses nothing because no way is longer than a
//! detour: other problems are not solved. A state is dropped if a bound says that it comes to nothing
//! better than the rule of the earliest start: each robot has to visit the tasks for which it alone has a
//! skill (Held, Karp 1962), and each task is followed by its tail.
//!
//! Time: exponential in tasks and robots; milliseconds for 8 tasks and 3 robots.

use std::collections::BTreeMap;

use crate::problem::{Problem, Skills};
use crate::schedule::earliest;

/// Most tasks of a problem that is solved exactly.
pub const MAX_TASKS: usize = 10;

/// Most robots of a problem that is solved exactly.
pub const MAX_ROBOTS: usize = 4;

/// Bounds that are no more than this below a makespan promise nothing better.
const TIE: f64 = 1e-9;

/// A way is no longer than a detour if it is by no more than this share.
const ROUNDING: f64 = 1e-12;

/// The place of a robot that has no task yet. Task j is at j + 1.
const START: u8 = 0;

/// The place of a robot that has nothing left to do.
const DONE: u8 = u8::MAX;

/// The least makespan; `None` if there are more than [`MAX_TASKS`] tasks or [`MAX_ROBOTS`] robots, or if a
/// way is longer than a detour.
#[must_use]
pub fn optimum(problem: &Problem) -> Option<f64> {
    let shortest = shortest(&problem.travel);
    let is_straight = |(way, least): (&f64, &f64)| *way <= least * (1.0 + ROUNDING);
    let are_straight = problem.travel.iter().flatten().zip(shortest.iter().flatten()).all(is_straight);
    if problem.tasks.len() > MAX_TASKS || problem.robots.len() > MAX_ROBOTS || !are_straight {
        return None;
    }
    let search = Search::of(problem, &shortest);
    let mut best = earliest(problem);
    let mut level =
        BTreeMap::from([(Key { covered: 0, places: [START; MAX_ROBOTS] }, vec![Times::default()])]);
    for _ in 0..problem.tasks.len() {
        let mut next = BTreeMap::new();
        for (key, states) in &level {
            for times in states {
                search.extend(State { key: *key, times: *times }, &mut best, &mut next);
            }
        }
        level = next;
    }
    Some(best)
}

/// Where a search is: the covered tasks as a set, and the place of each robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    covered: u16,
    places: [u8; MAX_ROBOTS],
}

/// Its times.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Times {
    ready: [f64; MAX_ROBOTS],
    /// Of tasks that others wait for.
    ends: [f64; MAX_TASKS],
    /// When the last of the robots that are done is at its end.
    finish: f64,
}

impl Times {
    fn all(&self) -> impl Iterator<Item = &f64> {
        self.ready.iter().chain(&self.ends).chain([&self.finish])
    }

    fn is_nowhere_later(&self, other: &Self) -> bool {
        self.all().zip(other.all()).all(|(own, other)| own <= other)
    }
}

#[derive(Debug, Clone, Copy)]
struct State {
    key: Key,
    times: Times,
}

/// What stays the same in a search.
struct Search<'p> {
    problem: &'p Problem,
    /// For each task, its groups without needless members, as sets of robots.
    groups: Vec<Vec<u8>>,
    tails: Vec<f64>,
    /// For each task, the sets of robots that have one of its skills each.
    able: Vec<Vec<u8>>,
    /// For each robot, the tasks for which it alone has a skill.
    own: Vec<u16>,
    /// For each robot, its shortest way from each place through each set of its own tasks to the end.
    tours: Vec<Vec<Vec<f64>>>,
}

impl<'p> Search<'p> {
    fn of(problem: &'p Problem, shortest: &[Vec<f64>]) -> Self {
        let robots = problem.robots.len();
        let has = |set: u8, robot: usize| set >> robot & 1 == 1;
        let skills =
            |set: u8| problem.skills_of(&(0..robots).filter(|r| has(set, *r)).collect::<Vec<usize>>());
        let groups = |requires: Skills| {
            let covers = |set: u8| requires & !skills(set) == 0;
            let is_least = |set: &u8| !(0..robots).any(|r| has(*set, r) && covers(set & !(1 << r)));
            (1..1_u8 << robots).filter(|set| covers(*set)).filter(is_least).collect()
        };
        let with = |skill: usize| {
            (0..robots).map(|r| u8::from(problem.robots[r].skills >> skill & 1 == 1) << r).sum()
        };
        let able = |requires: Skills| {
            (0..problem.skills).filter(|skill| requires >> skill & 1 == 1).map(with).collect::<Vec<u8>>()
        };
        let able: Vec<Vec<u8>> = problem.tasks.iter().map(|task| able(task.requires)).collect();
        let is_own = |task: usize, robot: usize| able[task].contains(&(1 << robot));
        let own = |robot: usize| {
            (0..problem.tasks.len()).map(|task| u16::from(is_own(task, robot)) << task).sum::<u16>()
        };
        let own: Vec<u16> = (0..robots).map(own).collect();
        Self {
            problem,
            groups: problem.tasks.iter().map(|task| groups(task.requires)).collect(),
            tails: problem.tails(),
            tours: (0..robots).map(|robot| tours(problem, robot, own[robot], shortest)).collect(),
            able,
            own,
        }
    }

    /// Covers one more task, in all ways that may be better than the best makespan.
    fn extend(&self, state: State, best: &mut f64, next: &mut BTreeMap<Key, Vec<Times>>) {
        let covered = state.key.covered;
        for (task, of) in self.problem.tasks.iter().enumerate() {
            let is_open = of.after.iter().all(|first| covered >> first & 1 == 1);
            if covered >> task & 1 == 1 || !is_open {
                continue;
            }
            for group in &self.groups[task] {
                let state = self.covered(state, task, *group);
                if self.bound(&state) >= *best - TIE {
                    continue;
                }
                if state.key.covered.count_ones() as usize == self.problem.tasks.len() {
                    *best = state.times.finish;
                    continue;
                }
                let known = next.entry(state.key).or_default();
                if !known.iter().any(|times| times.is_nowhere_later(&state.times)) {
                    known.retain(|times| !state.times.is_nowhere_later(times));
                    known.push(state.times);
                }
            }
        }
    }

    /// The state after a group has covered a task.
    fn covered(&self, State { mut key, mut times }: State, task: usize, group: u8) -> State {
        let Problem { tasks, robots, travel, .. } = self.problem;
        let members = || (0..robots.len()).filter(move |robot| group >> robot & 1 == 1);
        let from = |robot: usize| location(self.problem, robot, key.places[robot]);
        let arrival = |robot: usize| times.ready[robot] + travel[from(robot)][task + 1];
        let over = tasks[task].after.iter().map(|first| times.ends[*first]);
        let end = members().map(arrival).chain(over).fold(0.0, f64::max) + tasks[task].duration;
        key.covered |= 1 << task;
        members().for_each(|robot| (key.places[robot], times.ready[robot]) = (task as u8 + 1, end));
        times.ends[task] = end;
        let left = || (0..tasks.len()).filter(|task| key.covered >> task & 1 == 0);
        for first in 0..tasks.len() {
            if !left().any(|task| tasks[task].after.contains(&first)) {
                times.ends[first] = 0.0;
            }
        }
        for (robot, of) in robots.iter().enumerate() {
            let place = key.places[robot];
            if place != DONE && !left().any(|task| tasks[task].requires & of.skills != 0) {
                let way = if place == START { 0.0 } else { travel[place as usize][of.end] };
                times.finish = times.finish.max(times.ready[robot] + way);
                (key.places[robot], times.ready[robot]) = (DONE, 0.0);
            }
        }
        State { key, times }
    }

    /// No schedule that goes on from a state has a makespan below this.
    fn bound(&self, State { key, times }: &State) -> f64 {
        let Problem { tasks, travel, .. } = self.problem;
        let mut bound = times.finish;
        for (robot, tours) in self.tours.iter().enumerate().filter(|(robot, _)| key.places[*robot] != DONE) {
            let left = self.own[robot] & !key.covered;
            if key.places[robot] != START || left != 0 {
                bound = bound.max(times.ready[robot] + tours[key.places[robot] as usize][left as usize]);
            }
        }
        for task in (0..tasks.len()).filter(|task| key.covered >> task & 1 == 0) {
            let mut start = tasks[task].after.iter().map(|first| times.ends[*first]).fold(0.0, f64::max);
            for able in &self.able[task] {
                let robots = (0..self.problem.robots.len()).filter(|robot| able >> robot & 1 == 1);
                let robots = robots.filter(|robot| key.places[*robot] != DONE);
                let from = |robot: usize| location(self.problem, robot, key.places[robot]);
                let arrival = |robot: usize| times.ready[robot] + travel[from(robot)][task + 1];
                start = start.max(robots.map(arrival).fold(f64::INFINITY, f64::min));
            }
            bound = bound.max(start + self.tails[task]);
        }
        bound
    }
}

/// The shortest ways, over any locations (Floyd, Warshall).
fn shortest(travel: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut shortest = travel.to_vec();
    for over in 0..travel.len() {
        for from in 0..travel.len() {
            for to in 0..travel.len() {
                shortest[from][to] = shortest[from][to].min(shortest[from][over] + shortest[over][to]);
            }
        }
    }
    shortest
}

/// The location of a robot's place.
fn location(problem: &Problem, robot: usize, place: u8) -> usize {
    if place == START { problem.robots[robot].start } else { place.into() }
}

/// For each place and each set of tasks within `own`, how long the shortest tour of a robot takes from the
/// place through all of them to its end, work included.
fn tours(problem: &Problem, robot: usize, own: u16, shortest: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let sets = 1 << problem.tasks.len();
    let mut tours = vec![vec![0.0; sets]; problem.tasks.len() + 1];
    for set in (0..sets).filter(|set| set & !(own as usize) == 0) {
        for place in 0..tours.len() {
            let from = &shortest[location(problem, robot, place as u8)];
            let tasks = (0..problem.tasks.len()).filter(|task| set >> task & 1 == 1);
            let through = |task: usize| {
                from[task + 1] + problem.tasks[task].duration + tours[task + 1][set & !(1 << task)]
            };
            let least = tasks.map(through).fold(f64::INFINITY, f64::min);
            tours[place][set] = if set == 0 { from[problem.robots[robot].end] } else { least };
        }
    }
    tours
}
