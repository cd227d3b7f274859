//! The report of a sweep.

use std::path::Path;

use experiments::sweep::folder::Folder;
use serde_json::Value;

use crate::altered_results::files;
use crate::place::{column, place, refused, rows};
use crate::support::{read, root, succeeds, usar};

#[test]
fn a_report_is_one_file_with_figures_and_the_numbers_behind_them() {
    let folder = place();
    let here = folder.path();
    refused(here, 2, "report results", &["results: is not the folder of a sweep"]);
    succeeds(&usar(here, "sweep grid.ron --set duration_s=85 --trials 6"));
    assert_eq!(succeeds(&usar(here, "report results/grid")), "results/grid/report.html\n");
    let results = here.join("results/grid");
    let read = |name: &str| std::fs::read_to_string(results.join(name)).unwrap();
    let (overview, page) = (read("report.html"), read("plots/case-1.html"));
    // Nothing is fetched: the only addresses are names of XML namespaces.
    for page in [&overview, &page] {
        for source in ["src=", "@import", "url(\"http", "<script", "<link"] {
            assert!(!page.contains(source), "{source}");
        }
        let others = page.replace("http://www.w3.org/", "");
        assert!(!others.contains("http:") && !page.contains("https:"));
        assert!(!page.contains("NaN") && !page.contains(">inf"));
    }
    let plots = files(&results.join("plots"));
    let is_drawn = |page: &str, prefix: &str, name: &str| {
        assert!(page.contains(&format!("<figure id=\"{name}\">")), "{name}");
        assert!(plots[&format!("{prefix}{name}.svg")].starts_with(b"<svg viewBox="), "{name}");
        assert!(page.contains(&format!("{prefix}{name}.csv\">")), "{name}");
        let table = csv::Reader::from_reader(&*plots[&format!("{prefix}{name}.csv")]).records().count();
        assert!(table > 0, "{name}");
    };
    for name in ["along-roles-carrier-speed_mps", "along-conflicts-priority"] {
        is_drawn(&overview, "", name);
    }
    for name in
        ["rescuees", "energy-per-rescuee", "hp-per-rescuee", "waiting-and-deadlocks", "costs", "differences"]
    {
        is_drawn(&page, "case-1-", name);
    }
    for name in ["rescuees-over-time", "groups", "levels", "trust"] {
        is_drawn(&page, "case-1-", name);
    }
    for words in [
        "sum",
        "faster carriers",
        "roles.carrier.speed_mps=1.5",
        "usar sweep sweep.ron",
        "duration_s: 85",
        "Holm",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(
        page.contains("<a href=\"../report.html\">")
            && page.contains("exploratory comparisons, not corrected")
    );
    for case in 1..=4 {
        assert!(overview.contains(&format!("<a href=\"plots/case-{case}.html\">")), "{case}");
    }
    assert!(overview.contains("Does it depend on the scenario?") && overview.contains("faster carriers"));
    assert!(page.contains("<figure id=\"map\"") && plots["case-1-map.svg"].starts_with(b"<svg xmlns"));
    assert!(!page.contains("Ways of all robots"));
    succeeds(&usar(here, "report results/grid"));
    assert_eq!(overview, read("report.html"), "the same bytes again");
    assert_eq!(page, read("plots/case-1.html"), "the same bytes again");
    let more =
        ["--case", "3", "--title", "Of <speed>\u{202e}\u{7}", "--metric", "distance", "--baseline", "DIS"];
    succeeds(&usar(here, &[&["report", "results/grid"], &more[..]].concat()));
    assert!(!results.join("plots/case-1.html").exists());
    let third = read("plots/case-3.html");
    assert!(
        third.contains("<h1>Of &#60;speed&#62;\\u{202e}\\u{7}</h1>")
            && third.contains("<th colspan=\"5\">distance</th>")
    );
    let said = succeeds(&usar(here, &[&["compare", "results/grid"], &more[4..]].concat()));
    let [own, in_report] = [&said, &read("report.html")].map(|text| {
        text.lines().find(|line| line.contains("own question, that is asked by default")).unwrap().to_owned()
    });
    assert!(in_report.contains(&own.replace('\'', "&#39;")), "{own} {in_report}");
    refused(here, 2, "report results/grid --case 5", &["--case: must be from 1 to 4, found 5"]);
    refused(here, 2, "report results/grid --metric luck", &["unknown metric \"luck\""]);
    // The sweep can still be continued in a folder with a report.
    succeeds(&usar(here, "sweep grid.ron --set duration_s=85 --trials 6"));
}

#[test]
fn a_report_shows_chosen_trials_and_links_their_replays() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep short.ron --policies RNE,DIS --trials 2 --set duration_s=30"));
    refused(here, 2, "report results/paper --trial 9", &["--trial: must be the seed of a finished"]);
    succeeds(&usar(here, "report results/paper --trial 2 --with-replays"));
    let results = here.join("results/paper");
    let page = std::fs::read_to_string(results.join("report.html")).unwrap();
    for (label, number) in [("RNE", 1), ("DIS", 2)] {
        assert!(page.contains(&format!("Ways of all robots under {label}, seed 2.")));
        assert!(page.contains(&format!("<a href=\"plots/replay-{label}-2.html\">Watch the trial</a>")));
        assert!(results.join(format!("plots/ways-{number}.svg")).exists());
        let replay = std::fs::read_to_string(results.join(format!("plots/replay-{label}-2.html"))).unwrap();
        assert_eq!(replay.matches("<script type=\"application/x-usrec\"").count(), 1);
    }
    // The next report removes the files of this one, and the folder can start over.
    succeeds(&usar(here, "report results/paper"));
    assert!(!results.join("plots/replay-RNE-2.html").exists() && !results.join("plots/ways-1.svg").exists());
    succeeds(&usar(here, "report results/paper --with-replays"));
    succeeds(&usar(here, "sweep short.ron --policies RNE --trials 1 --set duration_s=30 --fresh"));
    assert!(!results.join("plots").exists());
}

