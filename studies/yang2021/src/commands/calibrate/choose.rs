//! `--choose`: finds which of several calibrated candidates is nearest to the recorded trials.

use experiments::comparison::digits;
use scenario::Scenario;
use yang2021::calibration::{CALIBRATED, Candidate, Judged, NOT_TOLD_APART, POLICY, Target, judge};
use yang2021::table::choice_table;

use super::Arguments;
use usar::prelude::*;

/// Seeds that no calibration uses.
const FIRST_SEED: u64 = 200_001;

/// Runs the candidates, and tells how near each is to the recorded trials.
pub(super) fn execute(asked: &Arguments, registry: &Registry) -> Result<Report, Failure> {
    let read = |folder: &PathBuf| Candidate::read(folder, &asked.target, registry);
    let candidates = asked.choose.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let (base, _) = Scenario::load(&asked.choose[0].join(CALIBRATED)).map_err(Failure::input)?;
    let target = Target::load(&asked.target, &base)?;
    let (first, trials) = (asked.first_seed.unwrap_or(FIRST_SEED), asked.trials.unwrap_or(40));
    let seeds: Vec<u64> = (first..first + u64::from(trials)).collect();
    let measure = |candidate: Candidate| {
        let quantities = candidate.measure(&seeds, &STOP)?;
        let quantities = quantities.ok_or_else(|| Failure::Interrupted("stopped".to_owned()))?;
        Ok((candidate, quantities))
    };
    let measured = asked.progress.work(candidates.len(), "candidates", |bar| {
        candidates.into_iter().map(measure).inspect(|_| bar.inc(1)).collect::<Result<Vec<_>, Failure>>()
    })??;
    let judged = judge(&target, &measured);
    if let Some(path) = &asked.out {
        write_csv(path, &target, &judged)?;
        write_identified(&path.with_file_name("identified.csv"), &measured)?;
    }
    Ok(told(&target, &judged, &seeds))
}

fn told(target: &Target, judged: &[Judged], seeds: &[u64]) -> Report {
    let mut out = Report::default();
    out.show("candidates", choice_table(target, judged));
    out.say(format!(
        "mean ± sample standard deviation of {POLICY} over {} trials (seeds {} to {}); data: {} trials",
        seeds.len(),
        seeds[0],
        seeds[seeds.len() - 1],
        target.trials
    ));
    let rivals = judged.iter().skip(1).filter(|judged| judged.share_nearest >= NOT_TOLD_APART);
    let alike: Vec<&str> = rivals.map(|judged| judged.candidate.as_str()).collect();
    out.say(format!("the choice: {}, misfit {}", judged[0].candidate, digits(judged[0].misfit, 3)));
    out.say(match alike.as_slice() {
        [] => "no other is the nearest in 5 % of the draws".to_owned(),
        alike => format!("not to be told from it by these data: {}", alike.join(", ")),
    });
    out
}

/// How well the values of each candidate are known.
fn write_identified(path: &Path, measured: &[(Candidate, Vec<Vec<f64>>)]) -> Result<(), Failure> {
    let header = ["candidate", "parameter", "value", "standard_error", "trades_off_with", "correlation"];
    let rows = measured.iter().flat_map(|(candidate, _)| {
        candidate.identified().into_iter().map(|one| {
            let [value, error, correlation] =
                [one.value, one.standard_error, one.correlation].map(|number| digits(number, 4));
            vec![candidate.name.clone(), one.parameter, value, error, one.trades_off_with, correlation]
        })
    });
    Destination::new("--out", path, true)?.write(tables::csv(header, rows)?.as_bytes())
}

fn write_csv(path: &Path, target: &Target, judged: &[Judged]) -> Result<(), Failure> {
    let names = target.quantities.iter().flat_map(|q| [format!("{}_mean", q.name), format!("{}_sd", q.name)]);
    let first = ["candidate", "misfit", "edge_penalty", "share_nearest"].map(str::to_owned);
    let row = |row: &Judged| {
        let numbers = [row.misfit, row.edge_penalty, row.share_nearest].into_iter();
        let spreads = row.spreads.iter().flat_map(|spread| [spread.mean, spread.sd]);
        let cells = numbers.chain(spreads).map(|number| number.to_string());
        std::iter::once(row.candidate.clone()).chain(cells).collect()
    };
    let table = tables::csv(first.into_iter().chain(names), judged.iter().map(row))?;
    Destination::new("--out", path, true)?.write(table.as_bytes())
}
