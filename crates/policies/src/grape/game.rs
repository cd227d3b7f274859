//! The game of one role: robots and tasks by number.

use teaming::decision::Protocol;

/// A robot moves if it gains more than this.
const GAIN: f64 = 1e-12;

/// Bytes of a number in a message.
const BYTES: usize = 8;

/// What a robot gets at a task: its reward times the share of its group's size, less its way.
pub(super) struct Game {
    /// For each robot, the reward of each task.
    pub(super) rewards: Vec<Vec<f64>>,
    /// For each robot, the way to each task.
    pub(super) ways: Vec<Vec<f64>>,
    /// The share of each of 1, 2, ... members. It must fall.
    pub(super) shares: Vec<f64>,
    /// The most members of each task.
    pub(super) room: Vec<usize>,
}

/// A partition in which no robot gains by a move.
pub(super) struct Played {
    /// The task of each robot.
    pub(super) task_of: Vec<usize>,
    moves: usize,
}

impl Game {
    /// What a robot gets at a task with so many members.
    fn gets(&self, robot: usize, task: usize, members: usize) -> f64 {
        self.rewards[robot][task] * self.shares[members - 1] - self.ways[robot][task]
    }

    /// The lowest robot that gains moves to its best task, again and again. As shares fall with the size of a
    /// group, this ends (the authors' Theorem 1).
    pub(super) fn play(&self) -> Played {
        let mut at: Vec<Option<usize>> = vec![None; self.rewards.len()];
        let mut sizes = vec![0; self.room.len()];
        let mut moves = 0;
        while let Some((robot, task)) = self.next_move(&at, &sizes) {
            sizes[task] += 1;
            if let Some(left) = at[robot].replace(task) {
                sizes[left] -= 1;
            }
            moves += 1;
        }
        Played { task_of: at.into_iter().flatten().collect(), moves }
    }

    fn next_move(&self, at: &[Option<usize>], sizes: &[usize]) -> Option<(usize, usize)> {
        (0..at.len()).find_map(|robot| {
            let has = at[robot].map_or(f64::NEG_INFINITY, |task| self.gets(robot, task, sizes[task]));
            let mut best: Option<(f64, usize)> = None;
            for task in
                (0..sizes.len()).filter(|task| at[robot] != Some(*task) && sizes[*task] < self.room[*task])
            {
                let gets = self.gets(robot, task, sizes[task] + 1);
                if best.is_none_or(|(most, _)| gets > most) {
                    best = Some((gets, task));
                }
            }
            best.filter(|(gets, _)| *gets > has + GAIN).map(|(_, task)| (robot, task))
        })
    }
}

