//! A trial that the page runs, some steps at a time.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

use recording::{Options, Recorder};
use scenario::seed::trial_number;
use serde::{Deserialize, Serialize};
use teaming::{Assignment, Decision, Question, Session, TrialStart};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{Advance, Simulation};

use crate::Failure;
use crate::texts::Texts;

/// The policy that the page itself is: its answers come by [`Trial::answer`].
const MINE: &str = "MINE";

/// What a trial is begun with.
#[derive(Deserialize)]
pub(crate) struct Wanted {
    #[serde(flatten)]
    texts: Texts,
    /// A policy with its options, such as `RNE(score: Sum)`, or `MINE`.
    policy: String,
    /// The seed, as text: JavaScript's numbers do not hold all seeds.
    seed: String,
    #[serde(default)]
    record: bool,
    /// Whether every invariant is checked at every step.
    #[serde(default)]
    check: bool,
}

/// A trial that was begun.
#[derive(Serialize)]
pub(crate) struct Begun {
    duration_s: f64,
    tasks: Vec<String>,
}

/// How far a trial is.
#[derive(Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub(crate) enum Progress {
    Running { time_s: f64 },
    Asks { question: Box<Question> },
    Over { time_s: f64, status: &'static str },
}

/// An answer that was taken.
#[derive(Serialize)]
pub(crate) struct Taken {}

/// What can be seen of a running trial.
#[derive(Serialize)]
pub(crate) struct Sight {
    time_s: f64,
    rescued: Vec<u32>,
    robots: Vec<[f32; 2]>,
}

/// The bytes of a recording, shared with its recorder.
#[derive(Clone, Default)]
struct Bytes(Rc<RefCell<Vec<u8>>>);

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A trial, until it is finished.
pub(crate) struct Trial {
    simulation: Simulation,
    /// None if the page answers.
    session: Option<Box<dyn Session>>,
    recorder: Option<Recorder<Bytes>>,
    bytes: Bytes,
    policy: String,
    /// Why an answer of the page was refused.
    refused: Option<String>,
}

impl Trial {
    pub fn begin(wanted: &Wanted) -> Result<(Self, Begun), Failure> {
        let policy = wanted.policy.trim().to_owned();
        let seed: u64 = wanted.seed.trim().parse().map_err(|_| {
            Failure::of(format!(
                "the seed must be a whole number from 0 to {}, found {:?}",
                u64::MAX,
                wanted.seed
            ))
        })?;
        let scenario = wanted.texts.scenario().map_err(Failure::of)?;
        if !scenario.allows(&policy) {
            let only = &scenario.only_policy;
            return Err(Failure::of(format!(
                "only_policy of the scenario allows {only} alone, found {policy}"
            )));
        }
        let registry = policies::standard();
        let session = if policy == MINE { None } else { Some(registry.open(&policy).map_err(Failure::of)?) };
        let simulation = Simulation::new(&scenario, seed).map_err(Failure::of)?;
        let simulation = if wanted.check { simulation.checked() } else { simulation };
        let bytes = Bytes::default();
        let measure = registry.measure(&policy).ok().or_else(|| registry.a_measure());
        let options = Options::new(&policy, measure);
        let recorder = wanted.record.then(|| Recorder::begin(bytes.clone(), &simulation, &options));
        let recorder = recorder.transpose().map_err(Failure::of)?;
        let begun = Begun {
            duration_s: scenario.duration_s,
            tasks: scenario.tasks.iter().map(|task| task.name.clone()).collect(),
        };
        let mut trial = Self { simulation, session, recorder, bytes, policy, refused: None };
        if let Some(session) = &mut trial.session {
            session
                .reset(&TrialStart { scenario: &scenario.name, number: trial_number(seed) })
                .map_err(Failure::of)?;
        }
        Ok((trial, begun))
    }

