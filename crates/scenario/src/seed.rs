//! The only source of random generators.
//!
//! A stream is identified by the trial's seed, a purpose and an entity, and by nothing else. The policy, the
//! number of robots and the order of other draws do not affect it (common random numbers).

use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, Open01};

/// The purpose of a stream. Its number enters the seed and never changes, because a change would alter every
/// published trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Initial battery level of a robot.
    EnergyLevel = 1,
    /// Initial health level of a robot.
    HpLevel = 2,
    /// Draws of the grouping policy in a round.
    Grouping = 3,
    /// One piece of sampled debris.
    SampledDebris = 4,
    /// One sampled radiation zone.
    SampledRadiation = 5,
    /// A distribution in place of a value, by the hash of the value's path.
    Slot = 6,
    /// One scattered thing.
    Scatter = 7,
    /// The order in which robots become liars.
    Liars = 8,
    /// A reading of a gauge, by robot and level, at a step.
    Gauge = 9,
    /// A lie that is drawn, by robot and level, at a step.
    Lie = 10,
    /// What a robot saw of a mate in a round.
    Witness = 11,
    /// The fate of a message, by link and number.
    Message = 12,
    /// The place of a rescuee that a robot makes up, by robot and number.
    Phantom = 13,
    /// The order in which robots speak at a step.
    Turn = 14,
    /// The number by which sessions know the trial.
    Trial = 15,
    /// How a robot sees a rescuee for a while.
    Sight = 16,
    /// A rescuee that a robot sees and that does not exist, at a step.
    FalseAlarm = 17,
    /// The direction in which a robot misplaces a thing.
    Misplace = 18,
}

/// The number by which sessions know a trial. Its seed, from which the truth follows, does not follow from
/// it.
pub fn trial_number(trial_seed: u64) -> u64 {
    stream(trial_seed, Purpose::Trial, 0).next_u64()
}

/// The stream of one purpose and entity in one trial.
pub fn stream(trial_seed: u64, purpose: Purpose, entity: u64) -> ChaCha8Rng {
    stream_at(trial_seed, purpose, entity, 0)
}

/// The stream of one purpose and entity at one moment of a trial: a step, a round or a number.
pub fn stream_at(trial_seed: u64, purpose: Purpose, entity: u64, moment: u64) -> ChaCha8Rng {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&trial_seed.to_le_bytes());
    seed[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
    seed[16..24].copy_from_slice(&entity.to_le_bytes());
    seed[24..].copy_from_slice(&moment.to_le_bytes());
    ChaCha8Rng::from_seed(seed)
}

/// One draw from a normal distribution by the Box-Muller method. It uses `libm`, so that its bits are the
/// same on every processor.
pub fn normal(stream: &mut ChaCha8Rng, mean: f64, standard_deviation: f64) -> f64 {
    let u: f64 = Open01.sample(stream);
    let v: f64 = Open01.sample(stream);
    let radius = (-2.0 * libm::log(u)).sqrt();
    mean + standard_deviation * radius * libm::cos(2.0 * std::f64::consts::PI * v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_seed_purpose_and_entity() {
        let first = |seed, purpose, entity| stream(seed, purpose, entity).next_u64();
        let base = first(1, Purpose::EnergyLevel, 0);
        assert_eq!(base, first(1, Purpose::EnergyLevel, 0));
        assert_ne!(base, first(2, Purpose::EnergyLevel, 0));
        assert_ne!(base, first(1, Purpose::HpLevel, 0));
        assert_ne!(base, first(1, Purpose::EnergyLevel, 1));
    }

    #[test]
    fn draws_are_pinned() {
        let mut draws = stream(1, Purpose::EnergyLevel, 0);
        let found: Vec<u64> = (0..2).map(|_| normal(&mut draws, 80.0, 20.0).to_bits()).collect();
        assert_eq!(found, PINNED, "a changed generator changes every published trial");
    }

    const PINNED: [u64; 2] = [4_636_479_169_512_081_469, 4_634_333_035_662_590_666];

    #[test]
    fn normal_draws_have_their_mean_and_deviation() {
        let mut draws = stream(7, Purpose::HpLevel, 3);
        let sample: Vec<f64> = (0..20_000).map(|_| normal(&mut draws, 90.0, 10.0)).collect();
        let mean = sample.iter().sum::<f64>() / 20_000.0;
        let variance = sample.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 19_999.0;
        assert!((mean - 90.0).abs() < 0.3 && (variance.sqrt() - 10.0).abs() < 0.2, "{mean} {variance}");
    }
}
