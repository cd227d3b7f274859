//! `usar study room`: how much grouping matters in a world.

use experiments::comparison::{Trials, short};
use experiments::experiment::{Experiment, Overrides};
use experiments::sweep::folder::Folder;
use reports::table::{between, mean, number, range};
use serde::Serialize;

use crate::arguments::{PoliciesArgument, ProgressArguments, ShownArguments, count, limit, one_seed};
use crate::input::read_sweep;
use crate::library;
use crate::prelude::*;

/// The policy that the others are compared with.
const DRAW: &str = "RANDOM";

/// The oracles, and which assignment each picks. They look at this metric: the rate does not reward rounds
/// that take long.
const ORACLES: [[&str; 2]; 2] = [["best", "Best"], ["worst", "Worst"]];
const METRIC: &str = "rescue_rate";

/// Rules that the paper compares; they are tried where no others are named.
const RULES: [&str; 4] = ["RNE", "DIS", "ENG", "HP_DIS"];

/// Does grouping matter in this world? Every rule, the best and the worst choice against a fair draw
#[derive(Debug, Args)]
#[command(after_help = "\
A world in which the best and the worst grouping rescue about the same cannot tell rules apart, and a lie \
costs nothing in it. The best and the worst choice are those of an oracle that plays assignments to the end \
of the round and takes the one with the most, or the fewest, rescuees a minute: neither looks further ahead. \
Of many assignments it plays a part only (--limit), so that the room is at least what is told.

The folder is that of a sweep, with all of its tables; an interrupted study resumes. Folders of several \
worlds make one table with a row for each.

Examples:
  usar study room tunnel
  usar study room scenarios/paper.ron --trials 100 --policies RNE,DIS --limit 240   # every assignment
  usar study room results/room-*")]
pub(crate) struct Arguments {
    /// Scenario (RON), or folders of finished studies
    #[arg(value_name = "FILE|DIR", required = true, value_parser = library::path)]
    files: Vec<PathBuf>,
    /// Trials of each policy, in each case or candidate
    #[arg(long, default_value_t = 32, value_parser = count(8..=1_000_000))]
    trials: u32,
    /// Most assignments of a decision to play, or problems to solve
    #[arg(long, default_value_t = 24, value_parser = limit())]
    limit: u64,
    #[command(flatten)]
    policies: PoliciesArgument,
    /// Seed of the first trial [default: the file's]
    #[arg(long, value_parser = one_seed)]
    first_seed: Option<u64>,
    /// File or folder to write [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

/// What the policies rescue in a world.
#[derive(Serialize)]
struct World {
    world: String,
    trials: u32,
    policies: Vec<Row>,
}

/// A policy beside the draw.
#[derive(Serialize)]
struct Row {
    policy: String,
    mean: Option<f64>,
    /// Difference from the draw, and its 95 % interval.
    difference: Option<f64>,
    interval: Option<[f64; 2]>,
    /// The same in percent of the draw.
    percent: Option<f64>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        match self.files.as_slice() {
            [file] if !file.is_dir() => {
                let experiment = self.experiment(file, registry)?;
                let named = Path::new("results").join(format!("room-{}", experiment.name));
                let place = self.out.clone().unwrap_or(named);
                Self::told(&[self.progress.finished(&place, experiment)?])
            }
            folders => {
                let read = |folder: &PathBuf| read_sweep(folder, registry);
                Self::told(&folders.iter().map(read).collect::<Result<Vec<_>, _>>()?)
            }
        }
    }

    fn told(folders: &[Folder]) -> Result<Report, Failure> {
        let worlds = folders.iter().map(World::of).collect::<Result<Vec<_>, _>>()?;
        let of = |World { world, trials, .. }: &World| {
            format!("{world}: rescuees.total of {trials} trials, paired by seed; minus {DRAW}")
        };
        let mut out = Report::of(worlds.iter().map(of));
        out.rows("worlds", &worlds)?;
        out.show("worlds", if let [world] = worlds.as_slice() { of_one(world) } else { of_all(&worlds) });
        Ok(out)
    }

