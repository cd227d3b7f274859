//! The exports. The page writes an argument into a [`room`], calls a function with its length in bytes, and
//! reads as many bytes as the function returned from where [`reply`] points. Arguments and replies are JSON
//! in UTF-8, but for those of [`segment`]. A failure is `{"error": "..."}`. A panic is a failure; the trial
//! that panicked is over.

#![expect(unsafe_code, reason = "exports of WebAssembly have names of their own")]

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::trial::{Trial, Wanted};
use crate::{Failure, check::check as checked, compare::compare as compared, policies as offered};

/// What the page and this module pass to each other.
#[derive(Default)]
struct Desk {
    argument: Vec<u8>,
    reply: Vec<u8>,
    trial: Option<Trial>,
    /// Bytes of a finished trial's recording that nobody has fetched.
    rest: Vec<u8>,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

/// Room for the argument of the next call, of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| {
        desk.argument = vec![0; bytes];
        desk.argument.as_mut_ptr()
    })
}

/// Where the reply of the last call begins.
#[unsafe(no_mangle)]
pub extern "C" fn reply() -> *const u8 {
    DESK.with_borrow(|desk| desk.reply.as_ptr())
}

/// Checks a scenario: its mistakes, its warnings, and what it is about.
#[unsafe(no_mangle)]
pub extern "C" fn check(_bytes: usize) -> usize {
    respond(|desk| Ok(checked(&argument(desk)?)))
}

/// The policies that there are.
#[unsafe(no_mangle)]
pub extern "C" fn policies(_bytes: usize) -> usize {
    respond(|_| Ok(offered()))
}

/// Begins a trial. One that was not finished is given up.
#[unsafe(no_mangle)]
pub extern "C" fn begin(_bytes: usize) -> usize {
    respond(|desk| {
        (desk.trial, desk.rest) = (None, Vec::new());
        let (trial, begun) = Trial::begin(&argument::<Wanted>(desk)?)?;
        desk.trial = Some(trial);
        Ok(begun)
    })
}

/// Does so many steps.
#[unsafe(no_mangle)]
pub extern "C" fn advance(_bytes: usize) -> usize {
    respond(|desk| {
        let steps = argument(desk)?;
        running(desk)?.advance(steps)
    })
}

/// Answers the question that an advance returned.
#[unsafe(no_mangle)]
pub extern "C" fn answer(_bytes: usize) -> usize {
    respond(|desk| {
        let text = String::from_utf8(std::mem::take(&mut desk.argument)).map_err(Failure::of)?;
        running(desk)?.answer(&text)
    })
}

/// What can be seen of the trial now.
#[unsafe(no_mangle)]
pub extern "C" fn frame(_bytes: usize) -> usize {
    respond(|desk| Ok(running(desk)?.sight()))
}

/// The bytes of the recording since the last call, as they are.
#[unsafe(no_mangle)]
pub extern "C" fn segment(_bytes: usize) -> usize {
    DESK.with_borrow_mut(|desk| {
        desk.reply = desk.trial.as_mut().map_or_else(|| std::mem::take(&mut desk.rest), Trial::segment);
        desk.reply.len()
    })
}

/// Ends the trial: its record, as `usar run --json` prints it.
#[unsafe(no_mangle)]
pub extern "C" fn finish(_bytes: usize) -> usize {
    reply_with(|desk| {
        let finished = desk.trial.take().ok_or_else(no_trial)?.finish()?;
        let line = finished.line()?;
        desk.rest = finished.bytes;
        Ok(line.into_bytes())
    })
}

/// Compares two policies over pairs of trials.
#[unsafe(no_mangle)]
pub extern "C" fn compare(_bytes: usize) -> usize {
    respond(|desk| compared(argument(desk)?))
}

fn no_trial() -> Failure {
    Failure::of("no trial is running")
}

fn running(desk: &mut Desk) -> Result<&mut Trial, Failure> {
    desk.trial.as_mut().ok_or_else(no_trial)
}

/// The argument of a call.
fn argument<T: DeserializeOwned>(desk: &mut Desk) -> Result<T, Failure> {
    let bytes = std::mem::take(&mut desk.argument);
    serde_json::from_slice(&bytes).map_err(|error| Failure::of(format!("the argument does not fit: {error}")))
}

/// Answers a call with JSON; returns the length of the reply.
fn respond<T: Serialize>(call: impl FnOnce(&mut Desk) -> Result<T, Failure>) -> usize {
    reply_with(|desk| serde_json::to_vec(&call(desk)?).map_err(Failure::of))
}

/// Answers a call with bytes, or with its failure as JSON; returns the length of the reply.
fn reply_with(call: impl FnOnce(&mut Desk) -> Result<Vec<u8>, Failure>) -> usize {
    DESK.with_borrow_mut(|desk| {
        let result = catch_unwind(AssertUnwindSafe(|| call(desk))).unwrap_or_else(|panic| {
            desk.trial = None;
            Err(Failure::of(format!("internal error: {}", message(&*panic))))
        });
        desk.reply = result.unwrap_or_else(|failure| serde_json::to_vec(&failure).unwrap_or_default());
        desk.reply.len()
    })
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a defect without a message")
}