impl Played {
    /// Each move is a round in which the robot tells all others how often the partition changed, a time stamp
    /// and the task of each robot.
    pub(super) fn sent(&self) -> Protocol {
        let robots = self.task_of.len();
        let messages = self.moves * robots.saturating_sub(1);
        let rounds = if robots > 1 { self.moves } else { 0 };
        Protocol {
            rounds: rounds as u64,
            messages: messages as u64,
            bytes: (messages * BYTES * (robots + 2)) as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::grape::Reward;

    /// 320 robots and five tasks of the authors' program, with the group that it gave each robot:
    /// <https://github.com/inmo-jang/GRAPE> (MIT), `Fig_7_Visualisation/Result`, circle. The first rows are
    /// the tasks, with their demands.
    const CIRCLE: &str = include_str!("../../tests/grouping/grape_circle.csv");

    fn sizes(game: &Game, task_of: &[usize]) -> Vec<usize> {
        (0..game.room.len()).map(|task| task_of.iter().filter(|at| **at == task).count()).collect()
    }

    fn sum(game: &Game, task_of: &[usize]) -> f64 {
        let sizes = sizes(game, task_of);
        task_of.iter().enumerate().map(|(robot, task)| game.gets(robot, *task, sizes[*task])).sum()
    }

    /// No robot gains by a move of its own to a task with room.
    fn is_stable(game: &Game, task_of: &[usize]) -> bool {
        let sizes = sizes(game, task_of);
        let gains = |robot: usize, to: usize| {
            let from = task_of[robot];
            let has = game.gets(robot, from, sizes[from]);
            to != from && sizes[to] < game.room[to] && game.gets(robot, to, sizes[to] + 1) > has + GAIN
        };
        !(0..task_of.len()).any(|robot| (0..sizes.len()).any(|to| gains(robot, to)))
    }

    /// What a stable partition loses at most (Theorem 3): for each task, the most that p robots would gain
    /// together if they got what each of p gets, instead of what one gets that joins the task as it is.
    fn loss(game: &Game, task_of: &[usize]) -> f64 {
        let (sizes, n) = (sizes(game, task_of), task_of.len());
        let of_task = |task: usize| {
            let gained = |robot: usize| {
                let joined = sizes[task] + usize::from(task_of[robot] != task);
                let now = game.gets(robot, task, joined.min(n));
                (1..=n).map(move |p| p as f64 * (game.gets(robot, task, p) - now))
            };
            (0..n).flat_map(gained).fold(f64::NEG_INFINITY, f64::max)
        };
        (0..sizes.len()).map(of_task).sum()
    }

    fn circle() -> (Game, Vec<usize>) {
        let rows: Vec<Vec<f64>> = CIRCLE
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect();
        let (tasks, robots) = rows.split_at(5);
        let way = |robot: &Vec<f64>, task: &Vec<f64>| libm::hypot(robot[0] - task[0], robot[1] - task[1]);
        let game = Game {
            rewards: vec![tasks.iter().map(|task| task[2]).collect(); robots.len()],
            ways: robots.iter().map(|robot| tasks.iter().map(|task| way(robot, task)).collect()).collect(),
            shares: Reward::Logarithm.shares(robots.len(), tasks.len()),
            room: vec![robots.len(); tasks.len()],
        };
        (game, robots.iter().map(|robot| robot[2] as usize).collect())
    }

    #[test]
    fn the_authors_instance_of_320_robots() {
        let (game, recorded) = circle();
        assert_eq!(sizes(&game, &recorded), [57, 44, 73, 70, 76]);
        assert!(is_stable(&game, &recorded));
        let is_close = |found: f64, published: f64| (found / published - 1.0).abs() < 1e-12;
        let (sum_of, loss_of) = (sum(&game, &recorded), loss(&game, &recorded));
        assert!(is_close(sum_of, 461_790.574_323_467_15), "{sum_of}");
        assert!(is_close(loss_of, 248_674.394_377_350_63), "{loss_of}");
        assert!(is_close(sum_of / (sum_of + loss_of), 0.649_983_594_782_884_6));
        // The lowest id first comes to groups of the same sizes. An independent program found the same.
        let played = game.play();
        assert!(is_stable(&game, &played.task_of));
        assert_eq!((sizes(&game, &played.task_of), played.moves), (sizes(&game, &recorded), 688));
        assert!(is_close(sum(&game, &played.task_of), 461_815.472_844_522_45));
    }

    fn drawn(draws: &mut ChaCha8Rng, turn: usize, robots: usize) -> Game {
        let tasks = 1 + turn % 4;
        let reward = [Reward::Logarithm, Reward::Peaked, Reward::Constant][turn % 3];
        let mut table = |most: f64| {
            (0..robots).map(|_| (0..tasks).map(|_| draws.random_range(0.0..most)).collect()).collect()
        };
        let (rewards, ways) = (table(1.0), table(0.3));
        Game { rewards, ways, shares: reward.shares(robots, tasks), room: vec![robots; tasks] }
    }

    #[test]
    fn ten_thousand_games_end_stable() {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        for turn in 0..10_000 {
            let mut game = drawn(&mut draws, turn, 1 + turn % 13);
            if turn % 5 == 0 {
                game.room = vec![(1 + turn % 13).div_ceil(game.room.len()); game.room.len()];
            }
            let played = game.play();
            assert_eq!(played.task_of.len(), 1 + turn % 13);
            assert!(is_stable(&game, &played.task_of), "{turn}");
        }
    }

    #[test]
    fn of_eight_robots_none_loses_more_than_theorem_3_says() {
        let mut draws = ChaCha8Rng::seed_from_u64(4);
        for turn in 0..150 {
            let game = drawn(&mut draws, turn, 8);
            let tasks = game.room.len();
            let task_of = |code: usize| (0..8).map(|i| code / tasks.pow(i) % tasks).collect::<Vec<usize>>();
            let best = (0..tasks.pow(8)).map(|code| sum(&game, &task_of(code))).fold(f64::MIN, f64::max);
            let played = game.play().task_of;
            assert!(best <= sum(&game, &played) + loss(&game, &played) + 1e-9, "{turn}");
        }
    }
}
