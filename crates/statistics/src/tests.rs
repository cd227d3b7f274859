//! Statistics compared with `SciPy` 1.17.1 (numpy 2.4.6), whose calls are quoted beside the numbers, and
//! with their own guarantees.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, Normal, StandardNormal};

use super::Moments;
use super::bootstrap::{Width, bca_interval, bca_ratio_interval, interval, ratio_interval, resamples};
use super::paired::{
    detectable, hodges_lehmann, holm, pairs_for_margin, pairs_needed, t_half_width, t_half_width_at,
};
use super::wilcoxon::{EXACT_PAIRS, SignedRank};

const PLANTS: [f64; 15] =
    [6.0, 8.0, 14.0, 16.0, 23.0, 24.0, 28.0, 29.0, 41.0, -48.0, 49.0, 56.0, 60.0, -67.0, 75.0];
const TIES_AND_ZEROS: [f64; 10] = [0.0, 0.0, 1.0, 1.0, -1.0, 2.0, 2.0, 3.0, 3.0, -2.0];
const ALL_POSITIVE: [f64; 10] = [12.0, 5.0, 9.0, 3.0, 14.0, 7.0, 21.0, 6.0, 8.0, 11.0];
const MIXED: [f64; 12] = [0.5, -0.25, 1.75, 2.5, -1.5, 3.25, 0.0, 4.0, -0.75, 1.25, 2.25, 0.5];

/// `wilcoxon(d, zero_method="wilcox", method=PermutationMethod(n_resamples=np.inf))`: statistic and p.
#[test]
fn the_signed_rank_test_is_scipys_with_ties_and_zeros() {
    for (differences, statistic, p) in [
        (PLANTS.as_slice(), 24.0, 0.041_259_765_625),
        (&TIES_AND_ZEROS, 7.0, 0.156_25),
        (&ALL_POSITIVE, 0.0, 0.001_953_125),
        (&MIXED, 11.0, 0.050_781_25),
    ] {
        let test = SignedRank::of(differences);
        assert!(test.is_exact);
        assert_eq!(test.positive.min(test.negative), statistic);
        assert!((test.p - p).abs() < 1e-12, "{} {p}", test.p);
    }
    let nothing = SignedRank::of(&[0.0, 0.0]);
    assert_eq!((nothing.pairs, nothing.p, nothing.effect()), (0, 1.0, 0.0));
    assert_eq!(SignedRank::of(&ALL_POSITIVE).effect(), 1.0);
}

/// All 2^10 choices of signs, one by one.
#[test]
fn counting_signs_is_enumerating_them() {
    let magnitudes = [1.0, 1.0, 2.0, 2.0, 2.0, 3.5, 4.0, 4.0, 5.0, 7.0_f64];
    let signed = |bits: u32| -> Vec<f64> {
        let sign = |i: usize| if bits >> i & 1 == 1 { 1.0 } else { -1.0 };
        magnitudes.iter().enumerate().map(|(i, magnitude)| sign(i) * magnitude).collect()
    };
    let spread = |test: &SignedRank| (test.positive - test.negative).abs();
    let all: Vec<f64> = (0..1024).map(|bits| spread(&SignedRank::of(&signed(bits)))).collect();
    for bits in [0, 1, 37, 513, 1000] {
        let test = SignedRank::of(&signed(bits));
        let as_extreme = all.iter().filter(|other| **other >= spread(&test)).count();
        assert!((test.p - as_extreme as f64 / 1024.0).abs() < 1e-12, "{bits}");
    }
}

/// Both are close to `scipy.stats.norm.sf(...)` of the normal approximation.
#[test]
fn drawn_signs_agree_with_counted_ones() {
    let differences = |count: usize| -> Vec<f64> {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        (0..count)
            .map(|_| 0.1 + <StandardNormal as Distribution<f64>>::sample(&StandardNormal, &mut draws))
            .collect()
    };
    let (counted, drawn) = (differences(EXACT_PAIRS), differences(EXACT_PAIRS + 1));
    let (counted, drawn) = (SignedRank::of(&counted), SignedRank::of(&drawn));
    assert!(counted.is_exact && !drawn.is_exact);
    assert!((counted.p - drawn.p).abs() < 0.02, "{} {}", counted.p, drawn.p);
}

/// `bootstrap((d,), np.mean, method="BCa", n_resamples=2_000_000, batch=100_000,
/// rng=np.random.default_rng(1))`.
#[test]
fn the_plain_interval_is_scipys() {
    for (differences, [low, high], tolerance) in [
        (PLANTS.as_slice(), [-1.666_666_7, 36.333_333_3], 0.5),
        (&ALL_POSITIVE, [7.1, 13.5], 0.11),
        (&MIXED, [0.25, 2.0625], 0.05),
        // Many resamples tie with the mean.
        (&[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.5], 0.11),
    ] {
        let interval = bca_interval(differences, 0.95, 100_000, 1, Width::Plain).unwrap();
        assert!(
            (interval[0] - low).abs() < tolerance && (interval[1] - high).abs() < tolerance,
            "{interval:?}"
        );
    }
    assert_eq!(bca_interval(&[3.0; 4], 0.95, 100, 1, Width::Plain), Some([3.0; 2]));
    assert_eq!(bca_interval(&[3.0], 0.95, 100, 1, Width::Plain), None);
    let again = |seed| bca_interval(&MIXED, 0.95, 1000, seed, Width::Expanded);
    assert_eq!(again(5), again(5));
    assert_ne!(again(5), again(6));
}

