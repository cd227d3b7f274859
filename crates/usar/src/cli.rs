//! The process: the command line is read, the command executed, and what came of it is the exit status.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::error::{ContextKind, ContextValue};
use clap::{ArgMatches, Command};
use clap_complete::CompleteEnv;
use experiments::experiment::{SOURCE, with_oracle};
use experiments::{Failure, note_panic, panic_message};
use programs::{Consent, Launch, Unknown};
use tables::{fold_at, show_as};
use teaming::Registry;
use terminal_size::terminal_size_of;

use crate::arguments::format_of;
use crate::command_line::CommandLine;
use crate::commands::{ASKED, Cli, VERSION, command, completing, examples_first};
use crate::library;
use crate::report::columns_of;
use crate::retired::instead;
use crate::running::{STOP, is_stopped, note_program, own_guard, status_of_signal, stop_on_signals, tell};
use crate::studies;

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
/// # fn my_policy() -> teaming::PolicyKind { policies::random::kind() }
/// fn main() -> std::process::ExitCode {
///     let mut registry = policies::standard();
///     registry.add(my_policy()).expect("a new name");
///     usar::main_with(registry)
/// }
/// ```
pub fn main_with(policies: Registry) -> ExitCode {
    CompleteEnv::with_factory(|| completing(command())).var(ASKED).complete();
    let line: Vec<OsString> = std::env::args_os().collect();
    ExitCode::from(run(&line, policies, own_guard()))
}

/// The `main` of the program of a study, which `usar` starts if it is built from the same sources.
pub fn main_of<C: CommandLine>() -> ExitCode {
    let line: Vec<OsString> = std::env::args_os().collect();
    if let [_, own, source] = &line[..]
        && own == "self"
        && source == "source"
    {
        println!("{SOURCE}");
        return ExitCode::SUCCESS;
    }
    let command = examples_first(C::command().version(VERSION.as_str()).max_term_width(110));
    ExitCode::from(run_as::<C>(command, &line, policies::standard(), own_guard()))
}

/// Runs a command line, its program first, and returns the exit status of [`main`]: for a program of another
/// language. `guard` are the words that start [`programs::guard`] in a process of its own.
pub fn run(line: &[OsString], policies: Registry, guard: Vec<OsString>) -> u8 {
    let command = command();
    match studies::start(line, &command) {
        Some(Ok(status)) => status,
        Some(Err(failure)) => {
            tell(format_args!("error: {failure}"));
            exit_status(&failure)
        }
        None => run_as::<Cli>(command, line, policies, guard),
    }
}

fn run_as<C: CommandLine>(
    command: Command,
    line: &[OsString],
    policies: Registry,
    guard: Vec<OsString>,
) -> u8 {
    if let [_, own, guard, words @ ..] = line
        && own == "self"
        && guard == "guard"
    {
        return programs::guard(words);
    }
    line.iter().take(1).for_each(|program| note_program(program));
    library::carry();
    // A panic is a defect of the program. It is caught and reported in one sentence, never as a backtrace.
    std::panic::set_hook(Box::new(note_panic));
    let matches = command.try_get_matches_from(line).unwrap_or_else(|error| {
        let words: Vec<String> =
            line.iter().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
        let advice = if error.use_stderr() { instead(&words).or_else(|| verb_for(&error)) } else { None };
        if let Some(advice) = advice {
            tell(format_args!("error: {advice}"));
            std::process::exit(2);
        }
        error.exit()
    });
    let cli = C::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    columns_of(terminal_size_of(std::io::stdout())).into_iter().for_each(fold_at);
    let mut verb = &matches;
    while let Some((_, below)) = verb.subcommand() {
        verb = below;
    }
    show_as(format_of(verb));
    let mut registry = with_oracle(policies);
    let longest = verb.try_get_one::<f64>("max_trial_s").ok().flatten();
    let longest = longest.and_then(|seconds| Duration::try_from_secs_f64(*seconds).ok());
    // A caller's policy of the same name stays.
    let _ = match launch_of(&cli, &typed(verb), longest, guard) {
        Some(launch) => programs::add_to(&mut registry, launch),
        None => programs::add_names(&mut registry),
    };
    let run = std::panic::AssertUnwindSafe(|| cli.execute(&registry)?.print());
    let result = std::panic::catch_unwind(run)
        .unwrap_or_else(|panic| Err(Failure::run(format!("internal error: {}", panic_message(&*panic)))));
    programs::end_all();
    match result {
        Ok(()) | Err(Failure::ClosedOutput) => 0,
        Err(failure) => {
            tell(format_args!("error: {failure}"));
            exit_status(&failure)
        }
    }
}

/// The policies on a command line: the words of the options that take policies, and no name of a file.
fn typed(verb: &ArgMatches) -> Vec<String> {
    let words = |option| verb.try_get_raw(option).ok().flatten().into_iter().flatten();
    let all = ["policy", "policies", "instead", "then"].into_iter().flat_map(words);
    all.map(|word| word.to_string_lossy().into_owned()).collect()
}

/// How a command may start policies that are programs: those in its own words, those that this user has
/// allowed, and others if it is told so. None for a command that only reads.
fn launch_of(
    cli: &impl CommandLine,
    typed: &[String],
    longest: Option<Duration>,
    guard: Vec<OsString>,
) -> Option<Launch> {
    const HINT: &str = "--run-programs allows it";
    if !cli.asks_policies() {
        return None;
    }
    let unknown = if cli.runs_programs() { Unknown::Allow } else { Unknown::Ask(HINT) };
    let consent = Consent::new(typed.iter().map(String::as_str), unknown, |line| tell(line), &STOP);
    let stop = Arc::clone(&STOP);
    Some(Launch { stop, begin: stop_on_signals, longest, consent, guard })
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
