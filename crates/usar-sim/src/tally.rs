//! The totals of each robot over a trial, and the causes of its delays.

use serde::{Deserialize, Serialize};

use crate::conflict::{Delay, DelayCause, Directive};
use crate::ids::RobotId;
use crate::mission::Activity;
use crate::navigation::Traveller;
use crate::robot::Condition;
use crate::world::Robot;

/// The totals of one robot.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct Tally {
    pub(crate) initial: [f64; 2],
    pub(crate) spent: [f64; 2],
    pub(crate) distance_m: f64,
    pub(crate) waiting_steps: u64,
    delay: Delay,
    stall: Stall,
    pub(crate) longest_stall: (u64, Delay),
}

/// The delays of a robot since it last came nearer to its goal.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Stall {
    /// Whether it is over, and nothing counted since. It only saves time.
    #[serde(skip)]
    is_over: bool,
    /// For each cause, its steps, and the robot for which this robot waited last.
    causes: [(u64, Option<RobotId>); DelayCause::ALL.len()],
}

impl Tally {
    /// The tally of a robot with these initial levels, in percent.
    pub(crate) fn new(initial: [f64; 2]) -> Self {
        Self { initial, ..Self::default() }
    }

    /// Why the robot does not move on, as far as it does not.
    pub(crate) fn delay(&self) -> Delay {
        self.delay
    }

    /// Adds a step, and the distance travelled in it, in metres.
    pub(crate) fn note_step(&mut self, metres: f64) {
        self.distance_m += metres;
        self.waiting_steps += u64::from(self.delay.cause.is_waiting());
    }

    /// Notes in a control step why the robot stops, and the control `steps` since it last came nearer to its
    /// goal. The cause that took most of these steps counts as the cause of the stall.
    pub(crate) fn note_delay(&mut self, delay: Delay, steps: u64) {
        self.delay = delay;
        if steps == 0 {
            if !std::mem::replace(&mut self.stall.is_over, true) {
                self.stall = Stall { is_over: true, ..Stall::default() };
            }
            return;
        }
        self.stall.is_over = false;
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