#[test]
fn the_same_differences_have_one_interval_and_its_mirror_image() {
    let turned: Vec<f64> = PLANTS.iter().map(|difference| -difference).collect();
    for confidence in [0.95, 0.99] {
        let [low, high] = interval(&PLANTS, confidence).unwrap();
        assert_eq!(interval(&PLANTS, confidence), Some([low, high]));
        let mirrored = interval(&turned, confidence).unwrap();
        assert!((mirrored[0] + high).abs() < 1e-9 && (mirrored[1] + low).abs() < 1e-9, "{mirrored:?}");
    }
    assert_eq!(
        [1, 10, 40, 200, 2_000, 10_000, 100_000].map(resamples),
        [100_000, 100_000, 50_000, 10_000, 10_000, 2_000, 2_000]
    );
}

/// Share of 2,000 experiments of `count` draws whose interval holds the mean, in percent.
fn coverage(count: usize, confidence: f64, mean: f64, draw: impl Fn(&mut ChaCha8Rng) -> f64) -> f64 {
    let resamples = if confidence > 0.95 { 5_000 } else { 2_000 };
    let mut draws = ChaCha8Rng::seed_from_u64(11);
    let holds = |seed: u64, draws: &mut ChaCha8Rng| {
        let values: Vec<f64> = (0..count).map(|_| draw(draws)).collect();
        let [low, high] = bca_interval(&values, confidence, resamples, seed, Width::Expanded).unwrap();
        (low..=high).contains(&mean)
    };
    let held = (0..2_000).filter(|seed| holds(*seed, &mut draws)).count();
    held as f64 / 20.0
}

#[test]
fn the_interval_covers_what_it_says_at_ten_and_at_fifty_pairs() {
    let normal = |draws: &mut ChaCha8Rng| StandardNormal.sample(draws);
    let counts = |draws: &mut ChaCha8Rng| {
        let z: f64 = StandardNormal.sample(draws);
        (5.0 * z).round()
    };
    let ten = [coverage(10, 0.95, 0.0, normal), coverage(10, 0.95, 0.0, counts)];
    let skewed = coverage(50, 0.95, 1.0, |draws| Exp1.sample(draws));
    for share in [ten[0], ten[1], skewed] {
        assert!((93.5..=96.5).contains(&share), "{ten:?} {skewed}");
    }
}

/// Ratios of sums. The true ratio is 2, and the summands' own ratios vary from almost nothing to very much.
#[test]
fn the_interval_of_a_ratio_covers_what_it_says() {
    let mut draws = ChaCha8Rng::seed_from_u64(12);
    let mut held = 0;
    for _ in 0..400 {
        let pairs: Vec<[f64; 2]> = (0..40)
            .map(|_| {
                let under: f64 = Exp1.sample(&mut draws);
                let noise: f64 = StandardNormal.sample(&mut draws);
                [2.0 * under + noise, under]
            })
            .collect();
        let [low, high] = bca_ratio_interval(&pairs, 0.95, 1_000, 1).unwrap();
        held += u32::from((low..=high).contains(&2.0));
    }
    let share = f64::from(held) / 4.0;
    assert!((91.5..=98.0).contains(&share), "{share} % of 400 intervals hold the true ratio");
    assert_eq!(ratio_interval(&[[1.0, 0.0], [2.0, 0.0]], 0.95), None);
    assert_eq!(ratio_interval(&[[2.0, 1.0], [4.0, 2.0]], 0.95), Some([2.0, 2.0]));
}

/// The intervals that refute a claim with three comparisons: 95 % shared by the three.
#[test]
fn a_shared_interval_covers_what_it_says_at_ten_pairs() {
    let share = coverage(10, 1.0 - 0.05 / 3.0, 0.0, |draws| StandardNormal.sample(draws));
    assert!((97.3..=99.2).contains(&share), "{share}");
}

