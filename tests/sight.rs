//! Sight with errors: rescuees at wrong places, twice, or where nobody is; and who finds it out.

use scenario::Scenario;
use usar_sim::record::TrialRecord;
use usar_sim::simulation::Simulation;

use crate::support::{policy, root};

/// A world of trust for 600 s, with these errors of all robots' sight, and these sections.
fn world(name: &str, sight: &str, sections: &str) -> Scenario {
    let text = std::fs::read_to_string(root().join(format!("scenarios/trust/{name}.ron"))).unwrap();
    let text = text.replace("duration_s: 1800.0,", &format!("duration_s: 600.0, {sections}"));
    let text = text.replace("observing_m:", &format!("{sight} observing_m:"));
    Scenario::parse(&text, name.as_ref()).unwrap_or_else(|error| panic!("{error}"))
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
    let exact = run(&world("tunnel", "", ""), 1);
    let noisy = run(&world("tunnel", "sight: (noise_m: 1),", ""), 1);
    let blind = run(&world("tunnel", "sight: (miss: 1),", ""), 1);
    let haunted = run(&world("tunnel", "sight: (false_alarms_per_min: 6),", ""), 1);
    assert_eq!((exact.finds.doubles, exact.finds.ghosts_visited, haunted.finds.doubles), (0, 0, 0));
    assert!(rescued(&noisy) > rescued(&exact) / 2, "{} {}", rescued(&noisy), rescued(&exact));
    assert!(noisy.finds.doubles > 0, "{:?}", noisy.finds);
    assert!(haunted.finds.ghosts_visited > 5, "{:?}", haunted.finds);
    assert!(rescued(&blind) < rescued(&exact), "who overlooks all sees none");
}

/// A world whose group-mates hear by a radio with these properties, and these lies.
fn by_radio(name: &str, medium: &str, deceit: &str) -> Scenario {
    let sections = format!("medium: ({medium}), deceit: [{deceit}],");
    let path = root().join(format!("scenarios/trust/{name}.ron"));
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replace("mission: (", &format!("{sections} mission: (belief_sharing: ByRadio, "));
    Scenario::parse(&text, &path).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn each_message_costs_its_sender_what_the_scenario_says() {
    let paid = run(&by_radio("tunnel", "energy_per_message: 0.05", ""), 1);
    let beyond_the_way: f64 =
        paid.robots.iter().map(|robot| robot.energy_spent - 0.08 * robot.distance_m).sum();
    let sent: u64 = paid.heard.as_ref().unwrap().links.iter().map(|link| link.sent).sum();
    let paid_for = beyond_the_way / 0.05;
    // At rest places nothing is paid, and the distances are of the velocities before each step.
    assert!(
        sent > 1_000 && paid_for < 1.02 * sent as f64 && paid_for > 0.9 * sent as f64,
        "{paid_for} {sent}"
    );
}

#[test]
fn misplaced_things_are_found_out_and_cost_people() {
    let of = |lies: &str| -> Vec<TrialRecord> {
        (1..=3).map(|seed| run(&by_radio("tunnel", "range_m: 40", lies), seed)).collect()
    };
    let [honest, misplaced] = ["", "(who: Count(6), lie: Misplace(by_m: 5))"].map(of);
    let all = |records: &[TrialRecord]| records.iter().map(rescued).sum::<u32>();
    assert!(all(&misplaced) < all(&honest), "{} {}", all(&misplaced), all(&honest));
    let ghosts = |records: &[TrialRecord]| records.iter().map(|it| it.finds.ghosts_visited).sum::<u32>();
    assert!(ghosts(&misplaced) > 0 && ghosts(&honest) == 0, "{} {}", ghosts(&misplaced), ghosts(&honest));
    assert!(misplaced.iter().all(|record| record.completed_rounds > 0), "robots get home again");
}

/// How often, over all steps, a belief in the field has a wreck.
fn wrecks_known(deceit: &str) -> usize {
    let (scenario, mut session) = (by_radio("flood", "", deceit), policy("HP_DIS"));
    let mut trial = Simulation::new(&scenario, 6).unwrap();
    let mut known = 0;
    while trial.step(&mut *session).is_none() {
        let groups = trial.model().task_ids().flat_map(|task| trial.beliefs_of(Some(task)));
        known += groups.map(|belief| belief.wrecks.iter().count()).sum::<usize>();
    }
    known
}

#[test]
fn hidden_wrecks_are_known_to_fewer_mates() {
    let (honest, hidden) = (wrecks_known(""), wrecks_known("(who: Share(1), lie: HideMate)"));
    assert!(hidden < honest && hidden > 0, "{hidden} {honest}");
}
