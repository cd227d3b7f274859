//! The program in a shell: its version, its help, its manual pages, completions, and `usar self doctor`.

use xtask::manual;

use crate::place::refused;
use crate::support::{json, read, root, succeeds, usar};

/// Some commands, of each depth.
const COMMANDS: [&str; 3] = ["sweep", "cluster submit", "study regret"];

#[test]
fn the_short_help_has_less_than_the_long_one_and_both_have_examples() {
    let root = root();
    assert!(succeeds(&usar(&root, &["-h"])).contains("\nstart "));
    for command in COMMANDS {
        let help = |flag| succeeds(&usar(&root, &command.split(' ').chain([flag]).collect::<Vec<_>>()));
        let (short, long) = (help("-h"), help("--help"));
        assert!(short.len() < long.len() && !short.contains("--fresh"), "{short}");
        assert!(short.contains("\nExamples:\n") && long.contains("\nExamples:\n"), "{long}");
    }
}

/// A finding of the doctor.
fn found(told: &serde_json::Value, what: &str) -> serde_json::Value {
    let findings = told["tables"]["findings"].as_array().unwrap();
    findings.iter().find(|row| row["what"] == what).unwrap()["found"].clone()
}

#[test]
fn the_version_tells_the_commit() {
    let version = succeeds(&usar(&root(), &["--version"]));
    let expected = concat!("usar ", env!("CARGO_PKG_VERSION"));
    let rest = version.trim_end().strip_prefix(expected).unwrap_or_else(|| panic!("{version}"));
    let [commit, features] = ["commit", "features"].map(|name| found(&json("self doctor --json"), name));
    let [commit, features] = [&commit, &features].map(|text| text.as_str().unwrap());
    let commit = if commit == "unknown" { String::new() } else { format!("commit {commit}; ") };
    assert_eq!(rest, format!(" ({commit}features: {features})"));
}

#[test]
fn each_shell_has_completions_that_know_policies_and_scenarios() {
    let root = root();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = succeeds(&usar(&root, &["self", "completions", shell]));
        assert!(script.contains("USAR_COMPLETE"), "{shell}: {script}");
    }
    refused(
        tempfile::tempdir().unwrap().path(),
        2,
        "self completions csh",
        &["possible values: bash, elvish, fish, powershell, zsh"],
    );
    let empty = tempfile::tempdir().unwrap();
    let offered = |words: &[&str]| -> String {
        let mut asked = std::process::Command::new(env!("CARGO_BIN_EXE_usar"));
        asked.args(["--", "usar"]).args(words).current_dir(empty.path());
        asked.env("USAR_COMPLETE", "bash").env("_CLAP_COMPLETE_INDEX", words.len().to_string());
        succeeds(&asked.output().unwrap())
    };
    assert_eq!(offered(&["view", "pap"]), "paper\npaper-calibrated");
    assert_eq!(offered(&["sweep", "paper", "--policies", "RNE,EN"]), "RNE,ENG");
    let verbs = offered(&[""]);
    for verb in COMMANDS.iter().filter_map(|command| command.split(' ').next()) {
        assert!(verbs.lines().any(|line| line == verb), "{verb}: {verbs}");
    }
}

#[test]
fn there_is_a_manual_page_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    manual::write_pages(folder.path()).unwrap();
    assert!(std::fs::read_dir(folder.path()).unwrap().count() > 25);
    let page = read(&folder.path().join("usar.1"));
    assert!(page.contains(".TH usar 1") && page.contains("Exit status:"), "{page}");
    for name in COMMANDS.map(|command| format!("usar-{}", command.replace(' ', "-"))) {
        let page = read(&folder.path().join(format!("{name}.1")));
        assert!(page.contains(&format!(".TH {name} 1")) && page.contains("\n.nf\nExample"), "{page}");
    }
    let page = manual::commands();
    assert!(COMMANDS.iter().all(|name| page.contains(&format!("\n## usar {name}\n"))), "{page}");
}

#[test]
fn the_doctor_tells_whether_results_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = succeeds(&usar(here, "self doctor --out deep/results"));
    assert!(told.contains("│ writable  ┆ yes ") && told.contains("is made by the first sweep"), "{told}");
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 0, "nothing is left behind");
    let findings = json("self doctor --json");
    assert!(found(&findings, "threads").as_u64().unwrap() > 0);
    assert!(found(&findings, "free").as_u64().is_some_and(|bytes| bytes > 0), "{findings}");
    std::fs::write(here.join("file"), "").unwrap();
    let output = usar(here, "self doctor --out file --json");
    assert_eq!(output.status.code(), Some(3));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found(&told, "writable"), false);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.starts_with("error: results cannot be written: "), "{message}");
}
