//! One seed, one result, bit for bit: the promises of `docs/determinism.md` that one process can test. Those
//! about processes, threads and surroundings are tested at the command line.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::{Experiment, Overrides};
use experiments::run::{Limits, Run, TrialKey, run_all};
use parry2d::math::Vector;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::Scenario;
use teaming::{Asked, Question, Session};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{Advance, Ask, AssignError, Simulation};
use usar_sim::snapshot::Identity;
use xtask::golden::{self, Goldens};

use crate::support::{self, paper, paper_with, policy};

/// A record that may be compared: no failed trial is as good as another.
fn sound(record: TrialRecord) -> TrialRecord {
    assert_eq!(record.status, Status::Completed);
    record
}

/// Runs a trial and restores it from its own snapshot wherever `when` says so.
fn restored(scenario: &Scenario, policy: &mut dyn Session, mut when: impl FnMut(u64) -> bool) -> TrialRecord {
    let mut trial = Simulation::new(scenario, 1).unwrap();
    while trial.step(&mut *policy).is_none() {
        if when(trial.steps()) {
            trial = Simulation::restore(scenario, &trial.snapshot("RNE")).unwrap();
        }
    }
    sound(trial.finish())
}

#[test]
fn a_trial_restored_at_every_step_of_1200_ends_as_if_it_had_not_been() {
    let scenario = paper_with(&[("duration_s: 600.0", "duration_s: 24.0")]);
    let mut policy = policy("RNE");
    let whole = restored(&scenario, &mut *policy, |_| false);
    let pieces = restored(&scenario, &mut *policy, |_| true);
    assert_eq!(whole.chain.links().len(), 3, "after 10, 20 and 24 s");
    assert_eq!(whole, pieces);
}

#[test]
fn a_trial_restored_at_random_steps_ends_as_if_it_had_not_been() {
    let scenario = paper();
    for (seed, name) in ["RANDOM", "RNE"].into_iter().enumerate() {
        let mut policy = policy(name);
        let mut draws = ChaCha8Rng::seed_from_u64(seed as u64);
        let whole = restored(&scenario, &mut *policy, |_| false);
        let pieces = restored(&scenario, &mut *policy, |_| draws.random_range(0..1000_u32) == 0);
        assert_eq!(whole, pieces, "{name}");
    }
}

#[test]
fn a_large_team_has_the_same_bits_on_any_number_of_threads() {
    let scenario = xtask::density::mission(600, 20.0, None);
    let trial = || Simulation::new(&scenario, 1).unwrap();
    let run = |trial: Simulation| trial.run(&mut *policy("ENG"), |_, _, _| {}).chain;
    let one_after_the_other = run(trial());
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let in_parallel = pool.install(|| run(trial().in_parallel()));
        assert_eq!(in_parallel, one_after_the_other, "{threads} threads");
    }
}

#[test]
fn checking_and_listening_change_nothing() {
    let scenario = paper_with(&[("duration_s: 600.0", "duration_s: 60.0")]);
    let mut policy = policy("ENG");
    let trial = || Simulation::new(&scenario, 3).unwrap();
    let mut heard = 0;
    let plain = trial().run(&mut *policy, |_, _, _| {});
    let listened = trial().run(&mut *policy, |_, events, _| heard += events.len());
    let checked = trial().checked().run(&mut *policy, |_, _, _| {});
    assert!(heard > 0);
    assert_eq!(plain.chain, listened.chain);
    assert_eq!(plain.chain, checked.chain);
}

#[test]
fn a_trial_whose_robots_share_nothing_is_restored_as_any_other() {
    let alone = ("    mission: (", "    mission: (belief_sharing: WithNobody,");
    let scenario = paper_with(&[alone, ("duration_s: 600.0", "duration_s: 200.0")]);
    let mut policy = policy("RNE");
    let whole = restored(&scenario, &mut *policy, |_| false);
    let pieces = restored(&scenario, &mut *policy, |step| step % 613 == 0);
    assert_eq!(whole, pieces);
    assert!(whole.rescued() > 0);
}

/// The question that a trial asks now.
#[track_caller]
fn asked(trial: &mut Simulation) -> Question {
    match trial.advance() {
        Advance::Asks(Ask::Grouping(question)) => question.clone(),
        other => panic!("nothing is asked: {other:?}"),
    }
}

