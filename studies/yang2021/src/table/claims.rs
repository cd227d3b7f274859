//! Tables of the paper's claims.

use experiments::comparison::{digits, short};
use reports::table::{between, number, range};
use tables::{Entry, Table, labelled, or_dash, right, right_or_dash, valued};

use crate::claims::{CLAIMS, Example, Judged, Shares, Verdict, verdicts_over_worlds};
use crate::scenarios::{PAPERS_TRIALS, Standing};

/// The verdicts on each claim from a scenario's trials: a row for each comparison.
pub(crate) fn claims_table(judged: &Judged) -> Table {
    let few = format!("first {PAPERS_TRIALS} pairs");
    let all = format!("{} pairs", judged.trials);
    let mut table =
        Table::new(["claim", &few, &all, "difference", "95 % interval", "shared interval", "n", "first 10"]);
    for ((claim, few), all) in CLAIMS.iter().zip(&judged.of_few).zip(&judged.of_all) {
        table.add([claim.words, few.verdict.words(), all.verdict.words()]);
        for (part, (few, all)) in claim.parts.iter().zip(few.parts.iter().zip(&all.parts)) {
            table.add([
                format!("  {}", part.words()).into(),
                "".into(),
                "".into(),
                number(all.difference),
                range(all.interval),
                range(all.shared_interval),
                right(all.n),
                right(format!("{} ({})", or_dash(few.difference, short), between(few.interval))),
            ]);
        }
    }
    table
}

/// The paper's examples with exact values.
pub(crate) fn examples_table(examples: &[Example]) -> Table {
    let row = |example: &Example| {
        [
            Entry::from(example.name),
            example.words.into(),
            valued(example.trusting, digits(example.trusting, 4)),
            valued(example.doubting, digits(example.doubting, 4)),
            example.verdict.words().into(),
        ]
    };
    let header = ["example", "claim", "entropy of the one", "of the other", "verdict"];
    Table::of(header, examples.iter().map(row))
}

/// The verdicts expected from experiments of other sizes, and the differences that they find; `None` if
/// there are too few trials.
pub(crate) fn power_table(judged: &Judged) -> Option<Table> {
    let mut table = Table::new(
        "claim,leans to,pairs for 80 %,of 10 pairs: holds,does not,undecided,difference,least found by 10"
            .split(','),
    );
    let share = |share: f64| valued(share, format!("{:.0} %", 100.0 * share));
    if judged.powers.iter().all(Option::is_none) {
        return None;
    }
    for ((claim, power), finding) in CLAIMS.iter().zip(&judged.powers).zip(&judged.of_all) {
        let Some(power) = power else { continue };
        let Shares { holds, does_not_hold } = power.of_few;
        table.add([
            claim.words.into(),
            power.leaning.words().into(),
            right(power.pairs_needed.map_or("> 1000000".to_owned(), |pairs| pairs.to_string())),
            share(holds),
            share(does_not_hold),
            share((1.0 - holds - does_not_hold).max(0.0)),
        ]);
        for (part, found) in claim.parts.iter().zip(&finding.parts) {
            table.add([
                format!("  {}", part.words()).into(),
                "".into(),
                right_or_dash(found.pairs_needed, |pairs| pairs.to_string()),
                "".into(),
                "".into(),
                "".into(),
                number(found.difference),
                number(found.least_found()),
            ]);
        }
    }
    Some(table)
}

/// All verdicts side by side: of each scenario, of all calibrated worlds together, and how many worlds of all
/// readings have which.
pub(crate) fn verdicts_table(judged: &[Judged]) -> Table {
    let main: Vec<&Judged> = judged.iter().filter(|world| world.standing.is_main()).collect();
    let readings = of_readings(judged);
    let over_worlds = verdicts_over_worlds(judged);
    let header = main.iter().flat_map(|scenario| {
        [PAPERS_TRIALS, scenario.trials].map(|trials| format!("{}, {trials} pairs", scenario.scenario))
    });
    let header = ["claim".to_owned()].into_iter().chain(header);
    let together = over_worlds.as_ref().map(|_| "all calibrated worlds".to_owned());
    let last = (readings.len() > 1).then(|| format!("{} readings", readings.len()));
    let mut table = Table::new(header.chain(together).chain(last));
    for (i, claim) in CLAIMS.iter().enumerate() {
        let verdicts =
            main.iter().flat_map(|scenario| [&scenario.of_few, &scenario.of_all].map(|of| of[i].verdict));
        let together = over_worlds.as_ref().map(|verdicts| verdicts[i]);
        let verdicts = verdicts.chain(together).map(|verdict| verdict.words().to_owned());
        let last = (readings.len() > 1).then(|| counted(&readings, i));
        table.add(labelled(claim.words, verdicts.chain(last)));
    }
    table
}

/// The calibrated worlds, one for each reading of when a tired robot rests.
fn of_readings(judged: &[Judged]) -> Vec<&Judged> {
    judged.iter().filter(|world| world.standing != Standing::Printed).collect()
}

/// The name of a world, without that of the calibrated one, of which it is a variant.
fn reading(world: &str) -> &str {
    world.strip_prefix("paper-calibrated-").unwrap_or(world)
}

/// How often each verdict on a claim occurs, in words.
fn counted(worlds: &[&Judged], claim: usize) -> String {
    let all =
        [Verdict::Holds, Verdict::WithinMargin, Verdict::DoesNotHold, Verdict::Same, Verdict::Undecided];
    let is = |world: &&&Judged, verdict| world.of_all[claim].verdict == verdict;
    let counts = all.map(|verdict| (worlds.iter().filter(|world| is(world, verdict)).count(), verdict));
    let found = counts.iter().filter(|(count, _)| *count > 0);
    found.map(|(count, verdict)| format!("{}: {count}", verdict.words())).collect::<Vec<_>>().join(", ")
}

/// For each comparison, the least and the largest difference over the worlds of all readings; `None` if there
/// is only one such world.
pub(crate) fn ranges_table(judged: &[Judged]) -> Option<Table> {
    let readings = of_readings(judged);
    let mut table = Table::new(["claim", "least", "in", "largest", "in"]);
    for (i, claim) in CLAIMS.iter().enumerate() {
        table.add([claim.words]);
        for (j, part) in claim.parts.iter().enumerate() {
            let found =
                |world: &&Judged| Some((world.of_all[i].parts[j].difference?, world.scenario.clone()));
            let mut found: Vec<(f64, String)> = readings.iter().filter_map(found).collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            let ends = [found.first(), found.last()];
            let cells = ends.into_iter().flat_map(|end| match end {
                Some((difference, world)) => [right(short(*difference)), reading(world).into()],
                None => [right("-"), "-".into()],
            });
            table.add(labelled(format!("  {}", part.words()), cells));
        }
    }
    (readings.len() > 1).then_some(table)
}
