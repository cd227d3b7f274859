//! `EXEC`: a policy, or a protocol of robots, whose sessions are processes of a program.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use teaming::session::each_alone;
use teaming::{
    Act, Asked, Basis, Deadline, Decision, Driver, PolicyError, PolicyKind, Question, Registry,
    RegistryError, Session, TrialStart, Turn,
};

use crate::consent::Consent;
use crate::error::{Complaint, ProgramError};
use crate::files::fingerprint;
use crate::options::{NAME, Options, OptionsError};
use crate::process::{MOST_BYTES, NoLine, Process, Until};
use crate::protocol::{Greeting, Message, Speaks, Trial, acts, decision};

/// What it does.
const ABOUT: &str = "a program in any language answers";

/// What it does for robots that talk.
const ABOUT_TALKS: &str = "a program in any language says what each robot does in its turn";

/// A longer wait for a hello is told.
const NOTICED: Duration = Duration::from_secs(5);

/// So many processes that end by themselves, one after the other, are enough.
const MOST_DEATHS: u32 = 3;

/// How the programs of a command are started and ended.
#[derive(Clone)]
pub struct Launch {
    /// Ends processes and waits when it is set.
    pub stop: Arc<AtomicBool>,
    /// Called before each start of a process, so that a command can set `stop` on signals from then on.
    pub begin: fn(),
    /// The longest time of a trial, which no wait for a line goes beyond.
    pub longest: Option<Duration>,
    /// Which commands may be started.
    pub consent: Consent,
    /// The words that start [`guard`](crate::guard) in a process of its own, before the number of this
    /// process and the words of a program; empty for no guard.
    pub guard: Vec<OsString>,
}

/// Adds `EXEC` to the policies and to the protocols of a registry.
///
/// # Errors
/// The name is taken; the registry has what could be added.
pub fn add_to(registry: &mut Registry, launch: Launch) -> Result<(), RegistryError> {
    let protocol = registry.add_protocol(made(launch.clone(), ABOUT_TALKS, Speaks::Acts));
    registry.add(made(launch, ABOUT, Speaks::Decisions)).and(protocol)
}

fn made(launch: Launch, about: &str, speaks: Speaks) -> PolicyKind {
    PolicyKind::made(NAME, about, move |options: Options, _: &_| {
        options.check()?;
        if options.isolate && speaks == Speaks::Decisions {
            return Err(OptionsError::Isolate);
        }
        let program = Program::new(options, NAME.to_owned(), launch.clone(), speaks);
        Ok::<_, OptionsError>(Arc::new(Handle(Arc::new(program))) as Arc<dyn Driver>)
    })
}

/// The same for readers: each program is a name that stands for itself, and none is ever started.
///
/// # Errors
/// Those of [`add_to`].
pub fn add_names(registry: &mut Registry) -> Result<(), RegistryError> {
    let named = |about: &str| {
        PolicyKind::made(NAME, about, |options: Options, _: &_| {
            options.check()?;
            Ok::<_, OptionsError>(Arc::new(Name(options)) as Arc<dyn Driver>)
        })
    };
    let protocol = registry.add_protocol(named(ABOUT_TALKS));
    registry.add(named(ABOUT)).and(protocol)
}

/// A program that stands for itself.
struct Name(Options);

impl Driver for Name {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Err(PolicyError::Absent { policy: NAME.to_owned() })
    }

    fn basis(&self) -> Basis {
        Basis::Absent
    }

    fn fingerprint(&self) -> Option<String> {
        Some("a program that was not started".to_owned())
    }

    fn program(&self) -> Option<String> {
        Some(self.0.in_words())
    }
}

/// A program, and what is known of it.
struct Program {
    options: Options,
    /// Name of the policy in tables.
    label: String,
    launch: Launch,
    speaks: Speaks,
    /// Number of processes so far.
    started: AtomicU32,
    /// Number of the last trials, in a row, in which a process ended by itself.
    deaths: AtomicU32,
    greeting: OnceLock<Greeting>,
    /// A process that was started for its hello and waits for its first session, or why there is none.
    spare: Mutex<Option<Result<Process, ProgramError>>>,
}

