//! What moving, radiation and work cost, compiled.

use scenario::Rates;
use scenario::{CostUnit, Costs};

use crate::vitals::{energy_cost, hp_cost};

/// What moving, radiation and work cost.
#[derive(Debug, Clone, Copy)]
pub struct CostModel {
    /// What costs are counted in.
    pub unit: CostUnit,
    energy: Rates,
    hp: Rates,
    /// Energy of one step of loading.
    pub loading_energy: f64,
    /// HP of one step in the area of the robot's own task.
    pub work_hp: f64,
    /// Energy of driving for a second, without what each metre costs.
    driving_energy_per_second: f64,
    dt_s: f64,
}

impl CostModel {
    pub(super) fn compile(costs: &Costs, dt_s: f64) -> Self {
        Self {
            unit: costs.unit,
            energy: costs.energy,
            hp: costs.hp,
            loading_energy: costs.work.energy_per_second * dt_s,
            work_hp: costs.work.hp_per_second * dt_s,
            driving_energy_per_second: costs.energy.per_step / dt_s + costs.energy.per_second,
            dt_s,
        }
    }

    /// Energy and HP of one step at this speed, in metres per second, in `zones` overlapping radiation zones.
    pub fn of_step(&self, speed: f32, moves: bool, zones: usize) -> [f64; 2] {
        let metres = f64::from(speed) * self.dt_s;
        [energy_cost(&self.energy, moves, metres, self.dt_s), hp_cost(&self.hp, zones, metres, self.dt_s)]
    }

    /// Energy of a way of this length, driven at this speed.
    pub(crate) fn of_way(&self, metres: f64, speed: f64) -> f64 {
        let seconds = metres / speed.max(1e-3);
        seconds * self.driving_energy_per_second + metres * self.energy.per_metre
    }
}