    /// Does so many steps, or fewer if the trial asks or is over.
    pub fn advance(&mut self, steps: u32) -> Result<Progress, Failure> {
        for _ in 0..steps {
            if let Some(progress) = self.step()? {
                return Ok(progress);
            }
        }
        Ok(Progress::Running { time_s: self.simulation.time_s() })
    }

    /// Does a step; returns why it could not go on.
    fn step(&mut self) -> Result<Option<Progress>, Failure> {
        let over = |status: &Status, time_s| Some(Progress::Over { time_s, status: status.name() });
        if let Some(reason) = &self.refused {
            return Ok(over(&Status::Failed(reason.clone()), self.simulation.time_s()));
        }
        let status = match &mut self.session {
            Some(session) => self.simulation.step(&mut **session),
            None => match self.simulation.advance() {
                Advance::Running => None,
                Advance::Over(status) => Some(status),
                Advance::Asks(_) => {
                    let question = self.simulation.question().cloned();
                    return Ok(question.map(|question| Progress::Asks { question: Box::new(question) }));
                }
            },
        };
        if let Some(status) = status {
            return Ok(over(&status, self.simulation.time_s()));
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.listen(&self.simulation).map_err(Failure::of)?;
        }
        Ok(None)
    }

    /// Takes the page's answer. A bad one fails the trial.
    pub fn answer(&mut self, text: &str) -> Result<Taken, Failure> {
        let taken = assignment(text).and_then(|assignment| {
            self.simulation.assign(Decision::of(assignment)).map_err(|error| error.to_string())
        });
        taken.map(|()| Taken {}).map_err(|reason| {
            let reason = format!("the policy failed: {reason}");
            self.refused = Some(reason.clone());
            Failure::of(reason)
        })
    }

    pub fn sight(&self) -> Sight {
        let tasks = &self.simulation.metrics().tasks;
        let robots = &self.simulation.world().robots;
        Sight {
            time_s: self.simulation.time_s(),
            rescued: tasks.iter().map(|totals| totals.rescued).collect(),
            robots: robots.iter().map(|robot| [robot.position.x, robot.position.y]).collect(),
        }
    }

    /// The bytes of the recording since the last call.
    pub fn segment(&mut self) -> Vec<u8> {
        self.bytes.0.take()
    }

    /// Ends the trial; returns its record as `usar run --json` prints it, and the last bytes of the
    /// recording.
    pub fn finish(self) -> Result<Finished, Failure> {
        let scenario = self.simulation.scenario().name.clone();
        let mut record = self.simulation.finish();
        if let Some(reason) = self.refused {
            record.status = Status::Failed(reason);
        }
        if let Some(recorder) = self.recorder {
            recorder.finish(&mut record).map_err(Failure::of)?;
        }
        if let Status::Failed(reason) = &record.status {
            let (label, seed) = (self.policy, record.seed);
            return Err(Failure::of(format!("trial of {label} with seed {seed} failed: {reason}")));
        }
        Ok(Finished { scenario, policy: self.policy, record, bytes: self.bytes.0.take() })
    }
}

/// A trial that ran to its end.
pub(crate) struct Finished {
    scenario: String,
    policy: String,
    record: TrialRecord,
    /// The last bytes of the recording.
    pub bytes: Vec<u8>,
}

impl Finished {
    /// Its record as a line of JSON.
    pub fn line(&self) -> Result<String, Failure> {
        serde_json::to_string(&self.record.named(&self.scenario, &self.policy)).map_err(Failure::of)
    }
}

/// The assignment of an answer: groups alone, or with the robots that stay at home.
fn assignment(text: &str) -> Result<Assignment, String> {
    let bad = |error: serde_json::Error| {
        let start: String = text.chars().take(200).collect();
        format!(
            "the answer must be one list of robots' ids for each task, as in [[0, 2], [1, 3]], or \
             {{\"groups\": .., \"idle\": ..}}: {error}; found {start}"
        )
    };
    if text.trim_start().starts_with('[') {
        return serde_json::from_str(text).map(Assignment::new).map_err(bad);
    }
    serde_json::from_str(text).map_err(bad)
}
