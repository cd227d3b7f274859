//! What robots said of themselves round by round, indexed once, and how far it agrees with what their
//! group-mates said.

use crate::evidence::{DOUBTED_POINTS, Evidence, RobotRound};
use crate::history::RoundOutcome;
use crate::ids::place_of;
use crate::levels::ENERGY;
use crate::question::Question;

/// Two times that differ by less than this are the same, in seconds: one of them comes from a subtraction.
pub const SAME_MOMENT_S: f64 = 1e-6;

/// The evidence of the rounds that are over, by robot and round.
#[derive(Debug, Clone)]
pub struct SaidRounds<'e> {
    /// The place of the battery in lists of levels, and its threshold.
    energy: Option<(usize, f64)>,
    levels: usize,
    /// The robots of the ledger, ascending.
    robots: Vec<u32>,
    /// The rounds of the ledger and those after them, ascending.
    rounds: Vec<u32>,
    cells: Vec<Cell<'e>>,
}

/// One robot in one round.
#[derive(Debug, Clone, Copy, Default)]
struct Cell<'e> {
    /// The levels that it said when the round began.
    first: Option<&'e [f64]>,
    entry: Option<&'e RobotRound>,
}

/// What the group-mates of a robot said that they spent in a round.
#[derive(Debug, Clone, PartialEq)]
pub struct Used {
    /// The robot.
    pub robot: u32,
    /// The median fall of each level, in percent points; absent where no mate came back with its group.
    pub points: Option<Vec<f64>>,
}

/// How far the base believes what a robot said of its energy in a round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyOutcome {
    /// The robot.
    pub robot: u32,
    /// The round.
    pub round: u32,
    /// From 0 (false) to 1 (true).
    pub outcome: f64,
}

impl<'e> SaidRounds<'e> {
    /// The index of the evidence of a question.
    #[must_use]
    pub fn new(question: &Question, evidence: &'e Evidence) -> Self {
        let mut robots: Vec<u32> = evidence.ledger.iter().map(|entry| entry.robot).collect();
        let mut rounds: Vec<u32> = evidence.ledger.iter().map(|entry| entry.round).collect();
        rounds.dedup();
        rounds.extend_from_within(..);
        let half = rounds.len() / 2;
        rounds[half..].iter_mut().for_each(|round| *round = round.saturating_add(1));
        for list in [&mut robots, &mut rounds] {
            list.sort_unstable();
            list.dedup();
        }
        let cells = vec![Cell::default(); robots.len() * rounds.len()];
        let energy = question.levels.iter().position(|level| level.name == ENERGY);
        let energy = energy.map(|place| (place, question.levels[place].threshold));
        let mut said = Self { energy, levels: question.levels.len(), robots, rounds, cells };
        for entry in &evidence.ledger {
            if let Some(place) = said.place(entry.robot, entry.round) {
                said.cells[place].entry = Some(entry);
            }
        }
        for report in &evidence.reports {
            let Some(place) = said.place(report.of, report.round) else { continue };
            let cell = &mut said.cells[place];
            if cell.first.is_none() && cell.entry.is_none_or(|trip| !is_after(report.sent_s, trip.left_s)) {
                cell.first = Some(&report.levels);
            }
        }
        said
    }

    fn place(&self, robot: u32, round: u32) -> Option<usize> {
        let row = place_of(&self.robots, robot, |robot| *robot)?;
        let first = self.rounds.first()?;
        let column = place_of(&self.rounds, round.checked_sub(*first)?, |round| round - first)?;
        Some(row * self.rounds.len() + column)
    }

    /// The place of the battery in lists of levels, and its threshold.
    #[must_use]
    pub fn energy(&self) -> Option<(usize, f64)> {
        self.energy
    }

