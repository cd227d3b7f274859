//! Pictures from the command line: the files written, and refusals.

use std::path::Path;
use std::process::{Command, Output};

use crate::commands::refused;
use crate::support::{program, read, root, succeeds, usar};

fn scenario() -> String {
    root().join("scenarios/minimal/head_on.ron").display().to_string()
}

#[test]
fn a_moment_and_the_trails_are_written_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    succeeds(&run(&["run", &scenario(), "--record", "a.usrec"]));
    assert_eq!(succeeds(&run(&["export", "frames", "a.usrec", "--at", "4", "--out", "a.svg"])), "a.svg\n");
    // The same from the scenario, which is simulated first.
    succeeds(&run(&["export", "frames", &scenario(), "--at", "4", "--out", "b.svg"]));
    let svg = read(&folder.path().join("a.svg"));
    assert_eq!(svg, read(&folder.path().join("b.svg")));
    assert!(svg.contains("head_on, seed 1, 0:04.0"), "{svg}");
    succeeds(&run(&["export", "frames", "a.usrec", "--trails", "--width", "88mm", "--out", "a.png"]));
    let again = run(&["export", "frames", "a.usrec", "--at", "5", "--out", "a.svg"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--out: a.svg exists; nothing was overwritten"));
    assert_eq!(svg, read(&folder.path().join("a.svg")));
    succeeds(&run(&["export", "frames", "a.usrec", "--at", "5", "--out", "a.svg", "--force"]));
    assert_ne!(svg, read(&folder.path().join("a.svg")));
    let late = run(&["export", "frames", "a.usrec", "--at", "5000", "--out", "late.svg"]);
    assert_eq!(late.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&late.stderr).contains("--at: must be from 0 to"));
    assert!(!folder.path().join("late.svg").exists());
}

#[test]
fn pictures_in_a_row_are_files_or_a_gif() {
    let folder = tempfile::tempdir().unwrap();
    let run = |verb: &str, out: &str| {
        let more = ["--every", "2", "--begin", "1", "--end", "7", "--width", "200", "--out"];
        usar(folder.path(), &[&["export", verb, &scenario()], &more[..], &[out]].concat())
    };
    assert_eq!(succeeds(&run("frames", "row")), "4 pictures in row\n");
    let names = std::fs::read_dir(folder.path().join("row")).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<_> = names.collect();
    names.sort();
    assert_eq!(names, ["00000.png", "00001.png", "00002.png", "00003.png"]);
    assert_eq!(run("frames", "row").status.code(), Some(2), "the folder is not empty");
    succeeds(&run("video", "row.gif"));
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
fn what_cannot_be_drawn_is_refused_in_one_sentence() {
    let file = scenario();
    refused(
        &["scenario", "draw", &file, "--out", "map.gif"],
        "--out: must end with .svg or .png, found map.gif",
    );
    refused(&["scenario", "draw", &file, "--out", "nowhere/map.svg"], "--out: there is no folder nowhere");
    refused(&["scenario", "draw", &file, "--out", "m.svg", "--width", "9cm"], "must be 100 to 8000 pixels");
    refused(&["export", "frames", &file, "--out", "a.svg"], "required arguments were not provided");
    refused(&["export", "frames", &file, "--every", "1"], "required arguments were not provided");
    refused(&["export", "video", &file, "--every", "0", "--out", "a.gif"], "must be a number from 0.001");
    refused(
        &["export", "frames", &file, "--at", "1", "--policy", "RNE,DIS", "--out", "a.svg"],
        "--policy: must be one policy",
    );
}

/// Runs `usar export video` with only the programs of one folder on the path.
fn film(folder: &Path, programs: &Path) -> Output {
    let arguments =
        ["export", "video", &scenario(), "--every", "2", "--end", "6", "--width", "201", "--out", "a.mp4"];
    Command::new(program()).args(arguments).current_dir(folder).env("PATH", programs).output().unwrap()
}

#[test]
fn a_film_without_ffmpeg_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = film(folder.path(), folder.path());
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("--out: needs the program ffmpeg, which is not installed"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn a_film_is_what_ffmpeg_makes_of_all_pixels() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let programs = tempfile::tempdir().unwrap();
    let fake = |script: &str| {
        let path = programs.path().join("ffmpeg");
        std::fs::write(
            &path,
            format!("#!/bin/sh\nPATH=/usr/bin:/bin\n[ \"$1\" = -version ] && exit 0\n{script}"),
        )
        .unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    };
    fake("echo 'no such codec' >&2; exit 3\n");
    let failed = film(folder.path(), programs.path());
    assert_eq!(failed.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&failed.stderr).contains("no such codec"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    fake("for last; do :; done\ncat > \"$last\"\necho \"$@\" >&2\n");
    assert_eq!(succeeds(&film(folder.path(), programs.path())), "a.mp4\n");
    let bytes = std::fs::read(folder.path().join("a.mp4")).unwrap();
    assert!(
        !bytes.is_empty() && bytes.len().is_multiple_of(4 * 201 * 4),
        "four pictures of 201 pixels across"
    );
}