/// Runs a trial by hand: `answer` is shown each question in its trial, answers it, and may put another trial
/// in its place.
fn by_hand(scenario: &Scenario, mut answer: impl FnMut(&mut Simulation, Question)) -> TrialRecord {
    let mut trial = Simulation::new(scenario, 1).unwrap();
    loop {
        let question = match trial.advance() {
            Advance::Running => None,
            Advance::Asks(_) => trial.question().cloned(),
            Advance::Over(_) => break,
        };
        question.into_iter().for_each(|question| answer(&mut trial, question));
    }
    sound(trial.finish())
}

/// Long enough for three rounds.
fn three_rounds() -> Scenario {
    paper_with(&[("duration_s: 600.0", "duration_s: 300.0")])
}

fn undisturbed(scenario: &Scenario, name: &str) -> TrialRecord {
    let record = sound(Simulation::new(scenario, 1).unwrap().run(&mut *policy(name), |_, _, _| {}));
    assert!(record.decisions.len() >= 3, "{} decisions", record.decisions.len());
    record
}

#[test]
fn a_trial_restored_whenever_it_asks_ends_as_if_it_had_not_been() {
    let scenario = three_rounds();
    for name in ["RNE", "RANDOM"] {
        let mut policy = policy(name);
        let pieces = by_hand(&scenario, |trial, question| {
            *trial = Simulation::restore(&scenario, &trial.snapshot(name)).unwrap();
            assert_eq!(trial.ending(), None);
            assert_eq!(asked(trial), question, "it asks the same again, history included");
            *trial = Simulation::restore(&scenario, &trial.snapshot(name)).unwrap();
            // Without another advance: a restored trial knows what it asks.
            trial.assign(policy.decide(&Asked::of(&question)).unwrap()).unwrap();
            // Answered, and not gone on yet.
            *trial = Simulation::restore(&scenario, &trial.snapshot(name)).unwrap();
        });
        assert_eq!(pieces, undisturbed(&scenario, name), "{name}");
    }
}

#[test]
fn decisions_by_hand_are_as_good_as_a_policy_s_and_questions_can_be_read_back() {
    let scenario = three_rounds();
    let mut policy = policy("RNE");
    let mut live = Vec::new();
    let record = by_hand(&scenario, |trial, question| {
        let decision = policy.decide(&Asked::of(&question)).unwrap();
        assert_eq!(asked(trial), question, "asking twice changes nothing");
        let mut refused = decision.clone();
        refused.assignment.groups.pop();
        assert!(matches!(trial.assign(refused), Err(AssignError::Refused(_))));
        let mut reversed = decision.clone();
        reversed.assignment.groups.iter_mut().for_each(|group| group.reverse());
        trial.assign(reversed).unwrap();
        assert_eq!(trial.assign(decision), Err(AssignError::NotAsked));
        live.push(question);
    });
    assert_eq!(record, undisturbed(&scenario, "RNE"));
    assert_eq!(record.decisions.len(), live.len());
    for (decision, question) in record.decisions.iter().zip(&live) {
        assert_eq!(question.history.len(), question.round as usize - 1);
        assert_eq!(record.question(decision), *question, "round {}", question.round);
        assert_eq!(policy.decide(&Asked::of(question)).unwrap(), decision.decision);
    }
    let last = &live[live.len() - 1].history;
    assert!(last.iter().all(|round| round.duration_s > 0.0 && round.groups.len() == 2));
    assert!(last.iter().flat_map(|round| &round.groups).any(|group| group.rescued > 0));
}

#[test]
fn another_policy_may_go_on_from_a_snapshot() {
    let scenario = three_rounds();
    let (mut rne, mut eng) = (policy("RNE"), policy("ENG"));
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    while trial.decisions().len() < 2 {
        assert_eq!(trial.step(&mut *rne), None);
    }
    let bytes = trial.snapshot("RNE");
    assert_eq!(Identity::of(&bytes).unwrap().policy, "RNE");
    let go_on = |policy: &mut dyn Session| {
        let trial = Simulation::restore(&scenario, &bytes).unwrap();
        sound(trial.run(policy, |_, _, _| {}))
    };
    let whole = undisturbed(&scenario, "RNE");
    assert_eq!(go_on(&mut *rne), whole);
    let mixed = go_on(&mut *eng);
    assert_eq!(mixed.decisions[..2], whole.decisions[..2]);
    assert!(mixed.decisions.len() > 2);
    for decision in &mixed.decisions[2..] {
        assert_eq!(decision.decision, eng.decide(&Asked::of(&mixed.question(decision))).unwrap());
    }
    assert_ne!(mixed.state_hash, whole.state_hash);
}

