//! The channel that all robots and the base share: which messages are heard, and when.

use std::collections::BTreeMap;

use parry2d::math::Vector;
use parry2d::query::Ray;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use scenario::seed::{Purpose, normal, stream_at};
use scenario::shapes::Outline;
use scenario::{Loss, PathLoss, Resend};
use serde::{Deserialize, Serialize};

use crate::ids::RobotId;
use crate::model::MediumModel;

/// The state of the channel, and what became of the messages on each link.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Channel {
    /// From when on the channel is free, in seconds.
    free_from_s: f64,
    /// The links on which anything was sent.
    links: BTreeMap<Ends, Link>,
    /// How many messages of each robot were not paid for yet.
    unpaid: BTreeMap<RobotId, u32>,
}

/// The two ends of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Ends {
    /// The sender.
    pub from: RobotId,
    /// Who is to hear it; the base if it is no robot.
    pub to: Option<RobotId>,
}

/// What became of the messages on a link.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Link {
    /// Messages that were sent.
    pub sent: u64,
    /// Messages that were heard; others were lost, or are under way.
    pub heard: u64,
    /// Delays of the messages that were heard, summed up, in seconds.
    pub delay_s: f64,
    /// Whether the link is in its bad state.
    is_bad: bool,
}

/// A message that is about to be sent.
#[derive(Debug, Clone, Copy)]
pub struct Sending {
    /// Seed of the trial.
    pub seed: u64,
    /// From whom and to whom.
    pub ends: Ends,
    /// Where the sender is, in metres.
    pub at: Vector,
    /// Where the other end is, in metres.
    pub to: Vector,
    /// The time, in seconds.
    pub time_s: f64,
    /// Whether the same sending reaches somebody else, so that it takes no more of the channel and of energy.
    pub is_sent: bool,
}

impl Channel {
    /// The links on which anything was sent, by their ends.
    pub fn links(&self) -> impl Iterator<Item = (&Ends, &Link)> {
        self.links.iter()
    }

    /// Sends a message, and again as often as the rules say while it is lost. Returns when it is heard, in
    /// seconds; `None` if it is lost.
    pub fn send(&mut self, medium: &MediumModel, first: Sending) -> Option<f64> {
        let Resend { times, after_s } = medium.resend;
        let at = |time: u32| Sending {
            time_s: first.time_s + f64::from(time) * after_s,
            is_sent: first.is_sent && time == 0,
            ..first
        };
        (0..=times).find_map(|time| self.send_once(medium, at(time)))
    }

    /// How many messages each robot has sent since this was asked last, where they cost something.
    pub fn take_unpaid(&mut self) -> BTreeMap<RobotId, u32> {
        std::mem::take(&mut self.unpaid)
    }

    /// Sends a message once. A lost message occupies the channel, too. Every message has draws of its own.
    fn send_once(&mut self, medium: &MediumModel, sending: Sending) -> Option<f64> {
        let Sending { seed, ends, at, to, time_s, is_sent } = sending;
        let link = self.links.entry(ends).or_default();
        let number = link.sent;
        link.sent += 1;
        if medium.energy_per_message > 0.0 && !is_sent {
            *self.unpaid.entry(ends.from).or_default() += 1;
        }
        let is_drawn = medium.path.is_some() || medium.loss != Loss::None;
        let is_lost_by_chance = is_drawn && {
            let mut draws = stream_at(seed, Purpose::Message, ends.number(), number);
            let (shadow, loss) = (normal(&mut draws, 0.0, 1.0), draws.random::<f64>());
            link.loses(medium.loss, loss, &mut draws)
                | medium.path.is_some_and(|path| shadow > margin(&path, [at, to], &medium.walls))
        };
        let is_lost =
            is_lost_by_chance || (at - to).length() > medium.range || medium.is_blacked_out([at, to], time_s);
        let air_s = if is_sent { 0.0 } else { medium.air_s };
        let sent_s = self.free_from_s.max(time_s) + air_s;
        if air_s > 0.0 {
            self.free_from_s = sent_s;
        }
        (!is_lost).then_some(sent_s + medium.delay_s)
    }

    /// Notes that a message was heard, so long after it was sent, in seconds.
    pub fn note_heard(&mut self, ends: Ends, delay_s: f64) {
        let link = self.links.entry(ends).or_default();
        link.heard += 1;
        link.delay_s += delay_s;
    }
}

impl Ends {
    /// The number of the link in streams of random numbers.
    fn number(self) -> u64 {
        u64::from(self.from.0) | self.to.map_or(0, |to| (u64::from(to.0) + 1) << 32)
    }
}

