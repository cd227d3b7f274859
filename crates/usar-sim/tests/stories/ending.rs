//! A mission ends when nobody is left to bring home.

use usar_sim::event::Event;
use usar_sim::record::{Status, TrialRecord};

use super::{scenario, trial};

/// Four robots and eight people, and a timeline.
fn told(mission: &str, timeline: &str) -> (TrialRecord, Vec<(f64, Event)>) {
    let world = r#"duration_s: 300, arena_m: (40, 40),
        team: [(role: "robot", count: 4, center: (20, 5), width_m: 6, body: (observing_m: 5, sensing_m: 14))],
        tasks: [
            (name: "far", difficulty: 2, center: (10, 34), size_m: (4, 2), grid: (2, 2), rest: (8, 12)),
            (name: "near", difficulty: 1, center: (30, 34), size_m: (4, 2), grid: (2, 2), rest: (32, 12)),
        ]"#;
    let mut told = Vec::new();
    let scenario = scenario(&format!("{world}, mission: ({mission}), timeline: [{timeline}]"));
    let record = trial(&scenario, |time_s, events, _| {
        told.extend(events.iter().map(|event| (time_s, event.clone())));
    });
    (record, told)
}

fn rounds(told: &[(f64, Event)]) -> usize {
    told.iter().filter(|(_, event)| matches!(event, Event::RoundStarted { .. })).count()
}

#[test]
fn no_round_opens_when_everybody_is_home_and_the_trial_ends() {
    let (record, told) = told("", "");
    assert_eq!((&record.status, record.rescued(), record.people), (&Status::Finished, 8, 8));
    assert_eq!((rounds(&told), record.completed_rounds), (2, 2));
    let last = *record.delivered_s.last().unwrap();
    let began = told.iter().rfind(|(_, event)| matches!(event, Event::RoundStarted { .. })).unwrap().0;
    assert!(began < last, "the last round brought somebody home");
    assert!(record.time_s < 150.0 && matches!(told.last(), Some((_, Event::Finished))), "{}", record.time_s);
    assert!(last <= record.time_s && record.time_to_share_s(1.0) == Some(last));
    assert!(record.time_to_share_s(0.5).unwrap() <= last);
    let (half, _) = self::told("", r#"(at_s: 5, event: TaskEnds("far"))"#);
    assert_eq!((half.rescued(), half.time_to_share_s(0.5)), (4, half.delivered_s.last().copied()));
    assert_eq!(half.time_to_share_s(0.9), None, "what never came has no time");
}

#[test]
fn at_duration_the_trial_goes_on_as_it_did_before() {
    let ((ended, early), (whole, late)) = (told("", ""), told("ends: AtDuration", ""));
    assert_eq!(whole.status, Status::Completed);
    assert!((whole.time_s - 300.0).abs() < 1e-9 && rounds(&late) > 1);
    assert_eq!(early[..early.len() - 1], late[..early.len() - 1], "it is the same trial up to its end");
    assert!(whole.energy() > 1.5 * ended.energy());
}

#[test]
fn a_mission_waits_for_what_is_to_come() {
    let (record, told) = told("", r#"(at_s: 120, event: RescueesAppear(task: "far", grid: (2, 1)))"#);
    assert_eq!((&record.status, record.rescued()), (&Status::Finished, 10));
    assert!(record.time_s > 120.0 && rounds(&told) > 1);
}

#[test]
fn who_is_off_to_rest_comes_home_before_the_end_and_its_costs_count() {
    let (record, told) = told("round_end: WithoutResting, energy_threshold: 90, rest_s: 60", "");
    assert_eq!((&record.status, record.rescued()), (&Status::Finished, 8));
    let last = |is_it: fn(&Event) -> bool| told.iter().rfind(|(_, event)| is_it(event)).unwrap().0;
    let ended = last(|event| matches!(event, Event::RoundEnded { .. }));
    let rested = last(|event| matches!(event, Event::RestEnded { .. }));
    assert!(ended < rested && rested < record.time_s, "{ended} {rested} {}", record.time_s);
    assert!(last(|event| matches!(event, Event::RoundStarted { .. })) < ended, "no other round began");
    assert!(record.ungrouped_energy > 0.0, "the way home is of no group");
}
