//! Sight with errors: rescuees at wrong places, twice, or where nobody is; and who finds it out.

use scenario::Scenario;
use usar_sim::record::TrialRecord;
use usar_sim::simulation::Simulation;

use crate::support::{policy, root};

/// The tunnel for 600 s, with these errors of all robots' sight, and these sections.
fn tunnel(sight: &str, sections: &str) -> Scenario {
    let text = std::fs::read_to_string(root().join("scenarios/trust/tunnel.ron")).unwrap();
    let text = text.replace("duration_s: 1800.0,", &format!("duration_s: 600.0, {sections}"));
    let text = text.replace("observing_m:", &format!("{sight} observing_m:"));
    Scenario::parse(&text, "tunnel.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// A checked trial, the same from a snapshot in its middle.
fn run(scenario: &Scenario, seed: u64) -> TrialRecord {
    let mut session = policy("HP_DIS");
    let whole = Simulation::new(scenario, seed).unwrap().checked().run(&mut *session, |_, _, _| {});
    assert_eq!(whole.status.name(), "completed", "{:?}", whole.status);
    let mut trial = Simulation::new(scenario, seed).unwrap();
    while trial.time_s() < 120.0 {
        assert_eq!(trial.step(&mut *session), None);
    }
    let again = Simulation::restore(scenario, &trial.snapshot("HP_DIS")).unwrap();
    assert_eq!(again.run(&mut *session, |_, _, _| {}).state_hash, whole.state_hash);
    whole
}

fn rescued(record: &TrialRecord) -> u32 {
    record.tasks.iter().map(|task| task.totals.rescued).sum()
}

#[test]
fn who_sees_badly_still_finds_people_and_who_sees_ghosts_walks_in_vain() {
    let exact = run(&tunnel("", ""), 1);
    let noisy = run(&tunnel("sight: (noise_m: 1),", ""), 1);
    let blind = run(&tunnel("sight: (miss: 1),", ""), 1);
    let haunted = run(&tunnel("sight: (false_alarms_per_min: 6),", ""), 1);
    assert_eq!((exact.finds.doubles, exact.finds.ghosts_visited, haunted.finds.doubles), (0, 0, 0));
    println!("{:?}", [&exact, &noisy, &blind, &haunted].map(|it| (rescued(it), it.finds)));
    assert!(rescued(&noisy) > rescued(&exact) / 2, "{} {}", rescued(&noisy), rescued(&exact));
    assert!(noisy.finds.doubles > 0, "{:?}", noisy.finds);
    assert!(haunted.finds.ghosts_visited > 5, "{:?}", haunted.finds);
    assert!(rescued(&blind) < rescued(&exact), "who overlooks all sees none");
}
