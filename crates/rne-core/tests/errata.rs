//! `studies/yang2021/docs/errata.md`, line by line: each printed number of the paper beside the exact one.

use rne_core::{NeedDistribution, NeedVector, NeedWeights, relative_entropy};

const R1: &[[f64; 3]] = &[[86.0, 120.0, 30.0]];
const R2: &[[f64; 3]] = &[[20.0, 30.0, 10.0]];
const R3: &[[f64; 3]] = &[[80.0, 115.0, 25.0]];
const G1: &[[f64; 3]] = &[[82.0, 114.0, 24.0], [79.0, 117.0, 23.0]];
const G2: &[[f64; 3]] = &[[40.0, 56.0, 12.0], [56.0, 48.0, 15.0]];

fn distribution(members: &[[f64; 3]]) -> NeedDistribution {
    let weights = NeedWeights::new(vec![6.0, 4.0, 2.0]).unwrap();
    let needs: Vec<NeedVector> =
        members.iter().map(|needs| NeedVector::new(needs.to_vec()).unwrap()).collect();
    NeedDistribution::of_group(&needs, &weights).unwrap()
}

fn trust(from: &[[f64; 3]], to: &[[f64; 3]]) -> f64 {
    relative_entropy(&distribution(from), &distribution(to)).unwrap().nats().unwrap()
}

/// The sum of the paper's Eq. 7 over shares as printed, which need not add up to 1.
fn raw_sum(p: &[f64], q: &[f64], log: fn(f64) -> f64) -> f64 {
    p.iter().zip(q).map(|(p, q)| p * log(p / q)).sum()
}

fn digits(members: &[[f64; 3]], to_digits: fn(f64) -> f64) -> Vec<f64> {
    distribution(members).shares().iter().map(|share| to_digits(*share)).collect()
}

fn rounded_4(share: f64) -> f64 {
    (share * 1e4).round() / 1e4
}

fn truncated_2(share: f64) -> f64 {
    (share * 1e2).floor() / 1e2
}

fn ln(x: f64) -> f64 {
    libm::log(x)
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
}

#[test]
fn example_1_first_share_is_a_typo() {
    let share = distribution(R1).shares()[0];
    close(rounded_4(share), 0.4886, 1e-12);
    close(share, 43.0 / 88.0, 1e-15);
}

#[test]
fn example_1_distributions() {
    assert_eq!(digits(R1, rounded_4), [0.4886, 0.4545, 0.0568]);
    assert_eq!(digits(R2, rounded_4), [0.4615, 0.4615, 0.0769]);
    assert_eq!(digits(R3, rounded_4), [0.4848, 0.4646, 0.0505]);
}

#[test]
fn example_1_trust() {
    close(trust(R1, R2), 0.003_725_460_660_859_402, 1e-12);
    close(trust(R1, R3), 0.000_504_442_597_037_169_6, 1e-12);
    close(trust(R1, R2), 0.00373, 5e-6);
    close(trust(R1, R3), 0.0005, 5e-5);
    assert!(trust(R1, R3) < trust(R1, R2), "R1 trusts R3 more, as the paper says");
}

#[test]
fn example_2_distributions() {
    assert_eq!(digits(G1, rounded_4), [0.4869, 0.4657, 0.0474]);
    assert_eq!(digits(G2, rounded_4), [0.5507, 0.3977, 0.0516]);
}

#[test]
fn example_2_trust_in_g1_comes_from_rounded_shares() {
    close(trust(R1, G1), 0.001_021_780_791_560_237_4, 1e-12);
    close(raw_sum(&digits(R1, rounded_4), &digits(G1, rounded_4), ln), 0.000_915, 5e-7);
}

#[test]
fn example_2_trust_in_g2_comes_from_rounded_shares() {
    close(trust(R1, G2), 0.007_766_973_877_978_922, 1e-12);
    let from_rounded = raw_sum(&digits(R1, rounded_4), &digits(G2, rounded_4), ln);
    close(from_rounded, 0.007_670_31, 5e-9);
    close(from_rounded, 0.007_674, 5e-6);
    assert!(trust(R1, G1) < trust(R1, G2), "R1 trusts G1 more, as the paper says");
}

#[test]
fn example_3_truncates_its_shares() {
    assert_eq!(digits(G1, truncated_2), [0.48, 0.46, 0.04]);
    assert_eq!(digits(G2, truncated_2), [0.55, 0.39, 0.05]);
    close(digits(G1, truncated_2).iter().sum(), 0.98, 1e-12);
}

#[test]
fn example_3_first_direction() {
    close(trust(G1, G2), 0.009_534_892_308_733_986, 1e-12);
    let printed = raw_sum(&digits(G1, truncated_2), &digits(G2, truncated_2), libm::log10);
    close(printed, 0.000_724_19, 5e-9);
    close(printed, 0.0007, 5e-5);
}

#[test]
fn example_3_second_direction() {
    close(trust(G2, G1), 0.009_418_613_384_441_856, 1e-12);
    let printed = raw_sum(&digits(G2, truncated_2), &digits(G1, truncated_2), libm::log10);
    close(printed, 0.009_401_94, 5e-9);
    close(printed, 0.0094, 5e-5);
}

#[test]
fn example_3_asymmetry_is_an_artefact() {
    close(trust(G1, G2) / trust(G2, G1), 1.0123, 5e-5);
}
