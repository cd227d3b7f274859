//! `usar reproduce`: the paper's experiment, and what it says of the paper's claims.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde::Serialize;

use super::{STOP, default_jobs, run_missing, stop_on_ctrl_c};
use crate::claims::{CLAIMS, Example, Finding, Power, TIMES, examples, judge, least_difference, power};
use crate::experiment::{Experiment, Overrides};
use crate::failure::Failure;
use crate::report;
use crate::stats::Moments;
use crate::sweep::disk::is_sweeps;
use crate::sweep::folder::{Folder, Opening};
use crate::sweep::{Limits, NewFile};
use crate::table::{claims_table, examples_table, power_table, verdicts_table};

/// Trials of the paper.
pub(crate) const PAPERS_TRIALS: u32 = 10;

/// Policies of the paper.
const POLICIES: [&str; 4] = ["RNE", "DIS", "ENG", "HP_DIS"];

/// The scenarios, which are a part of the program: it runs from any folder.
const SCENARIOS: [(&str, &str); 2] = [
    ("scenarios/paper.ron", include_str!("../../../../scenarios/paper.ron")),
    ("scenarios/paper-calibrated.ron", include_str!("../../../../scenarios/paper-calibrated.ron")),
];

/// Longest time of one trial.
const TRIAL_LIMIT: Duration = Duration::from_mins(10);

/// Trials below which nothing is said of the power.
const LEAST_TRIALS: u32 = PAPERS_TRIALS * TIMES as u32;

/// Seed of the experiments that are drawn for the power.
const POWER_SEED: u64 = 1;

/// Put the paper's claims to the test: four policies, two scenarios, paired trials
#[derive(Debug, Args)]
#[command(after_help = "\
Runs RNE, DIS, ENG and HP_DIS on paper.ron (printed constants) and paper-calibrated.ron (fitted to the authors' recorded trials of DIS), and \
says of each of the paper's claims whether it holds: over the first 10 trials, as many as the paper has, and over all.

A claim holds when the 95 % interval of each of its comparisons lies on the claimed side; it does not when one lies on the other side, at 95 % \
shared by its comparisons; else it is undecided. The last table says how many paired trials each claim would need, and what 10 could have shown.

The folder gets a sweep's folder for each scenario, with report.html; claims.csv, power.csv and examples.csv; and for each scenario a CSV with \
exactly the authors' columns. docs/experiments.md says what is in each. A broken-off run goes on with the same command; more --trials only add.

Examples:
  usar reproduce
  usar reproduce --trials 1000")]
pub(crate) struct Arguments {
    /// Paired trials of each policy and scenario
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(i64::from(PAPERS_TRIALS)..=1_000_000))]
    trials: u32,
    /// Folder for the results
    #[arg(long, default_value = "results/reproduction")]
    out: PathBuf,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Start over
    #[arg(long)]
    fresh: bool,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

