//! Gauges: what a robot reads of its own levels.

use rand::RngExt;
use scenario::Gauge;
use scenario::seed::{Purpose, normal, stream_at};

/// Which reading of which gauge.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    /// Seed of the trial.
    pub seed: u64,
    /// The robot and the level, as one number.
    pub of: u64,
    /// The step.
    pub step: u64,
    /// The time, in seconds.
    pub time_s: f64,
}

/// What a gauge shows of a level, in percent; `None` if the reading fails. Every reading has draws of its
/// own, whether they are used or not.
pub fn read(gauge: &Gauge, level: f64, reading: Reading) -> Option<f64> {
    let Reading { seed, of, step, time_s } = reading;
    let mut draws = stream_at(seed, Purpose::Gauge, of, step);
    let noise = normal(&mut draws, 0.0, gauge.sd);
    let fails = draws.random::<f64>() < gauge.dropout;
    (!fails).then(|| shown(gauge, level + noise, time_s))
}

/// The level with the gauge's bias and drift, in its steps, rounded half up.
fn shown(gauge: &Gauge, level: f64, time_s: f64) -> f64 {
    let level = level + gauge.bias + gauge.drift_per_h * time_s / 3600.0;
    let stepped =
        if gauge.quantum > 0.0 { (level / gauge.quantum + 0.5).floor() * gauge.quantum } else { level };
    stepped.clamp(0.0, 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const READING: Reading = Reading { seed: 1, of: 0, step: 0, time_s: 300.0 };

    /// Computed independently, in Python.
    #[test]
    fn bias_drift_and_steps_are_as_computed_elsewhere() {
        let gauge = Gauge { bias: -2.0, drift_per_h: 6.0, quantum: 5.0, ..Gauge::default() };
        assert_eq!(read(&gauge, 61.3, READING), Some(60.0));
        let half = Gauge { quantum: 5.0, ..Gauge::default() };
        assert_eq!(read(&half, 62.5, READING), Some(65.0));
        assert_eq!(read(&Gauge::default(), 61.3, READING), Some(61.3), "an exact gauge, to the bit");
    }

    #[test]
    fn noise_and_failures_are_as_often_as_said() {
        let gauge = Gauge { sd: 3.0, dropout: 0.1, ..Gauge::default() };
        let readings = (0..20_000).map(|step| read(&gauge, 50.0, Reading { step, ..READING }));
        let shown: Vec<f64> = readings.flatten().collect();
        let share = shown.len() as f64 / 20_000.0;
        let mean = shown.iter().sum::<f64>() / shown.len() as f64;
        let sd = (shown.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / shown.len() as f64).sqrt();
        assert!((share - 0.9).abs() < 0.0064 && (mean - 50.0).abs() < 0.067 && (sd - 3.0).abs() < 0.048);
    }
}
