//! `usar choose`: finds which of several calibrated candidates is nearest to the recorded trials.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::comparison::digits;
use experiments::files::NewFile;
use rne_core::Registry;
use serde_json::json;
use study_yang2021::calibration::{CALIBRATED, Candidate, Judged, NOT_TOLD_APART, POLICY, Target, judge};
use study_yang2021::table::choice_table;
use usar_sim::scenario::Scenario;

use super::{SCHEMA_VERSION, ShownArguments, print_table};
use crate::running::{STOP, default_jobs, progress_bar, stop_on_signals};

/// Choose between what several calibrations found, by trials that none was fitted to
#[derive(Debug, Args)]
#[command(after_help = "\
Each DIR is the folder of a finished `usar calibrate`; only DIS is run. The candidates run the same seeds, \
which none was fitted to. The one with the least misfit is the choice. Then the recorded trials and the \
seeds are drawn anew 4,000 times: a candidate that is the nearest in at least 5 % of the draws cannot be \
told from the choice by these data.

Examples:
  usar choose results/calibration/* --target scenarios/reference/dis_trials.csv
  usar choose results/calibration/* --target scenarios/reference/dis_trials.csv --csv choice.csv")]
pub(crate) struct Arguments {
    /// Folders of calibrations
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// Recorded trials (CSV with a column `method` that says DIS)
    #[arg(long, value_name = "CSV")]
    target: PathBuf,
    /// Trials of a candidate
    #[arg(long, default_value_t = 40, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    trials: u32,
    /// Seed of their first trial; far from those that calibrations use
    #[arg(long, default_value_t = 200_001, value_parser = clap::value_parser!(u64).range(..u64::MAX / 2))]
    first_seed: u64,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Write the table as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    pub(crate) shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let read = |folder: &PathBuf| Candidate::read(folder, &self.target, registry);
        let candidates = self.folders.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let (base, _) = Scenario::load(&self.folders[0].join(CALIBRATED)).map_err(Failure::input)?;
        let target = Target::load(&self.target, &base)?;
        stop_on_signals();
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build().map_err(Failure::run)?;
        let seeds: Vec<u64> = (0..self.trials).map(|trial| self.first_seed + u64::from(trial)).collect();
        let progress = progress_bar(candidates.len(), "candidates", jobs, self.quiet);
        let mut measured = Vec::with_capacity(candidates.len());
        for candidate in candidates {
            let quantities = pool.install(|| candidate.measure(&seeds, &STOP))?;
            let quantities = quantities.ok_or_else(|| Failure::Interrupted("stopped".to_owned()))?;
            measured.push((candidate, quantities));
            progress.inc(1);
        }
        progress.finish_and_clear();
        let judged = judge(&target, &measured);
        if let Some(path) = &self.csv {
            write_csv(path, &target, &judged)?;
        }
        if self.json || self.shown.is_json() {
            print_json(out, &target, &judged)
        } else {
            self.print(out, &target, &judged)
        }
    }

    fn print(&self, out: &mut dyn Write, target: &Target, judged: &[Judged]) -> Result<(), Failure> {
        print_table(out, &choice_table(target, judged))?;
        let (trials, first) = (self.trials, self.first_seed);
        writeln!(
            out,
            "mean ± sample standard deviation of {POLICY} over {trials} trials (seeds {first} to {}); data: \
             {} trials",
            first + u64::from(trials) - 1,
            target.trials
        )?;
        let alike: Vec<&str> = judged
            .iter()
            .skip(1)
            .filter(|judged| judged.share_nearest >= NOT_TOLD_APART)
            .map(|judged| judged.candidate.as_str())
            .collect();
        writeln!(out, "the choice: {}, misfit {}", judged[0].candidate, digits(judged[0].misfit, 3))?;
        match alike.as_slice() {
            [] => writeln!(out, "no other is the nearest in 5 % of the draws")?,
            alike => writeln!(out, "not to be told from it by these data: {}", alike.join(", "))?,
        }
        Ok(())
    }
}

fn print_json(out: &mut dyn Write, target: &Target, judged: &[Judged]) -> Result<(), Failure> {
    let candidate = |judged: &Judged| {
        let spreads = target.quantities.iter().zip(&judged.spreads);
        let quantities = spreads.map(|(q, s)| (q.name.clone(), json!({"mean": s.mean, "sd": s.sd})));
        json!({
            "candidate": judged.candidate,
            "misfit": judged.misfit,
            "edge_penalty": judged.edge_penalty,
            "share_nearest": judged.share_nearest,
            "quantities": quantities.collect::<serde_json::Map<_, _>>(),
        })
    };
    let candidates: Vec<_> = judged.iter().map(candidate).collect();
    let output =
        json!({"schema_version": SCHEMA_VERSION, "choice": judged[0].candidate, "candidates": candidates});
    writeln!(out, "{output:#}")?;
    Ok(())
}

fn write_csv(path: &std::path::Path, target: &Target, judged: &[Judged]) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let names = target.quantities.iter().flat_map(|q| [format!("{}_mean", q.name), format!("{}_sd", q.name)]);
    let first = ["candidate", "misfit", "edge_penalty", "share_nearest"].map(str::to_owned);
    table.write_record(first.into_iter().chain(names)).map_err(Failure::run)?;
    for row in judged {
        let numbers = [row.misfit, row.edge_penalty, row.share_nearest].into_iter();
        let spreads = row.spreads.iter().flat_map(|spread| [spread.mean, spread.sd]);
        let cells = numbers.chain(spreads).map(|number| number.to_string());
        table.write_record(std::iter::once(row.candidate.clone()).chain(cells)).map_err(Failure::run)?;
    }
    let bytes = table.into_inner().map_err(Failure::run)?;
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let folder = folder.unwrap_or(std::path::Path::new("."));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    NewFile::write(folder, &name, &bytes).map(drop)
}
