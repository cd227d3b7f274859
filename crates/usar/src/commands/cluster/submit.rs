//! `usar cluster submit`: runs a sweep on a cluster, as an array of Slurm jobs.

mod plan;
mod scripts;
mod submission;

use experiments::experiment::Experiment;
use experiments::files::NewFile;

pub(crate) use plan::Plan;
pub(crate) use scripts::quoted;
pub(crate) use submission::{ARRAY, LOGS, MERGE, Submission};

use super::estimate::{Measured, duration};
use super::slurm;
use crate::arguments::{Selection, count};
use crate::bad_value::BadValue;
use crate::library;
use crate::prelude::*;
use crate::running::program;
use plan::Wishes;

/// Run a sweep on a cluster: shards as an array of Slurm jobs, then merge and report
#[derive(Debug, Args)]
#[command(after_help = "\
Runs a sweep as an array of Slurm jobs, and merges and reports after it: measures a few trials, deals the \
sweep into shards of ten minutes or more (at most 500, and what the site takes), writes two job scripts to \
the folder of the shards, OUT-shards, and submits them: an array, and a job after it that merges and \
reports. The merged folder, --out, has the bytes of a single machine's. A task that is stopped, by \
preemption, its time or a lost node, goes on where it was. docs/cluster.md has the rest.

A template is a job script with words between @: @name@, @shards@, @at_once@, @cpus@, @time@, @merge_time@, \
@directives@ (account and partition), @directory@, @folder@ (of the shards), @out@, @usar@ and @arguments@. \
--dry-run prints the default one, filled in.

Examples:
  usar cluster submit scenarios/sweeps/energy.ron --dry-run
  usar cluster submit scenarios/sweeps/energy.ron --account robots --partition short --cpus 8
  usar cluster status results/energy-shards")]
pub(crate) struct Arguments {
    /// Scenario or sweep file (RON); it stays as it is until the last shard is done
    #[arg(value_parser = library::path)]
    file: PathBuf,
    /// Write nothing; say what would be written
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    selection: Selection,
    /// Slurm account to charge
    #[arg(long, value_parser = word)]
    account: Option<String>,
    /// Slurm partition
    #[arg(long, value_parser = word)]
    partition: Option<String>,
    /// Time limit of each shard, in Slurm's notation [default: twice what was estimated, at least
    /// half an hour]
    #[arg(long, value_parser = word)]
    time: Option<String>,
    /// Threads of each shard
    #[arg(long, default_value_t = 4, value_parser = count(1..=1024))]
    cpus: u32,
    /// Number of shards [default: from the estimate]
    #[arg(long, value_parser = count(1..=1_000_000))]
    shards: Option<u32>,
    /// Most shards that run at the same time [default: at most 100]
    #[arg(long, value_parser = count(1..))]
    at_once: Option<u32>,
    /// Job script of the shards to fill in, instead of the built-in one
    #[arg(long)]
    template: Option<PathBuf>,
    /// File or folder to write [default: results/NAME]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Parses a text that is allowed in a directive of a job script.
fn word(text: &str) -> Result<String, BadValue> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.:,".contains(c);
    let is_word = !text.is_empty() && text.chars().all(is_plain);
    is_word.then(|| text.to_owned()).ok_or_else(|| BadValue::new("letters, digits and -_.:", text))
}

