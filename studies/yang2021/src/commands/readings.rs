//! `usar yang2021 readings`: shows what each reading of the paper's ambiguous places changes.

use experiments::rounds::rounds_in;
use yang2021::readings::{Trials, averaged, groupings_in_words, rivals, single};
use yang2021::table::{averaged_table, readings_table, rivals_table};

use super::sorting::gaps;
use usar::arguments::ShownArguments;
use usar::input::read_sweep;
use usar::prelude::*;

/// Which reading of the paper's ambiguous places decides what?
#[derive(Debug, Args)]
#[command(after_help = "\
For a sweep with `readings` (scenarios/sweeps/readings.ron): how often each reading of RNE groups the teams \
that the default reading met otherwise than the default does, and what that does to the outcome, paired by \
seed; first each reading by itself, then averaged over all others.

Examples:
  usar sweep scenarios/sweeps/readings.ron
  usar yang2021 readings results/readings")]
pub(crate) struct Arguments {
    /// Folder of a sweep with readings of RNE, the default among them
    folder: PathBuf,
    #[command(flatten)]
    shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let mut folder = read_sweep(&self.folder, registry)?;
        if folder.experiment().cases.len() > 1 {
            refuse!("{}: has axes; readings are compared in a sweep of one case", self.folder.display());
        }
        let policies = folder.experiment().policies.clone();
        let default = policies
            .iter()
            .position(|policy| policy.name == "RNE" && policy.options().is_empty())
            .ok_or_else(|| {
                Failure::input(format!(
                    "{}: has no policy RNE without options to compare readings with",
                    self.folder.display()
                ))
            })?;
        let readings: Vec<usize> = (0..policies.len()).filter(|i| policies[*i].name == "RNE").collect();
        if readings.len() < 2 {
            refuse!("{}: has no readings to compare", self.folder.display());
        }
        let rounds = rounds_in(&mut folder, 0, default)?;
        let trials = Trials::of(&folder);
        if trials.numbers.is_empty() || rounds.is_empty() {
            refuse!("{}: has no trial yet that all policies have finished", self.folder.display());
        }
        let rows = single(&trials, default, &readings, &rounds)?;
        let pairs = trials.numbers.len();
        let mut out = Report::from(format!("Each reading by itself against the default, over {pairs} pairs"));
        out.show("readings", readings_table(&rows, &folder.experiment().metrics));
        out.say(format!(
            "regrouped: share of the {} rounds of the default's trials that the reading would group \
             otherwise, and of those that it would split otherwise\n\
             whichever half takes which task; trials: share that go otherwise; differences: reading less \
             default, with 95 % paired t intervals\n",
            rounds.len()
        ));
        let averaged = averaged(&trials, &readings);
        if !averaged.is_empty() {
            out.say(
                "Each reading averaged over all combinations of the others, against the default of its \
                 option",
            );
            out.show("averaged", averaged_table(&averaged, &folder.experiment().metrics));
            out.say("");
        }
        let distinct = trials.distinct(&readings);
        let rivals = rivals(&trials, &distinct);
        if !rivals.is_empty() {
            out.say(format!(
                "The {} of {} readings whose trials differ, against each other policy: how many are above, \
                 below, neither",
                distinct.len(),
                readings.len()
            ));
            out.show("rivals", rivals_table(&rivals));
            out.say(
                "95 % paired t intervals; corrected: at 95 % shared by these readings (Bonferroni); all: \
                 above, or below, each of the others; least and\n\
                 greatest are the extremes of so many\n",
            );
        }
        out.say(groupings_in_words(&folder, &readings, &rounds)?);
        out.extend(
            gaps(&folder, 0).map(|gaps| format!("{gaps}, each with its trials of the other policies")),
        );
        Ok(out)
    }
}
