//! `usar run`: runs one trial, with an account for each round.

mod event_lines;
mod live;
mod snapshot;

use experiments::experiment::PolicySpec;
use reports::table::rounds_table;
use scenario::{EmptyTasks, Moment, Scenario, Words};
use teaming::{Deadline, Session};
use usar_sim::metrics::CutOff;
use usar_sim::record::{DecisionRecord, Status, TaskRecord, TrialRecord};
use usar_sim::simulation::{InTime, Simulation};

use self::event_lines::EventLines;
use self::live::Live;
use self::snapshot::{Snapshot, save};
use crate::arguments::{MeasureArgument, ShownArguments, Trial, TrialArguments, WideArgument};
use crate::library;
use crate::prelude::*;
use crate::recordings;
use crate::running::Guard;

/// Run one trial and tell what happened, round by round
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  usar run scenarios/paper.ron
  usar run scenarios/paper.ron --policy DIS --seed 7 --json
  usar run scenarios/minimal/head_on.ron --check
  usar run scenarios/paper.ron --policy 'RNE(hard_rule: MeanEnergy)' --set duration_s=300
  usar run scenarios/paper.ron --seed 3 --save half.snapshot --save-at 300    the trial, and a snapshot of \
  it on the way
  usar run scenarios/paper.ron --resume half.snapshot                         the rest of that trial, with \
  the same result
  usar run scenarios/paper.ron --resume half.snapshot --policy DIS            another policy goes on from \
  there
  usar run scenarios/paper.ron --events events.jsonl                          every event with its time
  usar run scenarios/paper.ron --record paper.usrec                           then: usar view paper.usrec")]
pub(crate) struct Arguments {
    /// Scenario file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// Write a snapshot of the whole trial to this file, at --save-at; the file must not exist yet
    #[arg(long, value_name = "FILE", requires = "save_at", hide_short_help = true)]
    save: Option<PathBuf>,
    /// When to write the snapshot, in seconds of simulated time
    #[arg(long, value_name = "SECONDS", requires = "save", hide_short_help = true)]
    save_at: Option<f64>,
    /// Go on from a snapshot of a trial of this scenario
    #[arg(long, value_name = "FILE", conflicts_with = "seed", hide_short_help = true)]
    resume: Option<PathBuf>,
    /// Check every invariant at every step; a violation ends the trial as failed
    #[arg(long, hide_short_help = true)]
    check: bool,
    /// Longest time of a trial, in seconds of this machine
    #[arg(long, default_value_t = 600.0, value_name = "SECONDS", hide_short_help = true)]
    max_trial_s: f64,
    /// Write a recording of the trial to this file, for `usar view`; the file must not exist yet
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Frames of the recording per second of simulated time [default: 10]
    #[arg(long, value_name = "FPS", requires = "record", hide_short_help = true)]
    #[arg(value_parser = recordings::fps)]
    record_fps: Option<f64>,
    /// Write every event with its time to this file, a JSON object in a line; the file must not exist yet
    #[arg(long, value_name = "FILE.jsonl")]
    events: Option<PathBuf>,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    wide: WideArgument,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let snapshot = self.resume.as_deref().map(Snapshot::read).transpose()?;
        let otherwise = snapshot.as_ref().map(|snapshot| snapshot.identity.policy.as_str());
        let trial = self.trial.open(&self.file, otherwise, registry)?;
        let Trial { scenario, spec, .. } = &trial;
        let simulation =
            snapshot.as_ref().map_or_else(|| trial.begin(), |snapshot| snapshot.restore(scenario))?;
        let seed = simulation.seed();
        let simulation = if self.check { simulation.checked() } else { simulation };
        let mut simulation = simulation.in_parallel();
        if let (Some(path), Some(seconds)) = (&self.save, self.save_at) {
            save(&mut simulation, spec, path, seconds)?;
        }
        stop_on_signals();
        let record = self.run(simulation, spec, registry)?;
        if let Status::Failed(reason) = &record.status {
            if is_stopped() {
                return Err(Failure::Interrupted(format!(
                    "stopped at {:.0} s of simulated time",
                    record.time_s
                )));
            }
            return Err(Failure::run(format!("trial of {} with seed {seed} failed: {reason}", spec.label)));
        }
        if self.shown.is_json() {
            return Report::document(&record.named(&scenario.name, &spec.label));
        }
        let mut out = Report::from(format!(
            "{}, policy {}, seed {seed}: {} s simulated, {}",
            scenario.name,
            spec.label,
            (record.time_s * 1e6).round() / 1e6,
            record.status.name().replace('_', " ")
        ));
        if !record.rounds.is_empty() {
            out.show("rounds", rounds_table(&record, &scenario.words, self.wide.is_wide()));
        }
        tell(&mut out, &record, &scenario.words);
        if scenario.mission.empty_tasks == EmptyTasks::GetGroups {
            out.extend(finished_tasks(&record));
        }
        out.extend(too_late(scenario, &record));
        Ok(out)
    }

    /// Runs the trial with all its listeners.
    fn run(
        &self,
        simulation: Simulation,
        spec: &PolicySpec,
        registry: &Registry,
    ) -> Result<TrialRecord, Failure> {
        let mut session = session_of(spec, simulation.scenario(), simulation.seed())?;
        let guard = Guard::new(self.max_trial_s);
        let mut lines = self.events.as_deref().map(EventLines::begin).transpose()?;
        let mut live = (!self.quiet).then(|| Live::begin(&spec.label));
        let mut watch = |simulation: &Simulation| {
            guard.look(simulation)?;
            live.iter_mut().for_each(|live| live.listen(simulation));
            lines.iter_mut().try_for_each(|lines| lines.listen(simulation))
        };
        let record = match &self.record {
            Some(path) => {
                let (policy, measure) = (spec.label.clone(), spec.measure(registry));
                let options = recording::Options {
                    policy,
                    measure,
                    fps: self.record_fps.unwrap_or(recording::DEFAULT_FPS),
                };
                recordings::record_to(path, simulation, &mut *session, &options, &mut watch)
            }
            None => run(simulation, &mut *session, &mut watch),
        };
        live.into_iter().for_each(Live::finish);
        lines.map_or(Ok(()), EventLines::finish)?;
        record
    }
}

