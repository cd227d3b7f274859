//! Trials on threads. A trial that fails, panics or takes too long gives one failed outcome, and the others
//! continue.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use store::Failure;

use super::sessions::Sessions;
use super::trial::{Fault, FaultKind, HALTED, Outcome, Trial, TrialKey, UNANSWERED};
use crate::panics::panic_message;

/// How often the time limit and `stop` are checked, at least.
const WATCH_PERIOD: Duration = Duration::from_millis(100);

/// How often a shorter time limit is checked, at most.
const LEAST_WATCH_PERIOD: Duration = Duration::from_millis(1);

/// A longer time between two looks is one in which this process slept.
const LONGEST_LOOK: Duration = Duration::from_secs(5);

/// How long a trial that exceeded its time may take to give up, before its thread is abandoned.
const GRACE: Duration = Duration::from_secs(1);

/// The reason of a trial whose thread is abandoned.
const UNSTOPPED: &str = "it did not stop when it was told to";

/// A function that runs a trial with the sessions of its thread; it should end soon after the flag is set.
pub type Run = dyn Fn(&TrialKey, &mut Sessions, &AtomicBool) -> Result<Trial, Fault> + Send + Sync;

/// Bounds of a run.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Number of threads.
    pub jobs: usize,
    /// Longest time of one trial.
    pub trial: Option<Duration>,
}

enum Message {
    /// A worker began a trial. The flags tell it to end the trial, and not to take another.
    Started(usize, TrialKey, [Arc<AtomicBool>; 2]),
    Ended(usize, Box<Outcome>),
}

struct Running {
    key: TrialKey,
    since: Instant,
    /// When it was told to halt.
    halted: Option<Instant>,
    halt: Arc<AtomicBool>,
    is_abandoned: Arc<AtomicBool>,
}

/// Trials that have not been started.
type Queue = Box<dyn Iterator<Item = TrialKey> + Send>;

struct Pool {
    queue: Arc<Mutex<Queue>>,
    run: Arc<Run>,
    sender: Sender<Message>,
    workers: usize,
    threads: Vec<JoinHandle<()>>,
    running: BTreeMap<usize, Running>,
    /// When the time of the trials was looked at last.
    looked: Instant,
}

/// Runs all trials and hands each outcome to `done` as it arrives, in any order. A trial that exceeds the
/// time limit is told to halt, and its thread goes on with the next trial. If a policy does not even look at
/// its deadline, the thread is abandoned, and another one takes its place. Returns false if `stop`
/// interrupted the run.
///
/// # Errors
/// The threads cannot be started; or the errors of `done`, after which no further trial is started.
pub fn run_all(
    keys: Vec<TrialKey>,
    limits: Limits,
    run: Arc<Run>,
    stop: &AtomicBool,
    mut done: impl FnMut(Outcome) -> Result<(), Failure>,
) -> Result<bool, Failure> {
    run_batches(keys.into_iter(), limits, run, stop, |outcomes| outcomes.into_iter().try_for_each(&mut done))
}

/// The same as [`run_all`], but outcomes that arrive at the same time are handed over together.
///
/// # Errors
/// Those of [`run_all`].
pub fn run_batches(
    keys: impl ExactSizeIterator<Item = TrialKey> + Send + 'static,
    limits: Limits,
    run: Arc<Run>,
    stop: &AtomicBool,
    mut done: impl FnMut(Vec<Outcome>) -> Result<(), Failure>,
) -> Result<bool, Failure> {
    let mut left = keys.len();
    let (sender, receiver) = channel();
    let queue = Arc::new(Mutex::new(Box::new(keys) as Queue));
    let (threads, running, looked) = (Vec::new(), BTreeMap::new(), Instant::now());
    let mut pool = Pool { queue, run, sender, workers: 0, threads, running, looked };
    for _ in 0..limits.jobs.min(left) {
        pool.start_worker()?;
    }
    while left > 0 {
        let outcomes = pool.next_outcomes(&receiver, limits.trial, stop)?;
        left -= outcomes.len();
        if !outcomes.is_empty()
            && let Err(failure) = done(outcomes)
        {
            pool.halt();
            pool.join();
            return Err(failure);
        }
        if stop.load(Ordering::Relaxed) && left > 0 {
            pool.halt();
            pool.join();
            return Ok(false);
        }
    }
    pool.join();
    Ok(true)
}

