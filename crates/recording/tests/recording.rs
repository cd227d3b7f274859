//! Recordings of whole trials: read back, truncated, damaged.

use std::path::Path;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use recording::{Options, ReadError, Recorder, Recording, record};
use scenario::{Measure, Scenario};
use teaming::{Session, TaskId};
use usar_sim::mission::Activity;
use usar_sim::simulation::Simulation;
use usar_sim::world::RescueeState;

fn scenario(file: &str, duration_s: f64) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(file);
    let (scenario, _) = Scenario::load(&path).unwrap();
    let mut file = (*scenario).clone();
    file.duration_s = duration_s;
    Scenario::try_from(file).unwrap()
}

fn policy(name: &str) -> Box<dyn Session> {
    policies::standard().open(name).unwrap()
}

fn recorded(file: &str, duration_s: f64) -> Vec<u8> {
    let simulation = Simulation::new(&scenario(file, duration_s), 3).unwrap();
    let mut bytes = Vec::new();
    record(
        simulation,
        &mut *policy("RNE"),
        &Options::new("RNE", policies::standard().measure("RNE").ok()),
        &mut bytes,
    )
    .unwrap();
    bytes
}

/// Compares a frame with the simulation: numbers within their quantisation, everything else exactly.
fn assert_is_now(recording: &Recording, number: usize, now: &Simulation) {
    let frame = recording.frame(number).unwrap();
    assert_eq!(frame.step, now.steps());
    let near = |kept: i32, value: f64, what: &str| {
        assert!(
            (f64::from(kept) / 1000.0 - value).abs() <= 0.000_501,
            "{what} at {}: {kept}, {value}",
            frame.step
        );
    };
    let codes = &recording.header.codes;
    for (kept, robot) in frame.robots.iter().zip(&now.world().robots) {
        near(kept.motion.position_mm[0], robot.position.x.into(), "x");
        near(kept.motion.position_mm[1], robot.position.y.into(), "y");
        near(kept.motion.velocity_mm_s[0], robot.velocity.x.into(), "vx");
        near(kept.motion.velocity_mm_s[1], robot.velocity.y.into(), "vy");
        near(kept.motion.energy_millipercent, robot.energy, "energy");
        near(kept.motion.hp_millipercent, robot.hp, "hp");
        let (agent, delay) = (&now.mission().crew.agents[robot.id.index()], now.delay(robot.id));
        let activity = format!("{:?}", agent.activity).to_lowercase();
        let name = codes.activities[usize::from(kept.state.activity)].replace('_', "");
        assert!(activity.starts_with(&name), "{activity} {name}");
        assert_eq!(kept.state.rescuee, agent.activity.claim().map(|rescuee| rescuee.0));
        if let Activity::Loading(_, until) | Activity::Resting(until) = agent.activity {
            assert_eq!(kept.state.until_step.map(u64::from), Some(until));
        }
        assert_eq!(codes.delays[usize::from(kept.state.delay)], delay.cause.name());
        assert_eq!(kept.state.waits_for, delay.waits_for.map(|robot| robot.0));
        assert_eq!(kept.state.task, agent.task.map(|task| u32::from(task.0)));
        assert_eq!(kept.state.resources, robot.resources);
        assert_eq!(kept.state.load as usize, robot.load.len());
        assert_eq!(kept.state.condition == 0, robot.is_able());
        let traveller = now.navigator().traveller(robot.id);
        let ahead = traveller.route().map_or(&[][..], |route| route.ahead());
        assert_eq!(
            (kept.route.goal_mm.is_some(), kept.route.ahead_mm.len()),
            (traveller.goal().is_some(), ahead.len())
        );
        for (kept, at) in kept.route.ahead_mm.iter().zip(ahead) {
            near(kept[0], at.x.into(), "route x");
            near(kept[1], at.y.into(), "route y");
        }
    }
    for (kept, rescuee) in frame.rescuees.iter().zip(now.world().rescuees.iter()) {
        let (state, robot) = match rescuee.state {
            RescueeState::Waiting => match now.mission().claims.by(rescuee.id) {
                None => ("waiting", None),
                by => ("claimed", by),
            },
            RescueeState::OnBoard(robot) => ("on_board", Some(robot)),
            RescueeState::Rescued => ("delivered", None),
            RescueeState::Absent => ("absent", None),
        };
        assert_eq!(codes.rescuees[usize::from(kept.state)], state);
        assert_eq!(kept.robot, robot.map(|robot| robot.0));
    }
    for (kept, piece) in frame.debris.iter().zip(&now.world().debris) {
        near(kept.position_mm[0], piece.pose.translation.x.into(), "debris x");
        near(kept.position_mm[1], piece.pose.translation.y.into(), "debris y");
        assert_eq!(kept.sightings as usize, piece.sightings.len());
    }
    let tasks = (0..now.mission().crew.groups.len() as u16).map(TaskId);
    let known = tasks.map(Some).chain([None]).map(|group| now.beliefs_of(group).next().unwrap());
    assert_eq!(frame.groups.len(), now.mission().crew.groups.len() + 1);
    for (kept, known) in frame.groups.iter().zip(known) {
        assert!(
            kept.debris.iter().map(|(number, _)| *number).eq(known.debris.iter().map(|(number, _)| number))
        );
        for (number, sighting) in &kept.debris {
            let seen = &now.world().debris[*number as usize].sightings[*sighting as usize - 1];
            assert_eq!(*seen, known.debris.get(*number as usize).unwrap().pose);
        }
        assert!(kept.zones.iter().eq(known.zones_on().iter().map(|(number, _)| number)));
    }
    let sets: Vec<Vec<u32>> =
        now.conflict_sets().map(|set| set.iter().map(|id| *id as u32).collect()).collect();
    assert_eq!(frame.conflict_sets, sets);
}