/// The scripts of a submission, with their names.
type Scripts = [(&'static str, String); 2];

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        stop_on_signals();
        let experiment = Experiment::load(&self.file, &self.selection.overrides(), registry)?;
        experiment.check_start(&self.file)?;
        let whole = self.out.clone().unwrap_or_else(|| Path::new("results").join(&experiment.name));
        let whole = absolute(&whole)?;
        let folder = shards_of(&whole);
        if folder.exists() && !self.dry_run {
            let name = folder.display();
            let advice =
                format!("usar cluster status {name} says what is missing; --out takes another folder");
            refuse!("--out: {name} exists; nothing was submitted. {advice}");
        }
        let measured = Measured::of(&experiment, false)?;
        let wishes = Wishes {
            shards: self.shards,
            at_once: self.at_once,
            cpus: self.cpus,
            most_tasks: slurm::most_tasks(),
        };
        let plan = Plan::of(&experiment, measured.seconds_each, &wishes);
        let scripts = self.scripts(&experiment.name, &plan, &folder, &whole)?;
        let (shards, trials) = (plan.shards(), plan.trials.iter().max().copied().unwrap_or(0));
        let (time, cpus) = (duration(plan.seconds()), plan.cpus);
        let (shards, cpus) = (counted(shards, "shard"), counted(cpus as usize, "thread"));
        let each = if plan.shards() == 1 { "" } else { "each " };
        writeln!(out, "{shards}: {each}up to {trials} trials, about {time} on {cpus}")?;
        if plan.shards() == 1 && self.shards.is_none() {
            writeln!(out, "the sweep is short, so that one task is enough; --shards N splits it")?;
        }
        if self.dry_run {
            return print(out, &scripts, &folder);
        }
        submit(out, &folder, &scripts, Submission::new(&experiment.name, plan, whole))
    }

    fn scripts(&self, name: &str, plan: &Plan, folder: &Path, whole: &Path) -> Result<Scripts, Failure> {
        let shown = |path: &Path| quoted(&path.display().to_string());
        let directive = |flag: &str, value: &Option<String>| {
            value.as_ref().map(|value| format!("#SBATCH --{flag}={value}"))
        };
        let directives = [directive("account", &self.account), directive("partition", &self.partition)];
        let directives: Vec<String> = directives.into_iter().flatten().collect();
        let program = program()?;
        let file = shown(&absolute(&self.file)?);
        let chosen = self.selection.arguments();
        let arguments: Vec<String> =
            std::iter::once(file).chain(chosen.iter().map(|argument| quoted(argument))).collect();
        let words = [
            ("name", name.to_owned()),
            ("shards", plan.shards().to_string()),
            ("at_once", plan.at_once.to_string()),
            ("cpus", plan.cpus.to_string()),
            ("time", self.time.clone().unwrap_or_else(|| plan.time())),
            ("merge_time", "01:00:00".to_owned()),
            ("directives", directives.join("\n")),
            ("directory", shown(&absolute(Path::new("."))?)),
            ("folder", shown(folder)),
            ("out", shown(whole)),
            ("usar", shown(&program)),
            ("arguments", arguments.join(" ")),
        ];
        let template = match &self.template {
            None => scripts::ARRAY.to_owned(),
            Some(path) => ron_tree::file::read_text(path)
                .map_err(|error| Failure::input(format!("--template: {}: {error}", path.display())))?,
        };
        Ok([(ARRAY, scripts::fill(&template, &words)?), (MERGE, scripts::fill(scripts::MERGE, &words)?)])
    }
}

/// The path of the folder of the shards.
fn shards_of(whole: &Path) -> PathBuf {
    let name = whole.file_name().unwrap_or_default().to_string_lossy();
    whole.with_file_name(format!("{name}-shards"))
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let path = std::path::absolute(path)?;
    if path.to_string_lossy().contains('\n') {
        refuse!("{}: must not have a line break in it", path.display());
    }
    Ok(path)
}

fn print(out: &mut dyn Write, scripts: &Scripts, folder: &Path) -> Result<(), Failure> {
    for (name, script) in scripts {
        writeln!(out, "\n--- {}\n{script}", folder.join(name).display())?;
    }
    Ok(writeln!(
        out,
        "--- nothing was written or submitted; without --dry-run:\n{}",
        line(folder, None, None)
    )?)
}

/// The command that submits an array, or some of its tasks, and the merge job after it. The merge also
/// waits for `other`, an array that is still running.
pub(crate) fn line(folder: &Path, tasks: Option<&str>, other: Option<&str>) -> String {
    let script = |name: &str| quoted(&folder.join(name).display().to_string());
    let tasks = tasks.map_or(String::new(), |tasks| format!("--array={tasks} "));
    let (array, merge) = (script(ARRAY), script(MERGE));
    let other = other.map_or(String::new(), |array| format!("afterany:{array},"));
    format!("sbatch --dependency={other}afterok:$(sbatch --parsable {tasks}{array}) {merge}")
}

fn submit(
    out: &mut dyn Write,
    folder: &Path,
    scripts: &Scripts,
    mut submission: Submission,
) -> Result<(), Failure> {
    let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", folder.display()));
    std::fs::create_dir_all(folder.join(LOGS)).map_err(trouble)?;
    for (name, script) in scripts {
        NewFile::write(folder, name, script.as_bytes())?;
    }
    submission.write(folder)?;
    let script = |name: &str| folder.join(name).display().to_string();
    let array = slurm::submit(&[&script(ARRAY)]).inspect_err(|_| {
        let _ = std::fs::remove_dir_all(folder); // it is new, and nothing was submitted
    })?;
    submission.array = Some(array.clone());
    submission.write(folder)?;
    let merge = slurm::submit(&[&format!("--dependency=afterok:{array}"), &script(MERGE)])?;
    submission.merge = Some(merge.clone());
    submission.write(folder)?;
    let (whole, shards) = (submission.out.display(), folder.display());
    writeln!(out, "submitted: array {array}, and after it {merge}, which writes {whole}")?;
    Ok(writeln!(out, "to watch it: usar cluster status {shards}")?)
}
