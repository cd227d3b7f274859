//! Stories of timelines: events happen, robots notice them, and a trial resumes from a snapshot bit for bit.

use scenario::Scenario;
use usar_sim::event::Event;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;

use crate::scenario;

const WORLD: &str = r#"
    duration_s: 120, arena_m: (40, 40), mission: (ends: AtDuration),
    team: [(role: "robot", count: 4, center: (20, 5), width_m: 6, body: (observing_m: 5, sensing_m: 14))],
    tasks: [
        (name: "far", difficulty: 2, center: (10, 34), size_m: (4, 2), grid: (3, 2), rest: (8, 12)),
        (name: "near", difficulty: 1, center: (30, 34), size_m: (4, 2), grid: (3, 2), rest: (32, 12)),
    ],
    walls: [(from: (0, 22), to: (40, 22),
             doors: [(at_m: 10, width_m: 3, name: "west"), (at_m: 30, width_m: 3)])],
    radiation: [(at: (20, 16), radius_m: 2, name: "core")],
"#;

/// A checked trial of the world with a timeline, at its end, and the events of its timeline.
fn trial(timeline: &str) -> (Scenario, Vec<(f64, Event)>, Simulation) {
    let scenario = scenario(&format!("{WORLD} timeline: [{timeline}]"));
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
    let mut heard = Vec::new();
    let mut status = None;
    while status.is_none() {
        status = trial.step(&mut *policy);
        heard.extend(trial.events().iter().map(|event| (trial.time_s(), event.clone())));
    }
    assert_eq!(status, Some(Status::Completed));
    (scenario, heard, trial)
}

fn when(heard: &[(f64, Event)], is_it: impl Fn(&Event) -> bool) -> Vec<f64> {
    heard.iter().filter(|(_, event)| is_it(event)).map(|(time_s, _)| *time_s).collect()
}

#[test]
fn everything_happens_at_its_time() {
    let (_, heard, trial) = trial(
        r#"(at_s: 10, event: DebrisFalls(shape: Disc(1), at: (20, 30), name: "rock")),
           (at_s: 60, event: Opens("rock")),
           (at_s: 12, event: SourceAppears(at: (33, 26), radius_m: 2)), (at_s: 14, event: SourceDies("core")),
           (at_s: 16, event: RobotFails(3)), (at_s: 17, event: RobotLoses(robot: 1, energy: 20, hp: 5)),
           (at_s: 20, event: RescueesAppear(task: "near", grid: (2, 1))),
           (at_s: 90, event: TaskEnds("far"))"#,
    );
    for (at_s, is_it) in [
        (10.0, (|event| matches!(event, Event::DebrisFell { .. })) as fn(&Event) -> bool),
        (60.0, |event| matches!(event, Event::WayOpened { .. })),
        (12.0, |event| matches!(event, Event::SourceAppeared { zone: 1 })),
        (14.0, |event| matches!(event, Event::SourceDied { zone: 0 })),
        (16.0, |event| matches!(event, Event::Disabled { .. })),
        (17.0, |event| matches!(event, Event::Damaged { robot, .. } if robot.0 == 1)),
        (20.0, |event| matches!(event, Event::RescueesAppeared { count: 2, .. })),
        (90.0, |event| matches!(event, Event::TaskEnded { .. })),
    ] {
        let times = when(&heard, is_it);
        assert!(times.len() == 1 && (times[0] - at_s).abs() < 0.05, "{at_s}: {times:?}");
    }
    assert_eq!(trial.world().rescuees.len(), 14);
    assert!(!trial.world().robots[3].is_able());
}