impl Pool {
    fn start_worker(&mut self) -> Result<(), Failure> {
        let number = self.workers;
        self.workers += 1;
        let (queue, run, sender) = (Arc::clone(&self.queue), Arc::clone(&self.run), self.sender.clone());
        let work = move || {
            let mut sessions = Sessions::default();
            loop {
                let next = queue.lock().ok().and_then(|mut queue| queue.next());
                let Some(key) = next else { return };
                let [halt, is_abandoned] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
                let flags = [&halt, &is_abandoned].map(Arc::clone);
                if sender.send(Message::Started(number, key.clone(), flags)).is_err() {
                    return;
                }
                let trial = AssertUnwindSafe(|| run(&key, &mut sessions, &halt));
                let result = catch_unwind(trial).unwrap_or_else(|panic| {
                    let reason = format!("internal error: {}", panic_message(&*panic));
                    Err(Fault { kind: FaultKind::Panicked, reason })
                });
                let failed = result.is_err().then_some(key.policy);
                let ended = Message::Ended(number, Box::new(Outcome { key, result }));
                if sender.send(ended).is_err() || is_abandoned.load(Ordering::Relaxed) {
                    return;
                }
                // Whatever a failed session was doing, another one begins.
                let close = AssertUnwindSafe(|| failed.into_iter().for_each(|policy| sessions.close(policy)));
                if catch_unwind(close).is_err() {
                    sessions = Sessions::default();
                }
            }
        };
        let started = std::thread::Builder::new().name(format!("trials-{number}")).spawn(work);
        self.threads.push(started.map_err(|error| Failure::run(format!("cannot start a thread: {error}")))?);
        Ok(())
    }

    /// Waits for the threads to end, with all their sessions; not for long, because a thread that does not
    /// look at its flag may never end.
    fn join(&mut self) {
        let end = Instant::now() + GRACE;
        for thread in self.threads.drain(..) {
            while !thread.is_finished() && Instant::now() < end {
                std::thread::sleep(Duration::from_millis(1));
            }
            if thread.is_finished() {
                let _ = thread.join(); // a panic was reported as the outcome of its trial
            }
        }
    }

    /// The outcomes that arrived since the last call, including trials that exceeded the time limit.
    fn next_outcomes(
        &mut self,
        receiver: &Receiver<Message>,
        longest: Option<Duration>,
        stop: &AtomicBool,
    ) -> Result<Vec<Outcome>, Failure> {
        let mut outcomes = Vec::new();
        // All messages are read before any trial is declared late.
        let period = longest.map_or(WATCH_PERIOD, |longest| longest.clamp(LEAST_WATCH_PERIOD, WATCH_PERIOD));
        let first = receiver.recv_timeout(period).ok();
        self.forgive_sleep();
        for message in first.into_iter().chain(receiver.try_iter()) {
            match message {
                Message::Started(worker, key, [halt, is_abandoned]) => {
                    let since = Instant::now();
                    self.running.insert(worker, Running { key, since, halted: None, halt, is_abandoned });
                }
                // The outcome of an abandoned worker is dropped, as is that of a trial that was stopped with
                // the run.
                Message::Ended(worker, outcome) => {
                    if stop.load(Ordering::Relaxed) && is_halted(&outcome) {
                        continue;
                    }
                    let ended = self.running.remove(&worker).map(|_| ended(*outcome, longest));
                    outcomes.extend(ended);
                }
            }
        }
        let Some(longest) = longest else { return Ok(outcomes) };
        for running in self.running.values_mut().filter(|running| running.since.elapsed() > longest) {
            running.halt.store(true, Ordering::Relaxed);
            running.halted.get_or_insert_with(Instant::now);
        }
        let lost = |running: &Running| running.halted.is_some_and(|halted| halted.elapsed() > GRACE);
        let lost: Vec<usize> =
            self.running.iter().filter(|(_, running)| lost(running)).map(|(worker, _)| *worker).collect();
        for worker in lost {
            let Some(Running { key, is_abandoned, .. }) = self.running.remove(&worker) else { continue };
            is_abandoned.store(true, Ordering::Relaxed);
            self.start_worker()?;
            outcomes.push(Outcome { key, result: Err(timed_out(longest, UNSTOPPED)) });
        }
        Ok(outcomes)
    }

    /// Leaves out of the times of the trials what this process slept, as it does after a SIGSTOP.
    fn forgive_sleep(&mut self) {
        let slept = self.looked.elapsed().saturating_sub(LONGEST_LOOK);
        self.running.values_mut().for_each(|running| running.since += slept);
        self.looked = Instant::now();
    }

    /// Starts no further trial, and tells the running trials to end soon.
    fn halt(&self) {
        if let Ok(mut queue) = self.queue.lock() {
            *queue = Box::new(std::iter::empty());
        }
        self.running.values().for_each(|running| running.halt.store(true, Ordering::Relaxed));
    }
}

/// Whether a trial ended because it was told to.
fn is_halted(outcome: &Outcome) -> bool {
    outcome.result.as_ref().is_err_and(|fault| [HALTED, UNANSWERED].contains(&fault.reason.as_str()))
}

/// The outcome of a trial that may have been told to halt because it was late.
fn ended(outcome: Outcome, longest: Option<Duration>) -> Outcome {
    match (&outcome.result, longest) {
        // A policy may have a limit of its own, and says so.
        (Err(fault), Some(longest)) if is_halted(&outcome) => {
            let result = Err(timed_out(longest, &fault.reason));
            Outcome { result, ..outcome }
        }
        _ => outcome,
    }
}

