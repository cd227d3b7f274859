//! The compiled rules of reports, of their medium, and of deceit in one trial.

use std::sync::Arc;

use parry2d::math::Vector;
use rand::RngExt;
use scenario::seed::{Purpose, stream};
use scenario::shapes::{Outline, vector};
use scenario::{
    AtHome, Channel, Gauge, Happening, LevelSource, Lie, Loss, Mates, MediumRules, PathLoss, Resend,
    Scenario, Who, Witness, rounded_share,
};
use serde::{Deserialize, Serialize};
use teaming::{Expected, NeedId};

use super::{Layout, RobotModel};
use crate::ids::RobotId;

/// How the robots of a trial report, are heard, and lie.
#[derive(Debug, Clone)]
pub struct TelemetryModel {
    /// Seed of the trial.
    pub seed: u64,
    /// Steps between two reports of a robot.
    pub every_steps: u64,
    /// The gauges of energy and health of each role.
    pub gauges: Vec<[Gauge; 2]>,
    /// How robots look at their mates.
    pub witness: Witness,
    /// By what the base decides who must rest.
    pub fitness: LevelSource,
    /// By what the right of way knows levels.
    pub priority: LevelSource,
    /// Whether needs count at most as much as those of a fresh robot.
    pub clip: bool,
    /// The medium; without one, everything is heard at once.
    pub medium: Option<MediumModel>,
    /// All lies of the scenario.
    pub lies: Vec<LieModel>,
    /// For each robot, the lies that it tells by the scenario.
    pub told_by: Vec<Vec<usize>>,
    /// For each robot, when its first lie begins in this trial, in seconds; none for an honest robot.
    pub lies_since_s: Vec<Option<f64>>,
    /// What the base expects of energy and of health before the first report. A robot that was never heard
    /// counts with the means.
    pub initial: [Expected; 2],
}

/// A robot that tells a lie.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Liar {
    /// The robot.
    pub robot: u32,
    /// When its first lie begins, in seconds.
    pub since_s: f64,
}

/// A lie, with what it is about by number.
#[derive(Debug, Clone)]
pub struct LieModel {
    /// The lie.
    pub lie: Lie,
    /// Whether it is about energy, and whether about health.
    pub on_levels: [bool; 2],
    /// The needs that it is about.
    pub on_needs: Vec<NeedId>,
    /// When it begins and ends, in seconds. A lie of the timeline begins with its event.
    pub window_s: [f64; 2],
    /// The least level that is said.
    pub floor: f64,
}

/// The compiled medium.
#[derive(Debug, Clone)]
pub struct MediumModel {
    /// Where the base stands, in metres: in the middle of all homes.
    pub base: Vector,
    /// Greatest distance, in metres.
    pub range: f32,
    /// Loss of messages in bursts.
    pub loss: Loss,
    /// Loss by distance and walls.
    pub path: Option<PathLoss>,
    /// The walls and fixed pieces of debris. Doors and debris that comes and goes do not count.
    pub walls: Arc<[Outline]>,
    /// The blackouts: centre and radius in metres, and from when to when in seconds.
    pub blackouts: Vec<BlackoutModel>,
    /// Delay of every message, in seconds.
    pub delay_s: f64,
    /// Time that a message occupies the channel, in seconds.
    pub air_s: f64,
    /// Whether robots at home are heard at once and always.
    pub is_perfect_at_home: bool,
    /// Whether a lost message is sent again.
    pub resend: Resend,
    /// What each message costs its sender, in the unit of the scenario's costs.
    pub energy_per_message: f64,
}

/// A disc in which nothing is sent or heard for a time.
#[derive(Debug, Clone, Copy)]
pub struct BlackoutModel {
    /// Its centre, in metres.
    pub at: Vector,
    /// Its radius, in metres.
    pub radius: f32,
    /// From when to when, in seconds.
    pub window_s: [f64; 2],
}

impl TelemetryModel {
    /// Whether robots wait for one another before they speak.
    pub(crate) fn has_turns(&self) -> bool {
        self.medium.as_ref().is_some_and(|medium| medium.air_s > 0.0)
    }

    /// The rules of a scenario; `None` where everybody knows how every robot is.
    pub(super) fn compile(
        scenario: &Scenario,
        layout: &Layout,
        robots: &[Arc<RobotModel>],
        seed: u64,
    ) -> Option<Self> {
        if !scenario.goes_by_reports() {
            return None;
        }
        let rules = scenario.reports.clone().unwrap_or_default();
        let gauges = |name: &String| {
            let gauges = rules.sensors.get(name).copied().unwrap_or_default();
            [gauges.energy, gauges.hp]
        };
        let order = permutation(robots.len(), seed);
        let mut told_by = vec![Vec::new(); robots.len()];
        for (number, deceit) in scenario.deceit.iter().enumerate() {
            for id in liars(&deceit.who, scenario, robots, &order) {
                told_by[id.index()].push(number);
            }
        }
        let since = |number: &usize| scenario.deceit[*number].since_s;
        let first = |told: &Vec<usize>| told.iter().map(since).reduce(f64::min);
        let mut lies_since_s: Vec<Option<f64>> = told_by.iter().map(first).collect();
        for moment in &scenario.timeline {
            if let Happening::RobotLies { robot, .. } = moment.event {
                let since = &mut lies_since_s[robot as usize];
                *since = Some(since.map_or(moment.at_s, |since| since.min(moment.at_s)));
            }
        }
        let levels = scenario.initial_levels;
        Some(Self {
            seed,
            every_steps: ((rules.every_s / scenario.dt_s).round() as u64).max(1),
            gauges: scenario.roles.iter().map(|role| gauges(&role.name)).collect(),
            witness: rules.witness,
            fitness: rules.fitness,
            priority: rules.priority,
            clip: rules.clip,
            medium: scenario.medium.as_ref().map(|rules| MediumModel::compile(rules, layout, robots)),
            lies: lies(scenario),
            told_by,
            lies_since_s,
            initial: [levels.energy, levels.hp].map(|of| Expected { mean: of.mean, sd: of.sd }),
        })
    }

