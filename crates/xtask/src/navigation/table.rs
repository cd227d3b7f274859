//! The results of trials, as printed tables and as CSV.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use experiments::Failure;
use serde::{Deserialize, Serialize};

use super::problems::Problem;
use super::trial::{Late, Outcome};

/// A table that prints the line of each problem as soon as its trials have ended.
pub(super) struct Table {
    csv: Option<csv::Writer<std::fs::File>>,
    /// The least flow of another method that was ok in all trials, by problem.
    peers: BTreeMap<String, f64>,
    start: Instant,
    flows: Vec<f64>,
    trials: usize,
    ok: usize,
    given_up: u32,
}

/// A line of the CSV file.
#[derive(Serialize)]
struct Line<'o> {
    problem: &'static str,
    seed: u64,
    robots: usize,
    arrived: usize,
    flow: f64,
    ok: bool,
    given_up: u32,
    touches: f64,
    deepest_mm: f32,
    step_us: f64,
    time_s: f64,
    limit_s: f64,
    failure: &'o str,
}

impl Table {
    /// Prints the header, and opens the CSV file if there is one.
    pub(super) fn new(csv: Option<&Path>) -> Result<Self, Failure> {
        let open = |path: &Path| {
            csv::Writer::from_path(path)
                .map_err(|error| Failure::storage(format!("{}: {error}", path.display())))
        };
        let csv = csv.map(open).transpose()?;
        println!(
            "{:16} {:>6} {:>7} {:>7} {:>7} {:>6} {:>8} {:>8} {:>8}",
            "problem", "robots", "flow", "worst", "peer", "ok %", "given up", "touches", "us/step"
        );
        let peers = best_peers().map_err(|error| Failure::input(format!("peers.csv: {error}")))?;
        Ok(Self { csv, peers, start: Instant::now(), flows: Vec::new(), trials: 0, ok: 0, given_up: 0 })
    }

    /// Prints the line of a problem, and writes its trials.
    pub(super) fn add(&mut self, problem: &Problem, outcomes: &[Outcome]) -> Result<(), Failure> {
        let mean = |of: fn(&Outcome) -> f64| outcomes.iter().map(of).sum::<f64>() / outcomes.len() as f64;
        let flow = mean(|outcome| outcome.flow);
        let ok = outcomes.iter().filter(|outcome| outcome.is_ok()).count();
        let given_up: u32 = outcomes.iter().map(|outcome| outcome.given_up).sum();
        let peer = self.peers.get(problem.name).map_or("none".to_owned(), |flow| format!("{flow:.3}"));
        println!(
            "{:16} {:>6} {flow:>7.3} {:>7.3} {peer:>7} {:>6.0} {given_up:>8} {:>8.2} {:>8.2}",
            problem.name,
            outcomes.first().map_or(0, |outcome| outcome.robots),
            outcomes.iter().map(|outcome| outcome.flow).fold(0.0, f64::max),
            100.0 * ok as f64 / outcomes.len() as f64,
            mean(|outcome| outcome.touches),
            mean(|outcome| outcome.step_us),
        );
        self.flows.push(flow);
        self.trials += outcomes.len();
        self.ok += ok;
        self.given_up += given_up;
        let Some(csv) = &mut self.csv else { return Ok(()) };
        for outcome in outcomes {
            csv.serialize(line(problem, outcome)).map_err(Failure::storage)?;
        }
        csv.flush().map_err(Failure::storage)
    }

    /// Prints the summary line.
    pub(super) fn finish(self) {
        let logs = self.flows.iter().map(|flow| flow.ln()).sum::<f64>();
        let mean = (logs / self.flows.len() as f64).exp();
        let ok = 100.0 * self.ok as f64 / self.trials as f64;
        println!(
            "{:16} {:>6} {mean:>7.3} {:>7} {:>7} {ok:>6.1} {:>8}   geometric mean of {} problems, {} trials, \
             {:.0} s",
            "all",
            "",
            "",
            "",
            self.given_up,
            self.flows.len(),
            self.trials,
            self.start.elapsed().as_secs_f64()
        );
    }
}

/// The least flow among the other methods that were ok in all trials of a problem, by problem.
fn best_peers() -> Result<BTreeMap<String, f64>, csv::Error> {
    #[derive(Deserialize)]
    struct Peer {
        problem: String,
        flow: f64,
        ok_percent: f64,
    }
    let mut best = BTreeMap::new();
    for peer in csv::Reader::from_reader(include_bytes!("../../peers/peers.csv").as_slice()).deserialize() {
        let Peer { problem, flow, ok_percent } = peer?;
        if ok_percent >= 100.0 {
            let least = best.entry(problem).or_insert(flow);
            *least = flow.min(*least);
        }
    }
    Ok(best)
}

fn line<'o>(problem: &Problem, outcome: &'o Outcome) -> Line<'o> {
    Line {
        problem: problem.name,
        seed: outcome.seed,
        robots: outcome.robots,
        arrived: outcome.arrived,
        flow: outcome.flow,
        ok: outcome.is_ok(),
        given_up: outcome.given_up,
        touches: outcome.touches,
        deepest_mm: 1000.0 * outcome.deepest_m,
        step_us: outcome.step_us,
        time_s: outcome.time_s,
        limit_s: outcome.limit_s,
        failure: outcome.failure.as_deref().unwrap_or_default(),
    }
}

/// Prints why a trial is not ok; prints nothing if it is ok.
pub(super) fn explain(outcome: &Outcome) {
    if outcome.is_ok() {
        return;
    }
    let Outcome { seed, arrived, robots, time_s, limit_s, .. } = outcome;
    println!("  seed {seed}: {arrived} of {robots} arrived; over at {time_s:.1} s of {limit_s:.1} s");
    if let Some(reason) = &outcome.failure {
        println!("    broke off: {reason}");
    }
    if outcome.overlapped {
        println!("    bodies overlapped by {:.1} mm", 1000.0 * outcome.deepest_m);
    }
    for late in &outcome.late {
        let Late { robot, at, goal, delay, stalled_s, .. } = late;
        let waits_for = delay.waits_for.map(|id| format!(" robot {id}")).unwrap_or_default();
        let left = libm::hypot(goal[0] - f64::from(at[0]), goal[1] - f64::from(at[1]));
        let gave_up = late.gave_up_s.map(|time| format!(", gave up at {time:.1} s")).unwrap_or_default();
        println!(
            "    robot {robot}: at ({:.2}, {:.2}), goal ({:.2}, {:.2}), {left:.2} m away: {}{waits_for}, not \
             nearer for {stalled_s:.1} s{gave_up}",
            at[0],
            at[1],
            goal[0],
            goal[1],
            delay.cause.name()
        );
    }
}
