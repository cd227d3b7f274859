use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Bernoulli, Distribution, Normal};
use scenario::Words;

use super::*;
use crate::experiment::PolicySpec;
use crate::metric::Catalogue;

use crate::sweep::folder::{Measured, Results};

fn metrics() -> Catalogue {
    Catalogue::with(&["far".to_owned()], &Words::default())
}

/// Judges trials in which all metrics have the value of the policy.
fn judged(expected: &Expected, trials: &[[Option<f64>; 2]], intervals: usize, is_last: bool) -> Judgement {
    let metrics = metrics();
    let measured = |value: Option<f64>| Measured {
        status: "completed",
        metrics: Some(std::iter::repeat_n(value, metrics.len()).collect()),
        hash: 0,
        failure: None,
    };
    let of_trial = |(trial, values): (u32, &[Option<f64>; 2])| {
        [0, 1].map(|policy| ((0, policy, trial), measured(values[policy])))
    };
    let results: Results = (1..).zip(trials).flat_map(of_trial).collect();
    let trials = Trials::new(&metrics, &results, 1..=trials.len() as u32);
    judge(expected, &trials, 0, intervals, is_last)
}

/// Judges differences of two policies in a sweep's last look.
fn of_differences(expected: &Expected, differences: &[f64], intervals: usize) -> Judgement {
    let trials: Vec<_> = differences.iter().map(|d| [Some(*d), Some(0.0)]).collect();
    judged(expected, &trials, intervals, true)
}

fn read(text: &str) -> Result<Expected, String> {
    let metrics = metrics();
    let policies = ["RNE", "DIS"].map(|name| PolicySpec::parse(name, &policies::standard()).unwrap());
    parse(text, &metrics, &policies).map_err(|error| error.to_string())
}

#[test]
fn expectations_are_read() {
    let share = read("rescuees.far >= 60 in 90 % of seeds").unwrap();
    assert!((share.confidence - 0.95).abs() < 1e-12);
    let Expectation::Share { policy: 0, relation: Relation::AtLeast, value, share, .. } = share.what else {
        panic!()
    };
    assert!((value - 60.0).abs() < 1e-12 && (share - 0.9).abs() < 1e-12);
    let other = read("DIS: rounds < 2 in 50% of seeds (99 %)").unwrap();
    assert!((other.confidence - 0.99).abs() < 1e-12);
    assert!(matches!(other.what, Expectation::Share { policy: 1, relation: Relation::Below, .. }));
    assert!(matches!(
        read("rescuees: RNE > DIS by 5").unwrap().what,
        Expectation::Above { policies: [0, 1], .. }
    ));
    assert!(matches!(
        read("rescuees: RNE < DIS").unwrap().what,
        Expectation::Above { policies: [1, 0], by: 0.0, .. }
    ));
    assert!(matches!(read("energy: RNE = DIS within 3 (90 %)").unwrap().what, Expectation::Equal { .. }));
}

#[test]
fn what_is_no_expectation_is_refused_in_one_sentence() {
    for (text, reason) in [
        ("rescuees", "must be like"),
        ("luck > 3 in 50 % of seeds", "unknown metric \"luck\""),
        ("rescuees > x in 50 % of seeds", "\"x\" must be a number"),
        ("rescuees > 3 in 0 % of seeds", "with P above 0"),
        ("rescuees > 3 in 50 seeds", "in P % of seeds"),
        ("rescuees: RNE > ENG", "\"ENG\" must be a policy of the sweep (RNE, DIS)"),
        ("rescuees: RNE = DIS within -1", "must be above 0"),
        ("rescuees: RNE > DIS (100 %)", "from 50 % to below 100 %"),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.contains(reason) && error.starts_with("expect: "), "{text}: {error}");
    }
}

#[test]
fn looks_double_up_to_the_last() {
    assert_eq!(looks(200), [20, 40, 80, 160, 200]);
    assert_eq!(looks(20), [20]);
    assert_eq!(looks(3), [3]);
}

#[test]
fn every_seed_is_refuted_by_one() {
    let every = read("rescuees > 0 in 100 % of seeds").unwrap();
    let verdict = |values: &[Option<f64>], is_last| {
        let trials: Vec<_> = values.iter().map(|value| [*value, None]).collect();
        judged(&every, &trials, 3, is_last).verdict
    };
    assert_eq!(verdict(&[Some(1.0); 10], false), Verdict::Undecided);
    assert_eq!(verdict(&[Some(1.0); 10], true), Verdict::Holds);
    assert_eq!(verdict(&[Some(1.0), None], false), Verdict::Fails);
}

