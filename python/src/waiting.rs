//! Work without the lock of the interpreter, which Ctrl-C ends.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use experiments::panic_message;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often signals are looked at.
const PERIOD: Duration = Duration::from_millis(50);

/// Does work on a thread of its own, while this one looks for signals and calls `tick`. What either raises
/// sets `stop`; the work should end soon after.
pub fn wait_for<T: Send>(
    py: Python<'_>,
    stop: &AtomicBool,
    mut tick: impl FnMut(Python<'_>) -> PyResult<()> + Send,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    py.detach(|| {
        std::thread::scope(|scope| {
            let (ended, end) = channel::<()>();
            let worker = scope.spawn(move || {
                let _ended = ended; // dropped when the work is done, or panics
                catch_unwind(AssertUnwindSafe(work))
            });
            let mut raised = None;
            while raised.is_none() && end.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
                raised = Python::attach(|py| py.check_signals().and_then(|()| tick(py))).err();
            }
            if raised.is_some() {
                stop.store(true, Ordering::Relaxed);
            }
            let done = worker.join().and_then(|done| done);
            let panicked = |panic: Box<dyn std::any::Any + Send>| {
                PyRuntimeError::new_err(format!("internal error: {}", panic_message(&*panic)))
            };
            raised.map_or_else(|| done.map_err(panicked), Err)
        })
    })
}
