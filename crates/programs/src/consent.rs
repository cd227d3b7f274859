//! Consent: which commands may be started. The name of a program in a file starts nothing by itself. A
//! command is started if it stands on the command line, or if this user has allowed it before.

use std::collections::BTreeMap;
use std::fs::{OpenOptions, create_dir_all, read_to_string};
use std::io::{IsTerminal, Write, stdin};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use ron_tree::Node;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use rustix::termios::{QueueSelector, tcflush};
use sha2::Digest;

use crate::error::Complaint;
use crate::files::seal;
use crate::options::{NAME, Options};

/// What is done about a command that nobody has typed or allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// It is not started. The text says how a user allows it.
    Refuse(&'static str),
    /// A person at the terminal is asked; without a terminal it is not started, as above.
    Ask(&'static str),
    /// It is started, and allowed from now on.
    Allow,
}

/// Which commands may be started. Clones share what was answered.
#[derive(Clone)]
pub struct Consent(Arc<Shared>);

struct Shared {
    /// The programs whose commands were typed.
    typed: Vec<Options>,
    unknown: Unknown,
    /// The file in which allowed programs are kept, if there is one.
    kept: Option<PathBuf>,
    /// Shows a line to the user.
    tell: fn(&str),
    stop: Arc<AtomicBool>,
    /// What was decided of each program in this process.
    decided: Mutex<BTreeMap<String, bool>>,
}

/// The right to start a command. Only [`Consent::permit`] makes one.
#[derive(Debug)]
pub(crate) struct Permit(());

impl Consent {
    /// Consent to the programs in these typed policies, and to those that were allowed before. `tell` shows a
    /// line to the user; a question ends when `stop` is set.
    #[must_use]
    pub fn new<'t>(
        typed: impl IntoIterator<Item = &'t str>,
        unknown: Unknown,
        tell: fn(&str),
        stop: &Arc<AtomicBool>,
    ) -> Self {
        let typed = typed.into_iter().flat_map(programs_in).collect();
        let (kept, stop, decided) = (kept_file(), Arc::clone(stop), Mutex::default());
        Self(Arc::new(Shared { typed, unknown, kept, tell, stop, decided }))
    }

    /// The same without a memory: what is allowed is allowed in this process, and no file is read or written.
    #[must_use]
    pub fn forgetting(self) -> Self {
        let Shared { typed, unknown, tell, stop, .. } = &*self.0;
        let (typed, stop, decided) = (typed.clone(), Arc::clone(stop), Mutex::default());
        Self(Arc::new(Shared { typed, unknown: *unknown, kept: None, tell: *tell, stop, decided }))
    }

    /// Shows a line to the user.
    pub(crate) fn tell(&self, line: &str) {
        (self.0.tell)(line);
    }

    /// Permits the start of a program. An edit of its files, or another working folder, asks again.
    pub(crate) fn permit(&self, options: &Options) -> Result<Permit, Complaint> {
        let digest = digest(options, &self.0.stop)?;
        // The lock is held while a person is asked, so that no other thread asks the same.
        let mut decided = self.0.decided.lock().unwrap_or_else(PoisonError::into_inner);
        let allowed = *decided.entry(digest).or_insert_with_key(|digest| self.0.decide(options, digest));
        if allowed {
            return Ok(Permit(()));
        }
        let hint = match self.0.unknown {
            Unknown::Refuse(hint) | Unknown::Ask(hint) => hint,
            Unknown::Allow => "",
        };
        Err(Complaint::NotAllowed { command: options.in_words(), hint })
    }
}

impl Shared {
    fn decide(&self, options: &Options, digest: &str) -> bool {
        let is_kept = self.kept.as_deref().is_some_and(|file| is_kept(file, digest));
        let allowed = is_kept
            || self.typed.contains(options)
            || match self.unknown {
                Unknown::Refuse(_) => false,
                Unknown::Ask(_) => self.ask(options),
                Unknown::Allow => true,
            };
        if allowed && !is_kept {
            self.keep(options, digest);
        }
        allowed
    }

