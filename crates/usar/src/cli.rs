//! The command line.

use std::io::Write;
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::{CommandFactory, Parser, Subcommand};
use experiments::experiment::with_oracle;
use experiments::provenance::COMMIT;
use experiments::{Failure, note_panic, panic_message};
use reports::table::{Format, fold_at, show_as};
use rne_core::Registry;
use terminal_size::{Width, terminal_size_of};

use crate::commands::sentences;
use crate::commands::{
    calibrate, check, choose, compare, completions, doctor, draw, estimate, export, figure, fmt, fork, group,
    list, man, merge, new, oracle, readings, regret, render, report, reproduce, resolve, run, schema, search,
    sensitivity, sorting, status, submit, sweep, test, tidy, trust, verify, view, why,
};
use crate::running::{status_of_signal, tell};

/// The version, with the commit from which the program was built, if known.
static VERSION: LazyLock<String> = LazyLock::new(|| match COMMIT {
    "unknown" => env!("CARGO_PKG_VERSION").to_owned(),
    commit => format!("{} (commit {commit})", env!("CARGO_PKG_VERSION")),
});

/// Which robots should team up? A laboratory for trust and grouping policies in mixed robot teams.
#[derive(Debug, Parser)]
#[command(
    name = "usar",
    version = VERSION.as_str(),
    max_term_width = 110,
    after_help = "\
Examples:
  usar sweep scenarios/paper.ron                       the paper's experiment: policies over paired trials
  usar run scenarios/paper.ron --policy RNE --seed 3   one trial, round by round
  usar compare results/paper                           is A better than B, by how much, how sure is that?
  usar report results/paper                            all of it as one page, with figures
  usar figure results/paper rescuees --width 88mm      a figure for the column of a paper, as PDF
  usar view scenarios/paper.ron --policy RNE,DIS       watch two trials side by side, in a browser
  usar sensitivity scenarios/paper.ron --over mission.rest_s=0..60    what matters for the outcome?
  usar search scenarios/paper.ron --policy RNE --against DIS --over mission.rest_s=0..60    where does it \
  fail?
  usar draw scenarios/paper.ron --out map.svg          the world before anything runs
  usar render scenarios/paper.ron --at 120 --out frame.png
  usar estimate scenarios/paper.ron --trials 1000      how long, and how much disk?
  usar submit scenarios/sweeps/energy.ron --slurm      on a cluster; `usar status` tells how it goes
  usar verify results/paper                            do the numbers come out again?
  usar trust --weights 6,4,2 --from 86,120,30 --to 20,30,10
  usar group robots.csv --policy RNE
  usar new mine                                        a commented scenario to begin with
  usar check scenarios/*.ron                           is every value in its range?
  usar resolve scenarios/paper.ron                     every value, and where it comes from
  usar fmt mine.ron                                    its layout; comments stay
  usar list policies                                   which there are: also scenarios, roles, metrics
  usar completions bash                                for the shell; `usar man` writes manual pages
  usar doctor                                          version, processor, threads; can results be written?

Exit status:
  0    a result
  1    a failure while running: a trial without numbers, a failed check, an internal error
  2    input that cannot be used; nothing was written
  3    a disk error; what was finished is kept
  130  stopped by Ctrl-C (129 by SIGHUP, 143 by SIGTERM)

Data goes to stdout, progress and messages to stderr."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Sorting(sorting::Arguments),
    Sweep(sweep::Arguments),
    Test(test::Arguments),
    Estimate(estimate::Arguments),
    Merge(merge::Arguments),
    Submit(submit::Arguments),
    Status(status::Arguments),
    Compare(compare::Arguments),
    Report(report::Arguments),
    Figure(figure::Arguments),
    Tidy(tidy::Arguments),
    Reproduce(reproduce::Arguments),
    Fork(fork::Arguments),
    Oracle(oracle::Arguments),
    Readings(readings::Arguments),
    Regret(regret::Arguments),
    Sensitivity(sensitivity::Arguments),
    Search(search::Arguments),
    Verify(verify::Arguments),
    Calibrate(calibrate::Arguments),
    Choose(choose::Arguments),
    New(new::Arguments),
    Check(check::Arguments),
    Fmt(fmt::Arguments),
    Resolve(resolve::Arguments),
    List(list::Arguments),
    Trust(trust::Arguments),
    Group(group::Arguments),
    Schema(schema::Arguments),
    View(view::Arguments),
    Why(why::Arguments),
    Draw(draw::Arguments),
    Render(render::Arguments),
    Export(export::Arguments),
    Doctor(doctor::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// Runs the command with which the process was called. The exit status is 0 for a result, 1 for a failure
/// of the run, 2 for unusable input, 3 for a disk error, 130 after Ctrl-C, 143 after SIGTERM and 129 after
/// SIGHUP.
#[must_use]
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
#[must_use]
pub fn main_with(policies: Registry) -> ExitCode {
    let mut registry = with_oracle(policies);
    // A panic is a defect of the program. It is caught and reported in one sentence, never as a backtrace.
    std::panic::set_hook(Box::new(note_panic));
    let cli = Cli::parse();
    if let Some((Width(columns), _)) = terminal_size_of(std::io::stdout()) {
        fold_at(columns);
    }
    let (format, has_json) = cli.command.shown();
    show_as(format);
    let mut out = sentences(format, has_json);
    let run = std::panic::AssertUnwindSafe(|| {
        cli.command.choose_measure(&mut registry)?;
        cli.command.execute(&registry, &mut *out)
    });
    let result = std::panic::catch_unwind(run)
        .unwrap_or_else(|panic| Err(Failure::run(format!("internal error: {}", panic_message(&*panic)))));
    let result = result.and_then(|()| Ok(out.flush()?));
    match result {
        Ok(()) | Err(Failure::ClosedOutput) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(format_args!("error: {failure}"));
            ExitCode::from(exit_status(&failure))
        }
    }
}

fn exit_status(failure: &Failure) -> u8 {
    match failure {
        Failure::ClosedOutput => 0,
        Failure::Run(_) => 1,
        Failure::Input(_) => 2,
        Failure::Storage(_) => 3,
        Failure::Interrupted(_) => status_of_signal(),
    }
}

impl Command {
    /// Chooses the trust measure that the command line names.
    fn choose_measure(&self, registry: &mut Registry) -> Result<(), Failure> {
        let measure = match self {
            Self::Run(arguments) => &arguments.measure,
            Self::Sorting(arguments) => &arguments.measure,
            Self::Sweep(arguments) => &arguments.measure,
            Self::Report(arguments) => &arguments.measure,
            Self::Figure(arguments) => &arguments.measure,
            Self::Regret(arguments) => &arguments.measure,
            Self::Why(arguments) => &arguments.measure,
            _ => return Ok(()),
        };
        measure.choose(registry)
    }

    /// The format of tables, and whether the command has its own JSON.
    fn shown(&self) -> (Format, bool) {
        let (shown, has_json) = match self {
            Self::Run(arguments) => (arguments.shown, true),
            Self::Compare(arguments) => (arguments.shown, true),
            Self::Fork(arguments) => (arguments.shown, true),
            Self::Oracle(arguments) => (arguments.shown, true),
            Self::Regret(arguments) => (arguments.shown, true),
            Self::Choose(arguments) => (arguments.shown, true),
            Self::Why(arguments) => (arguments.shown, true),
            Self::Sensitivity(arguments) => (arguments.shown, true),
            Self::Sweep(arguments) => (arguments.shown, false),
            Self::Reproduce(arguments) => (arguments.shown, false),
            Self::Readings(arguments) => (arguments.shown, false),
            Self::Calibrate(arguments) => (arguments.shown, false),
            Self::Sorting(arguments) => (arguments.shown, false),
            _ => return (Format::Table, false),
        };
        (shown.format(), has_json)
    }

    fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        match self {
            Self::Run(arguments) => arguments.execute(registry, out),
            Self::Sorting(arguments) => arguments.execute(registry, out),
            Self::Sweep(arguments) => arguments.execute(registry, out),
            Self::Test(arguments) => arguments.execute(registry, out),
            Self::Estimate(arguments) => arguments.execute(registry, out),
            Self::Merge(arguments) => arguments.execute(registry, out),
            Self::Submit(arguments) => arguments.execute(registry, out),
            Self::Status(arguments) => arguments.execute(registry, out),
            Self::Compare(arguments) => arguments.execute(registry, out),
            Self::Reproduce(arguments) => arguments.execute(registry, out),
            Self::Report(arguments) => arguments.execute(registry, out),
            Self::Figure(arguments) => arguments.execute(registry, out),
            Self::Tidy(arguments) => arguments.execute(registry, out),
            Self::Fork(arguments) => arguments.execute(registry, out),
            Self::Oracle(arguments) => arguments.execute(registry, out),
            Self::Readings(arguments) => arguments.execute(registry, out),
            Self::Regret(arguments) => arguments.execute(registry, out),
            Self::Sensitivity(arguments) => arguments.execute(registry, out),
            Self::Search(arguments) => arguments.execute(registry, out),
            Self::Verify(arguments) => arguments.execute(registry, out),
            Self::Calibrate(arguments) => arguments.execute(registry, out),
            Self::Choose(arguments) => arguments.execute(registry, out),
            Self::New(arguments) => arguments.execute(out),
            Self::Check(arguments) => arguments.execute(registry, out),
            Self::Fmt(arguments) => arguments.execute(out),
            Self::Resolve(arguments) => arguments.execute(out),
            Self::List(arguments) => arguments.execute(registry, out),
            Self::Trust(arguments) => arguments.execute(out),
            Self::Group(arguments) => arguments.execute(registry, out),
            Self::Schema(arguments) => arguments.execute(out),
            Self::View(arguments) => arguments.execute(registry, out),
            Self::Why(arguments) => arguments.execute(registry, out),
            Self::Draw(arguments) => arguments.execute(registry, out),
            Self::Render(arguments) => arguments.execute(registry, out),
            Self::Export(arguments) => arguments.execute(registry, out),
            Self::Doctor(arguments) => arguments.execute(out),
            Self::Completions(arguments) => arguments.execute(Cli::command(), out),
            Self::Man(arguments) => arguments.execute(Cli::command(), out),
        }
    }
}