/// Checks that the table of trials has each metric of each trial, to the bit.
fn every_metric_is_a_column(results: &Path, trials: &[csv::StringRecord]) {
    let sweep = Folder::read(results, &policies::standard()).unwrap();
    let metrics = &sweep.experiment().metrics;
    let places: Vec<usize> = metrics.iter().map(|metric| column(results, &metric.column())).collect();
    assert_eq!(trials.len(), sweep.results().len());
    for (row, measured) in trials.iter().zip(sweep.results().values()) {
        let cells = places.iter().map(|place| row[*place].parse().ok().map(f64::to_bits));
        let values = measured.metrics.as_ref().unwrap().iter().map(|value| value.map(f64::to_bits));
        assert!(cells.eq(values), "{row:?}");
    }
}

/// The numbers of a figure equal those of the tables.
#[test]
fn the_reports_numbers_are_those_of_the_trials() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep short.ron --policies RNE,DIS --trials 3 --set duration_s=120"));
    succeeds(&usar(here, "report results/paper"));
    let results = here.join("results/paper");
    let trials = rows(&results, "trials.csv");
    every_metric_is_a_column(&results, &trials);
    let rescuees = column(&results, "rescuees_total");
    let rescued: Vec<f64> =
        trials.iter().filter(|row| &row[0] == "DIS").map(|row| row[rescuees].parse().unwrap()).collect();
    let last = rows(&results.join("plots"), "rescuees-over-time.csv")
        .into_iter()
        .rfind(|row| &row[0] == "rescuees.total" && &row[1] == "DIS")
        .unwrap();
    assert_eq!((&last[2], &last[3]), ("120", "3"));
    assert!((last[4].parse::<f64>().unwrap() - rescued.iter().sum::<f64>() / 3.0).abs() < 1e-9);
    // The heat map of trust agrees with `usar trust` for the same needs.
    let robots = rows(&results, "groups.csv");
    let needs = |robot: &str| -> Vec<f64> {
        let row = robots
            .iter()
            .find(|row| &row[0] == "RNE" && &row[1] == "1" && &row[3] == "1" && &row[4] == robot);
        row.unwrap().iter().skip(9).map(|need| need.parse().unwrap()).collect()
    };
    let all: Vec<Vec<f64>> = (0..12).map(|robot| needs(&robot.to_string())).collect();
    let weights: Vec<String> =
        (0..7).map(|k| (1.0 / all.iter().map(|needs| needs[k]).fold(0.0, f64::max)).to_string()).collect();
    let text = |needs: &[f64]| needs.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let (from, to, weights) = (text(&all[0]), text(&all[1]), weights.join(","));
    let said = succeeds(&usar(
        here,
        &["trust", "--weights", &weights, "--trustor", &from, "--trustee", &to, "--json"],
    ));
    let rne = serde_json::from_str::<Value>(&said).unwrap()["tables"]["pair"][0]["rne"].as_f64().unwrap();
    let shown = &rows(&results.join("plots"), "trust.csv")[1];
    assert_eq!((&shown[0], &shown[1]), ("0", "1"));
    assert!((shown[2].parse::<f64>().unwrap() - rne).abs() < 1e-12);
}