/// The verdict of one sequential test, with up to 160 trials.
fn sequential(expected: &Expected, mut draw: impl FnMut() -> [f64; 2]) -> Verdict {
    let mut trials = Vec::new();
    let looks = looks(160);
    for look in &looks {
        while trials.len() < *look as usize {
            trials.push(draw().map(Some));
        }
        let judged = judged(expected, &trials, looks.len(), look == looks.last().unwrap());
        if judged.verdict != Verdict::Undecided {
            return judged.verdict;
        }
    }
    Verdict::Undecided
}

/// With the truth exactly at the expected value, either verdict is wrong, and both are rare. Far from it,
/// the correct verdict is found.
#[test]
fn verdicts_are_seldom_wrong_and_clear_cases_are_found() {
    let share = read("rescuees >= 1 in 80 % of seeds").unwrap();
    let mut draws = ChaCha8Rng::seed_from_u64(8);
    let mut wrong = 0;
    for _ in 0..400 {
        let truth = Bernoulli::new(0.8).unwrap();
        let verdict = sequential(&share, || [f64::from(u8::from(truth.sample(&mut draws))), 0.0]);
        wrong += u32::from(verdict != Verdict::Undecided);
    }
    assert!(wrong <= 30, "{wrong} of 400 verdicts at the edge");
    let above = read("rescuees: RNE > DIS by 2").unwrap();
    let noise = Normal::new(0.0, 1.0).unwrap();
    for (truth, expected) in [(4.0, Verdict::Holds), (0.0, Verdict::Fails)] {
        let verdict = sequential(&above, || [truth + noise.sample(&mut draws), noise.sample(&mut draws)]);
        assert_eq!(verdict, expected);
    }
    assert_eq!(sequential(&share, || [1.0, 0.0]), Verdict::Holds);
    assert_eq!(sequential(&share, || [0.0, 0.0]), Verdict::Fails);
}

#[test]
fn eight_differences_other_than_the_commonest_decide() {
    let above = read("rescuees: RNE > DIS").unwrap();
    let mut differences = vec![1.0; 40];
    (0..7).for_each(|i| differences[i] = 2.0 + i as f64 / 10.0);
    let seven = of_differences(&above, &differences, 1);
    assert_eq!((seven.verdict, seven.interval), (Verdict::Undecided, None));
    assert!(seven.needs.unwrap().ends_with("8 differences other than the commonest one (found 7)"));
    differences[7] = 3.0;
    assert_eq!(of_differences(&above, &differences, 1).verdict, Verdict::Holds);
    // The rarer an error may be, the more differences it takes.
    assert_eq!(of_differences(&above, &differences, 100).verdict, Verdict::Undecided);
    // Equal differences tell nothing of those that were not seen, and 19 pairs are too few.
    assert_eq!(of_differences(&above, &[1.0; 200], 1).verdict, Verdict::Undecided);
    let few: Vec<f64> = (1..20).map(f64::from).collect();
    assert_eq!(of_differences(&above, &few, 1).verdict, Verdict::Undecided);
}

#[test]
fn expectations_of_a_file_share_their_error() {
    let above = read("rescuees: RNE > DIS").unwrap();
    let differences: Vec<f64> = (0..40).map(|i| f64::from(i) - 13.0).collect();
    assert_eq!(of_differences(&above, &differences, 1).verdict, Verdict::Holds);
    assert_eq!(
        of_differences(&above, &differences, 20).verdict,
        Verdict::Undecided,
        "shared by twenty intervals"
    );
    let every = read("rescuees > 0 in 100 % of seeds").unwrap().what;
    assert!(above.what.has_interval() && !every.has_interval());
}

/// Neither undecided nor equal within a margin: no difference was possible, or none was seen.
#[test]
fn policies_that_are_the_same_in_all_trials_are_told_to_be() {
    for text in ["rescuees: RNE = DIS within 5", "rescuees: RNE > DIS"] {
        let same = of_differences(&read(text).unwrap(), &[0.0; 40], 1);
        assert_eq!((same.verdict, same.interval), (Verdict::Same, None), "{text}");
        assert_eq!(same.needs.as_deref(), Some("the same in all trials"));
    }
}
