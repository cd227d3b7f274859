//! The needs of a robot at a frame.

use scenario::Measure;
use usar_sim::vitals::health_factor;

use crate::frame::RobotFrame;
use crate::header::World;

impl World {
    /// The needs of a robot at a frame, in the order of the table of needs, with the precision of the
    /// recorded levels.
    pub fn needs_of(&self, robot: usize, frame: &RobotFrame) -> Vec<f64> {
        let role = self.body_of(robot);
        let level = |millipercent: i32| f64::from(millipercent) / 1000.0;
        let (energy, hp) = (level(frame.motion.energy_millipercent), level(frame.motion.hp_millipercent));
        let factor = health_factor(hp, self.health_floor);
        let room = role.capacity - frame.state.load.min(role.capacity);
        let value = |need: &scenario::NeedFile| match need.measures {
            Measure::Health => role.hp * hp / 100.0,
            Measure::Speed => role.speed_mps * factor,
            Measure::Sensing => role.sensing_m * factor,
            Measure::Energy => role.energy * energy / 100.0,
            Measure::Resources => f64::from(frame.state.resources),
            Measure::Capacity => f64::from(room),
            Measure::Observing => role.observing_m * factor,
            Measure::Constant => role.constants.get(&need.name).copied().unwrap_or(0.0),
        };
        self.needs.iter().map(value).collect()
    }
}
