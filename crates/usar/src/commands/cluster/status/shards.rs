//! The state of each shard of a sweep, from its folder and from Slurm's state of its task.

use experiments::experiment::Shard;
use experiments::sweep::host::Hosts;
use experiments::sweep::shards::{Progress, Shards};
use serde::Serialize;

use super::super::slurm::Tasks;
use super::super::submit::quoted;
use crate::prelude::*;

ron_tree::named! {
    /// The state of a shard.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub(super) enum State {
        /// All its trials are finished.
        Done = "done",
        /// A process works in its folder.
        Running = "running",
        /// Its task is in the queue.
        Waiting = "waiting",
        /// Its task ended before the shard was done.
        Failed = "failed",
        /// The shard is neither done, nor running, nor in the queue.
        Lost = "lost",
        /// Its folder is not what `usar cluster merge` takes for this shard.
        Refused = "refused",
    }
}

/// A shard.
#[derive(Debug, Serialize)]
pub(super) struct OneShard {
    /// From 1; 0 for a folder that is refused before its number is known.
    pub number: u32,
    pub state: State,
    /// Slurm's state of the task, or the process that works in the folder.
    pub why: String,
    /// Number of finished trials, and of all trials.
    pub finished: usize,
    pub trials: usize,
    #[serde(skip)]
    pub folder: PathBuf,
}

/// Slurm's states of tasks: the queued tasks, if there is a queue, and the final states of others.
pub(super) struct Said {
    pub queued: Option<Tasks>,
    pub ended: Tasks,
}

impl OneShard {
    /// The shard in a folder, which has this many trials to run.
    pub(super) fn of(
        shards: &Shards,
        shard: Option<Shard>,
        folder: PathBuf,
        trials: usize,
        said: &Said,
    ) -> Self {
        let number = shard.map_or(1, |shard| shard.number);
        match shards.progress(&folder, shard) {
            Ok(there) => {
                let (state, why) = state(Some(&there), number, said);
                Self { number, state, why, finished: there.finished, trials, folder }
            }
            Err(refusal) => Self::refused(number, &refusal, trials, folder),
        }
    }

    /// A shard whose folder cannot be merged.
    pub(super) fn refused(number: u32, refusal: &Failure, trials: usize, folder: PathBuf) -> Self {
        let why = refusal.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { number, state: State::Refused, why, finished: 0, trials, folder }
    }

    /// A shard of a submission that has no folder yet.
    pub(super) fn not_begun(number: u32, folder: PathBuf, trials: usize, said: &Said) -> Self {
        let (state, why) = state(None, number, said);
        Self { number, state, why, finished: 0, trials, folder }
    }

    /// A shard that has no folder yet, with the number of its trials; the folder of another shard, and
    /// whether that one is checked.
    pub(super) fn absent(
        shard: Shard,
        folder: PathBuf,
        trials: usize,
        like: &Path,
        is_checked: bool,
    ) -> Self {
        let number = shard.number;
        let mut absent = Self { number, state: State::Lost, why: String::new(), finished: 0, trials, folder };
        absent.why = format!("not started; to run it: {}", absent.command(like, is_checked, shard));
        absent
    }

    /// The command that runs this shard, from the sweep file in the folder of this or another shard.
    pub(super) fn command(&self, like: &Path, is_checked: bool, Shard { number, of }: Shard) -> String {
        let [file, out] =
            [&like.join("sweep.ron"), &self.folder].map(|path| quoted(&path.display().to_string()));
        let check = if is_checked { " --check" } else { "" };
        format!("usar sweep {file} --shard {number}/{of}{check} --out {out}")
    }
}

fn state(there: Option<&Progress>, number: u32, said: &Said) -> (State, String) {
    if there.is_some_and(|there| there.is_complete) {
        return (State::Done, String::new());
    }
    if let Some(holder) = there.and_then(|there| there.holder.as_ref()) {
        return (State::Running, holder.to_string());
    }
    let queued = said.queued.as_ref().and_then(|tasks| tasks.get(&number));
    match (queued.map(String::as_str), said.ended.get(&number)) {
        (Some(state @ ("RUNNING" | "COMPLETING")), _) => (State::Running, state.to_owned()),
        (Some(state), _) => (State::Waiting, state.to_owned()),
        (None, Some(state)) if state != "PENDING" && state != "RUNNING" => (State::Failed, state.clone()),
        (None, _) => (State::Lost, "not in the queue, and nothing is at work in its folder".to_owned()),
    }
}

/// Mean wall-clock time of a trial in a shard, in seconds, over all runs that ended; `None` before the
/// first.
pub(super) fn seconds_each(folders: impl Iterator<Item = impl AsRef<Path>>) -> Option<f64> {
    let runs = folders.flat_map(|folder| Hosts::read(folder.as_ref()).runs);
    let (seconds, trials) =
        runs.fold((0.0, 0), |(seconds, trials), run| (seconds + run.seconds, trials + run.trials));
    (trials > 0).then(|| seconds / trials as f64)
}

/// Numbers in Slurm's notation: `1,4-7`.
pub(super) fn ranges(numbers: &[u32]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let run = |run: &[u32]| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    };
    runs.map(run).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_without_a_folder_is_what_slurm_says_of_its_task() {
        let of = |queued: Option<&str>, ended: Option<&str>| {
            let tasks = |state: Option<&str>| state.map(|state| (3, state.to_owned())).into_iter().collect();
            state(None, 3, &Said { queued: Some(tasks(queued)), ended: tasks(ended) }).0
        };
        assert_eq!(of(Some("RUNNING"), None), State::Running);
        assert_eq!(of(Some("PENDING"), Some("NODE_FAIL")), State::Waiting, "it was queued again");
        assert_eq!(of(None, Some("TIMEOUT")), State::Failed);
        assert_eq!(of(None, None), State::Lost);
        assert_eq!(ranges(&[1, 4, 5, 6, 9]), "1,4-6,9");
    }
}
