//! Energy and health: pure functions for the costs of a robot's actions and for the effect of its health.

use scenario::Rates;

/// Energy spent in one step of `dt` seconds, in the unit of the rates.
pub(crate) fn energy_cost(rates: &Rates, moving: bool, metres: f64, dt: f64) -> f64 {
    let moved = if moving { rates.per_step + rates.per_metre * metres } else { 0.0 };
    moved + rates.per_second * dt
}

/// Health lost in one step of `dt` seconds inside `zones` overlapping zones, which add up, in the unit of the
/// rates.
pub(crate) fn hp_cost(rates: &Rates, zones: usize, metres: f64, dt: f64) -> f64 {
    zones as f64 * (rates.per_step + rates.per_metre * metres + rates.per_second * dt)
}

/// Factor in [floor, 1] on speed, sensing and observing range at a health level in percent. It is 1 at 100 %
/// and falls linearly to `floor` at 0 %.
pub fn health_factor(hp_percent: f64, floor: f64) -> f64 {
    floor + (1.0 - floor) * (hp_percent / 100.0).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRINTED_ENERGY: Rates = Rates { per_step: 0.0045, per_metre: 0.0, per_second: 0.0 };
    const PRINTED_HP: Rates = Rates { per_step: 0.0003, per_metre: 0.0, per_second: 0.0 };

    #[test]
    fn a_minute_of_moving_costs_13_and_a_half_percent_with_the_printed_constant() {
        let cost: f64 = (0..3000).map(|_| energy_cost(&PRINTED_ENERGY, true, 0.04, 0.02)).sum();
        assert!((cost - 13.5).abs() < 1e-9);
        assert!(energy_cost(&PRINTED_ENERGY, false, 0.0, 0.02) == 0.0);
    }

    #[test]
    fn overlapping_zones_add_up() {
        assert!(hp_cost(&PRINTED_HP, 0, 0.04, 0.02) == 0.0);
        assert!((hp_cost(&PRINTED_HP, 2, 0.04, 0.02) - 0.0006).abs() < 1e-15);
    }

    #[test]
    fn health_lowers_abilities_linearly_to_the_floor() {
        for (hp, factor) in [(100.0, 1.0), (50.0, 0.75), (0.0, 0.5), (-1.0, 0.5), (120.0, 1.0)] {
            assert!((health_factor(hp, 0.5) - factor).abs() < 1e-15);
        }
    }
}
