//! The totals of each robot over a trial, and the causes of its delays.

use serde::{Deserialize, Serialize};

use crate::conflict::{Delay, DelayCause, Directive};
use crate::ids::RobotId;
use crate::mission::Activity;
use crate::navigation::Traveller;
use crate::record::RobotRecord;
use crate::robot::{Condition, Robot};

/// The totals of one robot.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct Tally {
    initial: [f64; 2],
    spent: [f64; 2],
    distance_m: f64,
    waiting_steps: u64,
    delay: Delay,
    stall: Stall,
    longest_stall: (u64, Delay),
}

/// The delays of a robot since it last came nearer to its goal.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Stall {
    /// For each cause, its steps, and the robot for which this robot waited last.
    causes: [(u64, Option<RobotId>); DelayCause::ALL.len()],
}

impl Tally {
    /// The tally of a robot with these initial levels, in percent.
    pub(crate) fn new(energy: f64, hp: f64) -> Self {
        Self { initial: [energy, hp], ..Self::default() }
    }

    /// Why the robot does not move on, as far as it does not.
    pub(crate) fn delay(&self) -> Delay {
        self.delay
    }

    /// Adds a travelled distance, in metres.
    pub(crate) fn note_way(&mut self, metres: f64) {
        self.distance_m += metres;
    }

    /// Adds the energy and HP that were spent, in the unit of the scenario's costs.
    pub(crate) fn note_costs(&mut self, [energy, hp]: [f64; 2]) {
        self.spent = [self.spent[0] + energy, self.spent[1] + hp];
    }

    /// The energy and HP that were spent so far, in the unit of the scenario's costs.
    pub(crate) fn spent(&self) -> [f64; 2] {
        self.spent
    }

    /// Notes why the robot stops, and the `steps` since it last came nearer to its goal. The cause that took
    /// most of these steps counts as the cause of the stall.
    pub(crate) fn note_delay(&mut self, delay: Delay, steps: u64) {
        self.waiting_steps += u64::from(delay.cause.is_waiting());
        self.delay = delay;
        if steps == 0 {
            self.stall = Stall::default();
            return;
        }
        let (count, waits_for) = &mut self.stall.causes[delay.cause as usize];
        *count += 1;
        *waits_for = delay.waits_for.or(*waits_for);
        if steps > self.longest_stall.0 {
            let causes = DelayCause::ALL.into_iter().zip(self.stall.causes);
            let most = causes.rev().max_by_key(|(_, (count, _))| *count);
            let delay = most.map(|(cause, (_, waits_for))| Delay { cause, waits_for });
            self.longest_stall = (steps, delay.unwrap_or_default());
        }
    }

    /// The robot's record of the trial.
    pub(crate) fn record(&self, robot: &Robot, dt_s: f64) -> RobotRecord {
        let seconds = |steps: u64| steps as f64 * dt_s;
        RobotRecord {
            robot: robot.id.0,
            role: robot.spec.name.clone(),
            initial_energy: self.initial[0],
            initial_hp: self.initial[1],
            final_energy: robot.energy,
            final_hp: robot.hp,
            energy_spent: self.spent[0],
            hp_lost: self.spent[1],
            distance_m: self.distance_m,
            waiting_s: seconds(self.waiting_steps),
            longest_stall_s: seconds(self.longest_stall.0),
            stall: self.longest_stall.1,
            stranded: robot.condition == Condition::Stranded,
            disabled: robot.condition == Condition::Disabled,
        }
    }
}

/// Why a robot does not move on, as far as it does not.
pub(crate) fn delay_cause(
    robot: &Robot,
    activity: Activity,
    traveller: &Traveller,
    directive: Directive,
) -> DelayCause {
    match robot.condition {
        Condition::Stranded => return DelayCause::Stranded,
        Condition::Disabled => return DelayCause::Disabled,
        Condition::Able => {}
    }
    match directive {
        Directive::Yield { .. } => DelayCause::RightOfWay,
        Directive::Blocked { .. } | Directive::Follow { .. } => DelayCause::Blocked,
        Directive::Retreat { .. } | Directive::GiveWay(_) => DelayCause::MakingRoom,
        Directive::BackOff(_) => DelayCause::BackingOff,
        Directive::Proceed(_) => DelayCause::UnderWay,
        Directive::Stand => match activity {
            Activity::Loading(..) => DelayCause::Loading,
            Activity::Resting(_) => DelayCause::Resting,
            _ if traveller.leads_nowhere() => DelayCause::NoRoute,
            _ => DelayCause::NothingToDo,
        },
    }
}
