//! Work without the lock of the interpreter, which Ctrl-C ends. Meanwhile the thread that called answers for
//! policies in Python.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, available_parallelism};
use std::time::{Duration, Instant};

use experiments::panic_message;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

/// How often signals are looked at.
const PERIOD: Duration = Duration::from_millis(50);

/// Does work on threads of its own, one for each core at most. They have ended when it returns, because the
/// child of a process that forks has none of its threads.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let cores = available_parallelism().map_or(1, usize::from);
    let mut threads_at_work = Vec::new();
    let builder = ThreadPoolBuilder::new().num_threads(threads.clamp(1, cores)).spawn_handler(|thread| {
        threads_at_work.push(Builder::new().spawn(|| thread.run())?);
        Ok(())
    });
    let pool = builder.build().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let done = catch_unwind(AssertUnwindSafe(|| pool.install(work)));
    drop(pool);
    for thread in threads_at_work {
        let _ = thread.join(); // a panic of the work is in `done`
    }
    Ok(done.unwrap_or_else(|panic| resume_unwind(panic)))
}

/// Something that the thread that called does for a thread at work.
type Job = Box<dyn FnOnce(Python<'_>) + Send>;

/// The thread that called, as threads at work reach it. `None` tells it that the work is done.
#[derive(Clone)]
pub struct Caller(Sender<Option<Job>>);

impl Caller {
    /// What this gives on the thread that called: there, Ctrl-C raises an exception in the midst of it.
    /// `None` once the call is ending.
    pub fn ask<T: Send + 'static>(
        &self,
        job: impl FnOnce(Python<'_>) -> PyResult<T> + Send + 'static,
    ) -> Option<PyResult<T>> {
        let (answer, answered) = channel();
        let answering = move |py: Python<'_>| {
            let _ = answer.send(job(py)); // a thread that panicked waits no more
        };
        self.0.send(Some(Box::new(answering))).ok().and_then(|()| answered.recv().ok())
    }
}

/// A call from Python.
pub struct Call {
    /// Ends the work.
    pub stop: Arc<AtomicBool>,
    /// The thread that called.
    pub caller: Caller,
    jobs: Receiver<Option<Job>>,
}

impl Call {
    /// A call that came to this thread.
    pub fn new() -> Self {
        let (caller, jobs) = channel();
        Self { stop: Arc::default(), caller: Caller(caller), jobs }
    }

    /// Does work on a thread of its own, while this one looks for signals, calls `tick` and does what
    /// [`Caller::ask`] brings. What signals and `tick` raise sets `stop`; the work should end soon after.
    pub fn wait_for<T: Send>(
        self,
        py: Python<'_>,
        mut tick: impl FnMut(Python<'_>) -> PyResult<()> + Send,
        work: impl FnOnce() -> T + Send,
    ) -> PyResult<T> {
        let Self { stop, caller: Caller(end), jobs } = self;
        py.detach(move || {
            std::thread::scope(|scope| {
                let worker = scope.spawn(move || {
                    let done = catch_unwind(AssertUnwindSafe(work));
                    let _ = end.send(None); // the thread that called is there until then
                    done
                });
                let (mut raised, mut looked) = (None, Instant::now());
                loop {
                    match jobs.recv_timeout(PERIOD.saturating_sub(looked.elapsed())) {
                        Ok(Some(job)) if raised.is_none() => Python::attach(job),
                        Ok(Some(_)) | Err(RecvTimeoutError::Timeout) => {}
                        Ok(None) | Err(RecvTimeoutError::Disconnected) => break,
                    }
                    if looked.elapsed() >= PERIOD {
                        let look = Python::attach(|py| py.check_signals().and_then(|()| tick(py)));
                        raised = raised.or(look.err());
                        stop.fetch_or(raised.is_some(), Ordering::Relaxed);
                        looked = Instant::now();
                    }
                }
                let done = worker.join().and_then(|done| done);
                let panicked = |panic: Box<dyn std::any::Any + Send>| {
                    PyRuntimeError::new_err(format!("internal error: {}", panic_message(&*panic)))
                };
                raised.map_or_else(|| done.map_err(panicked), Err)
            })
        })
    }
}
