//! Worlds of any size at one density, for the raw physics and for the full simulator. A walled square of 40
//! sqrt(N / 12) m holds N robots and 5 boxes for each robot; two of twelve robots are aerial.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::{
    DebrisFile, DebrisShape, InitialLevels, Normal, Point, Row, Scenario, ScenarioFile, TaskFile,
};

use crate::worlds::base;

/// Radius of all robots, in metres.
pub const RADIUS_M: f64 = 0.25;
/// Top speed of all robots, in metres per second.
pub const SPEED_MPS: f64 = 1.0;
/// Time step, in seconds.
pub const DT_S: f64 = 0.02;

/// Side of the arena, in metres.
pub fn side(robots: u32) -> f64 {
    40.0 * (f64::from(robots) / 12.0).sqrt()
}

/// Number of aerial robots: two of twelve.
pub fn aerial(robots: u32) -> u32 {
    (robots / 6).max(1)
}

/// Boxes of half extents 0.4 to 1.2 m at any angle, away from places for which `is_taken` is true.
pub fn boxes(robots: u32, is_taken: impl Fn(Point) -> bool) -> Vec<DebrisFile> {
    let mut draws = ChaCha8Rng::seed_from_u64(u64::from(robots));
    let mut boxes = Vec::new();
    while boxes.len() < 5 * robots as usize {
        let half = [0; 2].map(|_| draws.random_range(0.4..1.2));
        let at = [0; 2].map(|_| draws.random_range(0.0..side(robots)));
        let rotation_deg = draws.random_range(0.0..180.0);
        if !is_taken(at) {
            let shape = DebrisShape::Box(2.0 * half[0], 2.0 * half[1]);
            boxes.push(DebrisFile { rotation_deg, ..DebrisFile::fixed(shape, at) });
        }
    }
    boxes
}

/// A mission for the full simulator, `duration_s` seconds long. Homes are in rows along the southern wall.
/// Tasks are across the arena, or `to_tasks_m` from the homes, so that robots are already at work within a
/// minute. Rest places are in front of the tasks or behind them.
pub fn mission(robots: u32, duration_s: f64, to_tasks_m: Option<f64>) -> Scenario {
    let side = side(robots);
    let aerial = aerial(robots);
    let suppliers = robots / 3;
    let spacing = 2.0 * RADIUS_M + 0.7;
    let per_row = ((side - 4.0) / spacing) as u32;
    let mut team = Vec::new();
    let mut y = 1.5;
    for (role, count) in
        [("carrier", robots - suppliers - aerial), ("supplier", suppliers), ("observer", aerial)]
    {
        let mut left = count;
        while left > 0 {
            let count = left.min(per_row);
            let width_m = spacing * f64::from(count - 1);
            team.push(Row { count, width_m, ..Row::of_one(role, [side / 2.0, y]) });
            left -= count;
            y += spacing;
        }
    }
    let block = f64::from(robots).sqrt() * (2.0 * RADIUS_M + 1.2) / 2.0 + 2.5;
    let task = |name: &str, difficulty: u32, x: f64| TaskFile {
        name: name.to_owned(),
        difficulty,
        center: [x, to_tasks_m.map_or(0.85 * side, |gap| y + gap + 0.05 * side)],
        size_m: [0.2 * side, 0.1 * side],
        grid: [robots.min(100), 5],
        rest: [x, to_tasks_m.map_or(0.5 * side, |gap| y + gap + 0.1 * side + block)],
        ..TaskFile::default()
    };
    let tasks = vec![task("hard", 2, 0.25 * side), task("easy", 1, 0.75 * side)];
    let is_taken = |[x, at]: Point| {
        let at_rest = |task: &TaskFile| (x - task.rest[0]).abs() < block && (at - task.rest[1]).abs() < block;
        at < y + 1.5 || tasks.iter().any(at_rest)
    };
    let mut file = ScenarioFile {
        name: format!("density-{robots}"),
        debris: boxes(robots, is_taken),
        team,
        initial_levels: InitialLevels {
            energy: Normal { mean: 80.0, sd: 20.0 },
            hp: Normal { mean: 90.0, sd: 10.0 },
        },
        tasks,
        ..base(0, [side, side], duration_s)
    };
    for role in &mut file.roles {
        (role.radius_m, role.speed_mps, role.acceleration_mps2) = (RADIUS_M, SPEED_MPS, 2.0);
    }
    if let Err(problems) = Scenario::try_from(file.clone()) {
        // A few of the boxes hide a rescuee from everybody's reach: they are left out.
        let number = |field: &str| field.strip_prefix("debris[")?.split(']').next()?.parse::<usize>().ok();
        let hiding: Vec<usize> = problems.iter().filter_map(|problem| number(&problem.field)).collect();
        let mut at = 0..;
        file.debris.retain(|_| at.next().is_some_and(|at| !hiding.contains(&at)));
    }
    Scenario::try_from(file).unwrap_or_else(|problems| panic!("{problems:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worlds_of_any_size_can_be_used() {
        for robots in [12, 100, 1_000] {
            let scenario = mission(robots, 60.0, None);
            assert_eq!(scenario.team.iter().map(|row| row.count).sum::<u32>(), robots);
            assert!(scenario.debris.len() as u32 + robots / 10 >= 5 * robots, "{}", scenario.debris.len());
        }
    }
}
