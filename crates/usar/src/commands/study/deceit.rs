//! `usar study deceit`: what lies cost each policy, how many liars it bears, and how well estimators judge.

use experiments::comparison::{Standing, digits, short};
use experiments::deceit::{ACCURACY, Borne, Deceit, Difference};
use experiments::experiment::Experiment;
use experiments::files::NewFile;
use experiments::sweep::folder::Folder;
use reports::deceit_figures;
use reports::table::{mean, number, range};

use crate::arguments::{ProgressArguments, Selection, ShownArguments};
use crate::input::read_sweep;
use crate::library;
use crate::prelude::*;

/// How many liars does a policy bear? Rules, estimators and uses of trust against lies
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is a sweep file with an axis of who lies, such as \"deceit[0].who\": [Count(0), Count(1), Count(2)]; \
all other axes together are the lie, or the world. Its baseline is the fair draw, its first primary metric \
is judged, and its margin is the largest difference that does not matter. Policies stand behind estimators \
as `HP_DIS <- Kalman | Exclude`.

A policy breaks down between two numbers of liars: up to the first it is shown to be better than the draw, \
with the second it is shown not to be. Both hold together at 95 %. Where a policy is not shown to be \
better among honest robots, there is nothing to break down. How well estimators judge is told by policies \
`DIS <- ESTIMATOR`: DIS hears nothing, so that all estimators have the same evidence.

The folder is that of a sweep, with all of its tables, and with two figures and their numbers: what each \
policy has above a draw by number of liars (deceit-above-draw), and how many liars it bears \
(deceit-breakdown). An interrupted study resumes.

Examples:
  usar study deceit scenarios/sweeps/trust-tunnel.ron
  usar study deceit scenarios/sweeps/trust-tunnel.ron --json > tunnel.json")]
pub(crate) struct Arguments {
    /// Sweep file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    /// File or folder to write [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        if self.file.is_dir() {
            let chosen = self.selection.arguments().into_iter().next();
            if let Some(name) = chosen.or(self.out.as_ref().map(|_| "--out".to_owned())) {
                return Err(Failure::input(format!("{name}: is for a sweep file, and not for a folder")));
            }
            let folder = read_sweep(&self.file, registry)?;
            Deceit::check(folder.experiment()).map_err(Failure::input_at(self.file.display()))?;
            return Self::told(&folder);
        }
        let experiment = Experiment::load(&self.file, &self.selection.overrides(), registry)?;
        Deceit::check(&experiment).map_err(Failure::input_at(self.file.display()))?;
        let named = Path::new("results").join(&experiment.name);
        let place = self.out.clone().unwrap_or(named);
        Self::told(&self.progress.finished(&place, experiment)?)
    }

    fn told(folder: &Folder) -> Result<Report, Failure> {
        let found = Deceit::of(folder)?;
        for (name, content) in deceit_figures(&found)? {
            NewFile::write(folder.path(), &name, &content)?;
        }
        let trials = folder.experiment().trials;
        let margin = found.margin.map_or("0".to_owned(), short);
        let first =
            format!("{}: {trials} pairs by seed, minus {}; margin {margin}", found.metric, found.draw);
        let mut out = Report::from(first);
        out.say("\nMeans by number of liars, and how many liars a policy bears");
        out.show("policies", borne(&found));
        if !found.prices.is_empty() {
            out.say("\nThe price where nobody lies: a policy with its estimator minus the same without");
            out.show("prices", prices(&found));
        }
        if !found.judgements.is_empty() {
            out.say("\nHow well estimators judge the same evidence");
            out.show("judgements", judgements(&found));
        }
        Ok(out)
    }
}

/// A row of a policy, or of an estimator, among robots that tell a lie.
fn of_lie(who: &str, lie: &str, cells: impl IntoIterator<Item: Into<Entry>>) -> Vec<Entry> {
    labelled(who, labelled(lie, cells))
}

fn borne(found: &Deceit) -> Table {
    let header = of_lie("policy", "lie", found.counts.iter().map(Entry::from).chain(["breaks down".into()]));
    let row = |one: &Borne| {
        let means = one.means.iter().map(|value| mean(*value));
        of_lie(&one.policy, &one.lie, means.chain([breakdown(one, &found.counts)]))
    };
    Table::of(header, found.borne.iter().map(row))
}

/// The breakdown in words: "between 2 and 5 of 6"; for programs both numbers, as far as they are known.
fn breakdown(one: &Borne, counts: &[u32]) -> Entry {
    let all = counts.last().copied().unwrap_or_default();
    let at = |place: usize| counts.get(place).copied().unwrap_or_default();
    let words = match (one.breakdown.safe, one.breakdown.broken) {
        (None, _) => match one.breakdown.standing {
            Standing::Judged => "no room shown".to_owned(),
            Standing::Same => "the same as the draw".to_owned(),
            few @ Standing::TooFew { .. } => format!("no breakdown point: {few}"),
        },
        (Some(safe), Some(broken)) => format!("between {} and {} of {all}", at(safe), at(broken)),
        (Some(safe), None) => format!("above {} of {all}, or never", at(safe)),
    };
    Entry::from(words).with([one.breakdown.safe, one.breakdown.broken].map(|place| place.map(at)))
}

fn prices(found: &Deceit) -> Table {
    let rows = found.prices.iter().map(|price| {
        let has_one = found.prices.iter().filter(|other| other.policy == price.policy).count() == 1;
        let Difference { mean, interval } = price.difference;
        let place = if has_one { "everywhere" } else { &price.lie };
        of_lie(&price.policy, place, [number(mean), range(interval)])
    });
    Table::of(["policy", "where", "difference", "95 % interval"], rows)
}

fn judgements(found: &Deceit) -> Table {
    let rows = found.judgements.iter().map(|one| {
        let values = one.values.iter().map(|value| right_or_dash(*value, |it| digits(it, 3)));
        of_lie(&one.guide, &one.lie, [right(one.liars)].into_iter().chain(values))
    });
    Table::of(["estimator", "lie", "liars"].into_iter().chain(ACCURACY), rows)
}