fn timed_out(longest: Duration, reason: &str) -> Fault {
    let is_told = [UNANSWERED, UNSTOPPED].contains(&reason);
    let and = if is_told { format!(": {reason}") } else { String::new() };
    let reason = format!("it took longer than {} s{and}", longest.as_secs_f64());
    Fault { kind: FaultKind::TimedOut, reason }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use scenario::Scenario;
    use teaming::{Asked, Decision, PolicyError, Session};

    use super::super::trial::{TrialSetup, run_trial};
    use super::*;

    fn keys_for(trials: u32) -> Vec<TrialKey> {
        let key =
            |i: u32| TrialKey { case: 0, policy: 0, trial: i + 1, seed: u64::from(i), label: "FAKE".into() };
        (0..trials).map(key).collect()
    }

    fn failed(reason: String) -> Result<Trial, Fault> {
        Err(Fault { kind: FaultKind::Failed, reason })
    }

    fn reasons(run: Arc<Run>, limits: Limits) -> Vec<String> {
        let mut outcomes = Vec::new();
        let all = run_all(keys_for(5), limits, run, &AtomicBool::new(false), |outcome| {
            outcomes.push(outcome);
            Ok(())
        });
        assert!(all.unwrap());
        outcomes.sort_by_key(|outcome| outcome.key.trial);
        outcomes.iter().filter_map(Outcome::failure).collect()
    }

    #[test]
    fn a_trial_that_panics_fails_alone() {
        let run = |key: &TrialKey, _: &mut Sessions, _: &AtomicBool| {
            assert!(key.seed != 2, "seed two");
            failed(format!("fake {}", key.seed))
        };
        let reasons = reasons(Arc::new(run), Limits { jobs: 2, trial: None });
        assert_eq!(reasons.len(), 5);
        assert_eq!(reasons[1], "trial 2 of FAKE (seed 1) failed: fake 1");
        assert_eq!(reasons[2], "trial 3 of FAKE (seed 2) panicked: internal error: seed two");
    }

    #[test]
    fn a_trial_that_never_ends_is_given_up_and_the_others_go_on() {
        let run = |key: &TrialKey, _: &mut Sessions, _: &AtomicBool| {
            if key.seed == 1 {
                std::thread::sleep(Duration::from_hours(1)); // it does not even look at the flag
            }
            failed("done".to_owned())
        };
        let limits = Limits { jobs: 1, trial: Some(Duration::from_millis(300)) };
        let reasons = reasons(Arc::new(run), limits);
        assert_eq!(reasons.len(), 5);
        assert_eq!(
            reasons[1],
            "trial 2 of FAKE (seed 1) timed out: it took longer than 0.3 s: it did not stop when it was told \
             to"
        );
        assert_eq!(reasons[4], "trial 5 of FAKE (seed 4) failed: done");
    }

    #[test]
    fn a_policy_that_looks_at_its_deadline_is_cut_off_and_its_thread_goes_on() {
        struct Ponders;
        impl Session for Ponders {
            fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
                while !asked.deadline.is_over() {
                    std::thread::sleep(Duration::from_millis(5));
                }
                Err(PolicyError::Late)
            }
        }
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let scenario = Scenario::load(&path).unwrap().0;
        let threads: Arc<Mutex<Vec<_>>> = Arc::default();
        let seen = Arc::clone(&threads);
        let run = move |key: &TrialKey, _: &mut Sessions, halt: &AtomicBool| {
            seen.lock().unwrap().push(std::thread::current().id());
            let setup = TrialSetup { scenario: &scenario, seed: key.seed, is_checked: false };
            if key.seed == 1 { run_trial(&setup, &mut Ponders, halt) } else { failed("done".to_owned()) }
        };
        let limits = Limits { jobs: 1, trial: Some(Duration::from_millis(300)) };
        let reasons = reasons(Arc::new(run), limits);
        let late = "timed out: it took longer than 0.3 s: its policy did not answer in time";
        assert_eq!(reasons[1], format!("trial 2 of FAKE (seed 1) {late}"));
        let threads = threads.lock().unwrap();
        assert!(threads.len() == 5 && threads.iter().all(|thread| *thread == threads[0]), "{threads:?}");
    }

    #[test]
    fn no_further_trial_starts_when_it_is_to_stop_or_an_outcome_cannot_be_kept() {
        let run: Arc<Run> = Arc::new(|_: &TrialKey, _: &mut Sessions, _: &AtomicBool| {
            std::thread::sleep(Duration::from_millis(2));
            failed("done".to_owned())
        });
        let limits = Limits { jobs: 1, trial: None };
        let stop = AtomicBool::new(false);
        let mut heard = 0;
        let all = run_all(keys_for(500), limits, Arc::clone(&run), &stop, |_| {
            heard += 1;
            stop.store(true, Ordering::Relaxed);
            Ok(())
        });
        assert!(!all.unwrap() && heard < 100, "{heard}");
        let full =
            run_all(keys_for(500), limits, run, &AtomicBool::new(false), |_| Err(Failure::run("full")));
        assert_eq!(full.unwrap_err().to_string(), "full");
    }
}