/// What a scenario's trials say of each claim.
pub(crate) struct Judged {
    /// Name of the scenario.
    pub scenario: String,
    /// Over as many trials as the paper has.
    pub of_few: Vec<Finding>,
    /// Over all.
    pub of_all: Vec<Finding>,
    /// What experiments of other sizes would say.
    pub powers: Vec<Option<Power>>,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        stop_on_ctrl_c();
        if is_sweeps(&self.out) {
            return Err(Failure::input(format!(
                "--out: {} is the folder of one sweep; the folders of both scenarios would be put into it",
                self.out.display()
            )));
        }
        // Both are opened first, so that a folder that cannot be used is known before the first trial.
        let open = |(path, text): (&str, &str)| self.open(Path::new(path), text);
        let mut folders = SCENARIOS.into_iter().map(open).collect::<Result<Vec<_>, Failure>>()?;
        let mut judged = Vec::new();
        for folder in &mut folders {
            self.run(folder)?;
            report::write(folder, 0)?;
            self.write_authors_columns(folder)?;
            judged.push(self.judge(folder)?);
        }
        self.write_claims(&judged)?;
        self.write_power(&judged)?;
        let examples = examples()?;
        self.write_examples(&examples)?;
        self.print(out, &judged, &examples)?;
        if !self.quiet {
            eprintln!("results in {}", self.out.display());
        }
        let failures = folders.iter().flat_map(|folder| folder.results().values());
        let failures: Vec<&str> = failures.filter_map(|measured| measured.failure.as_deref()).collect();
        if failures.is_empty() { Ok(()) } else { Err(Failure::run(failures.join("\n"))) }
    }

    /// Opens the folder of one scenario.
    fn open(&self, path: &Path, text: &str) -> Result<Folder, Failure> {
        let overrides = Overrides {
            policies: Some(POLICIES.map(str::to_owned).to_vec()),
            trials: Some(self.trials),
            ..Overrides::default()
        };
        let experiment = Experiment::parse(text.to_owned(), path, &overrides)?;
        let opening = Opening { shard: None, is_fresh: self.fresh };
        let place = self.out.join(&experiment.name);
        Folder::open(&place, Arc::new(experiment), opening, &mut |note| eprintln!("note: {note}"))
    }

    /// Runs the trials that are not there yet.
    fn run(&self, folder: &mut Folder) -> Result<(), Failure> {
        if !self.quiet {
            let name = &folder.experiment().name;
            eprintln!("{name}: {} trials of each of {} policies", self.trials, POLICIES.len());
        }
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        run_missing(folder, None, Limits { jobs, trial: Some(TRIAL_LIMIT) }, self.quiet)?;
        folder.finish(&STOP)
    }

    fn judge(&self, folder: &Folder) -> Result<Judged, Failure> {
        let all =
            |trials| CLAIMS.iter().map(|claim| judge(folder, claim, trials)).collect::<Result<Vec<_>, _>>();
        let (of_few, of_all) = (all(PAPERS_TRIALS)?, all(self.trials)?);
        let powers =
            of_all.iter().map(|finding| power(finding, PAPERS_TRIALS as usize, POWER_SEED)).collect();
        Ok(Judged { scenario: folder.experiment().name.clone(), of_few, of_all, powers })
    }

    fn print(&self, out: &mut dyn Write, judged: &[Judged], examples: &[Example]) -> Result<(), Failure> {
        for scenario in judged {
            writeln!(out, "{}", scenario.scenario)?;
            writeln!(out, "{}\n", claims_table(scenario, self.trials))?;
        }
        writeln!(out, "The paper's numerical examples, with exact values (nats)")?;
        writeln!(out, "{}\n", examples_table(examples))?;
        writeln!(out, "Power: what 10 pairs could have shown, and how many pairs it takes")?;
        for scenario in judged {
            writeln!(out, "{}", scenario.scenario)?;
            let table = power_table(scenario).map(|table| table.to_string());
            writeln!(
                out,
                "{}\n",
                table.unwrap_or_else(|| format!(
                    "not said: it takes {LEAST_TRIALS} trials, there are {}",
                    self.trials
                ))
            )?;
        }
        writeln!(
            out,
            "leans to: what large experiments would say, were the means of these trials the truth; pairs for 80 %: the fewest with which 80 % of experiments say so (of a comparison: of paired t tests at 5 %);\n\
             of 10 pairs: verdicts of experiments of 10 pairs drawn from these; least found by 10: the difference that 80 % of experiments of 10 pairs find\n"
        )?;
        writeln!(out, "Verdicts")?;
        writeln!(out, "{}", verdicts_table(judged, self.trials))?;
        writeln!(out, "{}", footnote())?;
        Ok(())
    }

    /// The columns of the authors' tables, and no others.
    fn write_authors_columns(&self, folder: &Folder) -> Result<(), Failure> {
        let path = folder.path().join("trials.csv");
        let bad = |error: csv::Error| Failure::storage(format!("{}: {error}", path.display()));
        let mut trials = csv::Reader::from_path(&path).map_err(bad)?;
        let columns =
            trials.headers().map_err(bad)?.iter().position(|name| name == "policy").unwrap_or_default();
        let mut table = csv::Writer::from_writer(Vec::new());
        let header = trials.headers().map_err(bad)?.clone();
        for record in std::iter::once(Ok(header)).chain(trials.records()) {
            table.write_record(record.map_err(bad)?.iter().take(columns)).map_err(Failure::run)?;
        }
        let bytes = table.into_inner().map_err(Failure::run)?;
        NewFile::write(&self.out, &format!("{}.csv", folder.experiment().name), &bytes).map(drop)
    }

    fn write_claims(&self, judged: &[Judged]) -> Result<(), Failure> {
        let mut rows = Vec::new();
        for scenario in judged {
            for (trials, findings) in [(PAPERS_TRIALS, &scenario.of_few), (self.trials, &scenario.of_all)] {
                for (claim, finding) in CLAIMS.iter().zip(findings) {
                    for (part, found) in claim.parts.iter().zip(&finding.parts) {
                        rows.push(ClaimRow {
                            scenario: &scenario.scenario,
                            trials,
                            section: claim.section,
                            claim: claim.name,
                            words: claim.words,
                            verdict: finding.verdict.words(),
                            comparison: part.words(),
                            n: found.differences.len(),
                            difference: found.difference,
                            low: found.interval.map(|[low, _]| low),
                            high: found.interval.map(|[_, high]| high),
                            shared_low: found.shared_interval.map(|[low, _]| low),
                            shared_high: found.shared_interval.map(|[_, high]| high),
                        });
                    }
                }
            }
        }
        self.write("claims.csv", &rows)
    }

    fn write_examples(&self, examples: &[Example]) -> Result<(), Failure> {
        let row = |example: &Example| ExampleRow {
            example: example.name,
            words: example.words,
            trusting_nats: example.trusting,
            doubting_nats: example.doubting,
            verdict: example.verdict.words(),
        };
        self.write("examples.csv", &examples.iter().map(row).collect::<Vec<_>>())
    }

    fn write_power(&self, judged: &[Judged]) -> Result<(), Failure> {
        let mut rows = Vec::new();
        for scenario in judged {
            for ((claim, finding), power) in CLAIMS.iter().zip(&scenario.of_all).zip(&scenario.powers) {
                for (part, found) in claim.parts.iter().zip(&finding.parts) {
                    let values: Vec<f64> =
                        found.differences.iter().map(|(_, difference)| *difference).collect();
                    let sd = Moments::of(&values).sd;
                    rows.push(PowerRow {
                        scenario: &scenario.scenario,
                        claim: claim.name,
                        leaning: power.map(|power| power.leaning.words()),
                        claim_pairs_needed: power.and_then(|power| power.pairs_needed),
                        holds_at_10: power.map(|power| power.of_few.holds),
                        does_not_hold_at_10: power.map(|power| power.of_few.does_not_hold),
                        comparison: part.words(),
                        n: values.len(),
                        difference: found.difference,
                        sd,
                        pairs_needed: found.pairs_needed,
                        least_difference_at_10: sd
                            .and_then(|sd| least_difference(sd, PAPERS_TRIALS as usize)),
                    });
                }
            }
        }
        self.write("power.csv", &rows)
    }

    fn write(&self, name: &str, rows: &[impl Serialize]) -> Result<(), Failure> {
        let mut table = csv::Writer::from_writer(Vec::new());
        rows.iter().try_for_each(|row| table.serialize(row)).map_err(Failure::run)?;
        let bytes = table.into_inner().map_err(Failure::run)?;
        NewFile::write(&self.out, name, &bytes).map(drop)
    }
}