    fn experiment(&self, file: &Path, registry: &Registry) -> Result<Experiment, Failure> {
        let rules = self.policies.list().unwrap_or_else(|| RULES.map(str::to_owned).to_vec());
        let limit = self.limit;
        let oracle = |[label, pick]: [&str; 2]| {
            format!("{label}=ORACLE(metric: \"{METRIC}\", pick: {pick}, limit: {limit})")
        };
        let others = std::iter::once(DRAW.to_owned()).chain(ORACLES.map(oracle));
        let policies = Some(rules.into_iter().filter(|rule| rule != DRAW).chain(others).collect());
        let (trials, first_seed) = (Some(self.trials), self.first_seed);
        let overrides = Overrides { policies, trials, first_seed, ..Overrides::default() };
        Experiment::load(file, &overrides, registry)
    }
}

impl World {
    fn of(folder: &Folder) -> Result<Self, Failure> {
        let experiment = folder.experiment();
        let (world, trials, policies) = (experiment.name.clone(), experiment.trials, rows(folder)?);
        Ok(Self { world, trials, policies })
    }
}

fn of_one(world: &World) -> Table {
    let row = |row: &Row| {
        [
            Entry::from(&row.policy),
            mean(row.mean),
            number(row.difference),
            range(row.interval),
            right_or_dash(row.percent, |percent| format!("{percent:+.1}")),
        ]
    };
    let header = ["policy", "mean", "minus a draw", "95 % interval", "in %"];
    Table::of(header, world.policies.iter().map(row))
}

/// A row for each world: what a draw rescues, and what each policy has above it.
fn of_all(worlds: &[World]) -> Table {
    let mut others: Vec<&str> = Vec::new();
    for row in worlds.iter().flat_map(|world| &world.policies) {
        if row.policy != DRAW && !others.contains(&&*row.policy) {
            others.push(&row.policy);
        }
    }
    let row = |world: &World| {
        let of = |label: &str| world.policies.iter().find(|row| row.policy == label);
        let above = |label: &&str| {
            let row = of(label);
            right_or_dash(row.and_then(|row| Some((row.difference?, row.interval))), |(above, interval)| {
                match interval {
                    Some(_) => format!("{} ({})", short(above), between(interval)),
                    None => short(above),
                }
            })
        };
        let draw = mean(of(DRAW).and_then(|row| row.mean));
        labelled(&world.world, std::iter::once(draw).chain(others.iter().map(above)))
    };
    Table::of(["world", DRAW].into_iter().chain(others.iter().copied()), worlds.iter().map(row))
}

fn rows(folder: &Folder) -> Result<Vec<Row>, Failure> {
    let experiment = folder.experiment();
    let metric = experiment.metrics.named("rescuees.total")?;
    let (trials, of) = (Trials::of(folder, 0), |policy: usize| ((0, policy), metric));
    let draw = experiment.policies.iter().position(|policy| policy.label == DRAW);
    let draw = draw.ok_or_else(|| Failure::input(format!("{}: has no {DRAW}", experiment.name)))?;
    let of_draw = trials.moments(of(draw)).mean;
    let row = |(place, label): (usize, &str)| {
        let pairs = trials.pairs([of(place), of(draw)]);
        let difference = pairs.difference().filter(|_| place != draw);
        Row {
            policy: label.to_owned(),
            mean: trials.moments(of(place)).mean,
            difference,
            interval: pairs.cautious(0.95).filter(|_| place != draw),
            percent: difference.zip(of_draw).filter(|(_, of)| *of > 0.0).map(|(it, of)| 100.0 * it / of),
        }
    };
    Ok(experiment.policies.iter().map(|policy| policy.label.as_str()).enumerate().map(row).collect())
}
