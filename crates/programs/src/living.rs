//! The groups of processes that live. A group has a program and what the program started itself.

use std::collections::BTreeMap;
use std::process::Child;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, kill_process_group, waitid};

/// How long a program may take to end after its bye.
pub(crate) const PATIENCE: Duration = Duration::from_secs(2);

/// How long a guard may take to end its program.
const GUARDED: Duration = Duration::from_millis(100);

/// How often the end of a process is looked for.
pub(crate) const LOOK: Duration = Duration::from_millis(2);

/// The groups that live, by the number of their first process, and whether each has heard its bye.
static LIVING: Mutex<BTreeMap<i32, bool>> = Mutex::new(BTreeMap::new());

fn living() -> MutexGuard<'static, BTreeMap<i32, bool>> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A group, by its first process; `None` once it was killed, because its number may then be another's.
#[derive(Debug)]
pub(crate) struct Group(Option<Pid>);

impl Group {
    /// The group of a process that was started as the first of its group.
    pub(crate) fn of(child: &Child) -> Self {
        let pid = Pid::from_child(child);
        living().insert(pid.as_raw_nonzero().get(), false);
        Self(Some(pid))
    }

    /// Notes that it has heard its bye, so that [`end_all`] waits for it.
    pub(crate) fn note_bye(&self) {
        self.0.map(|pid| living().insert(pid.as_raw_nonzero().get(), true));
    }

    /// Whether its first process has ended. The process is not waited for, so that its number stays taken.
    pub(crate) fn is_over(&self) -> bool {
        let how = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        self.0.is_none_or(|pid| waitid(WaitId::Pid(pid), how).is_ok_and(|status| status.is_some()))
    }

    /// Ends all its processes. Its first process must not have been waited for before the first call.
    pub(crate) fn kill(&mut self) {
        let Some(pid) = self.0.take() else { return };
        end_group(pid);
        living().remove(&pid.as_raw_nonzero().get());
    }
}

/// Ends a group. Its first process, the guard, may first end a program that has left the group. A group that
/// is over needs no signal.
fn end_group(group: Pid) {
    let how = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    let is_over = || !waitid(WaitId::Pid(group), how).is_ok_and(|status| status.is_none());
    if !is_over() && kill_process(group, Signal::TERM).is_ok() {
        let late = Instant::now() + GUARDED;
        while !is_over() && Instant::now() < late {
            sleep(LOOK);
        }
    }
    let _ = kill_process_group(group, Signal::KILL);
}

/// Ends every program that this process has started and that still lives. Programs that have heard their bye
/// may take their two seconds; all others are killed at once. A command calls this last.
pub fn end_all() {
    let end = Instant::now() + PATIENCE;
    loop {
        let waits = {
            let living = living();
            let is_late = Instant::now() > end;
            let ends = living.iter().filter(|(_, is_ending)| is_late || !**is_ending);
            ends.filter_map(|(group, _)| Pid::from_raw(*group)).for_each(end_group);
            !is_late && living.values().any(|is_ending| *is_ending)
        };
        if !waits {
            return;
        }
        sleep(LOOK);
    }
}