    /// What the base saw of a robot in a round.
    #[must_use]
    pub fn entry(&self, robot: u32, round: u32) -> Option<&'e RobotRound> {
        self.cells[self.place(robot, round)?].entry
    }

    /// The levels that a robot said when a round began, in percent; none if that was not heard.
    #[must_use]
    pub fn first(&self, robot: u32, round: u32) -> Option<&'e [f64]> {
        self.cells[self.place(robot, round)?].first
    }

    /// By how much each level of a robot fell in a round, as it said, in percent points.
    #[must_use]
    pub fn drops(&self, robot: u32, round: u32) -> Option<Vec<f64>> {
        let (before, after) = (self.first(robot, round)?, self.first(robot, round.saturating_add(1))?);
        Some(before.iter().zip(after).map(|(before, after)| before - after).collect())
    }

    /// For each member of the groups of a round, the medians of what its group-mates said that they spent.
    /// Mates that turned back, rested or were lost do not count. It takes n log n for a group of n.
    #[must_use]
    pub fn used(&self, round: &RoundOutcome) -> Vec<Used> {
        let mut all = Vec::new();
        for group in &round.groups {
            let ids: Vec<u32> = group.members.iter().map(|member| member.id).collect();
            let drops: Vec<Option<Vec<f64>>> = ids
                .iter()
                .map(|id| {
                    let is_fit = self.entry(*id, round.round).is_some_and(RobotRound::is_sound);
                    self.drops(*id, round.round).filter(|_| is_fit)
                })
                .collect();
            let medians: Vec<_> = (0..self.levels).map(|level| medians_of_others(&drops, level)).collect();
            let of = |(place, robot): (usize, u32)| Used {
                robot,
                points: medians.iter().map(|medians| medians[place]).collect(),
            };
            all.extend(ids.into_iter().enumerate().map(of));
        }
        all
    }

    /// How far the base believes what each robot said of the energy that it spent, round by round: 1 if it is
    /// what its group-mates spent (the median of those that came back with their group), 0 from
    /// [`DOUBTED_POINTS`] away on. A round in which a robot rested says nothing; one in which it turned back
    /// or was lost says something only if it had said that it was far from tired.
    #[must_use]
    pub fn energy_outcomes(&self, history: &[RoundOutcome]) -> Vec<EnergyOutcome> {
        let of_round = |round: &RoundOutcome| {
            let number = round.round;
            let outcome = move |used: Used| self.energy_outcome(used, number);
            self.used(round).into_iter().filter_map(outcome).collect::<Vec<_>>()
        };
        history.iter().flat_map(of_round).collect()
    }

    fn energy_outcome(&self, Used { robot, points }: Used, round: u32) -> Option<EnergyOutcome> {
        let (energy, threshold) = self.energy?;
        let used = points?[energy];
        let entry = self.entry(robot, round)?;
        let outcome = if entry.turned_back || entry.lost {
            let said = self.first(robot, round)?[energy];
            if said - used <= threshold + DOUBTED_POINTS {
                return None;
            }
            0.0
        } else if entry.rested {
            return None;
        } else {
            1.0 - ((self.drops(robot, round)?[energy] - used).abs() / DOUBTED_POINTS).min(1.0)
        };
        Some(EnergyOutcome { robot, round, outcome })
    }
}

/// Whether one time is later than another, in seconds.
#[must_use]
pub fn is_after(time_s: f64, other_s: f64) -> bool {
    time_s > other_s + SAME_MOMENT_S
}

/// For each place, the median of the values of all others that have one.
fn medians_of_others(drops: &[Option<Vec<f64>>], level: usize) -> Vec<Option<f64>> {
    let known = |place: usize| drops[place].as_ref().map(|drop| (drop[level], place));
    let mut sorted: Vec<(f64, usize)> = (0..drops.len()).filter_map(known).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut rank = vec![None; drops.len()];
    for (at, (_, place)) in sorted.iter().enumerate() {
        rank[*place] = Some(at);
    }
    rank.into_iter().map(|own| median_without(&sorted, own)).collect()
}

