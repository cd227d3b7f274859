//! The process: the command line is read, the command executed, and what came of it is the exit status.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::FromArgMatches;
use clap::error::{ContextKind, ContextValue};
use clap_complete::CompleteEnv;
use experiments::experiment::with_oracle;
use experiments::{Failure, note_panic, panic_message};
use reports::table::{fold_at, show_as};
use rne_core::Registry;
use terminal_size::terminal_size_of;

use crate::arguments::format_of;
use crate::commands::{ASKED, Cli, command, completing};
use crate::library;
use crate::output::{columns_of, sentences};
use crate::running::{STOP, is_stopped, note_program, status_of_signal, stop_on_signals, tell};

/// Runs the command with which the process was called. The exit status is 0 for a result, 1 for a failure
/// of the run, 2 for unusable input, 3 for a disk error, 130 after Ctrl-C, 143 after SIGTERM and 129 after
/// SIGHUP.
pub fn main() -> ExitCode {
    main_with(policies::standard())
}

/// The same with policies of the caller's own beside the built-in ones: the `main` of a program that adds
/// policies.
///
/// ```no_run
/// # fn my_policy() -> rne_core::PolicyKind { policies::random::kind() }
/// fn main() -> std::process::ExitCode {
///     let mut registry = policies::standard();
///     registry.add(my_policy()).expect("a new name");
///     usar::main_with(registry)
/// }
/// ```
pub fn main_with(policies: Registry) -> ExitCode {
    CompleteEnv::with_factory(|| completing(command())).var(ASKED).complete();
    ExitCode::from(run(std::env::args_os(), policies))
}

/// Runs a command line, its program first, and returns the exit status of [`main`]: for a program of another
/// language.
pub fn run(line: impl IntoIterator<Item = OsString>, policies: Registry) -> u8 {
    let line: Vec<OsString> = line.into_iter().collect();
    line.iter().take(1).for_each(|program| note_program(program));
    let mut registry = with_oracle(policies);
    // A caller's policy of the same name stays.
    let _ = registry.add(programs::kind(&STOP, stop_on_signals));
    library::carry();
    // A panic is a defect of the program. It is caught and reported in one sentence, never as a backtrace.
    std::panic::set_hook(Box::new(note_panic));
    let matches = command().try_get_matches_from(line).unwrap_or_else(|error| {
        if let Some(verb) = verb_for(&error) {
            tell(format_args!("error: {verb}"));
            std::process::exit(2);
        }
        error.exit()
    });
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    columns_of(terminal_size_of(std::io::stdout())).into_iter().for_each(fold_at);
    let mut verb = &matches;
    while let Some((_, below)) = verb.subcommand() {
        verb = below;
    }
    let format = format_of(verb);
    show_as(format);
    let mut out = sentences(format);
    let run = std::panic::AssertUnwindSafe(|| cli.execute(&registry, &mut *out));
    let result = std::panic::catch_unwind(run)
        .unwrap_or_else(|panic| Err(Failure::run(format!("internal error: {}", panic_message(&*panic)))));
    let result = result.and_then(|()| Ok(out.flush()?));
    programs::end_all();
    match result {
        Ok(()) | Err(Failure::ClosedOutput) => 0,
        Err(failure) => {
            tell(format_args!("error: {failure}"));
            exit_status(&failure)
        }
    }
}

/// For a file or folder in the place of a command: a sentence with the command that is meant.
fn verb_for(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(found)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let path = Path::new(found);
    let verb = match path.extension().and_then(|ending| ending.to_str()) {
        Some("ron") => "run",
        Some("usrec") => "view",
        _ if path.is_dir() => "compare",
        _ => return None,
    };
    Some(format!("{found} is no command; did you mean `usar {verb} {found}`?"))
}

fn exit_status(failure: &Failure) -> u8 {
    match failure {
        Failure::ClosedOutput => 0,
        // A policy that was told to stop has not answered.
        Failure::Run(_) | Failure::Input(_) if is_stopped() => status_of_signal(),
        Failure::Run(_) => 1,
        Failure::Input(_) => 2,
        Failure::Storage(_) => 3,
        Failure::Interrupted(_) => status_of_signal(),
    }
}