impl Program {
    fn new(options: Options, label: String, launch: Launch, speaks: Speaks) -> Self {
        Self {
            options,
            label,
            launch,
            speaks,
            started: AtomicU32::new(0),
            deaths: AtomicU32::new(0),
            greeting: OnceLock::new(),
            spare: Mutex::new(None),
        }
    }

    /// A process that has said hello.
    fn start(&self) -> Result<Process, ProgramError> {
        (self.launch.begin)();
        let permit = self.launch.consent.permit(&self.options)?;
        let mut process = Process::start(permit, &self.options, &self.launch.guard).map_err(|error| {
            let program = self.options.command.first().cloned().unwrap_or_default();
            match error.kind() {
                std::io::ErrorKind::NotFound => Complaint::NoProgram(program),
                _ => Complaint::NoStart { program, reason: error.to_string() },
            }
        })?;
        let number = self.started.fetch_add(1, Ordering::Relaxed);
        let hello = Message::hello(self.speaks, &self.label, &self.options.options.0, number).line();
        let until = Until { deadline: Deadline::NEVER, stop: &self.launch.stop };
        let (longest, limit) = self.longest(self.options.start(), "start_s");
        let mut line = process.exchange(&hello, longest.min(NOTICED), until);
        if matches!(line, Err(NoLine::Silent)) && longest > NOTICED {
            let (label, seconds) = (&self.label, longest.as_secs_f64());
            self.launch.consent.tell(&format!("waiting up to {seconds} s for the hello of policy {label}"));
            line = process.exchange(&[], longest.saturating_sub(NOTICED), until);
        }
        let line = line.map_err(|no_line| {
            let silent = Complaint::NoHello(longest.as_secs_f64(), limit);
            self.failed(&mut process, no_line, silent)
        })?;
        let greeting = Greeting::read(&line, self.speaks).map_err(|complaint| {
            let last_words = process.last_words();
            ProgramError { line: Some(line), last_words, ..complaint.into() }
        })?;
        let first = self.greeting.get_or_init(|| greeting.clone());
        if *first != greeting {
            let [before, now] = [first, &greeting].map(|hello| format!("{} {}", hello.name, hello.version));
            return Err(Complaint::Changed { before, now }.into());
        }
        Ok(process)
    }

    /// The longest wait for a line, and what limits it.
    fn longest(&self, own: Duration, name: &'static str) -> (Duration, &'static str) {
        match self.launch.longest.filter(|longest| *longest < own) {
            Some(longest) => (longest, "--max-trial-s"),
            None => (own, name),
        }
    }

    /// What a process does that sends no line; it is of no use any more.
    fn failed(&self, process: &mut Process, no_line: NoLine, silent: Complaint) -> ProgramError {
        let complaint = match no_line {
            NoLine::Silent => silent,
            NoLine::Late => Complaint::Stopped,
            NoLine::TooLong => Complaint::LongLine,
            NoLine::Refused(error) => Complaint::Unheard(error.to_string()),
            NoLine::Ended => {
                self.deaths.fetch_add(1, Ordering::Relaxed);
                let end = process.end();
                match process.unended() {
                    Some(line) => Complaint::Unended { end, line },
                    None => Complaint::Ended(end),
                }
            }
        };
        ProgramError { last_words: process.last_words(), ..complaint.into() }
    }

    /// The process that waits for its first session, or else a new one.
    fn process(&self) -> Result<Process, ProgramError> {
        let spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner).take();
        let is_of_use = |spare: &Result<Process, _>| spare.as_ref().map_or(true, |there| !there.is_over());
        spare.filter(is_of_use).unwrap_or_else(|| self.start())
    }

    /// Starts a process for its hello, unless there was one.
    fn greeting(&self) -> Option<&Greeting> {
        if self.greeting.get().is_none() {
            let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
            if self.greeting.get().is_none() && spare.is_none() {
                *spare = Some(self.start());
            }
        }
        self.greeting.get()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let spare = self.spare.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        let spare = spare.and_then(Result::ok).into_iter();
        spare.for_each(|process| process.dismiss(&Message::Bye {}.line(), &self.launch.stop));
    }
}

/// The driver.
struct Handle(Arc<Program>);