    /// Shows a command and asks for consent. The default is no.
    fn ask(&self, options: &Options) -> bool {
        if !stdin().is_terminal() || !std::io::stderr().is_terminal() {
            return false;
        }
        let stdin = stdin();
        let _ = tcflush(&stdin, QueueSelector::IFlush); // what was typed before the question answers nothing
        (self.tell)(&format!(
            "a policy is a program, which would run with your rights in this folder:\n  {}\nstart it? [y/N]",
            options.in_words()
        ));
        while !self.stop.load(Ordering::Relaxed) {
            let mut ends = [PollFd::new(&stdin, PollFlags::IN)];
            let period = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
            match poll(&mut ends, Some(&period)) {
                Ok(0) | Err(Errno::INTR) => {}
                Err(_) => return false,
                // A terminal gives one line at a time.
                Ok(_) => {
                    let mut line = [0; 64];
                    let length = rustix::io::read(&stdin, &mut line).unwrap_or(0);
                    let answer = line[..length].trim_ascii().to_ascii_lowercase();
                    return answer == b"y" || answer == b"yes";
                }
            }
        }
        false
    }

    fn keep(&self, options: &Options, digest: &str) {
        let Some(file) = &self.kept else { return };
        let line = format!("{digest} {}\n", shortened(options.in_words()));
        let folder = file.parent().unwrap_or(Path::new("."));
        let kept = create_dir_all(folder)
            .and_then(|()| OpenOptions::new().append(true).create(true).open(file))
            .and_then(|mut file| file.write_all(line.as_bytes()));
        if let Err(error) = kept {
            (self.tell)(&format!(
                "note: the program is allowed for this call only; {}: {error}",
                file.display()
            ));
        }
    }
}

/// The start of a command, as a file of allowed programs shows it to its reader.
fn shortened(command: String) -> String {
    if command.len() < 200 { command } else { command.chars().take(200).collect::<String>() + " .." }
}

/// The file of allowed programs: `$XDG_STATE_HOME/usar/allowed`, or that in `~/.local/state`.
fn kept_file() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let state = folder("XDG_STATE_HOME").or_else(|| Some(folder("HOME")?.join(".local/state")))?;
    Some(state.join("usar/allowed"))
}

fn is_kept(file: &Path, digest: &str) -> bool {
    let text = read_to_string(file).unwrap_or_default();
    text.lines().any(|line| line.split(' ').next() == Some(digest))
}

/// A hash of all that a permission is for: the options, the working folder, and the files that decide
/// answers.
fn digest(options: &Options, stop: &AtomicBool) -> Result<String, Complaint> {
    let folder = std::env::current_dir().unwrap_or_default();
    let mut seal = seal(options, stop)?;
    seal.update(serde_json::to_vec(options).unwrap_or_default()); // texts and numbers: it can be written
    seal.update([0]);
    seal.update(folder.as_os_str().as_encoded_bytes());
    Ok(format!("{:x}", seal.finalize()))
}

/// The programs that a typed text names, also those in the options of another policy, where quotes have
/// backslashes.
fn programs_in(typed: &str) -> Vec<Options> {
    let unescaped = typed.replace("\\\"", "\"");
    let texts = [typed, unescaped.as_str()];
    let behind = texts
        .into_iter()
        .flat_map(|text| text.match_indices(NAME).map(|(at, name)| &text[at + name.len()..]));
    // The options end with one of the brackets that follow.
    let options = |rest: &str| {
        let mut ends = rest.match_indices(')').map(|(end, _)| &rest[..=end]);
        ends.find_map(|text| Node::parse(text).ok()?.read_as::<Options>().ok())
    };
    behind.filter_map(options).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_programs_of_a_typed_text_are_found() {
        let commands = |text| -> Vec<Vec<String>> {
            programs_in(text).into_iter().map(|options| options.command).collect()
        };
        let expected = [["sh", "-c", "echo (a)"].map(str::to_owned).to_vec()];
        assert_eq!(commands(r#"a=EXEC(command: ["sh", "-c", "echo (a)"]),DIS"#)[..1], expected);
        let nested = r#"ORACLE(horizon: Trial, then: "EXEC(command: [\"sh\", \"-c\", \"echo (a)\"])")"#;
        assert_eq!(commands(nested), expected);
        assert_eq!(commands("EXEC and EXEC(command: ").len(), 0);
    }
}
