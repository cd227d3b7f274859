//! Comparisons in sentences, and their numbers as text.

use super::{Beyond, Comparison, Judged, LEAST_PAIRS, Verdict};

/// The finding as one sentence.
pub(super) fn in_words(comparison: &Comparison) -> String {
    let Comparison { a, b, n, .. } = comparison;
    let place = comparison.axes.iter().map(|(path, value)| format!("{path}={value}"));
    let of_sums =
        if comparison.is_of_sums { " (as a ratio of sums, since some trial has few rescuees)" } else { "" };
    let metric = format!("{}{of_sums}", comparison.metric);
    let place = place.chain([metric]).collect::<Vec<_>>().join(", ");
    let Some(difference) = comparison.difference else {
        return format!(
            "{place}: nothing can be said of {a} and {b}: there is no pair of trials in which both have a \
             value."
        );
    };
    if comparison.verdict == Verdict::Same {
        return format!("{place}: {a} and {b} are the same in all trials (n = {n}).");
    }
    let (Some([low, high]), Some(p)) = (comparison.interval, comparison.p_holm) else {
        let from = if *n == 1 { "in the only pair".to_owned() } else { format!("over {n} pairs") };
        let distinct = if comparison.repeated > 0 { " of trials that differ" } else { "" };
        return format!(
            "{place}: {a} less {b} is {} {from}{distinct}; {}.",
            short(difference),
            if *n < LEAST_PAIRS {
                format!("a test takes {LEAST_PAIRS} or more")
            } else {
                "too few trials have rescuees for an interval".to_owned()
            }
        );
    };
    let range = format!("95 % interval {} to {}, n = {n}", short(low), short(high));
    let size = short(difference.abs());
    let direction = if difference > 0.0 { "above" } else { "below" };
    let power = power_in_words(comparison);
    let is_clear =
        (low > 0.0 || high < 0.0) && comparison.effect.is_some_and(|effect| effect * difference > 0.0);
    if let Some(equivalence) = equivalence_in_words(comparison, difference, p) {
        return format!("{place}: {equivalence}");
    }
    if comparison.is_found() && !is_clear {
        let shift = comparison.shift.unwrap_or(0.0);
        return format!(
            "{place}: undecided between {a} and {b}: by ranks {a} is {} (shift {}; corrected {}), but the \
             interval of the mean difference, {}, does not exclude zero ({range}).",
            if comparison.effect.unwrap_or(0.0) > 0.0 { "above" } else { "below" },
            short(shift),
            p_in_words(p),
            short(difference)
        );
    }
    if comparison.is_found() {
        let margin = comparison.judged.map_or(String::new(), beyond_in_words);
        return format!(
            "{place}: {a} is {size} {direction} {b} ({range}; corrected {}).{margin}",
            p_in_words(p)
        );
    }
    if is_clear && !comparison.is_found() {
        return format!(
            "{place}: {a} is {size} {direction} {b} ({range}). Taken alone this interval excludes zero, but \
             the corrected test does not confirm it ({}): the difference is not shown.{power}",
            p_in_words(p)
        );
    }
    if size == "0" {
        return format!("{place}: no difference shows between {a} and {b}: their means are equal ({range}).");
    }
    format!(
        "{place}: no difference shows between {a} and {b}: {a} is {size} {direction} ({range}; corrected \
         {}).{power}",
        p_in_words(p)
    )
}

/// What the trials could have shown, where they show nothing: with a margin, how many pairs have power for
/// it; without, the least difference that they detect.
fn power_in_words(comparison: &Comparison) -> String {
    let n = comparison.n;
    if let Some(Judged { margin, pairs_for_margin: Some(pairs), .. }) = comparison.judged {
        let margin = short(margin);
        return if pairs > n as u64 {
            format!(
                " In one uncorrected test, about {} pairs have 80 % power to detect a difference as large as \
                 the margin of {margin}, and to show equivalence if there is none.",
                pairs_in_words(pairs)
            )
        } else {
            format!(
                " In one uncorrected test, these pairs have 80 % power to detect a difference as large as \
                 the margin of {margin}."
            )
        };
    }
    comparison.detectable.map_or(String::new(), |least| {
        format!(
            " With {n} pairs, one uncorrected test has 80 % power to detect a difference of {}.",
            short(least)
        )
    })
}

/// A number of pairs to about two significant digits.
pub(super) fn pairs_in_words(pairs: u64) -> String {
    let unit = 10_u64.pow(pairs.max(1).ilog10().saturating_sub(1));
    let rounded = pairs.div_ceil(unit) * unit;
    if rounded > 1_000_000 { "more than a million".to_owned() } else { rounded.to_string() }
}

/// That two policies are equivalent, in words; `None` if they are not shown to be.
fn equivalence_in_words(comparison: &Comparison, difference: f64, p: f64) -> Option<String> {
    let Judged { margin, interval_90, .. } = comparison.judged.filter(|_| comparison.is_equivalent())?;
    let ([low, high], Comparison { a, b, n, .. }) = (interval_90?, comparison);
    let [low, high, difference, margin] = [low, high, difference, margin].map(short);
    let shown = if comparison.is_found() {
        let p = p_in_words(p);
        format!("; the difference is shown (corrected {p}), and smaller than what was said to matter")
    } else {
        String::new()
    };
    Some(format!(
        "{a} and {b} are equivalent within {margin} (difference {difference}, 90 % interval {low} to {high}, \
         n = {n}){shown}."
    ))
}

/// What is known of the margin where a difference is shown.
fn beyond_in_words(judged: Judged) -> String {
    let margin = short(judged.margin);
    match judged.beyond {
        Some(Beyond::Yes) => format!(" The whole interval lies beyond the margin of {margin}."),
        Some(Beyond::Undecided) | None => {
            format!(" Whether the difference is larger than the margin of {margin} is undecided.")
        }
    }
}

/// About three significant digits.
pub fn short(value: f64) -> String {
    digits(value, 3)
}

/// About this many significant digits, in engineering form for very large and very small numbers.
///
/// ```
/// use statistics::comparison::digits;
///
/// let shown = [0.000_378, 8.333e-6, -12_345_678.0, 52.7].map(|value| digits(value, 3));
/// assert_eq!(shown, ["0.000378", "8.33e-6", "-12.3e6", "52.7"]);
/// ```
pub fn digits(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-5..1e7).contains(&value.abs()) && value.is_finite() {
        let power = 3 * (value.abs().log10() / 3.0).floor() as i32;
        let part = value / 10.0_f64.powi(power);
        // Rounding errors of sums that cancel out are shown as 0.
        return if value.abs() < 1e-12 {
            "0".to_owned()
        } else {
            format!("{}e{power}", self::digits(part, digits))
        };
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { text }
}

/// A p value as papers print it.
pub fn short_p(p: f64) -> String {
    if p < 0.0001 { "< 0.0001".to_owned() } else { format!("{p:.4}") }
}

/// A p value for use in a sentence.
pub fn p_in_words(p: f64) -> String {
    if p < 0.0001 { "p < 0.0001".to_owned() } else { format!("p = {p:.4}") }
}
