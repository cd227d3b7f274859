//! `usar yang2021 sorting`: compares the groups of a sweep's policies with sorting.

use experiments::metric::task_names;
use experiments::rounds::{self, GroupLevels, SortingAgreement, agreement, energy, hp, rounds_in};
use experiments::sweep::folder::Folder;
use reports::table::{levels_table, likeness_table};
use scenario::Scenario;
use teaming::{MadeMeasure, Member};
use yang2021::blindness::{Blindness, Example};

use usar::arguments::{CaseArgument, MeasureArgument, ShownArguments};
use usar::input::read_sweep;
use usar::prelude::*;

/// What do the policies' groups amount to: sorting by energy, by HP, or by what?
#[derive(Debug, Args)]
#[command(after_help = "\
Prints, for each policy of a finished sweep, how often its split of the team is the one that sorting each \
role by energy, by HP or by their ratio would give; the mean levels of the groups round by round; and an \
example of how blind relative entropy is to magnitude.

Examples:
  usar yang2021 sorting results/paper
  usar yang2021 sorting results/energy --case 3")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    #[command(flatten)]
    case: CaseArgument,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let mut folder = read_sweep(&self.folder, registry)?;
        let case = self.case.index(folder.experiment())?;
        let policies = folder.experiment().policies.clone();
        let (mut agreements, mut levels, mut blind) = (Vec::new(), Vec::new(), Vec::new());
        for (place, policy) in policies.iter().enumerate() {
            let rounds = rounds_in(&mut folder, case, place)?;
            agreements.push((policy.label.clone(), agreement(&rounds)));
            levels.extend(rounds::levels(&policy.label, &rounds));
            if let Some(measure) = policy.own_measure(registry).filter(|_| blind.is_empty()) {
                let mut blindness = Blindness::default();
                rounds.iter().try_for_each(|round| blindness.add(round, &*measure.it))?;
                blind.push(Blind {
                    label: policy.label.clone(),
                    rounds: rounds.len(),
                    measure: measure.clone(),
                    blindness,
                });
            }
        }
        if agreements.iter().all(|(_, of)| of[0].rounds() == 0) {
            refuse!("{}: no round of this case was split into two groups", self.folder.display());
        }
        let mut out = told(&agreements, &levels, &folder.experiment().cases[case].scenario, &blind);
        out.extend(gaps(&folder, case));
        Ok(out)
    }
}

/// How blind a policy's trust measure was to magnitude.
struct Blind {
    label: String,
    rounds: usize,
    measure: MadeMeasure,
    blindness: Blindness,
}

/// A sentence about failed and missing trials; `None` if there are none.
pub(super) fn gaps(folder: &Folder, case: usize) -> Option<String> {
    let keys = folder.experiment().keys(None).filter(|key| key.case == case);
    let (mut failed, mut missing) = (0, 0);
    for key in keys {
        match folder.results().get(&(key.case, key.policy, key.trial)) {
            None => missing += 1,
            Some(measured) => failed += u32::from(measured.metrics.is_none()),
        }
    }
    (failed + missing > 0)
        .then(|| format!("{failed} trials failed, {missing} are missing: these are left out"))
}

fn told(
    agreements: &[(String, [SortingAgreement; 3])],
    levels: &[GroupLevels],
    scenario: &Scenario,
    blind: &[Blind],
) -> Report {
    let hardest = scenario.hardest_first().first().map_or("", |task| &scenario.tasks[task.index()].name);
    let mut out = Report::from(
        "In which share of the rounds a policy's split is the one that sorting each role gives (in brackets: \
         by chance)",
    );
    out.show("sorting", likeness_table(agreements));
    out.say(format!(
        "split: in all roles, whichever half takes which task; higher: the group of the {hardest} task has \
         the higher mean of that level. Ties count as sorted,\n\
         by chance too\n"
    ));
    out.say("Mean levels of the groups when a round begins, in percent");
    out.show("levels", levels_table(levels, &task_names(scenario)));
    out.say("n: rounds with two groups\n");
    blind.iter().for_each(|blind| tell_blindness(&mut out, blind));
    out
}

fn tell_blindness(out: &mut Report, blind: &Blind) {
    let Blind { label, rounds, measure, blindness } = blind;
    let (name, unit) = (&measure.name, measure.it.unit());
    let robot = |robot: &Member| {
        let (energy, hp) = (energy(robot), hp(robot));
        format!("robot {} (energy {energy:.0} %, HP {hp:.0} %)", robot.id)
    };
    if let Some(Example { trial, seed, round, role, unlike, alike, .. }) = &blindness.plainest {
        out.say(format!(
            "Blind to magnitude: the plainest of the {rounds} rounds of {label}: trial {trial} (seed \
             {seed}), round {round}, {}s",
            role.to_lowercase()
        ));
        for (pair, what) in [(unlike, "farther apart, more trust"), (alike, "nearer, less trust")] {
            out.say(format!(
                "  {} to {}: {:.0} points apart, {name} {:.2e} {unit}, trust {:.6} ({what})",
                robot(&pair.from),
                robot(&pair.to),
                pair.apart(),
                pair.distrust,
                measure.it.trust(pair.distrust)
            ));
        }
    }
    if let Some(misjudged) = blindness.misjudged() {
        out.say(format!(
            "Of all two pairs of robots of one role and round, in {:.1} % the one whose levels are nearer to \
             each other has the higher {name} (unrelated: 50 %).",
            100.0 * misjudged
        ));
    }
}