#[test]
fn the_order_of_trials_changes_nothing() {
    let overrides =
        Overrides { trials: Some(2), set: vec!["duration_s=30.0".to_owned()], ..Overrides::default() };
    let experiment = Arc::new(
        Experiment::load(&support::root().join("scenarios/paper.ron"), &overrides, &policies::standard())
            .unwrap(),
    );
    let forwards: Vec<TrialKey> = experiment.keys(None).collect();
    let mut shuffled = forwards.clone();
    shuffled.reverse();
    shuffled.swap(1, 5);
    let records = |keys: &[TrialKey]| {
        let experiment = Arc::clone(&experiment);
        let run: Arc<Run> = Arc::new(move |key, sessions, halt| experiment.run(key, sessions, halt));
        let limits = Limits { jobs: 2, trial: None };
        let mut outcomes = Vec::new();
        let all = run_all(keys.to_vec(), limits, run, &AtomicBool::new(false), |outcome| {
            outcomes.push(outcome);
            Ok(())
        });
        assert!(all.unwrap());
        outcomes.sort_by(|a, b| a.key.cmp(&b.key));
        outcomes.into_iter().map(|outcome| outcome.result.unwrap().record).collect::<Vec<_>>()
    };
    assert_eq!(records(&forwards), records(&shuffled));
}

/// Renewed by `just golden` only, with a line in the changelog. CI compares the same file with a release
/// build. Where what comes out of trials changes, the number of the program's bits must be raised.
#[test]
fn what_comes_out_of_trials_changes_only_with_the_number_of_bits() {
    let expected = std::fs::read_to_string(golden::path()).unwrap();
    let now = Goldens::computed();
    assert_eq!(now.refused_after(&Goldens::parse(&expected).unwrap()), None);
    assert_eq!(now.to_string(), expected, "`just golden` renews it: see docs/determinism.md");
    let other = |from: &str, to: &str| Goldens::parse(&expected.replacen(from, to, 1)).unwrap();
    let (line, bits) = (expected.lines().nth(1).unwrap(), expected.lines().next().unwrap());
    let [name, state, outcome] = line.split(' ').collect::<Vec<_>>().try_into().unwrap();
    let refusal = |line: &str| now.refused_after(&other(&format!("{name} {state} {outcome}"), line));
    assert!(refusal(&format!("{name} {state} 0")).unwrap().contains("usar_sim::BITS must be raised"));
    assert!(refusal(&format!("{name} 0 {outcome}")).unwrap().contains("HASH_FORMAT must be raised"));
    assert_eq!(
        now.refused_after(&other(&format!("{bits}\n{line}"), &format!("bits 0 hash_format 0\n{name} 0 0"))),
        None
    );
}

#[test]
fn robots_go_where_they_are_steered_and_along_their_routes_again() {
    let mut trial = Simulation::new(&paper(), 1).unwrap();
    let Advance::Asks(Ask::Grouping(question)) = trial.advance() else { panic!("it asks first") };
    let decision = policy("DIS").decide(&Asked::of(question)).unwrap();
    trial.assign(decision).unwrap();
    let places = |trial: &Simulation| -> Vec<Vector> {
        trial.world().robots.iter().map(|robot| robot.position).collect()
    };
    let go =
        |trial: &mut Simulation| (0..50).for_each(|_| assert!(matches!(trial.advance(), Advance::Running)));
    let start = places(&trial);
    trial.steer(Some(vec![Vector::ZERO; 12]));
    go(&mut trial);
    assert_eq!(places(&trial), start);
    let mut unsteered = trial.checkpoint().resume();
    trial.steer(Some(vec![Vector::new(0.0, 0.5); 12]));
    go(&mut trial);
    let moved = places(&trial).into_iter().zip(&start).map(|(now, then)| now - *then);
    let north = moved.filter(|way| way.y > 0.2 && way.x.abs() < 0.2).count();
    assert!(north >= 10, "{north} of 12 went north");
    go(&mut unsteered);
    let went =
        places(&unsteered).into_iter().zip(&start).filter(|(now, then)| (*now - **then).length() > 0.3);
    assert!(went.count() >= 10);
}