/// A row of `claims.csv`: one comparison of one claim, over so many trials.
#[derive(Serialize)]
struct ClaimRow<'a> {
    scenario: &'a str,
    trials: u32,
    section: &'a str,
    claim: &'a str,
    words: &'a str,
    verdict: &'a str,
    comparison: String,
    n: usize,
    difference: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
    shared_low: Option<f64>,
    shared_high: Option<f64>,
}

/// A row of `examples.csv`: one of the paper's numerical examples.
#[derive(Serialize)]
struct ExampleRow<'a> {
    example: &'a str,
    words: &'a str,
    trusting_nats: f64,
    doubting_nats: f64,
    verdict: &'a str,
}

/// A row of `power.csv`: one comparison of one claim.
#[derive(Serialize)]
struct PowerRow<'a> {
    scenario: &'a str,
    claim: &'a str,
    leaning: Option<&'a str>,
    claim_pairs_needed: Option<u32>,
    holds_at_10: Option<f64>,
    does_not_hold_at_10: Option<f64>,
    comparison: String,
    n: usize,
    difference: Option<f64>,
    sd: Option<f64>,
    pairs_needed: Option<u64>,
    least_difference_at_10: Option<f64>,
}

fn footnote() -> String {
    format!(
        "Paired by seed; intervals: BCa bootstrap at 95 %, widened for small n. A claim holds when the interval of each of its comparisons lies on the\n\
         claimed side, and does not when one lies on the other side (by the shared interval: 95 % for all its comparisons together); else it is undecided. Each verdict is\n\
         wrong in about 2.5 % of experiments at most; the {} claims are not corrected for one another. docs/reproduction.md discusses them.",
        CLAIMS.len()
    )
}
