//! CBBA with bundles of sequences: robots plan their whole ways by bids (Choi, Brunet, How 2009,
//! *Consensus-Based Decentralized Auctions for Robust Task Allocation*, IEEE T-RO 25).
//!
//! An item is a skill that a task requires. A robot's score is the sum over its items of `exp(-end / scale)`,
//! with the end of the task on the robot's own way and the work of all tasks, shared by all robots, as the
//! scale. It adds the item that raises its score the most, at the best place of its way, as long as it
//! outbids what it has heard; a bid is at most the one before it in the bundle (Johnson et al. 2012, bid
//! warping), so that bids settle. All robots hear all bids. One that is outbid drops the item and all that it
//! added later. Equal bids go to the lower id.
//!
//! Robots do not know that they will wait for others. So tasks are begun in the order of their planned ends.

use crate::problem::{Problem, Skills};
use crate::schedule::Schedule;

/// Most items of a bundle.
const LONGEST: usize = 10;

/// A bid is above another one if it is more than this above it.
const TIE: f64 = 1e-12;

/// The makespan of the plan by CBBA. Tasks that no bundle has room for follow by the rule of the earliest
/// start.
#[must_use]
pub fn cbba(problem: &Problem) -> f64 {
    let plans = agreed(problem);
    let mut planned = vec![(0.0, Vec::new()); problem.tasks.len()];
    for (robot, plan) in plans.iter().enumerate() {
        for (task, end) in ends(problem, robot, &plan.way) {
            planned[task].0 = f64::max(planned[task].0, end);
            planned[task].1.push(robot);
        }
    }
    let mut schedule = Schedule::new(problem);
    loop {
        let is_planned =
            |task: &usize| problem.tasks[*task].requires & !problem.skills_of(&planned[*task].1) == 0;
        let next = schedule.open().filter(is_planned).min_by(|a, b| planned[*a].0.total_cmp(&planned[*b].0));
        let rule = || {
            let teams = schedule.open().filter_map(|task| schedule.team(task, 0.0));
            teams.min_by(|a, b| a.start.total_cmp(&b.start)).map(|team| (team.task, team.joining))
        };
        let planned = next.map(|task| (task, planned[task].1.clone()));
        let Some((task, team)) = planned.or_else(rule) else { return schedule.makespan() };
        for robot in team {
            if schedule.missing(task) & problem.robots[robot].skills != 0 {
                schedule.commit(robot, task, 0.0);
            }
        }
    }
}

/// A skill that a task requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Item {
    task: usize,
    skill: Skills,
}

/// What a robot wants to do: its items in the order in which it added them, with its bids, and its way.
#[derive(Debug, Clone, Default, PartialEq)]
struct Plan {
    bundle: Vec<(usize, f64)>,
    way: Vec<usize>,
}

/// The plans on which all agree.
fn agreed(problem: &Problem) -> Vec<Plan> {
    let skills = (0..problem.skills).map(|skill| 1 << skill);
    let of_task = |task: usize| skills.clone().map(move |skill| Item { task, skill });
    let items = (0..problem.tasks.len()).flat_map(of_task);
    let items: Vec<Item> = items.filter(|item| problem.tasks[item.task].requires & item.skill != 0).collect();
    let work: f64 = problem.tasks.iter().map(|task| task.duration).sum();
    let auction = Auction { problem, items: &items, scale: (work / problem.robots.len() as f64).max(1e-9) };
    let mut plans = vec![Plan::default(); problem.robots.len()];
    let mut winners: Vec<Option<(f64, usize)>> = vec![None; items.len()];
    for _ in 0..=items.len() * problem.robots.len() {
        let before = plans.clone();
        for (robot, plan) in plans.iter_mut().enumerate() {
            auction.drop_lost(robot, plan, &winners);
            while plan.bundle.len() < LONGEST && auction.add(robot, plan, &winners) {}
        }
        winners = vec![None; items.len()];
        let bids = plans
            .iter()
            .enumerate()
            .flat_map(|(robot, plan)| plan.bundle.iter().map(move |bid| (robot, bid)));
        for (robot, (item, bid)) in bids {
            if winners[*item].is_none_or(|(best, _)| *bid > best + TIE) {
                winners[*item] = Some((*bid, robot));
            }
        }
        if plans == before {
            break;
        }
    }
    plans.iter_mut().enumerate().for_each(|(robot, plan)| auction.drop_lost(robot, plan, &winners));
    plans
}

struct Auction<'p> {
    problem: &'p Problem,
    items: &'p [Item],
    scale: f64,
}

impl Auction<'_> {
    /// Drops the first item that another robot has won, and all that were added later.
    fn drop_lost(&self, robot: usize, plan: &mut Plan, winners: &[Option<(f64, usize)>]) {
        let is_lost = |(item, _): &(usize, f64)| winners[*item].is_some_and(|(_, winner)| winner != robot);
        if let Some(first) = plan.bundle.iter().position(is_lost) {
            plan.bundle.truncate(first);
            let Plan { bundle, way } = plan;
            way.retain(|task| bundle.iter().any(|(item, _)| self.items[*item].task == *task));
        }
    }

    /// Adds the item with the largest bid that wins. Returns whether there is one.
    fn add(&self, robot: usize, plan: &mut Plan, winners: &[Option<(f64, usize)>]) -> bool {
        let most = plan.bundle.last().map_or(f64::INFINITY, |(_, bid)| *bid);
        let own = self.score(robot, plan, &plan.way, None);
        let mut best: Option<(f64, usize, Vec<usize>)> = None;
        for (at, item) in self.items.iter().enumerate() {
            let is_held = plan.bundle.iter().any(|(held, _)| *held == at);
            if is_held || self.problem.robots[robot].skills & item.skill == 0 {
                continue;
            }
            let places = if plan.way.contains(&item.task) { 0..0 } else { 0..plan.way.len() + 1 };
            let inserted = places.map(|place| {
                let mut way = plan.way.clone();
                way.insert(place, item.task);
                way
            });
            let ways = inserted.chain(plan.way.contains(&item.task).then(|| plan.way.clone()));
            for way in ways {
                let bid = (self.score(robot, plan, &way, Some(item.task)) - own).min(most);
                let wins = winners[at]
                    .is_none_or(|(other, winner)| bid > other + TIE || bid > other - TIE && robot <= winner);
                if wins && bid > 0.0 && best.as_ref().is_none_or(|(known, ..)| bid > known + TIE) {
                    best = Some((bid, at, way));
                }
            }
        }
        let Some((bid, item, way)) = best else { return false };
        plan.bundle.push((item, bid));
        plan.way = way;
        true
    }

    /// The score of a robot's way with the items of its plan, and one more of a task.
    fn score(&self, robot: usize, plan: &Plan, way: &[usize], more: Option<usize>) -> f64 {
        let held =
            |task: usize| plan.bundle.iter().filter(|(item, _)| self.items[*item].task == task).count();
        let worth = |task: usize| (held(task) + usize::from(more == Some(task))) as f64;
        ends(self.problem, robot, way)
            .into_iter()
            .map(|(task, end)| worth(task) * libm::exp(-end / self.scale))
            .sum()
    }
}

/// Each task of a robot's way, with its end if the robot waits for nobody.
fn ends(problem: &Problem, robot: usize, way: &[usize]) -> Vec<(usize, f64)> {
    let (mut place, mut now) = (problem.robots[robot].start, 0.0);
    let end = |task: &usize| {
        now += problem.travel[place][task + 1] + problem.tasks[*task].duration;
        place = task + 1;
        (*task, now)
    };
    way.iter().map(end).collect()
}