/// A figure for a paper: as wide as its column, in three formats, of one metric and of some policies.
#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn a_figure_fits_the_column_of_a_paper() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let scenario = root().join("scenarios/paper.ron");
    let scenario = scenario.to_str().unwrap();
    let mut sweep = vec!["sweep", scenario, "--trials", "2", "--set", "duration_s=60", "--quiet"];
    sweep.extend(["--policies", "RNE,DIS", "--out", "short"]);
    succeeds(&usar(folder, &sweep));
    let figure = |more: &[&str]| {
        usar(folder, &[&["export", "short", "--figure", "rescuees-over-time"], more].concat())
    };
    let told = succeeds(&figure(&["--to", "a.svg", "--metric", "rescuees", "--policies", "DIS", "--grey"]));
    assert_eq!(told, "a.svg\n");
    let svg = read(&folder.join("a.svg"));
    assert!(svg.contains("width=\"88mm\"") && svg.contains("DIS") && !svg.contains("RNE"), "{svg}");
    assert!(!svg.contains("#D55E00"), "no colour is left");
    for name in ["groups", "levels", "sorting"] {
        let file = format!("{name}.svg");
        succeeds(&usar(folder, &["export", "short", "--figure", name, "--policies", "DIS", "--to", &file]));
        let svg = read(&folder.join(&file));
        assert!(svg.contains("DIS") && !svg.contains("RNE"), "{name}: {svg}");
    }
    succeeds(&figure(&["--to", "a.pdf"]));
    succeeds(&figure(&["--to", "a.png", "--dpi", "60"]));
    let begins = |name: &str, with: &[u8]| std::fs::read(folder.join(name)).unwrap().starts_with(with);
    assert!(begins("a.pdf", b"%PDF-") && begins("a.png", b"\x89PNG"));
    for (more, says) in [
        (&["--to", "a.pdf"][..], "exists; nothing was overwritten"),
        (&["--metric", "rounds", "--to", "b.pdf"], "the figure rescuees-over-time has no panel of rounds"),
        (&["--policies", "LUCK", "--to", "b.pdf"], "--policies: must be policies of the sweep (RNE, DIS)"),
        (&["--width", "800", "--to", "b.pdf"], "must be 20mm to 1000mm"),
    ] {
        let output = figure(more);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && stderr.contains(says), "{stderr}");
    }
    succeeds(&usar(folder, "report short"));
    let table = read(&folder.join("short/plots/rescuees-over-time.csv"));
    assert!(table.starts_with("metric,policy,time_s,n,"), "{table}");
}