impl Driver for Handle {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        if self.0.options.isolate {
            return Ok(Box::new(Isolated {
                program: Arc::clone(&self.0),
                robots: BTreeMap::new(),
                trial: None,
            }));
        }
        Ok(Box::new(ProgramSession::open(&self.0)?))
    }

    fn basis(&self) -> Basis {
        match self.0.greeting() {
            Some(Greeting { is_deterministic: false, .. }) => Basis::Undetermined,
            _ => Basis::Question,
        }
    }

    fn fingerprint(&self) -> Option<String> {
        let Some(greeting) = self.0.greeting() else {
            return Some("a program that does not start".to_owned());
        };
        let fingerprint = fingerprint(&self.0.options, greeting, &self.0.launch.stop);
        Some(fingerprint.unwrap_or_else(|complaint| complaint.to_string()))
    }

    fn program(&self) -> Option<String> {
        Some(self.0.options.in_words())
    }

    fn permission(&self) -> Result<(), PolicyError> {
        let permit = self.0.launch.consent.permit(&self.0.options);
        permit.map(drop).map_err(|complaint| ProgramError::from(complaint).into())
    }

    fn labelled(&self, label: &str) -> Option<Arc<dyn Driver>> {
        let Program { options, launch, speaks, .. } = &*self.0;
        let program = Program::new(options.clone(), label.to_owned(), launch.clone(), *speaks);
        Some(Arc::new(Self(Arc::new(program))))
    }

    fn gave_up(&self) -> Option<String> {
        let is_enough = self.0.deaths.load(Ordering::Relaxed) >= MOST_DEATHS;
        is_enough.then(|| format!("its program ended by itself in {MOST_DEATHS} trials in a row"))
    }
}

/// A process at work.
struct ProgramSession {
    program: Arc<Program>,
    process: Option<Process>,
    /// Seed and scenario of the trial.
    trial: Option<(u64, String)>,
    /// How many trials have begun.
    trials: u64,
    /// Why the process of this trial is no more.
    lost: Option<PolicyError>,
    questions: u64,
}

impl ProgramSession {
    fn open(program: &Arc<Program>) -> Result<Self, PolicyError> {
        let process = Some(program.process()?);
        let program = Arc::clone(program);
        Ok(Self { program, process, trial: None, trials: 0, lost: None, questions: 0 })
    }

