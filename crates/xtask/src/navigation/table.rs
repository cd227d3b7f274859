//! The results of trials as a printed table.

use std::collections::BTreeMap;
use std::time::Instant;

use experiments::Failure;
use serde::Deserialize;

use super::problems::Problem;
use super::trial::Outcome;

/// A table that prints the line of each problem as soon as its trials have ended.
pub(super) struct Table {
    /// The least flow of another method that was ok in all trials, by problem.
    peers: BTreeMap<String, f64>,
    start: Instant,
    flows: Vec<f64>,
    trials: usize,
    ok: usize,
    given_up: u32,
}

impl Table {
    /// Prints the header.
    pub(super) fn new() -> Result<Self, Failure> {
        println!(
            "{:16} {:>6} {:>7} {:>7} {:>7} {:>6} {:>8} {:>8} {:>8}",
            "problem", "robots", "flow", "worst", "peer", "ok %", "given up", "touches", "us/step"
        );
        let peers = best_peers().map_err(|error| Failure::input(format!("peers.csv: {error}")))?;
        Ok(Self { peers, start: Instant::now(), flows: Vec::new(), trials: 0, ok: 0, given_up: 0 })
    }

    /// Prints the line of a problem.
    pub(super) fn add(&mut self, problem: &Problem, outcomes: &[Outcome]) {
        let mean = |of: fn(&Outcome) -> f64| outcomes.iter().map(of).sum::<f64>() / outcomes.len() as f64;
        let flow = mean(|outcome| outcome.flow);
        let ok = outcomes.iter().filter(|outcome| outcome.is_ok()).count();
        let given_up: u32 = outcomes.iter().map(|outcome| outcome.given_up).sum();
        let peer = self.peers.get(&problem.name).map_or("none".to_owned(), |flow| format!("{flow:.3}"));
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