#[test]
fn a_closed_door_is_seen_and_gone_round_and_its_opening_is_noticed() {
    let closed = r#"(at_s: 1, event: Closes("west"))"#;
    let (_, heard, _) = trial(closed);
    let closed_at = when(&heard, |event| matches!(event, Event::WayClosed { .. }));
    let rescued = |heard: &[(f64, Event)]| when(heard, |event| matches!(event, Event::Loaded { .. })).len();
    assert_eq!(closed_at.len(), 1);
    let with_it = rescued(&heard);
    let (_, heard, trial) = trial(&format!(r#"{closed}, (at_s: 40, event: Opens("west"))"#));
    assert!(rescued(&heard) >= with_it && with_it > 0, "{} and {with_it}", rescued(&heard));
    let door = trial.model().gates[0];
    let noticed = when(
        &heard,
        |event| matches!(event, Event::DebrisDiscovered { debris, .. } if *debris as usize == door),
    );
    assert!(
        noticed.iter().any(|time_s| *time_s < 40.0) && noticed.iter().any(|time_s| *time_s > 40.0),
        "{noticed:?}"
    );
}

#[test]
fn nothing_falls_on_a_robot() {
    // Robots pass the door all the time. It closes when no robot is in it.
    let timeline: Vec<String> = (1..40)
        .map(|i| {
            format!(
                r#"(at_s: {}, event: {}("west"))"#,
                4 + 2 * i,
                if i % 2 == 1 { "Closes" } else { "Opens" }
            )
        })
        .collect();
    let (_, heard, trial) = trial(&timeline.join(", "));
    assert!(when(&heard, |event| matches!(event, Event::WayClosed { .. })).len() > 10);
    assert!(trial.overlaps().unwrap().deepest_m < 0.05);
}

#[test]
fn a_task_that_begins_later_gets_robots_then_and_none_after_its_end() {
    let (_, heard, _) = trial(r#"(at_s: 40, event: TaskBegins("far")), (at_s: 80, event: TaskEnds("far"))"#);
    for (time_s, event) in &heard {
        if let Event::RoundStarted { groups, .. } = event {
            let is_open = (40.0..80.0).contains(time_s);
            assert_eq!(!groups[0].is_empty(), is_open, "{time_s}: {groups:?}");
        }
        if let Event::Loaded { rescuee, .. } = event {
            assert!(rescuee.0 >= 6 || *time_s >= 40.0, "rescuee {rescuee} at {time_s} s");
        }
    }
}

#[test]
fn a_trial_goes_on_bit_for_bit_from_before_and_after_each_event() {
    let (scenario, _, whole) = trial(
        r#"(at_s: 10, event: DebrisFalls(shape: Box(3, 1), at: (11, 25), name: "slab")),
           (at_s: 20, event: Closes("west")), (at_s: 30, event: SourceDies("core")),
           (at_s: 35, event: RobotLoses(robot: 2, energy: 95)), (at_s: 50, event: Opens("slab")),
           (at_s: 52, event: Opens("west")), (at_s: 60, event: TaskEnds("far"))"#,
    );
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    let moments: Vec<f64> =
        scenario.timeline.iter().flat_map(|moment| [-0.02, 0.0, 0.02].map(|by| moment.at_s + by)).collect();
    let digest = whole.finish().state_hash;
    for at_s in moments {
        while trial.time_s() < at_s - 1e-9 {
            assert_eq!(trial.step(&mut *policy), None);
        }
        let bytes = trial.snapshot("RNE");
        let mut again = Simulation::restore(&scenario, &bytes).unwrap().checked();
        while again.step(&mut *policy).is_none() {}
        assert_eq!(again.finish().state_hash, digest, "from {at_s} s");
    }
}

#[test]
fn what_waits_to_close_is_called_off_when_its_way_is_to_open() {
    // A robot stands in the door at 10 s, so that the door cannot close.
    let story = |events: &str| {
        let text = format!(
            r#"(name: "gate", duration_s: 40, dt_s: 0.02, arena_m: (40, 40),
            team: [(role: "robot", count: 1, center: (20, 20), width_m: 0)],
            errands: [(robot: 0, to: [(20, 30)])],
            walls: [(from: (0, 20.5), to: (40, 20.5), doors: [(at_m: 20, width_m: 3, name: "gate")])],
            timeline: [{events}])"#
        );
        let scenario = Scenario::parse(&text, "gate.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
        let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
        let mut policy = policies::standard().open("RANDOM").unwrap();
        let mut heard = Vec::new();
        while trial.step(&mut *policy).is_none() {
            heard.extend(trial.events().iter().cloned());
        }
        let ways = |event: &Event| match event {
            Event::WayClosed { .. } => Some("closed"),
            Event::WayOpened { .. } => Some("opened"),
            Event::CalledOff { .. } => Some("called off"),
            _ => None,
        };
        heard.iter().filter_map(ways).collect::<Vec<_>>()
    };
    assert_eq!(
        story(r#"(at_s: 0, event: Closes("gate")), (at_s: 0.02, event: Opens("gate"))"#),
        ["called off"]
    );
    assert_eq!(story(r#"(at_s: 0, event: Closes("gate"))"#), ["closed"]);
    let twice = r#"(at_s: 0, event: Closes("gate")), (at_s: 0, event: Opens("gate")),
        (at_s: 0, event: Closes("gate"))"#;
    assert_eq!(story(twice), ["called off", "closed"]);
}

#[test]
fn two_events_of_one_thing_in_a_step_are_no_violation() {
    let (_, heard, _) = trial(
        r#"(at_s: 10, event: SourceAppears(at: (33, 26), radius_m: 2, name: "s")),
           (at_s: 10, event: SourceDies("s")),
           (at_s: 10, event: DebrisFalls(shape: Disc(1), at: (20, 30), name: "x")),
           (at_s: 10, event: Opens("x"))"#,
    );
    assert_eq!(when(&heard, |event| matches!(event, Event::WayOpened { .. })).len(), 1);
}
