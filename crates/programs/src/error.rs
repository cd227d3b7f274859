//! What is wrong with a program, in one sentence for the person who can mend it.

use std::fmt;

use teaming::schema::since;
use teaming::{AssignmentError, PolicyError, SCHEMA_VERSION};
use thiserror::Error;

/// So many bytes of a line are shown.
pub(crate) const SHOWN_BYTES: usize = 200;

/// What a program answers by a protocol, as the end of a sentence.
fn spoken(protocol: u64) -> &'static str {
    match protocol {
        1 => ", in which questions get decisions; a program that speaks 2 stands behind `by`",
        _ => ", in which turns of robots get acts",
    }
}

/// What is meant by a command that is a file of this folder.
fn hint(program: &str) -> String {
    let is_here = std::path::Path::new(program).is_file();
    if is_here {
        format!("; did you mean \"./{program}\", or an interpreter before it?")
    } else {
        String::new()
    }
}

/// What is wrong.
#[derive(Debug, Clone, Error)]
pub(crate) enum Complaint {
    #[error("its command cannot be started: there is no program {0:?}{hint}", hint = hint(.0))]
    NoProgram(String),
    #[error("its command cannot be started: {program:?}: {reason}")]
    NoStart { program: String, reason: String },
    #[error("sources: no file matches {0:?}")]
    NoSource(String),
    #[error("sources: {pattern:?} takes more than {most} {what}")]
    Sources { pattern: String, most: usize, what: &'static str },
    #[error("sources: the files have more than 256 MiB together")]
    LargeSources,
    #[error("it is a program that nobody has allowed: {command}; {hint}")]
    NotAllowed { command: String, hint: &'static str },
    #[error("{path:?}, which decides its answers, cannot be read: {reason}")]
    Unreadable { path: String, reason: String },
    #[error("it sent no hello within {0} s ({1})")]
    NoHello(f64, &'static str),
    #[error("it was told to stop")]
    Stopped,
    #[error("it did not answer within {0} s ({1})")]
    Silent(f64, &'static str),
    #[error("{0}")]
    Ended(End),
    #[error("it cannot be heard: {0}")]
    Unheard(String),
    #[error("it sent a line of more than 16 MiB")]
    LongLine,
    #[error("the question has more than 16 MiB")]
    LongQuestion,
    #[error("it sent an empty line; each line must be a message")]
    EmptyLine,
    #[error("it sent a line that begins with a byte order mark; its output must be UTF-8 without one")]
    Marked,
    #[error("{end} after a line without a line end: {line:?}")]
    Unended { end: End, line: String },
    #[error("it sent a line that is not UTF-8")]
    NotUtf8,
    #[error("it sent a line that is not JSON ({0}); what it prints for people belongs on its standard error")]
    NotJson(String),
    #[error("it sent a line in which {0}")]
    Twice(String),
    #[error("it sent {0}, which is no JSON; leave such a field out, or write null")]
    NotFinite(&'static str),
    #[error("it sent a message whose type is {found}, expected {expected}")]
    Type { found: String, expected: &'static str },
    #[error("its hello speaks protocol {found}; here it must speak protocol {expected}{}", spoken(*expected))]
    Protocol { found: String, expected: u64 },
    #[error("its hello has schema_version {0}; this program has questions of version {SCHEMA_VERSION}{since}",
        since = since(.0))]
    Schema(String),
    #[error("{field} of its hello must be {rule}, found {found}")]
    Hello { field: &'static str, rule: &'static str, found: String },
    #[error("its hello changed while it was running: it was {before}, and is now {now}")]
    Changed { before: String, now: String },
    #[error("it answered question {found}, expected an answer to question {expected}")]
    Id { found: String, expected: u64 },
    #[error("its answer to the {to} cannot be read: {reason}")]
    Answer { to: &'static str, reason: String },
    #[error("its decision does not answer the question: {0}")]
    Assignment(AssignmentError),
    #[error("it gave up: {0}")]
    GaveUp(String),
}

/// How a process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Status(i32),
    Signal(i32),
    /// It has closed its output and lives on.
    Closed,
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Status(status) => write!(f, "it exited with status {status}"),
            Self::Signal(signal) => write!(f, "it was ended by signal {signal}"),
            Self::Closed => f.write_str("it closed its standard output"),
        }
    }
}

/// A complaint, with all that helps to mend it.
#[derive(Debug, Clone)]
pub(crate) struct ProgramError {
    /// What is wrong.
    pub(crate) complaint: Box<Complaint>,
    /// The round whose question waits.
    pub(crate) round: Option<u32>,
    /// The line as it was sent.
    pub(crate) line: Option<Vec<u8>>,
    /// The last lines of the standard error.
    pub(crate) last_words: Vec<String>,
}

impl From<Complaint> for ProgramError {
    fn from(complaint: Complaint) -> Self {
        Self { complaint: Box::new(complaint), round: None, line: None, last_words: Vec::new() }
    }
}

impl From<ProgramError> for PolicyError {
    fn from(error: ProgramError) -> Self {
        match *error.complaint {
            Complaint::Silent(..) => Self::Slow(error.to_string()),
            Complaint::NotAllowed { command, hint } => Self::NotAllowed { command, hint },
            _ => Self::Other(error.to_string()),
        }
    }
}

impl fmt::Display for ProgramError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(round) = self.round {
            write!(f, "round {round}: ")?;
        }
        write!(f, "{}", self.complaint)?;
        if let Some(line) = self.line.as_ref().filter(|line| !line.trim_ascii().is_empty()) {
            write!(f, "; its line: {}", shown(line))?;
        }
        if !self.last_words.is_empty() {
            write!(f, "\nits standard error ends with:")?;
        }
        self.last_words.iter().try_for_each(|line| write!(f, "\n  {line}"))
    }
}

/// The first bytes of a line, up to a whole character.
fn shown(line: &[u8]) -> String {
    let end = (0..=SHOWN_BYTES.min(line.len())).rev();
    let is_boundary = |end: &usize| line.get(*end).is_none_or(|byte| byte & 0xC0 != 0x80);
    let end = end.into_iter().find(is_boundary).unwrap_or_default();
    let more = if end < line.len() { format!(" ... ({} bytes)", line.len()) } else { String::new() };
    format!("{}{more}", String::from_utf8_lossy(&line[..end]))
}