/// `np.median([(a + b) / 2 for i, a in enumerate(d) for b in d[i:]])`.
#[test]
fn the_shift_is_the_median_of_walsh_averages() {
    assert_eq!(hodges_lehmann(&PLANTS), Some(25.0));
    assert_eq!(hodges_lehmann(&TIES_AND_ZEROS), Some(1.0));
    assert_eq!(hodges_lehmann(&MIXED), Some(1.125));
    assert_eq!(hodges_lehmann(&[]), None);
    // 1,001 whole numbers: the means of two are 0, 0.5, ..., 1000, and their median is 500.
    let many: Vec<f64> = (0..=1_000).map(f64::from).collect();
    assert!((hodges_lehmann(&many).unwrap() - 500.0).abs() < 1e-9);
    let skewed: Vec<f64> = (0..=1_000).map(|i| f64::from(i).powi(2)).collect();
    let mut averages: Vec<f64> = skewed
        .iter()
        .enumerate()
        .flat_map(|(i, a)| skewed[i..].iter().map(move |b| f64::midpoint(*a, *b)))
        .collect();
    averages.sort_by(f64::total_cmp);
    assert!((hodges_lehmann(&skewed).unwrap() - averages[(averages.len() - 1) / 2]).abs() < 1e-6);
}

/// Holm's own rule by hand: 0.01 x 4, then 0.03 x 3 twice (never less than before), then 0.2.
#[test]
fn holms_correction() {
    assert_eq!(holm(&[0.03, 0.01, 0.2, 0.04]), [0.09, 0.04, 0.2, 0.09]);
    assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
}

/// From `scipy.stats.nct`: the least n with power 0.8 at d = 0.2, 0.5, 0.8, 1.2 is 199, 34, 15, 8.
#[test]
fn the_pairs_needed_are_those_of_the_noncentral_t() {
    for (effect, pairs) in [(0.2, 199), (0.5, 34), (0.8, 15), (1.2, 8)] {
        let scaled = [-1.0, 1.0].map(|sign| effect + sign * 0.5_f64.sqrt()); // of standard deviation 1
        let needed = pairs_needed(&scaled).unwrap();
        assert!(needed.abs_diff(pairs) <= 1, "{effect}: {needed}");
    }
    assert_eq!(pairs_needed(&[1.0, 1.0]), None);
    assert_eq!(pairs_needed(&[-1.0, 1.0]), None);
}

#[test]
fn the_detectable_difference_and_the_pairs_needed_are_two_sides_of_one_thing() {
    let least = detectable(2.0, 34).unwrap();
    assert!((least - 1.0).abs() < 0.03, "{least}");
    assert_eq!(detectable(1.0, 5), None);
    assert!(detectable(1.0, 6).is_some());
    assert_eq!(detectable(0.0, 34), None);
}

/// With the pairs for a margin, at least about 80 % of experiments detect a true difference as large as the
/// margin, and about 80 % show equivalence where there is no difference.
#[test]
fn the_pairs_for_a_margin_have_80_percent_power() {
    let spread = [-1.0, 1.0].map(|sign| sign * 0.5_f64.sqrt()); // of standard deviation 1
    let (margin, times) = (0.5, 4_000);
    let pairs = pairs_for_margin(&spread, margin).unwrap();
    let mut draws = ChaCha8Rng::seed_from_u64(8);
    let mut share = |truth: f64, is_told: &dyn Fn(f64, &[f64]) -> bool| {
        let of = Normal::new(truth, 1.0).unwrap();
        let told = (0..times).filter(|_| {
            let values: Vec<f64> = (0..pairs).map(|_| of.sample(&mut draws)).collect();
            is_told(Moments::of(&values).mean.unwrap(), &values)
        });
        told.count() as f64 / f64::from(times)
    };
    let detected = share(margin, &|mean, values| mean > t_half_width(values).unwrap());
    let equivalent = share(0.0, &|mean, values| mean.abs() + t_half_width_at(values, 0.9).unwrap() < margin);
    assert!((0.80..0.87).contains(&detected), "{detected}");
    assert!((0.78..0.84).contains(&equivalent), "{equivalent}");
    assert_eq!(pairs_for_margin(&[1.0, 1.0], margin), None);
    assert_eq!(pairs_for_margin(&spread, 1e6), Some(6));
}

/// `scipy.stats.t.interval(0.95, 9, scale=scipy.stats.sem(d))` of [`ALL_POSITIVE`].
#[test]
fn the_t_interval() {
    assert!((t_half_width(&ALL_POSITIVE).unwrap() - T_HALF_WIDTH).abs() < 1e-9);
    assert_eq!(t_half_width(&[1.0]), None);
}

const T_HALF_WIDTH: f64 = 3.727_795_847_319_446_6;

/// 5.34 - 3.20 is not 2.14 in binary: what is tied on paper is tied in ranks.
#[test]
fn differences_that_are_tied_on_paper_are_tied() {
    let in_binary = [5.34 - 3.20, 3.20 - 5.34, 4.28 - 2.14, 1.07, -0.53, 3.21, 0.1 + 0.2 - 0.3];
    assert_ne!(in_binary[0], in_binary[2]);
    let on_paper = [2.14, -2.14, 2.14, 1.07, -0.53, 3.21, 0.0];
    assert_eq!(SignedRank::of(&in_binary), SignedRank::of(&on_paper));
}
