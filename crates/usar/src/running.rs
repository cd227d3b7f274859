//! Sessions of policies, signals, and messages on stderr.

use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Once, OnceLock};
use std::time::Instant;

use experiments::Failure;
use experiments::experiment::PolicySpec;
use scenario::Scenario;
use scenario::seed::trial_number;
use signal_hook::consts::{SIGINT, SIGTERM};
use teaming::{PolicyError, Session, TrialStart};
use terminal_size::terminal_size_of;
use usar_sim::simulation::Simulation;

use crate::printable::Printable;
use crate::report::columns_of;

/// A trial checks once in this many steps whether it is to stop.
const CLOCK_CHECK_STEPS: u64 = 64;

/// Set by Ctrl-C, SIGTERM and SIGHUP.
pub static STOP: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// The number of the signal that set [`STOP`]; 0 for none.
static SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// The file of this program, where a command line had it.
static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Notes the first word of a command line, which is the program's file unless the shell looked for it.
pub(crate) fn note_program(word: &OsStr) {
    let named = Path::new(word);
    if named.is_absolute() && named.is_file() {
        let _ = PROGRAM.set(named.to_owned());
    }
}

/// The file of this program: of a package for another language, its script and not that language.
///
/// # Errors
/// The system does not say.
pub(crate) fn program() -> std::io::Result<PathBuf> {
    PROGRAM.get().cloned().map_or_else(std::env::current_exe, Ok)
}

/// The words that start this program as a guard, also after its file was replaced.
pub(crate) fn own_guard() -> Vec<OsString> {
    let own = Path::new("/proc/self/exe");
    let file = if own.exists() { Ok(own.to_owned()) } else { std::env::current_exe() };
    file.map_or_else(|_| Vec::new(), |file| [file.into(), "self".into(), "guard".into()].to_vec())
}

/// Opens a session of a policy for a trial.
///
/// # Errors
/// The policy cannot be opened, or does not take the trial.
pub fn session_of(spec: &PolicySpec, scenario: &Scenario, seed: u64) -> Result<Box<dyn Session>, Failure> {
    let failed = |error: PolicyError| format!("policy {}: {error}", spec.label);
    let mut session = spec.made().open().map_err(|error| Failure::input(failed(error)))?;
    session
        .reset(&TrialStart { scenario: &scenario.name, number: trial_number(seed) })
        .map_err(|error| Failure::run(failed(error)))?;
    Ok(session)
}

/// From now on, Ctrl-C, SIGTERM and SIGHUP set [`STOP`], and running work ends in an orderly way.
pub fn stop_on_signals() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(register_signals);
}

fn register_signals() {
    #[cfg(unix)]
    let signals = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    #[cfg(not(unix))]
    let signals = [SIGINT, SIGTERM];
    for signal in signals {
        let _ = signal_hook::flag::register_usize(signal, Arc::clone(&SIGNAL), signal as usize);
        let _ = signal_hook::flag::register(signal, Arc::clone(&STOP));
    }
}

/// Whether [`STOP`] is set.
pub fn is_stopped() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// The exit status after a signal, in the convention of shells: 130 after Ctrl-C.
pub(crate) fn status_of_signal() -> u8 {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => 130,
        signal => 128_u8.wrapping_add(signal as u8),
    }
}

/// Ends a single trial that exceeds its time limit or is to stop.
pub(crate) struct Guard {
    begun: Instant,
    longest_s: f64,
}

impl Guard {
    /// A guard that gives a trial this long from now on, in seconds of wall-clock time.
    pub(crate) fn new(longest_s: f64) -> Self {
        Self { begun: Instant::now(), longest_s }
    }

    /// Checks from time to time whether the trial may continue.
    pub(crate) fn look(&self, simulation: &Simulation) -> Result<(), Failure> {
        if !simulation.steps().is_multiple_of(CLOCK_CHECK_STEPS) {
            return Ok(());
        }
        let at = simulation.time_s();
        if is_stopped() {
            return Err(Failure::Interrupted(format!("stopped at {at:.0} s of simulated time")));
        }
        if self.begun.elapsed().as_secs_f64() > self.longest_s {
            return Err(Failure::run(format!(
                "the trial took longer than {} s and had come to {at:.0} s of simulated time; --max-trial-s \
                 gives it longer",
                self.longest_s
            )));
        }
        Ok(())
    }
}

/// Prints a line on stderr. Failures to write it are ignored.
pub fn tell(what: impl Display) {
    let mut stderr =
        Printable::new(std::io::stderr()).with_columns(columns_of(terminal_size_of(std::io::stderr())));
    let _ = writeln!(stderr, "{what}").and_then(|()| stderr.flush());
}
