//! One process of a program: started in a group of its own, asked line by line, and ended.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, ioctl_fionbio};
use teaming::Deadline;

use crate::consent::Permit;
use crate::error::{End, SHOWN_BYTES};
use crate::guard::guarded;
use crate::living::{Group, LOOK, PATIENCE};
use crate::options::Options;

/// Longest line, in bytes.
pub(crate) const MOST_BYTES: usize = 16 << 20;

/// How often the deadline is looked at.
const PERIOD: Duration = Duration::from_millis(50);

/// A longer time between two looks is one in which this process slept.
const LONGEST_LOOK: Duration = Duration::from_secs(5);

/// How long a process may take to exit once it has closed its output, and its last words to arrive.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// How long a process may take to end after its bye when everything is to stop.
const HURRY: Duration = Duration::from_millis(200);

/// Number of lines of standard error that are kept.
const KEPT_LINES: usize = 20;

/// Longest kept line of standard error, in bytes.
const KEPT_BYTES: u64 = 500;

/// When a process is waited for no longer.
#[derive(Clone, Copy)]
pub(crate) struct Until<'a> {
    pub(crate) deadline: Deadline<'a>,
    pub(crate) stop: &'a AtomicBool,
}

impl Until<'_> {
    fn is_over(self) -> bool {
        self.deadline.is_over() || self.stop.load(Ordering::Relaxed)
    }
}

/// Why no line came.
#[derive(Debug)]
pub(crate) enum NoLine {
    /// It took too long.
    Silent,
    /// It is wanted no longer.
    Late,
    /// The process closed its output.
    Ended,
    /// The line has more than [`MOST_BYTES`].
    TooLong,
    /// The system refuses.
    Refused(std::io::Error),
}

impl From<Errno> for NoLine {
    fn from(error: Errno) -> Self {
        Self::Refused(error.into())
    }
}

/// A process at work.
pub(crate) struct Process {
    child: Child,
    group: Group,
    stdin: Option<ChildStdin>,
    stdout: ChildStdout,
    received: Vec<u8>,
    /// So many received bytes have no end of a line.
    looked_at: usize,
    said: Said,
}

