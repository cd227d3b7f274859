//! Robots and a resolver for unit tests.

use parry2d::math::Vector;
use scenario::Scenario;

use super::reciprocal::Reciprocal;
use super::{Directive, Mover, PriorityKey, Scratch, Step};
use crate::event::EventLog;
use crate::ids::RobotId;
use crate::model::{Brakes, RightOfWayModel};

/// A ground robot of 0.4 m radius with this preferred velocity, whose route leads 10 m in that direction.
pub(super) fn mover(id: u32, at: [f32; 2], preferred: [f32; 2]) -> Mover<'static> {
    let (position, preferred) = (Vector::from(at), Vector::from(preferred));
    Mover {
        robot: RobotId(id),
        aerial: false,
        position,
        velocity: Vector::ZERO,
        preferred,
        retreat_left: None,
        stalled_steps: 0,
        leg_left: 10.0,
        route: if preferred == Vector::ZERO {
            &[]
        } else {
            Box::leak(Box::new([position + 10.0 * preferred.normalize()]))
        },
        passages: &[],
        trail: &[],
        radius: 0.4,
        speed: 2.0,
        brakes: Brakes { deceleration: 3.0, delay_s: 0.0 },
        priority: PriorityKey { class: 0, level: 50.0, robot: RobotId(id) },
        known: None,
        can_make_room: true,
    }
}

/// The rules for steps of 0.02 s in an arena of 20 m.
pub(super) fn rules_of_right_of_way() -> RightOfWayModel {
    let text = "(name: \"t\", duration_s: 10, dt_s: 0.02, arena_m: (20, 20), team: [(role: \"robot\", \
                count: 1, center: (5, 5), width_m: 0)], roles: [(name: \"robot\")], errands: [(robot: 0, \
                to: [(9, 9)])])";
    RightOfWayModel::compile(&Scenario::parse(text, "t.ron".as_ref()).unwrap())
}

/// The default rule, with all that its steps need.
pub(super) struct Bench {
    pub(super) model: RightOfWayModel,
    pub(super) state: Reciprocal,
    scratch: Scratch,
    directives: Vec<Directive>,
    log: EventLog,
}

impl Bench {
    pub(super) fn new() -> Self {
        Self {
            model: rules_of_right_of_way(),
            state: Reciprocal::default(),
            scratch: Scratch::default(),
            directives: Vec::new(),
            log: EventLog::default(),
        }
    }

    /// A part of the step of these robots.
    pub(super) fn step(&mut self, movers: &mut [Mover], act: fn(&mut Reciprocal, &mut Step)) {
        let Self { model, state, scratch, directives, log } = self;
        directives.resize(movers.len(), Directive::Stand);
        scratch.neighbours.sort(movers);
        act(state, &mut Step { model, scratch, movers, directives, log });
    }

    /// The directives of these robots.
    pub(super) fn resolve(&mut self, movers: &mut [Mover]) -> Vec<Directive> {
        self.step(movers, Reciprocal::resolve);
        self.directives.clone()
    }
}
