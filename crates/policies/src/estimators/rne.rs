//! `Rne(t0)`: Relative Needs Entropy between what a robot said of itself and what others measured of it.
//!
//! `T(said, measured)` with the team's weights, each need divided by its maximum over the team, as the
//! policy RNE compares robots (Yang, Parasuraman 2021, *How Can Robots Trust Each Other For Better
//! Cooperation?*); trust `exp(-T / t0)`. `T` is small: with `t0` = 1 a lie of 40 points still gets 0.976.
//! The needs that are compared follow from levels:
//!
//! - energy: said when a round was over, against said when it began less what the fit group-mates said that
//!   they spent; for a robot that had to turn back though it had said that it was far from tired, what it
//!   would have by its own words, against the threshold of a rest;
//! - health: said when a round began, against the median of what its mates measured by its speed.
//!
//! A level that nobody measured counts as said. `T` is the mean over the rounds in which one was measured.

use rne_core::{NeedDistribution, NeedVector, NeedWeights, relative_entropy};
use teaming::evidence::DOUBTED_POINTS;
use teaming::{
    Body, Estimate, Estimator, EstimatorKind, Evidence, Member, PolicyError, Question, SaidRounds, Used,
};

use super::last_said::{last_said, last_said_with, member_of};
use super::medians::by_round;

teaming::options! {
    /// Believes robots whose needs are as they said; levels are those said last.
    #[derive(Copy)]
    pub struct Rne {
        /// The relative needs entropy at which trust has fallen to 1 / e, in nats, above 0.
        pub t0: f64 = 0.005,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Rne", "trust by Relative Needs Entropy of said and measured", Rne::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_RNE"))
}

impl Rne {
    fn checked(self) -> Result<Self, &'static str> {
        let is_scale = self.t0.is_finite() && self.t0 > 0.0;
        if is_scale { Ok(self) } else { Err("t0 must be a number above 0") }
    }
}

impl Estimator for Rne {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let weights = NeedWeights::new(scaled_weights(question)).map_err(PolicyError::Options)?;
        let mut sums = vec![(0.0, 0_u32); question.members.len()];
        for (place, look) in looks(question, evidence) {
            let member = &question.members[place];
            let Some(body) = evidence.body(member.id) else { continue };
            let (sum, count) = &mut sums[place];
            *sum += distrust(member, body, &weights, &look)?;
            *count += 1;
        }
        let trust = |(sum, count): (f64, u32)| {
            let mean = if count == 0 { 0.0 } else { sum / f64::from(count) };
            libm::exp(-mean / self.t0)
        };
        last_said_with(question, sums.into_iter().map(trust))
    }
}

/// The weights of the needs, each divided by its maximum over the team.
fn scaled_weights(question: &Question) -> Vec<f64> {
    let scaled = |(need, weight): (usize, f64)| {
        let values = question.members.iter().map(|member| member.needs.values()[need]);
        let most = values.fold(0.0, f64::max);
        if most > 0.0 { weight / most } else { 0.0 }
    };
    question.weights().into_iter().enumerate().map(scaled).collect()
}

/// What a robot said of its levels, and what was measured of them.
#[derive(Debug, Clone, PartialEq)]
struct Look {
    said: Vec<f64>,
    measured: Vec<f64>,
}

/// RNE from what was said to what was measured, in nats.
fn distrust(member: &Member, body: &Body, weights: &NeedWeights, look: &Look) -> Result<f64, PolicyError> {
    let distribution = |levels: &[f64]| {
        let mut needs = member.needs.values().to_vec();
        for follows in &body.needs {
            needs[follows.need.index()] = follows.at(levels);
        }
        NeedDistribution::of_agent(&NeedVector::new(needs)?, weights)
    };
    let rne =
        distribution(&look.said).and_then(|said| relative_entropy(&said, &distribution(&look.measured)?));
    let rne = rne.map_err(|source| PolicyError::Needs { id: member.id, source })?;
    Ok(rne.nats().unwrap_or(f64::INFINITY))
}

/// The looks at members in the rounds in which one of their levels was measured, by the places of the
/// members.
fn looks(question: &Question, evidence: &Evidence) -> Vec<(usize, Look)> {
    let said = SaidRounds::new(question, evidence);
    let seen = measured_hp(question, evidence);
    let mut looks = Vec::new();
    for round in &question.history {
        for used in said.used(round) {
            let Some(member) = member_of(question, used.robot) else { continue };
            let Some(begun) = said.first(used.robot, round.round) else { continue };
            let energy = energy_look(&said, &used, round.round);
            let found = seen[member].binary_search_by_key(&round.round, |(round, _)| *round);
            let slowing = evidence.body(used.robot).map(|body| body.slowed_by);
            let slowing = slowing.zip(found.ok().map(|place| seen[member][place].1));
            if energy.is_none() && slowing.is_none() {
                continue;
            }
            let mut look = Look { said: begun.to_vec(), measured: begun.to_vec() };
            if let Some((at, [said, measured])) = energy {
                (look.said[at], look.measured[at]) = (said, measured);
            }
            if let Some((at, measured)) = slowing {
                look.measured[at.index()] = measured;
            }
            looks.push((member, look));
        }
    }
    looks
}

