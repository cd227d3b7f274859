//! `sensitivity` and `search`: their results, their interruptions, and their refusals.

use crate::support::{read, refuses as refused, succeeds, two_minutes as place, usar};

const RADIUS: &str = "radiation[*].radius_m=3..9";

fn sensitivity<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments =
        vec!["study", "sensitivity", "short.ron", "--policies", "RNE,DIS", "--trials", "1", "--quiet"];
    arguments.extend(["--metric", "distance", "--baseline", "DIS", "--out", out]);
    arguments.extend(["--set", "duration_s=40", "--over", "mission.loading_s=1..20", "--over", RADIUS]);
    arguments.extend(more);
    arguments
}

#[test]
fn a_study_that_was_broken_off_ends_as_one_that_was_not() {
    let place = place();
    let folder = place.path();
    for (method, count, less, more) in
        [("morris", "--trajectories", "2", "4"), ("sobol", "--samples", "2", "3")]
    {
        let [whole, parts] = ["whole", "parts"].map(|name| format!("{name}-{method}"));
        let run = |out: &str, count_of: &str, jobs: &str| {
            let mut more = vec!["--method", method, count, count_of, "--jobs"];
            more.extend(jobs.split(' '));
            succeeds(&usar(folder, &sensitivity(out, &more)))
        };
        let told = run(&whole, more, "1");
        run(&parts, less, "2");
        let log = folder.join(&parts).join("evaluations.jsonl");
        let text = read(&log);
        std::fs::write(&log, &text[..text.len() - 5]).unwrap(); // killed while it wrote a line
        assert_eq!(run(&parts, more, "2"), told);
        for file in ["evaluations.jsonl", "indices.csv", "indices.svg", "sensitivity.json"] {
            assert_eq!(
                read(&folder.join(&parts).join(file)),
                read(&folder.join(&whole).join(file)),
                "{file}"
            );
        }
        for outcome in ["RNE: distance", "DIS: distance", "RNE - DIS: distance"] {
            assert!(told.contains(outcome), "{told}");
        }
        assert!(told.contains("chance (other seeds)") && !told.contains("NaN"), "{told}");
        let table = run(&whole, more, "1 --format csv");
        assert!(table.starts_with("parameter,"), "{table}");
    }
    let other = usar(folder, &sensitivity("whole-sobol", &["--method", "sobol", "--draw-seed", "2"]));
    refused(&other, &["has the sensitivity study of something else", "seed: 1 there, 2 now"]);
}

#[test]
fn a_search_says_what_fresh_seeds_say() {
    let place = place();
    let folder = place.path();
    let search = |more: &[&str]| {
        let mut arguments =
            vec!["search", "short.ron", "--policy", "RNE", "--against", "DIS", "--trials", "1"];
        arguments.extend(["--set", "duration_s=40", "--quiet", "--out", "found"]);
        arguments.extend(["--over", "mission.loading_s=1..20", "--over", RADIUS]);
        arguments.extend(["--evaluations", "6", "--confirm-trials", "3"]);
        arguments.extend(more);
        usar(folder, &arguments)
    };
    let told = succeeds(&search(&[]));
    assert!(told.contains("on the 1 seeds of the search (400001 to 400001)"), "{told}");
    assert!(told.contains("Run again on 3 fresh seeds (500001 to 500003)"), "{told}");
    let log = read(&folder.join("found/evaluations.jsonl"));
    assert_eq!(succeeds(&search(&[])), told, "what is there is not run again");
    assert_eq!(read(&folder.join("found/evaluations.jsonl")), log);
    succeeds(&usar(folder, "check found/found.ron"));
    succeeds(&usar(folder, "compare found/confirmation"));
    refused(&search(&["--confirm-seed", "400001"]), &["the seeds that confirm must be others"]);
    refused(&search(&["--metric", "distance"]), &["distance is neither good nor bad; --lowest or --highest"]);
}

#[test]
fn what_cannot_vary_is_refused() {
    let place = place();
    let folder = place.path();
    for (over, says) in [
        ("mission.rest=0..60", "--over: mission.rest is no field"),
        ("radiation[0].radius_m=3..9", "radiation[0].radius_m: is set by two parameters"),
        ("duration_s=-5..60", "--over: duration_s"),
        ("team=1..2", "is not a number but has parts"),
    ] {
        let output = usar(folder, &sensitivity("none", &["--over", over]));
        refused(&output, &[says]);
        assert!(!folder.join("none").exists(), "nothing is written");
    }
}