impl Link {
    /// Mean delay of the messages that were heard, in seconds.
    pub fn mean_delay_s(&self) -> Option<f64> {
        (self.heard > 0).then(|| self.delay_s / self.heard as f64)
    }

    /// Whether the chain of the link loses a message, and its step.
    fn loses(&mut self, loss: Loss, draw: f64, draws: &mut ChaCha8Rng) -> bool {
        let step: f64 = draws.random();
        let Loss::GilbertElliott { p, r, good, bad } = loss else { return false };
        let is_lost = draw < if self.is_bad { bad } else { good };
        self.is_bad = if self.is_bad { step >= r } else { step < p };
        is_lost
    }
}

impl MediumModel {
    fn is_blacked_out(&self, ends: [Vector; 2], time_s: f64) -> bool {
        self.blackouts.iter().any(|blackout| {
            let is_in = |place: &Vector| (*place - blackout.at).length() <= blackout.radius;
            blackout.window_s[0] <= time_s && time_s < blackout.window_s[1] && ends.iter().any(is_in)
        })
    }
}

/// By how many standard deviations of the shadowing the loss of the path between two places is within the
/// budget.
fn margin(path: &PathLoss, [at, to]: [Vector; 2], walls: &[Outline]) -> f64 {
    let distance = f64::from((at - to).length());
    let walls = walls.iter().filter(|wall| is_between(wall, at, to)).count();
    let loss = path.pl0_db + 10.0 * path.n * libm::log10(distance.max(1.0)) + walls as f64 * path.wall_db;
    (path.budget_db - loss) / path.sigma_db
}

