//! `usar bench`: how far policies are from the optimum of problems of task allocation.

mod problems;
mod summary;

use std::time::{Duration, Instant};

use experiments::experiment::{PolicySpec, Program, split_list};
use experiments::files::NewFile;
use mrta::{Problem, cbba, dispatch, earliest, optimum};
use rayon::prelude::*;
use teaming::{Asked, Decision, PolicyError, Session, TrialStart};

use summary::{Method, Solved};
use usar::arguments::{ProgressArguments, ReplaceArgument, ShownArguments, count, one_seed, parse_policy};
use usar::output::check_folder;
use usar::prelude::*;

/// How far is each policy from the optimum of a benchmark?
#[derive(Debug, Args)]
#[command(after_help = "\
Robots with skills, tasks that need groups with certain skills for some time, ways, and an order: how much \
longer does a schedule take than the shortest one? A problem is a JSON file of MRTA-Benchmark: Q (skills \
of robots), R (skills that tasks require), T_e (how long tasks take), task_locations, \
precedence_constraints and, if ways take other times than their lengths, T_t. It may also be a config.json \
of HeteroMRTA: setup, tasks, and robots that begin and end at their own places. A folder stands for all of \
its .json files and for the config.json of its subfolders; a config.json has the name of its folder.

Problems of at most 10 tasks and 4 robots are solved exactly. Gaps are in percent of the optimum, or of \
the best schedule found where a problem is larger. A policy is asked whenever a robot becomes free, over \
the tasks that are left. Two methods plan without being asked: EARLIEST takes the task that can start the \
earliest, again and again; CBBA is the auction with bundles of sequences. studies/bench/docs/bench.md has \
the rules.

--out gets makespans.csv, the problems that were made (problems/), and by what program (program.json).

Examples:
  usar bench --generate 1000 --seed 1
  usar bench --generate 100 --policies 'DIS,GREEDY(quality: 0),RNE' --out results/bench
  usar bench 1p_000000.json --policies OPTIMAL --json
  usar bench MRTA-Benchmark/problems --limit 100 --format csv
  usar bench HeteroMRTA/RALTestSet --policies DIS,GREEDY,RNE")]
pub(crate) struct Arguments {
    /// Problem (JSON), or a folder of problems
    #[arg(value_name = "FILE|DIR", required_unless_present = "generate", conflicts_with = "generate")]
    file: Option<PathBuf>,
    /// Make so many problems of the published form: 8 tasks, 3 robots and 3 skills
    #[arg(long, value_name = "N", value_parser = count(1..=1_000_000))]
    generate: Option<u32>,
    /// Seed of the trial, or of what is generated [default: 1]
    #[arg(long, value_parser = one_seed, conflicts_with = "file")]
    seed: Option<u64>,
    /// Policies, separated by commas, by their labels or with their options in brackets, and with an
    /// estimator after `<-` [default: all that answer without levels of energy and HP]
    #[arg(long)]
    policies: Option<String>,
    /// Most assignments of a decision to play, or problems to solve [default: all]
    #[arg(long, value_name = "N", value_parser = count(1..=1_000_000))]
    limit: Option<u32>,
    /// File or folder to write [default: none]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgument,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

/// Policies where none are named.
const POLICIES: &str = "RANDOM,DIS,OPTIMAL,GREEDY,GRAPE,SNAKE,BALANCE,SIMILAR,KMEANS,SPECTRAL,RNE";

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let listed = self.policies.as_deref().unwrap_or(POLICIES);
        let policies = split_list(listed).into_iter().map(|text| parse_policy("--policies", text, registry));
        let policies = policies.collect::<Result<Vec<PolicySpec>, Failure>>()?;
        if let Some(policy) = policies.iter().find(|policy| !policy.is_of_question()) {
            refuse!("--policies: {} plays the trial that asks; here is no trial", policy.label);
        }
        let problems = self.problems()?;
        if let Some(place) = &self.out {
            check_folder(place, self.replace.force)?;
        }
        let solved = self.progress.work(problems.len(), "problems", |bar| {
            let solve = |problem: &Problem| {
                let solved = solved(problem, &policies);
                bar.inc(1);
                solved
            };
            problems.par_iter().map(solve).collect::<Result<Vec<Solved>, Failure>>()
        })??;
        if let Some(place) = &self.out {
            self.write(place, &problems, &solved, &policies)?;
        }
        Ok(summary::told(&solved))
    }

    fn problems(&self) -> Result<Vec<Problem>, Failure> {
        let limit = self.limit.map_or(usize::MAX, |limit| limit as usize);
        match (&self.file, self.generate) {
            (Some(path), _) => problems::read(path, limit),
            (None, count) => {
                let seed = self.seed.unwrap_or(1);
                Ok(problems::generated(count.unwrap_or(0), seed).take(limit).collect())
            }
        }
    }

    fn write(
        &self,
        place: &Path,
        problems: &[Problem],
        solved: &[Solved],
        policies: &[PolicySpec],
    ) -> Result<(), Failure> {
        make_folder(place, self.replace.force)?;
        let program = Program::running(policies)?.digest().to_string();
        let program = serde_json::json!({"program": program, "study": mrta::STUDY});
        NewFile::write(place, "program.json", format!("{program:#}\n").as_bytes())?;
        NewFile::write(place, "makespans.csv", summary::csv(solved)?.as_bytes())?;
        if self.generate.is_some() {
            let folder = place.join("problems");
            std::fs::create_dir_all(&folder)?;
            // Made problems have one start and one end, which can be written.
            for (problem, text) in problems.iter().filter_map(|of| Some((of, mrta::write(of)?))) {
                NewFile::write(&folder, &format!("{}.json", problem.name), text.as_bytes())?;
            }
        }
        Ok(())
    }
}

/// A problem by all methods.
fn solved(problem: &Problem, policies: &[PolicySpec]) -> Result<Solved, Failure> {
    if is_stopped() {
        return Err(Failure::Interrupted("stopped; nothing was written".to_owned()));
    }
    let plan = |label: &str, makespan| Method {
        label: label.to_owned(),
        makespan,
        decisions: 0,
        time: Duration::ZERO,
    };
    let mut methods = vec![plan("EARLIEST", earliest(problem)), plan("CBBA", cbba(problem))];
    for policy in policies {
        let failed = |error: &dyn std::fmt::Display| {
            Failure::input(format!("{}: policy {}: {error}", problem.name, policy.label))
        };
        let session = policy.made().open().map_err(|error| failed(&error))?;
        let mut timed = Timed { session, decisions: 0, time: Duration::ZERO };
        let makespan = dispatch(problem, &mut timed).map_err(|error| failed(&error))?;
        let (label, decisions, time) = (policy.label.clone(), timed.decisions, timed.time);
        methods.push(Method { label, makespan, decisions, time });
    }
    Ok(Solved { problem: problem.name.clone(), optimum: optimum(problem), methods })
}

/// A session, with the time that it takes.
struct Timed {
    session: Box<dyn Session>,
    decisions: u32,
    time: Duration,
}

impl Session for Timed {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.session.reset(trial)
    }

    #[expect(
        clippy::disallowed_methods,
        reason = "the time that a policy takes is printed; no number depends on it"
    )]
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        let begun = Instant::now();
        let decision = self.session.decide(asked);
        (self.decisions, self.time) = (self.decisions + 1, self.time + begun.elapsed());
        decision
    }
}