#[test]
fn a_recording_is_the_trial_at_a_hundred_random_times_and_changes_no_result() {
    for (file, duration_s) in [("paper.ron", 300.0), ("three-tasks.ron", 200.0)] {
        let scenario = scenario(file, duration_s);
        let mut policy = policy("RNE");
        let alone = Simulation::new(&scenario, 3).unwrap().run(&mut *policy, |_, _, _| {});
        let mut bytes = Vec::new();
        let simulation = Simulation::new(&scenario, 3).unwrap();
        let whole = record(
            simulation,
            &mut *policy,
            &Options::new("RNE", policies::standard().measure("RNE").ok()),
            &mut bytes,
        )
        .unwrap();
        assert_eq!(alone, whole, "{file}: recording changed the trial");

        let mut again = Vec::new();
        let simulation = Simulation::new(&scenario, 3).unwrap();
        record(
            simulation,
            &mut *policy,
            &Options::new("RNE", policies::standard().measure("RNE").ok()),
            &mut again,
        )
        .unwrap();
        assert!(again == bytes, "{file}: one trial, one recording");

        let recording = Recording::read(&bytes).unwrap();
        assert_eq!(recording.cut, None);
        assert_eq!(recording.frames(), 1 + (duration_s * 10.0) as usize);
        let mut draws = ChaCha8Rng::seed_from_u64(1);
        let mut chosen: Vec<usize> = (0..98).map(|_| draws.random_range(0..recording.frames())).collect();
        chosen.extend([0, recording.frames() - 1]);
        let mut now = Simulation::new(&scenario, 3).unwrap();
        let mut events = Vec::new();
        for number in 0..recording.frames() {
            if chosen.contains(&number) {
                assert_is_now(&recording, number, &now);
            }
            for _ in 0..recording.header.steps_per_frame {
                if now.step(&mut *policy).is_none() {
                    events.extend(now.events().iter().map(|event| (now.steps(), event.clone())));
                }
            }
        }
        assert_eq!(recording.events, events);
        let decisions = recording.decisions.iter().zip(&whole.decisions);
        assert_eq!(recording.decisions.len(), whole.decisions.len());
        for (kept, decided) in decisions {
            assert_eq!((&kept.question, &kept.decision), (&decided.question, &decided.decision));
            let trust = kept.trust.as_ref().unwrap();
            assert_eq!(trust.members.len(), kept.question.members.len());
            assert!((0..trust.members.len()).all(|i| trust.robots[i][i] == Some(0.0)));
        }
        let summary = recording.summary.unwrap();
        assert_eq!((summary.state_hash, summary.rounds), (whole.state_hash, whole.rounds));
    }
}

