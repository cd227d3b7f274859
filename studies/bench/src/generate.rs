//! Problems of the form of the published ones `1p_000000` to `1p_000002`.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use crate::problem::{Problem, Robot, Skills, Task};

/// Skills, and robots.
const SKILLS: usize = 3;

/// Tasks.
const TASKS: usize = 8;

/// Draws a problem: three robots with a skill each, and eight tasks that require one. A quarter of the robots
/// and tasks has a second skill. All skills are there. Tasks take 50 to 99, and lie on whole numbers in a
/// square of side 100, in which distance is time. One task comes after another one.
#[must_use]
pub fn generate(name: &str, seed: u64) -> Problem {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let second = |draws: &mut ChaCha8Rng, first: usize| -> Skills {
        let other = (first + draws.random_range(1..SKILLS)) % SKILLS;
        1 << first | Skills::from(draws.random_range(0..4) == 0) << other
    };
    let shift = draws.random_range(0..SKILLS);
    let mut robot = |robot: usize| {
        let skills = second(&mut draws, (robot + shift) % SKILLS);
        Robot { skills, start: 0, end: TASKS + 1 }
    };
    let robots = (0..SKILLS).map(&mut robot).collect();
    let mut tasks: Vec<Task> = Vec::new();
    for _ in 0..TASKS {
        let first = draws.random_range(0..SKILLS);
        let requires = second(&mut draws, first);
        let duration = f64::from(draws.random_range(50..100));
        tasks.push(Task { requires, duration, after: Vec::new() });
    }
    let before = draws.random_range(0..TASKS);
    tasks[(before + draws.random_range(1..TASKS)) % TASKS].after.push(before);
    let mut place = |_| [0; 2].map(|_: i32| f64::from(draws.random_range(0..100)));
    let places: Vec<[f64; 2]> = (0..TASKS + 2).map(&mut place).collect();
    let travel = Problem::distances(&places);
    Problem { name: name.to_owned(), skills: SKILLS, robots, tasks, places, travel }
}
