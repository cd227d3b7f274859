//! Pictures from the command line: the files written, and refusals.

use crate::commands::refused;
use crate::support::{read, root, succeeds, usar};

fn scenario() -> String {
    root().join("scenarios/minimal/head_on.ron").display().to_string()
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn a_moment_and_the_trails_are_written_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    succeeds(&run(&["run", &scenario(), "--record", "a.usrec"]));
    assert_eq!(succeeds(&run(&["export", "a.usrec", "--at", "4", "--to", "a.svg"])), "a.svg\n");
    // The same from the scenario, which is simulated first.
    succeeds(&run(&["export", &scenario(), "--at", "4", "--to", "b.svg"]));
    let svg = read(&folder.path().join("a.svg"));
    assert_eq!(svg, read(&folder.path().join("b.svg")));
    assert!(svg.contains("head_on, seed 1, 0:04.0"), "{svg}");
    succeeds(&run(&["export", "a.usrec", "--trails", "--width", "88mm", "--to", "a.png"]));
    let again = run(&["export", "a.usrec", "--at", "5", "--to", "a.svg"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--to: a.svg exists; nothing was overwritten"));
    assert_eq!(svg, read(&folder.path().join("a.svg")));
    succeeds(&run(&["export", "a.usrec", "--at", "5", "--to", "a.svg", "--force"]));
    assert_ne!(svg, read(&folder.path().join("a.svg")));
    let late = run(&["export", "a.usrec", "--at", "5000", "--to", "late.svg"]);
    assert_eq!(late.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&late.stderr).contains("--at: must be from 0 to"));
    assert!(!folder.path().join("late.svg").exists());
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn pictures_in_a_row_are_files_or_a_gif() {
    let folder = tempfile::tempdir().unwrap();
    let run = |to: &str| {
        let more = ["--every", "2", "--begin", "1", "--end", "7", "--width", "200", "--to"];
        usar(folder.path(), &[&["export", &scenario()], &more[..], &[to]].concat())
    };
    assert_eq!(succeeds(&run("f-%04d.png")), "4 pictures: f-%04d.png\n");
    let names = || {
        let names = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    };
    assert_eq!(names(), ["f-0000.png", "f-0001.png", "f-0002.png", "f-0003.png"]);
    std::fs::remove_file(folder.path().join("f-0000.png")).unwrap();
    assert_eq!(run("f-%04d.png").status.code(), Some(2), "the second picture is there");
    assert_eq!(names().len(), 3, "nothing was written");
    succeeds(&run("row.gif"));
    assert!(std::fs::read(folder.path().join("row.gif")).unwrap().starts_with(b"GIF89a"));
}

#[test]
fn the_world_of_a_seed_is_drawn_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let paper = root().join("scenarios/paper.ron").display().to_string();
    let draw = |seed: &str, out: &str| {
        let set = "tasks.hard.sampled.debris=5";
        let arguments = ["scenario", "draw", &paper, "--set", set, "--seed", seed, "--out", out];
        assert_eq!(succeeds(&usar(folder.path(), &arguments)), format!("{out}\n"));
        read(&folder.path().join(out))
    };
    let [one, two, again] =
        [("1", "1.svg"), ("2", "2.svg"), ("1", "again.svg")].map(|(seed, out)| draw(seed, out));
    assert_eq!(one, again);
    assert_ne!(one, two);
    assert!(one.contains(">debris of this seed<") && one.contains("paper, seed 1"));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn what_cannot_be_drawn_is_refused_in_one_sentence() {
    let file = scenario();
    refused(
        &["scenario", "draw", &file, "--out", "map.gif"],
        "--out: must end with .svg or .png, found map.gif",
    );
    refused(&["scenario", "draw", &file, "--out", "nowhere/map.svg"], "--out: there is no folder nowhere");
    refused(&["scenario", "draw", &file, "--out", "m.svg", "--width", "9cm"], "must be 100 to 8000 pixels");
    let refuse = |line: &str, says: &str| {
        refused(&[&["export", &file][..], &line.split(' ').collect::<Vec<_>>()].concat(), says);
    };
    refuse("--to a.svg", "--to: a.svg needs --at, --trails or --every, or --figure of a sweep");
    refuse("--every 1", "required arguments were not provided");
    refuse("--to a.gif", "--to: a.gif needs --every, the time between two pictures");
    refuse("--every 0 --to a.gif", "must be a number from 0.001");
    refuse("--at 1 --policy RNE,DIS --to a.svg", "--policy: must be one policy");
    refuse("--at 1 --to a.csv", "--at: is no option of the tables of a trial, which --to a.csv asks for");
    refuse("--at 1 --trails --to a.svg", "--trails: is no option of the picture of a moment");
    refuse("--at 1 --to a.mp4", "--to: must end with .csv, .parquet, .mcap, .png, .svg, .pdf or .gif");
    refuse("--figure costs --to a.pdf", "head_on.ron is no folder of a sweep");
    refuse("--trails --grey --to a.pdf", "--grey: is no option of the picture of trajectories");
    for to in ["a.png", "a-%d.png", "a-%04d-%04d.png", "a-%x%04d.png"] {
        refuse(&format!("--every 1 --to {to}"), "need one place for a number, as in 'x-%04d.png'");
    }
}