#[test]
fn a_recording_can_begin_in_the_middle_and_have_any_rate() {
    let scenario = scenario("minimal/head_on.ron", 20.0);
    let mut policy = policy("RNE");
    for fps in [1000.0, 7.0, 0.5] {
        let mut simulation = Simulation::new(&scenario, 1).unwrap();
        (0..37).for_each(|_| drop(simulation.step(&mut *policy)));
        let options = Options { fps, ..Options::new("RNE", policies::standard().measure("RNE").ok()) };
        let mut recorder = Recorder::begin(Vec::new(), &simulation, &options).unwrap();
        while simulation.step(&mut *policy).is_none() {
            recorder.listen(&simulation).unwrap();
        }
        let end = simulation.steps();
        let bytes = recorder.finish(&mut simulation.finish()).unwrap();
        let recording = Recording::read(&bytes).unwrap();
        let (first, every) = (recording.header.first_step, recording.header.steps_per_frame);
        assert_eq!((first, recording.frames() as u64), (37, (end - 37) / every + 1), "{fps}");
        assert_eq!(recording.frame_at(0.0), 0);
        assert_eq!(recording.frame_at(1e9), recording.frames() - 1);
    }
}

#[test]
fn a_recording_that_was_cut_gives_its_whole_chunks() {
    let bytes = recorded("paper.ron", 60.0);
    let whole = Recording::read(&bytes).unwrap();
    let mut most = 0;
    for length in (1..bytes.len()).step_by(97).chain([1, 7, 8, 9, 27, 28, bytes.len() - 1]) {
        match Recording::read(&bytes[..length]) {
            Ok(cut) => {
                assert!(cut.cut.is_some() && cut.summary.is_none());
                assert!(cut.frames() <= whole.frames());
                for number in (0..cut.frames()).step_by(50) {
                    assert_eq!(cut.frame(number), whole.frame(number));
                }
                most = most.max(cut.frames());
            }
            Err(ReadError::NoHeader { bytes }) => assert_eq!(bytes, length),
            Err(error) => panic!("cut at {length}: {error}"),
        }
    }
    assert!(most >= whole.frames() - 1, "{most} of {}", whole.frames());
    assert_eq!(Recording::read(&[]), Err(ReadError::NotARecording));
}

#[test]
fn flipped_bytes_are_found() {
    let bytes = recorded("paper.ron", 30.0);
    for at in (0..bytes.len()).step_by(31).chain(0..40) {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        let message = Recording::read(&flipped).expect_err("a flipped byte").to_string();
        assert!(
            message.contains("is not a recording") || message.contains("is damaged: chunk"),
            "{at}: {message}"
        );
    }
}

#[test]
fn a_whole_trial_of_the_paper_is_small() {
    let bytes = recorded("paper.ron", 600.0);
    assert!(bytes.len() < 2_000_000, "{} bytes", bytes.len());
    println!("{} bytes", bytes.len());
}

/// A robot whose row has a body of its own reports its needs with that body and not with its role's.
#[test]
fn a_body_of_its_own_is_what_a_robot_is_described_with() {
    let simulation = Simulation::new(&scenario("gallery/chance.ron", 2.0), 3).unwrap();
    let bodies = simulation.scenario().bodies();
    let bodies: Vec<_> = bodies.flat_map(|(body, count)| std::iter::repeat_n(body, count as usize)).collect();
    let mut bytes = Vec::new();
    record(
        simulation,
        &mut *policy("RNE"),
        &Options::new("RNE", policies::standard().measure("RNE").ok()),
        &mut bytes,
    )
    .unwrap();
    let recording = Recording::read(&bytes).unwrap();
    let (world, frame) = (&recording.header.world, recording.frame(0).unwrap());
    let speed = world.needs.iter().position(|need| need.measures == Measure::Speed).unwrap();
    let mut with_their_own = 0;
    for (robot, body) in bodies.iter().enumerate() {
        assert_eq!(world.body_of(robot), body);
        with_their_own += u32::from(world.roles[world.robots[robot].role] != *body);
        let reported = world.needs_of(robot, &frame.robots[robot])[speed];
        let factor = reported / body.speed_mps;
        assert!(
            (world.health_floor..=1.0).contains(&factor),
            "robot {robot}: {reported} of {}",
            body.speed_mps
        );
    }
    assert!(with_their_own > 0, "the scenario has suppliers with speeds of their own");
}
