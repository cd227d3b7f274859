//! Deceit about the field: what liars tell their group-mates in the place of what they noticed.

use parry2d::math::Vector;
use rand::RngExt;
use scenario::Lie;
use scenario::seed::{Purpose, stream_at};

use super::{Now, Telemetry};
use crate::belief::KnownRobot;
use crate::ids::RobotId;
use crate::model::Model;
use crate::report::{Report, Statement};

/// The number of a liar itself among the things that it misplaces.
const ITSELF: u64 = u64::MAX;

impl Telemetry {
    /// What a robot tells its mates of what it noticed: nothing of what it hides, and wrong places if it
    /// misplaces things.
    pub(super) fn deceive(&self, report: &Report, from: RobotId, now: &Now<'_>) -> Option<Report> {
        let rules = now.model.telemetry.as_ref()?;
        let tells = |is_it: fn(&Lie) -> bool| self.tells(rules, from, now.time_s(), is_it).is_some();
        let is_hidden = match report.says {
            Statement::ZoneIs { on: true, .. } => tells(|lie| matches!(lie, Lie::HideRadiation)),
            Statement::WreckLies { .. } => tells(|lie| matches!(lie, Lie::HideMate)),
            _ => false,
        };
        let mut said = report.clone();
        let off = |thing: u64| self.misplaced_by(from, thing, now.model, now.step);
        if let Statement::DebrisLies { debris, pose, .. } = &mut said.says {
            pose.translation += off(u64::from(*debris));
        } else if let Statement::RescueeWaits { rescuee, at } = &mut said.says {
            *at += off(1 << 32 | u64::from(rescuee.0));
        }
        (!is_hidden).then_some(said)
    }

    /// Where a robot says it is.
    pub(crate) fn place_said(&self, robot: &KnownRobot, model: &Model, step: u64) -> Vector {
        robot.position + self.misplaced_by(robot.id, ITSELF, model, step)
    }

    /// How far from its true place a liar says that a thing is.
    fn misplaced_by(&self, liar: RobotId, thing: u64, model: &Model, step: u64) -> Vector {
        let misplaces = |lie: &Lie| matches!(lie, Lie::Misplace { .. });
        let told = model.telemetry.as_ref().and_then(|rules| {
            let lie = self.tells(rules, liar, step as f64 * model.dt_s(), misplaces)?;
            Some((&lie.lie, rules.seed))
        });
        let Some((Lie::Misplace { by_m }, seed)) = told else { return Vector::ZERO };
        let turn: f64 = stream_at(seed, Purpose::Misplace, u64::from(liar.0), thing).random();
        let angle = std::f64::consts::TAU * turn;
        Vector::new((by_m * libm::cos(angle)) as f32, (by_m * libm::sin(angle)) as f32)
    }
}