fn is_between(wall: &Outline, from: Vector, to: Vector) -> bool {
    let ray = Ray::new(from, to - from);
    wall.shape.intersects_ray(&wall.pose, &ray, 1.0)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn medium() -> MediumModel {
        MediumModel {
            base: Vector::ZERO,
            range: f32::INFINITY,
            loss: Loss::None,
            path: None,
            walls: Arc::new([]),
            blackouts: Vec::new(),
            delay_s: 0.0,
            air_s: 0.0,
            is_perfect_at_home: false,
            resend: Resend::default(),
            energy_per_message: 0.0,
        }
    }

    /// Of messages lost one by one with probability 0.4, up to three sendings lose 6.4 %; each is paid for.
    #[test]
    fn a_lost_message_is_sent_again_and_paid_for_again() {
        let loss = Loss::GilbertElliott { p: 0.5, r: 0.5, good: 0.4, bad: 0.4 };
        let resend = Resend { times: 2, after_s: 0.5 };
        let medium = MediumModel { loss, resend, energy_per_message: 1.0, ..medium() };
        let mut channel = Channel::default();
        let mut attempt = |i: u32| channel.send(&medium, sending(5, 0, Vector::ZERO, f64::from(i)));
        let heard_s: Vec<Option<f64>> = (0..10_000).map(&mut attempt).collect();
        let share = heard_s.iter().filter(|heard| heard.is_none()).count() as f64 / 10_000.0;
        assert!((share - 0.064).abs() < 4.0 * 0.0025, "{share}");
        let late = |(i, heard): (usize, &Option<f64>)| Some(heard.as_ref()? - i as f64);
        let late: Vec<f64> = heard_s.iter().enumerate().filter_map(late).collect();
        assert!([0.0, 0.5, 1.0].iter().all(|s| late.contains(s)), "sent at most twice again, 0.5 s apart");
        let count = channel.links().map(|(_, link)| link.sent).sum::<u64>();
        assert_eq!(channel.take_unpaid().into_values().map(u64::from).sum::<u64>(), count);
        assert!(channel.take_unpaid().is_empty());
    }

    /// A message of a robot to the base.
    fn sending(seed: u64, robot: u32, at: Vector, time_s: f64) -> Sending {
        let ends = Ends { from: RobotId(robot), to: None };
        Sending { seed, ends, at, to: Vector::ZERO, time_s, is_sent: false }
    }

    /// Whether each of so many messages from a place, a second apart, is lost.
    fn losses(medium: &MediumModel, at: Vector, count: u32) -> Vec<bool> {
        let mut channel = Channel::default();
        let mut send = |i| channel.send(medium, sending(5, 0, at, f64::from(i)));
        (0..count).map(|i| send(i).is_none()).collect()
    }

    /// Mean loss and mean length of a burst by the formulas of Gilbert and Elliott, computed independently:
    /// 0.0740741 and 4, 0.0685185 and 2.1033483. Losses of one link follow one another, so that a mean varies
    /// by (1 + c) / (1 - c) more than that of single draws, with a correlation of 1 - p - r.
    #[test]
    fn a_chain_loses_as_many_messages_in_bursts_as_long_as_the_formulas_say() {
        let chains = [(0.0, 1.0, 0.074_074_074, 4.0), (0.01, 0.8, 0.068_518_519, 2.103_348_303)];
        for (good, bad, mean_loss, mean_burst) in chains {
            let loss = Loss::GilbertElliott { p: 0.02, r: 0.25, good, bad };
            let fates = losses(&MediumModel { loss, ..medium() }, Vector::ZERO, 100_000);
            let all = fates.iter().filter(|lost| **lost).count() as f64;
            let bursts = fates.windows(2).filter(|pair| !pair[0] && pair[1]).count() as f64;
            let error = (mean_loss * (1.0 - mean_loss) / 100_000.0 * 1.73 / 0.27_f64).sqrt();
            assert!((all / 100_000.0 - mean_loss).abs() < 3.0 * error, "{all}");
            assert!((all / bursts - mean_burst).abs() < 3.0 * mean_burst / bursts.sqrt(), "{bursts}");
        }
    }

    /// Shares that arrive, computed independently: 0.7733726 at 10 m behind a wall, 0.5117398 at 30 m, and 1
    /// nearby.
    #[test]
    fn a_path_loses_by_distance_and_walls_as_computed_elsewhere() {
        let path = PathLoss { budget_db: 80.0, pl0_db: 40.0, n: 2.7, wall_db: 10.0, sigma_db: 4.0 };
        let wall = Outline::disc(Vector::new(5.0, 0.0), 0.5);
        let cases =
            [(10.0, vec![wall], 0.773_372_6), (30.0, Vec::new(), 0.511_739_8), (0.2, Vec::new(), 1.0)];
        for (distance, walls, arrive) in cases {
            let medium = MediumModel { path: Some(path), walls: walls.into(), ..medium() };
            let lost = losses(&medium, Vector::new(distance, 0.0), 100_000);
            let share = lost.iter().filter(|lost| !**lost).count() as f64 / 100_000.0;
            let error = (arrive * (1.0 - arrive) / 100_000.0_f64).sqrt();
            assert!((share - arrive).abs() <= 3.0 * error, "{share} {arrive}");
        }
    }

    #[test]
    fn messages_wait_for_one_another_and_are_delayed() {
        let medium = MediumModel { air_s: 0.012_24, delay_s: 0.2, ..medium() };
        let mut channel = Channel::default();
        let mut send = |robot| channel.send(&medium, sending(1, robot, Vector::ZERO, 1.0));
        let heard = [send(0), send(1)].map(Option::unwrap);
        assert!((heard[0] - 1.212_24).abs() < 1e-12 && (heard[1] - 1.224_48).abs() < 1e-12, "{heard:?}");
        let ends = Ends { from: RobotId(1), to: None };
        channel.note_heard(ends, heard[1] - 1.0);
        let (_, last) = channel.links().last().unwrap();
        assert_eq!((last.sent, last.heard), (1, 1));
        assert!((last.mean_delay_s().unwrap() - 0.224_48).abs() < 1e-12);
    }

    #[test]
    fn what_is_told_to_many_is_sent_and_paid_for_once() {
        let medium = MediumModel { air_s: 0.5, energy_per_message: 1.0, ..medium() };
        let mut channel = Channel::default();
        let mut tell = |to: Option<RobotId>| {
            let first = sending(1, 0, Vector::ZERO, 1.0);
            let ends = Ends { from: RobotId(0), to };
            channel.send(&medium, Sending { ends, is_sent: to.is_some(), ..first }).unwrap()
        };
        let heard_s = [None, Some(RobotId(1)), Some(RobotId(2))].map(&mut tell);
        assert!(heard_s.iter().all(|heard_s| (heard_s - 1.5).abs() < 1e-12), "{heard_s:?}");
        assert_eq!(channel.take_unpaid(), BTreeMap::from([(RobotId(0), 1)]));
        assert_eq!(channel.links().count(), 3);
    }

    #[test]
    fn nothing_is_heard_out_of_range_and_in_a_blackout() {
        let near = MediumModel { range: 10.0, ..medium() };
        assert_eq!(losses(&near, Vector::new(10.0, 0.0), 2), [false, false]);
        assert_eq!(losses(&near, Vector::new(10.1, 0.0), 2), [true, true]);
        let blackout =
            crate::model::BlackoutModel { at: Vector::new(30.0, 0.0), radius: 5.0, window_s: [1.0, 2.0] };
        let dark = MediumModel { blackouts: vec![blackout], ..medium() };
        assert_eq!(losses(&dark, Vector::new(27.0, 0.0), 3), [false, true, false]);
        assert_eq!(losses(&dark, Vector::new(24.0, 0.0), 3), [false; 3]);
    }
}
