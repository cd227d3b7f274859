//! When a stopping rule looks at the interval's width.

/// Pairs before the first look. With fewer pairs, a spread that is narrow by chance would stop the sweep
/// too often.
pub const FIRST_LOOK: u32 = 20;

/// Pairs at the look after this one: a quarter more.
pub fn next_look(pairs: u32) -> u32 {
    pairs.saturating_add(pairs.div_ceil(4))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::Moments;
    use crate::paired::t_half_width;

    /// Share of 2,000 sequential experiments whose last interval holds the true mean, in percent, if the
    /// bound needs about `pairs` pairs.
    fn coverage(pairs: f64) -> f64 {
        let bound = 1.96 / pairs.sqrt();
        let mut draws = ChaCha8Rng::seed_from_u64(5);
        let mut held = 0;
        for _ in 0..2_000 {
            let mut values: Vec<f64> = Vec::new();
            let mut look = FIRST_LOOK;
            let half = loop {
                while values.len() < look as usize {
                    values.push(StandardNormal.sample(&mut draws));
                }
                let half = t_half_width(&values).unwrap();
                if half <= bound {
                    break half;
                }
                look = next_look(look);
            };
            held += u32::from(Moments::of(&values).mean.unwrap().abs() <= half);
        }
        f64::from(held) / 20.0
    }

    /// The figures of `docs/experiments.md`.
    #[test]
    fn looking_at_the_width_costs_little_coverage() {
        let shares = [15.0, 30.0, 60.0, 150.0].map(coverage);
        assert!(shares.iter().all(|share| (93.0..=96.5).contains(share)), "{shares:?}");
    }
}