    /// The levels that a robot counts with that was never heard, in percent.
    pub fn mean_levels(&self) -> [f64; 2] {
        self.initial.map(|expected| expected.mean)
    }

    /// The robots that tell a lie, sooner or later.
    pub fn liars(&self) -> Vec<Liar> {
        let liar = |(robot, since): (u32, &Option<f64>)| Some(Liar { robot, since_s: (*since)? });
        (0..).zip(&self.lies_since_s).filter_map(liar).collect()
    }

    /// Whether a robot is one of these mates.
    pub fn is_of(&self, mates: Mates, robot: RobotId) -> bool {
        let is_liar = self.lies_since_s[robot.index()].is_some();
        match mates {
            Mates::Honest => !is_liar,
            Mates::Liars => is_liar,
            Mates::All => true,
        }
    }
}

impl MediumModel {
    fn compile(rules: &MediumRules, layout: &Layout, robots: &[Arc<RobotModel>]) -> Self {
        let pieces = layout.debris.iter().enumerate();
        let fixed =
            pieces.filter(|(number, piece)| piece.movable.is_none() && !layout.gates.contains_key(number));
        let on_air = |kbps: f64| (f64::from(rules.bytes) * 8.0 / kbps + rules.overhead_ms) / 1000.0;
        Self {
            base: robots.iter().map(|robot| robot.home).sum::<Vector>() / robots.len() as f32,
            range: rules.range_m.map_or(f32::INFINITY, |range| range as f32),
            loss: rules.loss,
            path: rules.path,
            walls: fixed.map(|(_, piece)| piece.outline()).collect(),
            blackouts: rules
                .blackouts
                .iter()
                .map(|blackout| BlackoutModel {
                    at: vector(blackout.at),
                    radius: blackout.radius_m as f32,
                    window_s: [blackout.from_s, blackout.to_s],
                })
                .collect(),
            delay_s: rules.delay_s,
            air_s: rules.kbps.map_or(0.0, on_air),
            is_perfect_at_home: rules.at_home == AtHome::Perfect,
            resend: rules.resend,
            energy_per_message: rules.energy_per_message,
        }
    }
}

/// All lies: those of the list of deceit, then those of the timeline in the order of the file.
fn lies(scenario: &Scenario) -> Vec<LieModel> {
    let model = |lie: &Lie, on: &[Channel], window_s: [f64; 2], floor: f64| {
        let need = |channel: &Channel| match channel {
            Channel::Need(name) => scenario.needs.iter().position(|need| need.name == *name),
            Channel::Energy | Channel::Hp => None,
        };
        LieModel {
            lie: lie.clone(),
            on_levels: [on.contains(&Channel::Energy), on.contains(&Channel::Hp)],
            on_needs: on.iter().filter_map(need).map(|place| NeedId(place as u16)).collect(),
            window_s,
            floor,
        }
    };
    let listed = scenario.deceit.iter().map(|deceit| {
        let window = [deceit.since_s, deceit.until_s.unwrap_or(f64::INFINITY)];
        model(&deceit.lie, &deceit.on, window, deceit.floor)
    });
    let later = scenario.timeline.iter().filter_map(|moment| match &moment.event {
        Happening::RobotLies { lie, on, .. } => Some(model(lie, on, [moment.at_s, f64::INFINITY], 0.0)),
        _ => None,
    });
    listed.chain(later).collect()
}

/// The robots in an order drawn for the trial.
fn permutation(robots: usize, seed: u64) -> Vec<RobotId> {
    let mut order: Vec<RobotId> = (0..robots as u32).map(RobotId).collect();
    let mut draws = stream(seed, Purpose::Liars, 0);
    for last in (1..order.len()).rev() {
        order.swap(last, draws.random_range(0..=last));
    }
    order
}

/// The robots that tell a lie.
fn liars(who: &Who, scenario: &Scenario, robots: &[Arc<RobotModel>], order: &[RobotId]) -> Vec<RobotId> {
    let first = |count: u32| order[..count as usize].to_vec();
    match who {
        Who::Robots(ids) => ids.iter().map(|id| RobotId(*id)).collect(),
        Who::Count(count) => first(*count),
        Who::Share(share) => first(rounded_share(*share, robots.len() as u32)),
        Who::Role(role, count) => {
            let is_of = |id: &&RobotId| scenario.roles[robots[id.index()].role.index()].name == *role;
            order.iter().filter(is_of).take(*count as usize).copied().collect()
        }
    }
}
