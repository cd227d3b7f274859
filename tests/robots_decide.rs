//! Robots that decide for themselves: by what each knows, over a medium that may lose it.

use experiments::experiment::with_settings;
use rayon::prelude::*;
use scenario::{AtHome, Coin, Decider, Exchange, Loss, MediumRules, Scenario};
use teaming::{Assignment, Decision, Question};
use usar_sim::event::Event;
use usar_sim::record::TrialRecord;
use usar_sim::simulation::{Advance, Ask, Simulation};

use xtask::journeys::{Journeys, STANDSTILL_S};

use crate::support::{policy, root};

/// A scenario of the repository with these settings.
fn world(name: &str, settings: &[&str]) -> Scenario {
    let (scenario, _) = Scenario::load(&root().join("scenarios").join(name)).unwrap();
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    with_settings(&scenario, &settings).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A checked trial, with all its events.
fn run(scenario: &Scenario, name: &str, seed: u64) -> (TrialRecord, Vec<Event>) {
    let mut all = Vec::new();
    let trial = Simulation::new(scenario, seed).unwrap().checked();
    let record = trial.run(&mut *policy(name), |_, events, _| all.extend(events.to_vec()));
    (record, all)
}

/// The worlds that are shipped, with a mission.
const WORLDS: [&str; 18] = [
    "paper.ron",
    "paper-calibrated.ron",
    "leak.ron",
    "crowded.ron",
    "ground-only.ron",
    "eight-needs.ron",
    "three-tasks.ron",
    "two-aerial-roles.ron",
    "gallery/chance.ron",
    "gallery/collapse.ron",
    "gallery/corridors.ron",
    "gallery/failures.ron",
    "gallery/one-task.ron",
    "trust/tunnel.ron",
    "trust/convoy.ron",
    "trust/aftershocks.ron",
    "trust/avalanche.ron",
    "trust/flood.ron",
];

/// Where all hear all at once, robots decide as the base would: the same groups, events and end.
#[test]
fn who_hears_all_at_once_decides_as_the_base_does() {
    WORLDS.par_iter().for_each(|name| {
        for more in [&[][..], &["reports=()", "medium=(at_home: Medium)"]] {
            let settings = |decides: &'static str| [&["duration_s=240", decides], more].concat();
            let base = world(name, &settings("mission.decides=Base"));
            let alone = world(name, &settings("mission.decides=Robots(coin: Common)"));
            for by in ["RNE", "DIS", "ENG", "HP_DIS", "OPTIMAL", "RANDOM", "HP_DIS <- Beta | Discount"] {
                let [(base, happened), (robots, too)] = [run(&base, by, 3), run(&alone, by, 3)];
                let groups = |record: &TrialRecord| {
                    record.decisions.iter().map(|made| made.decision.assignment.clone()).collect::<Vec<_>>()
                };
                assert_eq!(groups(&base), groups(&robots), "{name} {by} {more:?}");
                assert!(happened == too, "{name} {by} {more:?}: other events");
                assert_eq!((&base.status, base.time_s), (&robots.status, robots.time_s), "{name} {by}");
                if more.is_empty() && base.heard.is_none() {
                    assert_eq!(base.state_hash, robots.state_hash, "{name} {by}");
                }
                let joins = robots.decisions.iter().flat_map(|made| &made.joins);
                assert!(joins.clone().count() > 0, "{name} {by}: nobody decided");
                assert!(joins.flat_map(|join| &join.ages_s).all(|age| *age == Some(0.0)), "{name} {by}");
            }
        }
    });
}

/// Only those whom a robot's radio reaches hear its lie; it knows itself.
#[test]
fn what_a_robot_did_not_hear_changes_nothing_for_it() {
    let far = "medium=(at_home: Medium, range_m: 3)";
    let asked = |deceit: &str| {
        let settings = ["mission.decides=Robots()", "reports=()", far, deceit];
        let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap();
        let Advance::Asks(Ask::Joins(questions)) = trial.advance() else { panic!("robots decide") };
        questions.to_vec()
    };
    let before = asked("deceit=[]");
    let after = asked("deceit=[(who: Robots([0]), lie: Understate(by: 0.5), on: [Energy, Hp])]");
    let homes: Vec<[f64; 2]> = before[0].members.iter().map(|member| member.home).collect();
    let is_far = |id: usize| {
        let [x, y] = [0, 1].map(|axis| homes[id][axis] - homes[0][axis]);
        x.hypot(y) > 3.0
    };
    let mut unaware = 0;
    for (before, after) in before.iter().zip(&after) {
        let robot = before.asker.unwrap() as usize;
        if robot == 0 || is_far(robot) {
            assert_eq!(before, after, "robot {robot} could not hear the lie of robot 0, or is it");
            unaware += 1;
        } else {
            assert_ne!(before.members[0], after.members[0], "robot {robot} heard robot 0");
        }
    }
    assert!(unaware > 1 && unaware < before.len(), "{unaware} of {}", before.len());
}

/// Lost messages cost agreement, and exchanges of what was heard bring it back; snapshots go on the same.
#[test]
fn robots_that_exchange_what_they_heard_agree_more() {
    let lossy = "medium=(at_home: Medium, loss: GilbertElliott(p: 0.5, r: 0.5, good: 0.6, bad: 0.6))";
    let agreement = |by: &str| {
        let decides = format!("mission.decides=Robots(by: {by})");
        let scenario = world("trust/tunnel.ron", &["duration_s=600", &decides, "reports=()", lossy]);
        let (record, events) = run(&scenario, "HP_DIS", 1);
        let first = &record.decisions[0];
        let mut session = policy("HP_DIS");
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        while trial.time_s() < 120.0 {
            assert_eq!(trial.step(&mut *session), None);
        }
        let again = Simulation::restore(&scenario, &trial.snapshot("HP_DIS")).unwrap();
        assert_eq!(again.run(&mut *session, |_, _, _| {}).state_hash, record.state_hash, "{by}");
        assert!(events.iter().any(|event| matches!(event, Event::Delivered { .. })), "{by}");
        let pairs = first.joins.iter().flat_map(|a| first.joins.iter().map(move |b| a.sees == b.sees));
        pairs.filter(|agree| *agree).count()
    };
    let (alone, gossip) = (agreement("Alone"), agreement("Gossip(exchanges: 4, every_s: 1)"));
    assert!(alone < gossip, "{alone} of 144 pairs agree alone, {gossip} after gossip");
    assert_eq!(gossip, 144, "after four exchanges all have heard all");
}

/// Of a team in which nobody goes, robots ask again after a while, and not in every step.
#[test]
fn a_team_of_which_nobody_goes_asks_again_later() {
    let sees_itself_out = |question: &Question| {
        let ids: Vec<u32> = question.members.iter().map(|member| member.id).collect();
        let asker = question.asker.unwrap();
        let mut groups = vec![Vec::new(); question.tasks.len()];
        groups[0] = ids.into_iter().filter(|id| *id != asker).collect();
        Decision::of(Assignment { groups, idle: vec![asker] })
    };
    let settings = [
        "mission.decides=Robots(retry_s: 20)",
        "mission.may_idle=true",
        "mission.group_sizes=Free",
        "duration_s=100",
    ];
    let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap();
    let mut asked_s = Vec::new();
    loop {
        let decisions: Vec<Decision> = match trial.advance() {
            Advance::Running => continue,
            Advance::Over(_) => break,
            Advance::Asks(Ask::Joins(questions)) => questions.iter().map(sees_itself_out).collect(),
            Advance::Asks(Ask::Grouping(_)) => panic!("robots decide"),
        };
        asked_s.push(trial.time_s().round());
        trial.join(&decisions).unwrap();
    }
    assert_eq!(asked_s, [0.0, 20.0, 40.0, 60.0, 80.0]);
    assert_eq!(trial.finish().status.name(), "completed");
}

/// Random missions over random media: no invariant is violated, and nobody stands still for good.
#[test]
fn in_random_worlds_robots_decide_soundly() {
    let some = std::env::var("RANDOM_WORLDS").ok().and_then(|count| count.parse().ok()).unwrap_or(12);
    (0..some).into_par_iter().for_each(|number: u64| {
        let seed = 2 * number + 1; // odd ones are missions
        let mut file = (*xtask::worlds::world(seed)).clone();
        file.duration_s = 100.0;
        let pick = |of: u64| (seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) % of;
        let by = match pick(3) {
            0 => Exchange::Alone,
            more => Exchange::Gossip { exchanges: more as u32, every_s: [0.0, 0.5, 2.0][pick(3) as usize] },
        };
        file.mission.decides = Decider::Robots { by, coin: Coin::Own, retry_s: 10.0 };
        let lost = [0.0, 0.3, 0.7, 1.0][pick(4) as usize];
        file.medium = (pick(5) > 0).then(|| MediumRules {
            range_m: Some([4.0, 10.0, 100.0][pick(3) as usize]),
            loss: Loss::GilbertElliott { p: 0.5, r: 0.5, good: lost, bad: lost },
            delay_s: [0.0, 0.3, 5.0][pick(7) as usize % 3],
            kbps: (pick(2) == 0).then_some(20.0),
            at_home: [AtHome::Medium, AtHome::Perfect][pick(2) as usize],
            ..MediumRules::default()
        });
        let scenario = Scenario::try_from(file).unwrap_or_else(|wrong| panic!("world {seed}: {wrong:?}"));
        let policy = ["HP_DIS", "RANDOM", "RNE"][pick(3) as usize];
        let journeys = Journeys::run(&scenario, policy, seed);
        let journeys = journeys.unwrap_or_else(|reason| panic!("world {seed}, {policy}: {reason}"));
        assert!(journeys.standstill_s <= STANDSTILL_S, "world {seed}: {} s", journeys.standstill_s);
    });
}