/// The place of energy in lists of levels, with what a robot said to have after a round and what it should.
fn energy_look(said: &SaidRounds<'_>, used: &Used, round: u32) -> Option<(usize, [f64; 2])> {
    let (energy, threshold) = said.energy()?;
    let entry = said.entry(used.robot, round)?;
    let expected = said.first(used.robot, round)?[energy] - used.points.as_ref()?[energy];
    if entry.turned_back || entry.lost {
        let was_far = expected > threshold + DOUBTED_POINTS;
        return was_far.then_some((energy, [expected, threshold]));
    }
    if entry.rested {
        return None;
    }
    Some((energy, [said.first(used.robot, round + 1)?[energy], expected.max(0.0)]))
}

/// For each member, the medians of the health that its mates measured in percent, by round.
fn measured_hp(question: &Question, evidence: &Evidence) -> Vec<Vec<(u32, f64)>> {
    let mut all: Vec<Vec<(u32, f64)>> = vec![Vec::new(); question.members.len()];
    for rating in &evidence.ratings {
        let (member, body) = (member_of(question, rating.of), evidence.body(rating.of));
        let hp = body.and_then(|body| rating.measured_level(body.top_mps, body.floor));
        if let Some((member, hp)) = member.zip(hp) {
            all[member].push((rating.round, hp));
        }
    }
    all.into_iter().map(by_round).collect()
}

#[cfg(test)]
mod tests {
    use teaming::{LevelId, LevelNeed, NeedId, RoleId};

    use super::*;

    /// The body and the fresh needs of a robot of the paper's scenario: hp, v, sen, eng, res, cap, obs.
    fn robot(at_100: [f64; 7]) -> (Member, Body) {
        let follows = |need: u16| {
            let (level, at_100) = (LevelId(u16::from(need != 3)), at_100[usize::from(need)]);
            let at_0 = if [0, 3].contains(&need) { 0.0 } else { at_100 / 2.0 };
            LevelNeed { need: NeedId(need), level, at_0, at_100 }
        };
        let needs = [0, 1, 2, 3, 6].map(follows).to_vec();
        let (top_mps, slowed_by, floor) = (at_100[1], LevelId(1), 0.5);
        let body = Body { robot: 0, top_mps, slowed_by, floor, carries: true, guides: false, needs };
        let needs = NeedVector::new(at_100.to_vec()).unwrap();
        let levels = vec![Some(100.0); 2];
        (Member { id: 0, role: RoleId(0), home: [0.0; 2], needs, levels }, body)
    }

    /// Reference: an independent implementation in Python.
    #[test]
    fn lies_are_as_far_from_the_truth_as_computed_elsewhere() {
        let weights = NeedWeights::new(vec![
            0.011_111_111_111_111_112,
            0.467_836_257_309_941_6,
            0.058_479_532_163_742_7,
            0.008_333_333_333_333_333,
            0.1,
            0.166_666_666_666_666_66,
            0.175_438_596_491_228_1,
        ]);
        let weights = weights.unwrap();
        let carrier = robot([100.0, 2.25, 3.0, 150.0, 1.0, 6.0, 0.006]);
        let observer = robot([50.0, 1.5, 18.0, 100.0, 0.0, 0.0, 6.0]);
        let cases = [
            (&carrier, [80.0, 90.0], [60.0, 90.0], 0.007_043_759_727_757_282, 0.992_980_989_404_720_2),
            (&observer, [80.0, 90.0], [60.0, 90.0], 0.005_579_902_203_388_996, 0.994_435_636_535_928_1),
            (&carrier, [40.0, 45.0], [80.0, 90.0], 0.043_160_850_615_181_64, 0.957_757_321_821_967),
        ];
        for ((member, body), said, measured, nats, trust) in cases {
            let look = Look { said: said.to_vec(), measured: measured.to_vec() };
            let found = distrust(member, body, &weights, &look).unwrap();
            assert!((found / nats - 1.0).abs() < 1e-9, "{found} {nats}");
            assert!((libm::exp(-found) / trust - 1.0).abs() < 1e-9);
        }
    }
}