impl Process {
    /// Starts a command in a group of its own, behind a guard.
    pub(crate) fn start(_: Permit, options: &Options, guard: &[OsString]) -> std::io::Result<Self> {
        let program = options.command.first().ok_or(ErrorKind::InvalidInput)?;
        if !is_there(program) {
            return Err(ErrorKind::NotFound.into());
        }
        let mut command = guarded(guard, &options.command);
        command.process_group(0).env_clear();
        command.envs(std::env::vars_os().filter(|(name, _)| options.passes(name)));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let group = Group::of(&child);
        let ends = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(stdin), Some(stdout), Some(stderr)) = ends else {
            return Err(ErrorKind::BrokenPipe.into());
        };
        // A program that does not read would hold up whoever writes.
        ioctl_fionbio(&stdin, true)?;
        let said = Said::listen(stderr)?;
        Ok(Self { child, group, stdin: Some(stdin), stdout, received: Vec::new(), looked_at: 0, said })
    }

    /// Whether it has ended by itself.
    pub(crate) fn is_over(&self) -> bool {
        self.group.is_over()
    }

    /// Sends a line and waits for one.
    pub(crate) fn exchange(
        &mut self,
        line: &[u8],
        patience: Duration,
        until: Until<'_>,
    ) -> Result<Vec<u8>, NoLine> {
        let (mut left, mut looked) = (patience, Instant::now());
        let mut unsent = line;
        loop {
            if unsent.is_empty()
                && let Some(line) = self.received_line()
            {
                return Ok(line);
            }
            if self.received.len() > MOST_BYTES {
                return Err(NoLine::TooLong);
            }
            if until.is_over() {
                return Err(NoLine::Late);
            }
            // What this process sleeps, as it does after a SIGSTOP, does not count.
            left = left.saturating_sub(looked.elapsed().min(LONGEST_LOOK));
            looked = Instant::now();
            if left.is_zero() {
                return Err(NoLine::Silent);
            }
            let ready = self.wait(!unsent.is_empty(), left.min(PERIOD))?;
            if ready.to_send {
                unsent = self.send(unsent)?;
            }
            if ready.to_receive {
                self.receive()?;
            }
        }
    }

    /// Waits until the process can be heard or, if there is something to send, reads.
    fn wait(&self, sends: bool, longest: Duration) -> Result<Ready, NoLine> {
        let mut ends = vec![PollFd::new(&self.stdout, PollFlags::IN)];
        if let Some(stdin) = self.stdin.as_ref().filter(|_| sends) {
            ends.push(PollFd::new(stdin, PollFlags::OUT));
        }
        // Less than a second: see `PERIOD`.
        let longest = Timespec { tv_sec: 0, tv_nsec: longest.subsec_nanos().into() };
        match poll(&mut ends, Some(&longest)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        let is_ready = |end: Option<&PollFd<'_>>| end.is_some_and(|end| !end.revents().is_empty());
        Ok(Ready { to_receive: is_ready(ends.first()), to_send: is_ready(ends.get(1)) })
    }

    /// Sends as much as the process takes now, and returns the rest.
    fn send<'l>(&mut self, line: &'l [u8]) -> Result<&'l [u8], NoLine> {
        let Some(stdin) = &mut self.stdin else { return Ok(&[]) };
        match stdin.write(line) {
            Ok(count) => Ok(&line[count..]),
            Err(error) if [ErrorKind::WouldBlock, ErrorKind::Interrupted].contains(&error.kind()) => Ok(line),
            // It does not read any more; how it ended is heard next.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(&[]),
            Err(error) => Err(NoLine::Refused(error)),
        }
    }

    fn receive(&mut self) -> Result<(), NoLine> {
        let mut bytes = [0; 1 << 14];
        match self.stdout.read(&mut bytes) {
            Ok(0) => Err(NoLine::Ended),
            Ok(count) => {
                self.received.extend_from_slice(&bytes[..count]);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            Err(error) => Err(NoLine::Refused(error)),
        }
    }

    /// The next line, if all of it is there.
    fn received_line(&mut self) -> Option<Vec<u8>> {
        let end = self.received[self.looked_at..].iter().position(|byte| *byte == b'\n');
        let Some(end) = end else {
            self.looked_at = self.received.len();
            return None;
        };
        let rest = self.received.split_off(self.looked_at + end + 1);
        let mut line = std::mem::replace(&mut self.received, rest);
        self.looked_at = 0;
        line.pop();
        Some(line)
    }

    /// The start of a line that has no end, if there is one.
    pub(crate) fn unended(&self) -> Option<String> {
        let shown = &self.received[..self.received.len().min(SHOWN_BYTES)];
        (!shown.is_empty()).then(|| String::from_utf8_lossy(shown).into_owned())
    }

    /// How the process ended, which has closed its output. Kills what is left of its group.
    pub(crate) fn end(&mut self) -> End {
        self.wait_for_end(LAST_WORDS);
        let is_over = self.is_over();
        self.group.kill();
        let Some(status) = self.child.wait().ok().filter(|_| is_over) else { return End::Closed };
        match (status.code(), status.signal()) {
            (Some(status), _) => End::Status(status),
            (None, Some(signal)) => End::Signal(signal),
            (None, None) => End::Closed,
        }
    }

    /// Says bye with this line, and kills the group if its first process has not ended soon.
    pub(crate) fn dismiss(mut self, bye: &[u8], stop: &AtomicBool) {
        self.group.note_bye();
        let _ = self.send(bye);
        drop(self.stdin.take());
        let patience = if stop.load(Ordering::Relaxed) { HURRY } else { PATIENCE };
        self.wait_for_end(patience);
    }

    fn wait_for_end(&self, patience: Duration) {
        let end = Instant::now() + patience;
        while !self.is_over() && Instant::now() < end {
            sleep(LOOK);
        }
    }

    /// The last lines of its standard error, the first one first.
    pub(crate) fn last_words(&self) -> Vec<String> {
        self.said.tail(if self.is_over() { LAST_WORDS } else { Duration::ZERO })
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.group.kill();
        let _ = self.child.wait();
    }
}

/// Whether a program is where the system looks for it.
fn is_there(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    program.contains('/') && Path::new(program).exists()
        || !program.contains('/') && std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// What can be done with a process now.
struct Ready {
    to_receive: bool,
    to_send: bool,
}

/// The standard error of a process. It is read at all times, so that nothing is held up.
struct Said {
    lines: Arc<Mutex<VecDeque<String>>>,
    listener: JoinHandle<()>,
}

impl Said {
    fn listen(stderr: ChildStderr) -> std::io::Result<Self> {
        let lines: Arc<Mutex<VecDeque<String>>> = Arc::default();
        let kept = Arc::clone(&lines);
        let listen = move || {
            let mut stderr = BufReader::new(stderr);
            let mut line = Vec::new();
            while stderr.by_ref().take(KEPT_BYTES).read_until(b'\n', &mut line).is_ok_and(|count| count > 0) {
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                if kept.len() == KEPT_LINES {
                    kept.pop_front();
                }
                kept.push_back(String::from_utf8_lossy(&line).trim_end().to_owned());
                line.clear();
            }
        };
        let listener = std::thread::Builder::new().name("standard error".to_owned()).spawn(listen)?;
        Ok(Self { lines, listener })
    }

    /// The kept lines. If the process has ended, the last of them may still be on their way.
    fn tail(&self, patience: Duration) -> Vec<String> {
        let end = Instant::now() + patience;
        while !self.listener.is_finished() && Instant::now() < end {
            sleep(LOOK);
        }
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}
