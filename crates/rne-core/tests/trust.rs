//! Properties of Relative Needs Entropy.

use proptest::prelude::*;
use rne_core::{NeedDistribution, NeedVector, NeedWeights, jeffreys, jensen_shannon, relative_entropy};

fn distribution(needs: &[f64], weights: &[f64]) -> NeedDistribution {
    let (needs, weights) = (NeedVector::new(needs.to_vec()), NeedWeights::new(weights.to_vec()));
    NeedDistribution::of_agent(&needs.unwrap(), &weights.unwrap()).unwrap()
}

/// Two needs vectors and weights of the same length, with zeros among the needs.
fn two_robots() -> impl Strategy<Value = (Vec<f64>, Vec<f64>, Vec<f64>)> {
    (1..9_usize).prop_flat_map(|needs| {
        let need = prop_oneof![4 => 0.001..1e4_f64, 1 => Just(0.0)];
        let vector = proptest::collection::vec(need, needs)
            .prop_filter("some need", |needs| needs.iter().any(|need| *need > 0.0));
        (vector.clone(), vector, proptest::collection::vec(0.01..100.0_f64, needs))
    })
}

proptest! {
    #[test]
    fn rne_is_never_negative_and_trust_is_a_share((a, b, weights) in two_robots()) {
        let rne = relative_entropy(&distribution(&a, &weights), &distribution(&b, &weights)).unwrap();
        let lacks = a.iter().zip(&b).any(|(a, b)| *a > 0.0 && *b == 0.0);
        prop_assert_eq!(rne.is_infinite(), lacks);
        prop_assert!(rne.nats().is_none_or(|nats| nats >= 0.0 && nats.is_finite()));
        prop_assert!((0.0..=1.0).contains(&rne.trust()));
    }

    #[test]
    fn rne_is_zero_for_proportional_needs((a, _, weights) in two_robots(), factor in 0.001..1000.0_f64) {
        let scaled: Vec<f64> = a.iter().map(|need| need * factor).collect();
        let rne = relative_entropy(&distribution(&a, &weights), &distribution(&scaled, &weights)).unwrap();
        prop_assert!(rne.nats().unwrap() < 1e-12);
    }

    #[test]
    fn rne_is_above_zero_for_different_distributions((a, b, weights) in two_robots()) {
        let (p, q) = (distribution(&a, &weights), distribution(&b, &weights));
        let apart = p.shares().iter().zip(q.shares()).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
        let rne = relative_entropy(&p, &q).unwrap();
        // Pinsker: the RNE is at least half the squared L1 distance.
        prop_assert!(apart < 1e-6 || rne.nats().is_none_or(|nats| nats >= 0.5 * apart * apart));
    }

    #[test]
    fn scaling_all_weights_changes_nothing((a, b, weights) in two_robots(), factor in 0.001..1000.0_f64) {
        let scaled: Vec<f64> = weights.iter().map(|weight| weight * factor).collect();
        let rne = |weights: &[f64]| {
            relative_entropy(&distribution(&a, weights), &distribution(&b, weights)).unwrap().nats()
        };
        match (rne(&weights), rne(&scaled)) {
            (Some(one), Some(other)) => prop_assert!((one - other).abs() < 1e-10 * one.max(1.0)),
            (one, other) => prop_assert_eq!(one, other),
        }
    }

    #[test]
    fn symmetric_divergences_are_symmetric_and_bounded((a, b, weights) in two_robots()) {
        let (p, q) = (distribution(&a, &weights), distribution(&b, &weights));
        prop_assert_eq!(jeffreys(&p, &q).unwrap().nats(), jeffreys(&q, &p).unwrap().nats());
        let js = jensen_shannon(&p, &q).unwrap();
        prop_assert!((js - jensen_shannon(&q, &p).unwrap()).abs() < 1e-12);
        prop_assert!((0.0..=std::f64::consts::LN_2 + 1e-12).contains(&js));
    }
}
