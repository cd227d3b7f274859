//! The decisions of a round, as pure functions: which robots take part, which turn back, and when a group
//! goes home.

use scenario::{RestFills, TurnBack};

use crate::event::{ReturnCause, TurnBackCause};
use crate::model::{LowLevel, MissionModel};

/// A robot's levels before a round and the cost of its costliest round, in percent (points).
#[derive(Debug, Clone, Copy)]
pub struct Fitness {
    /// Battery level.
    pub energy: f64,
    /// Health level.
    pub hp: f64,
    /// The most energy and HP that one round has cost.
    pub costliest_round: [f64; 2],
    /// Whether it has rested since it last was in a group. If so, another rest would not help.
    pub has_rested: bool,
}

/// Why a robot must rest before it can take part in a round; `None` if it is fit.
pub fn unfit_cause(rules: &MissionModel, robot: &Fitness) -> Option<TurnBackCause> {
    let is_low = |level: f64, low: LowLevel, cost: f64| {
        let expected = if low.turn_back == TurnBack::BeforeRound { level - cost } else { level };
        expected < low.threshold && !robot.has_rested
    };
    if is_low(robot.energy, rules.low_energy, robot.costliest_round[0]) {
        Some(TurnBackCause::Energy)
    } else if is_low(robot.hp, rules.low_hp, robot.costliest_round[1]) {
        Some(TurnBackCause::Hp)
    } else {
        None
    }
}

/// Why a robot must leave for its rest place now; `None` if it may stay. `way_cost` is the energy that the
/// straight line to the rest place costs, in percent points.
pub fn turn_back_cause(rules: &MissionModel, energy: f64, hp: f64, way_cost: f64) -> Option<TurnBackCause> {
    let at_once = |low: LowLevel, level: f64| low.turn_back == TurnBack::AtOnce && level < low.threshold;
    let keeps_reserve = rules.low_energy.turn_back != TurnBack::AfterRound;
    if at_once(rules.low_energy, energy) || keeps_reserve && energy < rules.rest_reserve * way_cost {
        Some(TurnBackCause::Energy)
    } else if at_once(rules.low_hp, hp) {
        Some(TurnBackCause::Hp)
    } else {
        None
    }
}

/// How many steps a robot with these levels (energy and HP, in percent) rests.
pub(crate) fn rest_steps(rules: &MissionModel, levels: [f64; 2]) -> u64 {
    let [once, twice] = rules.rest_steps;
    let fills_both = rules.rest_fills == RestFills::InTurn && levels.iter().all(|level| *level < 100.0);
    if fills_both { twice } else { once }
}

/// Energy and HP after a rest, in percent.
pub(crate) fn levels_after_rest(rules: &MissionModel, [energy, hp]: [f64; 2]) -> [f64; 2] {
    if rules.rest_fills != RestFills::Low {
        return [100.0; 2];
    }
    let (needs_energy, needs_hp) = (energy < rules.low_energy.threshold, hp < rules.low_hp.threshold);
    let neither = !needs_energy && !needs_hp;
    [
        if needs_energy || neither && energy <= hp { 100.0 } else { energy },
        if needs_hp || neither && energy > hp { 100.0 } else { hp },
    ]
}

/// The remaining capabilities of a group in the field.
#[derive(Debug, Clone, Copy, Default)]
pub struct FieldState {
    /// Members in the field that can carry.
    pub carrying_members: u32,
    /// Rescuees for which these members have room.
    pub free_capacity: u32,
    /// Resources that the members in the field have left.
    pub resources: u32,
    /// Rescuees that are claimed; without a claim, 1 if a member that can carry knows of one to go for.
    pub known_rescuees: u32,
    /// Members that have not yet swept the whole area.
    pub still_searching: u32,
}