    /// Sends a message of this number, and reads the answer.
    fn ask<T>(
        &mut self,
        asked: &Asked<'_>,
        message: impl FnOnce(u64, Option<Trial<'_>>) -> Vec<u8>,
        read: impl FnOnce(&[u8], u64) -> Result<T, Complaint>,
    ) -> Result<T, PolicyError> {
        let Some(mut process) = self.process.take() else {
            return Err(self.lost.clone().unwrap_or(PolicyError::Late));
        };
        self.questions += 1;
        let id = self.questions;
        let trial = self.trial.as_ref().map(|(_, scenario)| Trial { number: self.trials, scenario });
        let line = message(id, trial);
        if line.len() > MOST_BYTES {
            return Err(self.lose(ProgramError::from(Complaint::LongQuestion), asked.question));
        }
        let until = Until { deadline: asked.deadline, stop: &self.program.launch.stop };
        let (longest, limit) = self.program.longest(self.program.options.timeout(), "timeout_s");
        let line = match process.exchange(&line, longest, until) {
            Ok(line) => line,
            Err(NoLine::Late) => {
                self.lost = Some(PolicyError::Late);
                return Err(PolicyError::Late);
            }
            Err(no_line) => {
                let silent = Complaint::Silent(longest.as_secs_f64(), limit);
                let error = self.program.failed(&mut process, no_line, silent);
                return Err(self.lose(error, asked.question));
            }
        };
        let complaint = match read(&line, id) {
            Ok(answer) => {
                self.process = Some(process);
                return Ok(answer);
            }
            Err(complaint) => complaint,
        };
        let last_words = process.last_words();
        let is_in_step =
            matches!(complaint, Complaint::GaveUp(_) | Complaint::Answer { .. } | Complaint::Assignment(_));
        let has_line = !matches!(complaint, Complaint::GaveUp(_));
        let error = ProgramError { line: has_line.then_some(line), last_words, ..complaint.into() };
        if is_in_step {
            self.process = Some(process);
            return Err(ProgramError { round: Some(asked.question.round), ..error }.into());
        }
        Err(self.lose(error, asked.question))
    }

    /// Sends turns, in as few lines as may be.
    fn ask_acts(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        let line = |id: u64, trial: Option<Trial<'_>>| Message::Turns { id, trial, turns }.line();
        if turns.len() > 1 && line(u64::MAX, None).len() > MOST_BYTES / 2 {
            let (first, rest) = turns.split_at(turns.len() / 2);
            let mut acts = self.ask_acts(first, base)?;
            acts.extend(self.ask_acts(rest, base)?);
            return Ok(acts);
        }
        self.ask(base, line, |line, id| acts(line, id, turns.len()))
    }

    /// Notes that a process came to the end of a trial.
    fn end_trial(&mut self) {
        if self.trial.is_some() && self.process.is_some() && self.questions > 0 {
            self.program.deaths.store(0, Ordering::Relaxed);
        }
    }

    /// Notes that the process of this trial is no more.
    fn lose(&mut self, error: ProgramError, question: &Question) -> PolicyError {
        let error = PolicyError::from(ProgramError { round: Some(question.round), ..error });
        self.lost = Some(error.clone());
        error
    }
}

impl Session for ProgramSession {
    fn reset(&mut self, start: &TrialStart<'_>) -> Result<(), PolicyError> {
        let is_same = self
            .trial
            .as_ref()
            .is_some_and(|(number, scenario)| *number == start.number && scenario == start.scenario);
        match (&self.lost, is_same) {
            // What is late is told by the next question.
            (None | Some(PolicyError::Late), true) => return Ok(()),
            (Some(lost), true) => return Err(lost.clone()),
            (_, false) => {}
        }
        self.end_trial();
        self.trial = Some((start.number, start.scenario.to_owned()));
        self.trials += 1;
        if self.process.is_none() {
            self.lost = None;
            self.process = Some(self.program.process().map_err(|error| {
                let error = PolicyError::from(error);
                self.lost = Some(error.clone());
                error
            })?);
        }
        Ok(())
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        if self.program.speaks == Speaks::Acts {
            return Err(PolicyError::NoRule);
        }
        let question = asked.question.sealed();
        self.ask(
            asked,
            |id, trial| Message::Question { id, trial, question: &question }.line(),
            |line, id| decision(line, id, asked.question),
        )
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        if self.program.speaks == Speaks::Decisions {
            return each_alone(self, turns, base);
        }
        let sealed: Vec<Turn> = turns.iter().map(Turn::sealed).collect();
        self.ask_acts(&sealed, base)
    }
}

/// One process for each robot, so that none can know what another was told.
struct Isolated {
    program: Arc<Program>,
    robots: BTreeMap<u32, ProgramSession>,
    trial: Option<(u64, String)>,
}

impl Session for Isolated {
    fn reset(&mut self, start: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.trial = Some((start.number, start.scenario.to_owned()));
        self.robots.values_mut().try_for_each(|robot| robot.reset(start))
    }

    fn decide(&mut self, _: &Asked<'_>) -> Result<Decision, PolicyError> {
        Err(PolicyError::NoRule)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        let mut acts = Vec::new();
        for turn in turns {
            let robot = match self.robots.entry(turn.robot) {
                Entry::Occupied(robot) => robot.into_mut(),
                Entry::Vacant(place) => {
                    let mut robot = ProgramSession::open(&self.program)?;
                    if let Some((number, scenario)) = &self.trial {
                        robot.reset(&TrialStart { scenario, number: *number })?;
                    }
                    place.insert(robot)
                }
            };
            acts.extend(robot.act(std::slice::from_ref(turn), base)?);
        }
        Ok(acts)
    }
}

impl Drop for ProgramSession {
    fn drop(&mut self) {
        self.end_trial();
        let process = self.process.take();
        process
            .into_iter()
            .for_each(|process| process.dismiss(&Message::Bye {}.line(), &self.program.launch.stop));
    }
}
