//! Tables of the effects of a sweep's axes, with a row for each case or change.

use experiments::comparison::{Comparison, Effect, Interaction, Verdict, short};
use experiments::experiment::VARIANT;
use tables::{Table, labelled, right};

/// A row for each change of an axis, a column for each policy: the change of the policy's mean in percent,
/// with its interval. If all changes are from the same case and over the same seeds, the first row has the
/// means there.
pub fn effects_table(effects: &[&Effect]) -> Table {
    let percent = |effect: &Effect| match effect.in_percent() {
        Some((change, interval)) => {
            // Trials do not resolve a tenth of a percent. Adding zero removes the sign of -0.0.
            let rounded = |value: f64| (10.0 * value).round() / 10.0 + 0.0;
            let range = interval.map_or(String::new(), |ends| {
                let [low, high] = ends.map(rounded);
                format!(" ({low:.1} to {high:.1}){}", star(effect.is_found()))
            });
            format!("{:+.1} %{range}", rounded(change))
        }
        None => "-".to_owned(),
    };
    let cells = effects.iter().map(|effect| Pivot {
        row: change(&effect.path, &effect.values, &effect.others),
        column: effect.policy.clone(),
        text: percent(effect),
    });
    pivoted("change", means_before(effects).chain(cells))
}

/// The means before any change, if all changes are from the same case and each policy has the same mean there
/// in all of them.
fn means_before<'e>(effects: &'e [&Effect]) -> impl Iterator<Item = Pivot> + 'e {
    let before = |effect: &Effect| effect.means.map(|[there, _]| there);
    let is_alike = |a: &Effect, b: &Effect| a.policy != b.policy || before(a) == before(b);
    let is_one = effects.iter().all(|effect| {
        effect.reference == effects[0].reference && effects.iter().all(|other| is_alike(effect, other))
    });
    effects.iter().filter(move |effect| is_one && effect.case == effects[0].case).map(move |effect| Pivot {
        row: format!("mean, {}", place(&[(effect.path.clone(), effect.values[0].clone())])),
        column: effect.policy.clone(),
        text: before(effect).map_or_else(|| "-".to_owned(), short),
    })
}

/// A row for each change of an axis, a column for each pair of policies: the change of their difference,
/// with its interval.
pub fn interactions_table(interactions: &[&Interaction]) -> Table {
    let text = |one: &Interaction| with_interval(one.change, one.interval, one.is_found());
    let cells = interactions.iter().map(|one| Pivot {
        row: change(&one.path, &one.values, &one.others),
        column: format!("{} - {}", one.a, one.b),
        text: text(one),
    });
    pivoted("change", cells)
}

/// A row for each case, a column for each pair of policies: their difference, with its interval.
pub fn differences_table(comparisons: &[&Comparison]) -> Table {
    let text = |one: &Comparison| with_interval(one.difference, one.interval, one.verdict.is_shown());
    let cells = comparisons.iter().map(|one| Pivot {
        row: place(&one.axes),
        column: format!("{} - {}", one.a, one.b),
        text: text(one),
    });
    pivoted("case", cells)
}

/// The differences of one metric in many cases, for a narrow terminal: a row for each case, a column for each
/// pair of policies. Without intervals: `*` marks what is shown, `=` what is equivalent.
pub fn cases_table(comparisons: &[&Comparison]) -> Table {
    let mark = |one: &Comparison| match one.verdict {
        Verdict::Equivalent | Verdict::Same => " =",
        verdict => star(verdict.is_shown()),
    };
    let text = |one: &Comparison| {
        one.difference.map_or("-".to_owned(), |difference| format!("{}{}", signed(difference), mark(one)))
    };
    let values =
        |one: &Comparison| one.axes.iter().map(|(_, value)| value.as_str()).collect::<Vec<_>>().join(", ");
    let axes = comparisons.first().map_or(&[][..], |one| &one.axes);
    let title = axes.iter().map(|(path, _)| path.as_str()).collect::<Vec<_>>().join(", ");
    let cells = comparisons.iter().map(|one| Pivot {
        row: values(one),
        column: format!("{} - {}", one.a, one.b),
        text: text(one),
    });
    pivoted(&title, cells)
}

struct Pivot {
    row: String,
    column: String,
    text: String,
}

/// Arranges entries in a table, with rows and columns in the order in which they first occur.
fn pivoted(title: &str, entries: impl Iterator<Item = Pivot>) -> Table {
    let (mut rows, mut columns): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    let mut texts: Vec<Vec<String>> = Vec::new();
    let place = |names: &mut Vec<String>, name: String| {
        names.iter().position(|known| *known == name).unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        })
    };
    for Pivot { row, column, text } in entries {
        let (row, column) = (place(&mut rows, row), place(&mut columns, column));
        texts.resize(rows.len(), Vec::new());
        let width = texts[row].len().max(column + 1);
        texts[row].resize(width, "-".to_owned());
        texts[row][column] = text;
    }
    let rows = rows.iter().zip(&texts).map(|(row, texts)| labelled(row, texts.iter().map(right)));
    Table::of(labelled(title, &columns), rows)
}

/// `value (low to high)`, with a star if the difference is statistically shown.
fn with_interval(value: Option<f64>, interval: Option<[f64; 2]>, is_found: bool) -> String {
    let range = |[low, high]: [f64; 2]| format!(" ({} to {}){}", short(low), short(high), star(is_found));
    value.map_or("-".to_owned(), |value| signed(value) + &interval.map_or(String::new(), range))
}

fn signed(value: f64) -> String {
    let text = short(value);
    if value > 0.0 && text != "0" { format!("+{text}") } else { text }
}

fn star(is_found: bool) -> &'static str {
    if is_found { " *" } else { "" }
}

/// A change of an axis in words; for variants, only the variant's name.
fn change(path: &str, [from, to]: &[String; 2], others: &[(String, String)]) -> String {
    let here = if path == VARIANT { to.clone() } else { format!("{path} from {from} to {to}") };
    if others.is_empty() { here } else { format!("{here}, at {}", place(others)) }
}

/// The place of a case on the axes in words; for variants, only the variant's name.
fn place(axes: &[(String, String)]) -> String {
    let one = |(path, value): &(String, String)| {
        if path == VARIANT { value.clone() } else { format!("{path} = {value}") }
    };
    axes.iter().map(one).collect::<Vec<_>>().join(", ")
}
