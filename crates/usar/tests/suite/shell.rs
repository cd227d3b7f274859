//! The program in a shell: its version, its help, its manual pages, completions, and `usar doctor`.

use crate::commands::json;
use crate::place::refused;
use crate::support::{read, root, succeeds, usar};

/// The verbs that `usar --help` lists.
fn verbs(help: &str) -> Vec<&str> {
    let commands = help.split("\nCommands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let verbs = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let verbs: Vec<&str> = verbs.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(verbs.len() > 30 && verbs.contains(&"sweep"), "{help}");
    verbs.into_iter().filter(|verb| *verb != "help").collect()
}

#[test]
fn every_verb_has_examples_of_itself() {
    let root = root();
    let help = succeeds(&usar(&root, &["--help"]));
    assert!(help.contains("Exit status:\n  0 ") && help.contains("\n  3 "), "{help}");
    for verb in verbs(&help) {
        let help = succeeds(&usar(&root, &[verb, "--help"]));
        let examples = help.split("\nExample:\n").nth(1).or(help.split("\nExamples:\n").nth(1));
        let examples = examples.unwrap_or_else(|| panic!("usar {verb} --help has no examples"));
        assert!(examples.contains(&format!("usar {verb}")), "usar {verb} --help: {examples}");
    }
}

#[test]
fn the_version_tells_the_commit() {
    let version = succeeds(&usar(&root(), &["--version"]));
    let expected = concat!("usar ", env!("CARGO_PKG_VERSION"));
    let rest = version.trim_end().strip_prefix(expected).unwrap_or_else(|| panic!("{version}"));
    let commit = json(&["doctor", "--json"])["commit"].as_str().unwrap().to_owned();
    let told = if commit == "unknown" { String::new() } else { format!(" (commit {commit})") };
    assert_eq!(rest, told);
}

#[test]
fn each_shell_has_completions_of_every_verb() {
    let root = root();
    let help = succeeds(&usar(&root, &["--help"]));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = succeeds(&usar(&root, &["completions", shell]));
        for verb in verbs(&help) {
            assert!(script.contains(verb), "{shell}: {verb} is missing");
        }
        assert!(script.contains("--max-trial-s") || script.contains("max-trial-s"), "{shell}: no options");
    }
    refused(
        tempfile::tempdir().unwrap().path(),
        2,
        &["completions", "csh"],
        &["possible values: bash, elvish, fish, powershell, zsh"],
    );
}

#[test]
fn there_is_a_manual_page_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    assert!(succeeds(&usar(here, &["man"])).contains(".TH usar 1"));
    let told = succeeds(&usar(here, &["man", "--out", "man1"]));
    let help = succeeds(&usar(here, &["--help"]));
    assert_eq!(told.lines().count(), verbs(&help).len() + 1, "{told}");
    for verb in verbs(&help) {
        let page = read(&here.join("man1").join(format!("usar-{verb}.1")));
        assert!(page.contains(&format!(".TH usar-{verb} 1")) && page.contains("\n.nf\nExample"), "{page}");
    }
    refused(here, 2, &["man", "--out", "man1"], &["is not empty", "--force"]);
}

#[test]
fn the_page_of_commands_is_what_help_prints() {
    let root = root();
    let page = succeeds(&usar(&root, &["man", "--markdown"]));
    assert!(read(&root.join("docs/commands.md")) == page, "`just reference` makes docs/commands.md anew");
}

#[test]
fn the_doctor_tells_whether_results_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = succeeds(&usar(here, &["doctor", "--out", "deep/results"]));
    assert!(told.contains("writable   yes\n") && told.contains("is made by the first sweep"), "{told}");
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 0, "nothing is left behind");
    let findings = json(&["doctor", "--json"]);
    assert_eq!(findings["schema_version"], 1);
    assert!(findings["threads"].as_u64().unwrap() > 0);
    assert!(findings["results"]["free_bytes"].as_u64().is_some_and(|bytes| bytes > 0), "{findings}");
    std::fs::write(here.join("file"), "").unwrap();
    let output = usar(here, &["doctor", "--out", "file", "--json"]);
    assert_eq!(output.status.code(), Some(3));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(told["results"]["is_writable"], false);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.starts_with("error: results cannot be written: "), "{message}");
}