/// Why a group goes home now; `None` if it stays.
pub fn return_cause(field: &FieldState) -> Option<ReturnCause> {
    if field.carrying_members == 0 {
        Some(ReturnCause::NobodyCanCarry)
    } else if field.free_capacity == 0 {
        Some(ReturnCause::CapacityUsed)
    } else if field.resources == 0 {
        Some(ReturnCause::ResourcesUsed)
    } else if field.known_rescuees == 0 && field.still_searching == 0 {
        Some(ReturnCause::NothingLeft)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenario::MissionRules;

    fn compiled(rules: MissionRules) -> MissionModel {
        MissionModel::compile(&rules, 1.0, 1.0)
    }

    fn rules(turn_back: TurnBack) -> MissionModel {
        compiled(MissionRules {
            energy_turn_back: turn_back,
            hp_turn_back: turn_back,
            ..MissionRules::default()
        })
    }

    #[test]
    fn a_rest_restores_what_its_rule_says_and_takes_as_long() {
        let rules = |rest_fills| compiled(MissionRules { rest_fills, ..MissionRules::default() });
        let after =
            |fills, levels| (levels_after_rest(&rules(fills), levels), rest_steps(&rules(fills), levels));
        assert_eq!(after(RestFills::Both, [20.0, 60.0]), ([100.0, 100.0], 30));
        assert_eq!(after(RestFills::InTurn, [20.0, 60.0]), ([100.0, 100.0], 60));
        assert_eq!(after(RestFills::InTurn, [20.0, 100.0]), ([100.0, 100.0], 30));
        assert_eq!(after(RestFills::Low, [20.0, 60.0]), ([100.0, 60.0], 30));
        assert_eq!(after(RestFills::Low, [60.0, 29.0]), ([60.0, 100.0], 30));
        assert_eq!(after(RestFills::Low, [20.0, 29.0]), ([100.0, 100.0], 30));
        assert_eq!(after(RestFills::Low, [35.0, 40.0]), ([100.0, 40.0], 30), "none is below: the lower one");
        assert_eq!(after(RestFills::Low, [41.0, 40.0]), ([41.0, 100.0], 30));
    }

    #[test]
    fn every_fact_of_the_field_against_the_decision() {
        let at_work = FieldState {
            carrying_members: 3,
            free_capacity: 9,
            resources: 9,
            known_rescuees: 5,
            still_searching: 1,
        };
        let table = [
            (at_work, None),
            (FieldState { known_rescuees: 0, ..at_work }, None),
            (FieldState { still_searching: 0, ..at_work }, None),
            (FieldState { known_rescuees: 0, still_searching: 0, ..at_work }, Some(ReturnCause::NothingLeft)),
            (FieldState { resources: 0, ..at_work }, Some(ReturnCause::ResourcesUsed)),
            (FieldState { free_capacity: 0, ..at_work }, Some(ReturnCause::CapacityUsed)),
            (
                FieldState { carrying_members: 0, free_capacity: 0, ..at_work },
                Some(ReturnCause::NobodyCanCarry),
            ),
            (FieldState::default(), Some(ReturnCause::NobodyCanCarry)),
        ];
        for (field, cause) in table {
            assert_eq!(return_cause(&field), cause, "{field:?}");
        }
    }

    #[test]
    fn a_robot_turns_back_at_once_by_default_and_always_for_the_way() {
        let cause = |rule, energy, hp, way| turn_back_cause(&rules(rule), energy, hp, way);
        assert_eq!(cause(TurnBack::AtOnce, 29.9, 90.0, 1.0), Some(TurnBackCause::Energy));
        assert_eq!(cause(TurnBack::AtOnce, 30.0, 29.0, 1.0), Some(TurnBackCause::Hp));
        assert_eq!(cause(TurnBack::AtOnce, 30.0, 30.0, 1.0), None);
        assert_eq!(cause(TurnBack::WhenHome, 10.0, 10.0, 1.0), None);
        assert_eq!(cause(TurnBack::WhenHome, 10.0, 10.0, 7.0), Some(TurnBackCause::Energy));
        assert_eq!(cause(TurnBack::AfterRound, 1.0, 1.0, 7.0), None, "no reserve calls it back");
    }

    #[test]
    fn a_robot_is_fit_for_a_round_above_the_thresholds_and_if_asked_for_its_cost() {
        let cause = |rule, energy, cost, has_rested| {
            let robot = Fitness { energy, hp: 90.0, costliest_round: [cost, 0.0], has_rested };
            unfit_cause(&rules(rule), &robot)
        };
        let fit = |rule, energy, cost| cause(rule, energy, cost, false).is_none();
        assert!(fit(TurnBack::AtOnce, 30.0, 50.0));
        assert!(!fit(TurnBack::AtOnce, 29.0, 0.0));
        assert!(!fit(TurnBack::WhenHome, 29.0, 0.0));
        assert!(!fit(TurnBack::AfterRound, 29.0, 0.0));
        assert!(!fit(TurnBack::BeforeRound, 60.0, 40.0));
        assert!(fit(TurnBack::BeforeRound, 75.0, 40.0));
        assert_eq!(cause(TurnBack::BeforeRound, 98.0, 90.0, false), Some(TurnBackCause::Energy));
        assert_eq!(cause(TurnBack::BeforeRound, 98.0, 90.0, true), None, "as fit as it gets");
    }
}