/// Runs a trial to its end. `watch` is called after each step and may interrupt the trial.
fn run(
    mut simulation: Simulation,
    session: &mut dyn Session,
    watch: &mut dyn FnMut(&Simulation) -> Result<(), Failure>,
) -> Result<TrialRecord, Failure> {
    let mut session = InTime::new(session, Deadline::when(&STOP));
    while simulation.step(&mut session).is_none() {
        watch(&simulation)?;
    }
    Ok(simulation.finish())
}

/// Tasks that got a group although the team knew that nothing was left there, in a sentence each.
fn finished_tasks(record: &TrialRecord) -> Vec<String> {
    let rounds_of = |task: usize| {
        let is_finished = |one: &&DecisionRecord| {
            let known = one.question.tasks.get(task).and_then(|task| task.rescuees);
            known == Some(0)
                && one.decision.assignment.groups.get(task).is_some_and(|group| !group.is_empty())
        };
        record.decisions.iter().filter(is_finished).count()
    };
    let told = |(task, named): (usize, &TaskRecord)| match rounds_of(task) {
        0 => None,
        rounds => Some(format!(
            "note: task {} was known to be finished and still got a group in {}: mission.empty_tasks \
             is GetGroups; the default, GetNobody, sends nobody",
            named.task,
            counted(rounds, "round")
        )),
    };
    record.tasks.iter().enumerate().filter_map(told).collect()
}

/// Events of the timeline for which the trial was over too soon, in a sentence each.
fn too_late(scenario: &Scenario, record: &TrialRecord) -> Vec<String> {
    let end_s = record.time_s;
    let is_late = |(_, moment): &(usize, &Moment)| moment.at_s > end_s && moment.at_s <= scenario.duration_s;
    let told = |(number, moment): (usize, &Moment)| {
        let at_s = moment.at_s;
        format!("note: timeline[{number}], at {at_s} s, never happened: the trial was over at {end_s:.1} s")
    };
    scenario.moments().into_iter().filter(is_late).map(told).collect()
}

/// Prints what came of a trial as a whole.
fn tell(out: &mut Report, record: &TrialRecord, words: &Words) {
    let rescued = record.rescued();
    let by_task = record.tasks.iter().map(|task| format!("{} {}", task.task, task.totals.rescued));
    let by_task = by_task.collect::<Vec<_>>().join(", ");
    let by_task = if by_task.is_empty() { by_task } else { format!(" ({by_task})") };
    out.say(format!(
        "{:<12} {rescued}{by_task} in {} complete rounds; on board at the end {}",
        words.text("rescued"),
        record.completed_rounds,
        record.secured() - rescued
    ));
    let per = |cost: f64| match rescued {
        0 => "-".to_owned(),
        _ => format!("{:.2}", cost / f64::from(rescued)),
    };
    let (label, hp) = (words.text("per rescuee"), words.text("HP"));
    out.say(format!("{label:<12} {} energy, {} {hp} (points)", per(record.energy()), per(record.hp())));
    let (waiting, stall) = (record.waiting_s(), record.longest_stall_s());
    out.say(format!(
        "robots       turned back {}, {} stranded, {} disabled",
        counted(record.counts.turned_back as usize, "time"),
        record.stranded(),
        record.disabled()
    ));
    out.say(format!(
        "conflicts    {}, deadlocks {}, {waiting:.0} s waited in all, longest stall {stall:.1} s",
        record.counts.conflicts, record.counts.deadlocks
    ));
    out.say(format!(
        "right of way a robot made room {}, the turn passed {}, a set backed off {}",
        counted(record.counts.retreats as usize, "time"),
        counted(record.counts.rotations as usize, "time"),
        counted(record.counts.back_offs as usize, "time")
    ));
    if record.counts.errands_done + record.counts.unreachable > 0 {
        let (done, unreachable) = (record.counts.errands_done, record.counts.unreachable);
        out.say(format!("places       {done} errands done, {unreachable} places given up as unreachable"));
    }
    let joins = || record.decisions.iter().flat_map(|made| &made.joins);
    let late = joins().filter(|join| join.is_late).count();
    if late > 0 {
        out.say(format!("negotiated   {late} of {} joins were out of time", joins().count()));
    }
    for CutOff { robot, first_s, times, place: [x, y], cause } in &record.cut_off {
        let why = cause.name();
        out.say(format!(
            "cut off      robot {robot} at {first_s:.1} s, {times} times in all: it {why} to ({x:.1}, {y:.1})"
        ));
    }
    if record.stalled > 0 {
        let robots = counted(record.stalled as usize, "robot");
        out.say(format!("stalled      {robots} at the end: with something to do, and no nearer to it"));
    }
    if let Some(overlaps) = record.overlaps {
        out.say(format!("overlaps     {overlaps}"));
    }
    out.say(format!("state hash   {}", record.state_hash));
}
