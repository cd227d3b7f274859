//! `usar cluster submit`: the job script that runs a sweep on Slurm.

use experiments::experiment::{Experiment, Shard};
use experiments::files::NewFile;
use programs::quoted;

use crate::arguments::{Selection, count};
use crate::bad_value::BadValue;
use crate::library;
use crate::prelude::*;
use crate::running::program;

/// Write the job script that runs a sweep on Slurm, and print the command that submits it
#[derive(Debug, Args)]
#[command(after_help = "\
Deals the sweep into shards and writes OUT-shards/job.sh, a script of twenty lines that you may edit. The \
printed command submits it as an array with a task for each shard, and once more after it: then it merges \
the shards into --out and writes the report. The merged folder has the bytes of a single machine's. Options \
of sbatch stand behind `--` and become a line of the script. A task that was stopped goes on where it was: \
the same command again runs what is missing. docs/cluster.md has the rest.

Examples:
  usar cluster submit scenarios/sweeps/energy.ron --shards 8
  usar cluster submit scenarios/sweeps/energy.ron --shards 8 -- --account=robots --cpus-per-task=8")]
pub(crate) struct Arguments {
    /// Scenario or sweep file (RON); it stays as it is until the last shard is done
    #[arg(value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// Number of shards
    #[arg(long, value_name = "N", value_parser = count(1..=1_000_000))]
    shards: u32,
    /// File or folder to write [default: results/NAME]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Options of sbatch
    #[arg(last = true, value_name = "SBATCH", value_parser = word)]
    sbatch: Vec<String>,
}

/// Parses a word of a directive of a job script.
fn word(text: &str) -> Result<String, BadValue> {
    let is_plain = |c: char| c.is_ascii_graphic() && !"\"'\\#".contains(c);
    let is_word = !text.is_empty() && text.chars().all(is_plain);
    is_word.then(|| text.to_owned()).ok_or_else(|| BadValue::new("one word without quotes and #", text))
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let experiment = Experiment::load(&self.file, &self.selection.overrides(), registry)?;
        experiment.check_policies()?;
        experiment.check_start(&self.file)?;
        let seeds = experiment.seeds_of_cases();
        if self.shards as usize > seeds {
            refuse!("--shards: must be at most {seeds}, the seeds of all cases, found {}", self.shards);
        }
        let whole = self.out.clone().unwrap_or_else(|| Path::new("results").join(&experiment.name));
        let whole = absolute(&whole)?;
        let name = whole.file_name().unwrap_or_default().to_string_lossy();
        let folder = whole.with_file_name(format!("{name}-shards"));
        if folder.exists() {
            refuse!("--out: {} exists; nothing was written", folder.display());
        }
        let script = self.script(&experiment, &folder, &whole)?;
        let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", folder.display()));
        std::fs::create_dir_all(folder.join("logs")).map_err(trouble)?;
        NewFile::write(&folder, "job.sh", script.as_bytes())?;
        let most = experiment.count(Some(Shard { number: 1, of: self.shards }));
        let shards = counted(self.shards as usize, "shard");
        let script = folder.join("job.sh");
        let what = format!("{}: {shards} of up to {most} trials; to submit them:", script.display());
        Ok(Report::of([what, self.line(&folder)]))
    }

    /// The command that submits the array, and after it the job that merges.
    fn line(&self, folder: &Path) -> String {
        let (script, log) = (shown(&folder.join("job.sh")), shown(&folder.join("logs/merge.log")));
        let array = format!("sbatch --parsable --array=1-{} {script}", self.shards);
        format!("sbatch --dependency=afterany:$({array}) --output={} {script} merge", log.replace('%', "%%"))
    }

    fn script(&self, experiment: &Experiment, folder: &Path, whole: &Path) -> Result<String, Failure> {
        let has_programs = experiment.policies.iter().any(|policy| policy.made().it.program().is_some());
        let run_programs = has_programs.then(|| "--run-programs".to_owned());
        let chosen = self.selection.arguments().into_iter().map(|argument| quoted(&argument));
        let arguments: Vec<String> =
            std::iter::once(shown(&absolute(&self.file)?)).chain(run_programs).chain(chosen).collect();
        let (name, shards, line) = (&experiment.name, self.shards, self.line(folder));
        let (usar, arguments, directory) =
            (shown(&program()?), arguments.join(" "), shown(&absolute(Path::new("."))?));
        // Slurm replaces words behind `%` in the name of a log.
        let logs = shown(&folder.join("logs")).replace('%', "%%");
        let sbatch = self.sbatch.join(" ");
        let directives = if sbatch.is_empty() { sbatch } else { format!("\n#SBATCH {sbatch}") };
        let (folder, whole) = (shown(folder), shown(whole));
        Ok(format!(
            r#"#!/bin/bash
# The sweep {name}: a task for each of its shards, and with the word `merge` the whole and its report.
# This submits it, or runs what is missing:
# {line}
#SBATCH --job-name={name}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={logs}/%a.log{directives}
cd {directory} || exit 3
if [ "${{1:-}}" = merge ]; then
    {usar} cluster merge {folder} --out {whole}
    status=$?
    [ "$status" -gt 1 ] || {usar} report {whole} # 1: trials without numbers are rows of the table
    exit "$status"
fi
# Every finished trial is on disk: a task that is stopped goes on there when it runs again.
exec {usar} sweep {arguments} \
    --shard "$SLURM_ARRAY_TASK_ID/{shards}" --out {folder}/"$SLURM_ARRAY_TASK_ID" \
    --jobs "${{SLURM_CPUS_PER_TASK:-1}}" --quiet
"#
        ))
    }
}

/// A path as it is typed in a shell.
fn shown(path: &Path) -> String {
    quoted(&path.display().to_string())
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let path = std::path::absolute(path)?;
    if path.to_string_lossy().contains('\n') {
        refuse!("{}: must not have a line break in it", path.display());
    }
    Ok(path)
}
