//! The guard of a program: a process between the command and the program, which ends the program and all that
//! is in its group once the command is gone, however the command ended.

use std::ffi::{OsStr, OsString};
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, ExitStatus};
use std::thread::{Builder, sleep};
use std::time::Duration;

use rustix::process::{Pid, Signal, getpgrp, getpid, getppid, kill_current_process_group, kill_process};
use signal_hook::consts::{SIGCHLD, SIGTERM};
use signal_hook::iterator::Signals;

/// Exit status of a guard whose program does not start, as of a shell.
const NO_START: u8 = 126;

/// How often a guard looks whether the command lives.
const PERIOD: Duration = Duration::from_millis(100);

/// A command behind its guard: the words of the guard, the number of this process, the words of the program.
/// Without words of a guard there is none.
pub(crate) fn guarded(guard: &[OsString], words: &[String]) -> Command {
    let own = getpid().as_raw_nonzero().to_string();
    let own = (!guard.is_empty()).then_some(OsStr::new(&own));
    let mut words = guard.iter().map(OsString::as_os_str).chain(own).chain(words.iter().map(OsStr::new));
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words);
    command
}

/// Runs a program for the command with this process number, and ends as the program does: the `main` of a
/// guard. It must be the first process of a group of its own.
#[must_use]
pub fn guard(words: &[OsString]) -> u8 {
    let [parent, program, arguments @ ..] = words else { return NO_START };
    let parent = parent.to_str().and_then(|text| text.parse().ok()).and_then(Pid::from_raw);
    let is_alone = getpgrp() == getpid();
    let Some(parent) = parent.filter(|parent| is_alone && getppid() == Some(*parent)) else {
        return NO_START;
    };
    let told = |error: &io::Error| eprintln!("cannot be started: {}: {error}", program.display());
    let Ok(mut signals) = Signals::new([SIGTERM, SIGCHLD]) else { return NO_START };
    let mut child = match Command::new(program).args(arguments).spawn() {
        Ok(child) => child,
        Err(error) => {
            told(&error);
            return NO_START;
        }
    };
    let own = Pid::from_child(&child);
    if let Err(error) = watch(parent, own).and_then(|()| close_own_ends()) {
        told(&error);
        return end_group(own);
    }
    for signal in &mut signals {
        if signal == SIGTERM {
            return end_group(own);
        }
        if let Ok(Some(status)) = child.try_wait() {
            return end_like(status);
        }
    }
    end_group(own)
}

/// From now on, this process and the program end soon after the command, however it ended.
fn watch(parent: Pid, program: Pid) -> io::Result<()> {
    let look = move || {
        while getppid() == Some(parent) {
            sleep(PERIOD);
        }
        end_group(program)
    };
    Builder::new().name("guard".to_owned()).spawn(look).map(drop)
}

/// Leaves the standard streams to the program alone, so that their other ends see when it closes them.
fn close_own_ends() -> io::Result<()> {
    let nothing = std::fs::File::options().read(true).write(true).open("/dev/null")?;
    rustix::stdio::dup2_stdin(&nothing)?;
    rustix::stdio::dup2_stdout(&nothing)?;
    Ok(rustix::stdio::dup2_stderr(&nothing)?)
}

/// Kills the program, which may have left this group, and all processes of this group, this one with them.
fn end_group(program: Pid) -> u8 {
    let _ = kill_process(program, Signal::KILL);
    let _ = kill_current_process_group(Signal::KILL);
    NO_START
}

/// Ends with the exit status of the program, or by the signal that has ended it.
fn end_like(status: ExitStatus) -> u8 {
    if let Some(signal) = status.signal() {
        if signal == Signal::KILL.as_raw() {
            let _ = kill_process(getpid(), Signal::KILL);
        }
        let _ = signal_hook::low_level::emulate_default_handler(signal);
    }
    status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(NO_START)
}
