//! A sweep that is killed again and again. No finished trial is lost or run twice, and in the end its files
//! equal those of an uninterrupted sweep.

use std::collections::BTreeMap;
use std::io::Read;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use flate2::read::MultiGzDecoder;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Counts of a series of kills.
#[derive(Debug, Default)]
pub struct Report {
    /// Number of processes that were killed before they had finished.
    pub kills: u32,
    /// Number of sweeps that finished nevertheless.
    pub sweeps: u32,
    /// Number of finished trials found after kills, summed over all kills.
    pub kept: usize,
}

/// Kills sweeps with these arguments until this many kills are reached, and lets the last sweep finish.
///
/// # Panics
/// A trial was lost or run twice, or a file differs.
pub fn kill_sweeps(usar: &Path, arguments: &[&str], folder: &Path, kills: u32, longest_ms: u64) -> Report {
    let mut draws = ChaCha8Rng::seed_from_u64(u64::from(kills));
    let command = |out: &str| {
        let mut command = Command::new(usar);
        command.args(arguments).args(["--quiet", "--out", out]).current_dir(folder);
        command.stdout(Stdio::null()).process_group(0);
        command
    };
    assert!(command("alone").status().expect("usar runs").success());
    let alone = files(&folder.join("alone"));
    let (mut report, mut finished) = (Report::default(), 0);
    while report.kills < kills || finished > 0 || report.sweeps == 0 {
        let mut child = command("killed").spawn().expect("usar runs");
        if report.kills < kills {
            std::thread::sleep(Duration::from_millis(draws.random_range(0..=longest_ms)));
            let group = format!("-{}", child.id());
            let kill = Command::new("kill").args(["-9", "--", &group]).stderr(Stdio::null()).status();
            assert!(kill.is_ok(), "there is a kill command");
        }
        let status = child.wait().expect("it ends");
        let now = finished_trials(&folder.join("killed"));
        assert!(now >= finished, "{finished} trials were finished, {now} are left");
        if status.success() {
            assert_same(&files(&folder.join("killed")), &alone);
            report.sweeps += 1;
            std::fs::remove_dir_all(folder.join("killed")).expect("it can be removed");
            finished = 0;
        } else {
            assert_eq!(status.code(), None, "it was killed");
            report.kills += 1;
            report.kept += now;
            finished = now;
        }
    }
    report
}

/// Number of finished trials in a folder's journal; each must occur once.
fn finished_trials(folder: &Path) -> usize {
    let journal = journal(folder);
    let whole = journal.rfind('\n').map_or("", |end| &journal[..end]);
    let mut ids: Vec<&str> =
        whole.lines().filter_map(|line| line.split("\"id\":\"").nth(1)?.get(..32)).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "a trial was done twice");
    count
}

/// The journal of a folder, while it grows or of a finished sweep.
pub fn journal(folder: &Path) -> String {
    let mut text = String::new();
    if let Ok(growing) = std::fs::read_to_string(folder.join("journal.jsonl")) {
        text = growing;
    } else if let Ok(finished) = std::fs::File::open(folder.join("journal.jsonl.gz")) {
        MultiGzDecoder::new(finished).read_to_string(&mut text).expect("a whole file");
    }
    text
}

fn assert_same(killed: &BTreeMap<String, Vec<u8>>, alone: &BTreeMap<String, Vec<u8>>) {
    assert_eq!(killed.keys().collect::<Vec<_>>(), alone.keys().collect::<Vec<_>>());
    for (name, content) in killed {
        assert!(content == &alone[name], "{name} differs");
    }
}

/// The files of a folder, by name, except those that differ between two runs of the same sweep: locks that
/// killed processes left, and `host.json`.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read(path).expect("a file"))
    };
    let is_same = |(name, _): &(String, Vec<u8>)| name != "host.json" && !name.starts_with(".lock");
    std::fs::read_dir(folder).expect("a folder").map(file).filter(is_same).collect()
}
