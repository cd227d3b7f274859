//! Exports, events and stories from the command line.

use serde_json::Value;

use crate::commands::refused;
use crate::support::{read, root, succeeds, usar};

fn scenario() -> String {
    root().join("scenarios/minimal/head_on.ron").display().to_string()
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn a_trial_is_exported_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    let tables = ["robots", "groups", "events", "decisions"];
    let named = |ending: &str| tables.map(|name| format!("t-{name}.{ending}\n")).concat();
    for (to, said) in
        [("a.mcap", "a.mcap\n".to_owned()), ("t.csv", named("csv")), ("t.parquet", named("parquet"))]
    {
        assert_eq!(succeeds(&run(&["export", &scenario(), "--every", "1", "--to", to])), said);
    }
    assert!(std::fs::read(folder.path().join("a.mcap")).unwrap().starts_with(b"\x89MCAP0\r\n"));
    for name in tables {
        let parquet = std::fs::read(folder.path().join(format!("t-{name}.parquet"))).unwrap();
        assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    }
    let robots = read(&folder.path().join("t-robots.csv"));
    assert!(robots.starts_with("time_s,robot,role,"));
    assert_eq!(robots.lines().nth(3).map(|line| line.split(',').next()), Some(Some("1")));
    std::fs::remove_file(folder.path().join("t-robots.csv")).unwrap();
    let again = run(&["export", &scenario(), "--to", "t.csv"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--to: t-groups.csv exists; nothing was"));
    assert!(!folder.path().join("t-robots.csv").exists());
    succeeds(&run(&["export", &scenario(), "--to", "t.csv", "--force"]));
    refused(&["export", &scenario()], "required arguments were not provided");
    refused(&["export", &scenario(), "--to", "no/a.mcap"], "--to: there is no folder no");
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn a_sweep_is_one_table_and_each_of_its_trials_four() {
    let folder = tempfile::tempdir().unwrap();
    let run = |line: &str| usar(folder.path(), line);
    succeeds(&run("sweep paper --set duration_s=5 --quiet --policies RNE,DIS --trials 2 --out s"));
    let long = succeeds(&run("export s --to -"));
    assert_eq!(succeeds(&run("export s --to s.csv")), "s.csv\n");
    assert_eq!(read(&folder.path().join("s.csv")), long);
    assert!(succeeds(&run("export s --seed 2 --to s.csv")).starts_with("s-robots.csv\n"));
    let files = || std::fs::read_dir(folder.path()).unwrap().count();
    let before = files();
    for (line, says) in [
        (
            "s --to x.parquet",
            "--to: all of a sweep is one .csv, found x.parquet; --policy and --seed name one",
        ),
        (
            "s --to x.csv --case 1",
            "--case: is no option of the long table of a sweep, which --to x.csv asks for",
        ),
        ("s --policy DIS --to x.csv --figure costs", "--figure: is no option of the tables of a trial"),
        ("s --figure luck --to x.pdf", "--figure: must be a figure of this sweep ("),
        ("s --policy DIS --to -", "--to: must end with .csv, .parquet, .mcap"),
    ] {
        let output = run(&format!("export {line}"));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && stderr.contains(says), "{line}: {stderr}");
    }
    assert_eq!(files(), before, "nothing was written");
}

#[test]
fn earlier_verbs_name_the_command_that_is_used_instead() {
    for (old, new) in [
        (
            "export figure results/paper rescuees --out x.pdf",
            "export results/paper --to NAME.pdf --figure FIG",
        ),
        ("export table results/paper", "export results/paper --to NAME.csv`, with `--to -` for stdout"),
        ("export csv a.usrec --out t", "export a.usrec --to NAME.csv"),
        ("export parquet --every 1 a.usrec", "export FILE --to NAME.parquet"),
        ("export mcap a.usrec --out a.mcap", "export a.usrec --to NAME.mcap"),
        ("export frames a.usrec --at 3 --out a.svg", "export a.usrec --to NAME.png` with `--at S` or"),
        ("export video a.usrec --every 1 --out a.mp4", "export a.usrec --to NAME.gif --every S"),
        ("cluster status s-shards", "cluster merge s-shards --out FOLDER` says which shards are missing"),
        ("self man --out man1", "COMMAND --help`; the archive and the Debian package have manual pages"),
        ("cluster estimate paper --trials 9", "sweep paper`, whose progress tells the time that is left"),
    ] {
        let verb = old.split(' ').take(2).collect::<Vec<_>>().join(" ");
        refused(old, &format!("error: `usar {verb}` is now `"));
        refused(old, &format!("`usar {new}"));
    }
}

#[test]
fn every_event_of_a_trial_has_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    succeeds(&run(&["run", &scenario(), "--events", "e.jsonl"]));
    let lines = read(&folder.path().join("e.jsonl"));
    let events: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let times: Vec<f64> = events.iter().map(|event| event["time_s"].as_f64().unwrap()).collect();
    assert!(times.is_sorted() && times.len() > 5, "{lines}");
    let kinds: Vec<&str> = events.iter().map(|event| event["event"].as_str().unwrap()).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == "errand_done").count(), 2, "{lines}");
    assert_eq!(kinds.last(), Some(&"finished"));
    let again = run(&["run", &scenario(), "--events", "e.jsonl"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(read(&folder.path().join("e.jsonl")), lines);
    succeeds(&run(&["run", &scenario(), "--json"])).parse::<Value>().unwrap();
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn parquet_files_of_a_sweep_belong_to_it_and_are_verified() {
    let folder = tempfile::tempdir().unwrap();
    let paper = root().join("scenarios/paper.ron").display().to_string();
    let sweep = |more: &[&str]| {
        let first = ["sweep", &paper, "--set", "duration_s=5", "--quiet", "--policies", "RNE", "--out", "r"];
        usar(folder.path(), &[&first[..], more].concat())
    };
    let path = |name: &str| folder.path().join("r").join(name);
    let plain = succeeds(&sweep(&["--trials", "2"]));
    let manifest = read(&path("manifest.json"));
    assert_eq!(succeeds(&sweep(&["--trials", "2", "--tables", "parquet"])), plain);
    assert_eq!(read(&path("manifest.json")), manifest, "Parquet files are no part of the results");
    for name in ["trials", "rounds", "groups", "robots", "series", "hashes"] {
        assert!(path(&format!("{name}.parquet")).exists(), "{name}");
    }
    succeeds(&usar(folder.path(), "verify r --quiet"));
    let whole = std::fs::read(path("robots.parquet")).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    std::fs::write(path("robots.parquet"), &flipped).unwrap();
    let verified = usar(folder.path(), "verify r --quiet");
    assert_eq!(verified.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&verified.stderr).contains("robots.parquet: is not what robots.csv gives")
    );
    succeeds(&sweep(&["--trials", "2", "--tables", "parquet"]));
    assert_eq!(std::fs::read(path("robots.parquet")).unwrap(), whole);
    // The old Parquet files would have fewer trials.
    succeeds(&sweep(&["--trials", "3"]));
    assert!(!path("robots.parquet").exists());
    succeeds(&sweep(&["--trials", "3", "--tables", "parquet"]));
    succeeds(&sweep(&["--trials", "3", "--fresh"]));
    assert!(!path("trials.parquet").exists());
}

#[cfg(not(feature = "full"))]
#[test]
fn without_its_feature_a_kind_of_file_is_refused_before_any_trial() {
    let advice = "cargo install --locked --path crates/usar --features full";
    for (line, says) in [
        ("export paper --to a.mcap", "--to: this build writes no MCAP (CSV it does): "),
        ("export paper --to a.parquet", "--to: this build writes no Parquet (CSV it does): "),
        ("export paper --at 3 --to a.png", "--to: this build writes no PNG (SVG it does): "),
        ("export paper --every 3 --to a.gif", "--to: this build writes no GIF (SVG it does): "),
        ("scenario draw paper --out a.png", "--out: this build writes no PNG (SVG it does): "),
        ("sweep paper --tables parquet", "--tables: this build writes no Parquet (CSV it does): "),
    ] {
        refused(line, &format!("{says}{advice}"));
    }
}