/// The median of sorted values without the one of this rank.
fn median_without(sorted: &[(f64, usize)], own: Option<usize>) -> Option<f64> {
    let count = sorted.len() - usize::from(own.is_some());
    let at = |place: usize| sorted.get(place + usize::from(own.is_some_and(|own| place >= own)));
    let upper = at(count / 2)?.0;
    let lower = || at(count / 2 - 1).map(|(value, _)| *value);
    if count % 2 == 1 { Some(upper) } else { Some(f64::midpoint(lower()?, upper)) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::evidence::LevelReport;
    use crate::history::{GroupOutcome, MemberOutcome};
    use crate::ids::TaskId;
    use crate::levels::Level;

    fn report(of: u32, round: u32, energy: f64) -> LevelReport {
        let (sent_s, levels) = (60.0 * f64::from(round), vec![energy, energy / 2.0]);
        let needs = BTreeMap::new();
        LevelReport { of, by: of, round, sent_s, heard_s: sent_s, levels, needs, sd: vec![0.0; 2] }
    }

    /// A question whose robots rest below 30 %.
    fn question() -> Question {
        let levels =
            Level::energy_and_hp().into_iter().map(|level| Level { threshold: 30.0, ..level }).collect();
        Question { levels, ..Question::default() }
    }

    fn entry(robot: u32, turned_back: bool) -> RobotRound {
        let (left_s, back_s) = (60.0, Some(120.0));
        RobotRound { robot, round: 1, left_s, back_s, rescued: 0, turned_back, rested: false, lost: false }
    }

    fn rounds(ids: &[u32]) -> Vec<RoundOutcome> {
        let members = ids.iter().map(|id| MemberOutcome { id: *id, ..MemberOutcome::default() }).collect();
        let group = GroupOutcome { task: TaskId(0), rescued: 0, energy: 0.0, hp: 0.0, members };
        vec![RoundOutcome { round: 1, duration_s: 60.0, groups: vec![group] }]
    }

    /// Robots 0 to 3 said that they spent 12, 10, 14 and 25 points; the mates of the last spent 12.
    #[test]
    fn the_base_compares_what_robots_say_they_spent() {
        let said = [(0, 80.0, 68.0), (1, 70.0, 60.0), (2, 90.0, 76.0), (3, 60.0, 35.0)];
        let reports = [1, 2].into_iter().flat_map(|round| {
            said.iter()
                .map(move |(id, first, then)| report(*id, round, if round == 1 { *first } else { *then }))
        });
        let ledger = (0..4).map(|id| entry(id, false)).collect();
        let evidence = Evidence { reports: reports.collect(), ledger, ..Evidence::default() };
        let outcomes: Vec<f64> = SaidRounds::new(&question(), &evidence)
            .energy_outcomes(&rounds(&[0, 1, 2, 3]))
            .iter()
            .map(|found| found.outcome)
            .collect();
        // used: median of {10, 14, 25} = 14, {12, 14, 25} = 14, {12, 10, 25} = 12, {12, 10, 14} = 12
        assert_eq!(outcomes, [0.8, 0.6, 0.8, 0.0]);
        let mut caught = evidence.clone();
        caught.ledger[0].turned_back = true;
        let of = |evidence: &Evidence| {
            SaidRounds::new(&question(), evidence).energy_outcomes(&rounds(&[0, 1, 2, 3]))[0]
        };
        assert_eq!(of(&caught), EnergyOutcome { robot: 0, round: 1, outcome: 0.0 }, "80 - 14 > 40");
        caught.reports[0].levels[0] = 50.0;
        assert_eq!(of(&caught).robot, 1, "50 - 14 <= 40: it may have been tired");
    }

    #[test]
    fn what_mates_used_is_known_of_both_levels_and_late_reports_do_not_count() {
        let said = [(0, 80.0, 68.0), (1, 70.0, 60.0), (2, 90.0, 76.0)];
        let reports =
            said.iter().flat_map(|(id, before, after)| [report(*id, 1, *before), report(*id, 2, *after)]);
        let ledger = (0..3).map(|id| entry(id, false)).collect();
        let mut evidence = Evidence { reports: reports.collect(), ledger, ..Evidence::default() };
        let used = |evidence: &Evidence| {
            let used = SaidRounds::new(&question(), evidence).used(&rounds(&[0, 1, 2])[0]);
            used.into_iter().map(|used| used.points).collect::<Vec<_>>()
        };
        assert_eq!(used(&evidence), [Some(vec![12.0, 6.0]), Some(vec![13.0, 6.5]), Some(vec![11.0, 5.5])]);
        evidence.reports[0].sent_s = 70.0; // it was out already
        assert_eq!(used(&evidence), [Some(vec![12.0, 6.0]), Some(vec![14.0, 7.0]), Some(vec![10.0, 5.0])]);
        let alone = SaidRounds::new(&question(), &evidence).used(&rounds(&[1])[0]);
        assert_eq!(alone[0].points, None);
    }
}
