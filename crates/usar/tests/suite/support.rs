//! Runs the program and checks its output.

use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

/// The file of the laboratory's program, beside which those of studies stand.
pub fn program() -> &'static Path {
    static USAR: LazyLock<PathBuf> = LazyLock::new(|| Path::new(crate::PROGRAM).with_file_name("usar"));
    &USAR
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}

/// Arguments of a command: a list, or a text with blanks between them.
pub trait Words: Debug {
    fn words(&self) -> Vec<&str>;
}

impl Words for str {
    fn words(&self) -> Vec<&str> {
        self.split(' ').collect()
    }
}

impl<const N: usize> Words for [&str; N] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Words for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Words for Vec<&str> {
    fn words(&self) -> Vec<&str> {
        self.clone()
    }
}

pub fn usar(folder: &Path, arguments: &(impl Words + ?Sized)) -> Output {
    usar_in(folder).args(arguments.words()).output().expect("usar runs")
}

/// The command in a folder, as a user with programs that nobody else has allowed.
pub fn usar_in(folder: &Path) -> Command {
    let mut command = Command::new(program());
    command.current_dir(folder).env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"));
    command
}

/// The JSON that a command prints in the project's folder.
pub fn json(arguments: &(impl Words + ?Sized)) -> serde_json::Value {
    let output = usar(&root(), arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
pub fn succeeds(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Checks that a command was refused with these messages.
#[track_caller]
pub fn refuses(output: &Output, messages: &[&str]) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    for message in messages {
        assert!(stderr.contains(message), "must say {message:?}, said {stderr:?}");
    }
}

/// A folder with the paper's scenario for two minutes, and a target for it.
pub fn two_minutes() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = read(&root().join("scenarios/paper.ron")).replace("duration_s: 600.0", "duration_s: 120.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let target = "method,rescuees_hard,energy_hard\nDIS,10,150\nDIS,14,160\nDIS,12,170\n";
    std::fs::write(folder.path().join("target.csv"), target).unwrap();
    folder
}
