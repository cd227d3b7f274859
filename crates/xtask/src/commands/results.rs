//! `results [--list] [--on cluster] [OUTPUT ...]`, in the project's folder, with `usar` built in the same
//! profile: runs the commands of the ledger whose results are older than the program, or those named, one
//! after the other. A killed run goes on where it was; what other bits have left in a folder is deleted.

use std::path::Path;
use std::process::{Command, ExitCode};

use programs::quoted;
use usar_sim::BITS;
use xtask::results::{self, Row};

/// Where scripts for a cluster are written.
const JOBS: &str = "results/jobs";

/// Number of shards of a sweep on a cluster.
const SHARDS: u32 = 8;

pub fn run(arguments: &[String]) -> ExitCode {
    let rows = results::read(Path::new("."));
    let (mut is_list, mut is_on_cluster, mut named) = (false, false, Vec::new());
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--list" => is_list = true,
            "--on" if words.next().is_some_and(|place| place == "cluster") => is_on_cluster = true,
            name if rows.iter().any(|row| row.output == name) => named.push(name),
            other => {
                eprintln!(
                    "results: must be --list, --on cluster, or an output of docs/results.csv, found {other:?}"
                );
                return ExitCode::from(2);
            }
        }
    }
    let is_chosen =
        |row: &&Row| if named.is_empty() { row.is_stale() } else { named.contains(&row.output.as_str()) };
    let chosen: Vec<&Row> = rows.iter().filter(is_chosen).collect();
    if is_list {
        list(&rows.iter().collect::<Vec<_>>());
    } else {
        list(&chosen);
    }
    tell_cost(&chosen);
    if is_list {
        return ExitCode::SUCCESS;
    }
    let step = if is_on_cluster { submit } else { play };
    for row in chosen.into_iter().filter(|row| !row.command.is_empty()) {
        begin_anew(row);
        if !step(row) {
            eprintln!("results: {} failed; the same command goes on from there", row.output);
            return ExitCode::FAILURE;
        }
    }
    if !is_on_cluster {
        println!("results: `just pages` renews the numbers on pages; prose is renewed by hand");
    }
    ExitCode::SUCCESS
}

fn list(rows: &[&Row]) {
    println!("{:<42} {:>4}  {:<10} {:>7}  pages", "output", "bits", "state", "minutes");
    for row in rows {
        let state = match (row.is_stale(), row.command.is_empty()) {
            (false, _) => "up to date",
            (true, false) => "stale",
            (true, true) => "not kept",
        };
        let minutes = row.minutes.map_or("?".to_owned(), |minutes| minutes.to_string());
        println!("{:<42} {:>4}  {state:<10} {minutes:>7}  {}", row.output, row.bits, row.page);
    }
}

fn tell_cost(chosen: &[&Row]) {
    let kept: Vec<&&Row> = chosen.iter().filter(|row| !row.command.is_empty()).collect();
    let minutes: f64 = kept.iter().filter_map(|row| row.minutes).fold(0.0, |sum, minutes| sum + minutes);
    let unknown = kept.iter().filter(|row| row.minutes.is_none()).count();
    println!(
        "{} to be run: {minutes:.0} minutes of two cores, and {unknown} whose cost is not known; {} not kept",
        kept.len(),
        chosen.len() - kept.len()
    );
}

/// Deletes what another program has left in a row's folder; `usar` would refuse to go on there.
fn begin_anew(row: &Row) {
    if let Some(bits) = row.bits_there().filter(|bits| *bits != BITS) {
        println!("results/{}: trials of bits {bits} are deleted", row.output);
        std::fs::remove_dir_all(Path::new("results").join(&row.output)).expect("the folder can be deleted");
    }
}

/// The line that puts the programs beside this one before all others, and stops where a command fails.
fn preamble() -> String {
    let programs = super::usar().parent().map(|folder| folder.display().to_string()).unwrap_or_default();
    format!("set -euo pipefail\nPATH={}:$PATH\n", quoted(&programs))
}

fn shell(command: &str) -> bool {
    println!("\n{command}");
    Command::new("bash").args(["-c", &(preamble() + command)]).status().expect("bash runs").success()
}

/// Runs the command of a row, and writes in the ledger that it was run.
fn play(row: &Row) -> bool {
    let (is_new, before) = (row.bits_there().is_none(), minutes_of_children());
    let is_done = shell(&row.command);
    if is_done {
        let date = Command::new("date").arg("+%F").output().expect("date runs").stdout;
        let minutes = minutes_of_children().zip(before).map(|(after, before)| (after - before).max(0.01));
        let minutes = minutes.filter(|_| is_new).map(|minutes| (100.0 * minutes).round() / 100.0);
        results::mark(&row.output, String::from_utf8(date).expect("a date").trim(), minutes);
    }
    is_done
}

/// Half of the processor's minutes of all commands so far; none on a system that does not tell it.
fn minutes_of_children() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    // `cutime` and `cstime`, in hundredths of a second.
    let ticks: Option<Vec<f64>> = [13, 14].iter().map(|&i| fields.get(i)?.parse().ok()).collect();
    Some(ticks?.iter().sum::<f64>() / 100.0 / 60.0 / 2.0)
}

/// Writes the job script of a row, and prints the line that submits it.
fn submit(row: &Row) -> bool {
    if let Some(sweep) = row.command.strip_prefix("usar sweep ") {
        let script = format!("results/{}-shards/job.sh", row.output);
        if Path::new(&script).exists() {
            println!("\n{script}: was written before; it says how it is submitted");
            return true;
        }
        return shell(&format!("usar cluster submit {sweep} --shards {SHARDS}"));
    }
    let here = std::env::current_dir().expect("a folder");
    let script = format!("{JOBS}/{}.sh", row.output.replace('/', "-"));
    let here = quoted(&here.display().to_string());
    std::fs::create_dir_all(JOBS).expect("the folder can be made");
    let text = format!("#!/bin/bash\ncd {here}\n{}{}\n", preamble(), row.command);
    std::fs::write(&script, text).expect("the script can be written");
    // Results of one world may be made of one another: they wait for those submitted before.
    println!("sbatch --job-name={} --dependency=singleton {script}", quoted(&row.world));
    true
}
