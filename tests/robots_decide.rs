//! Robots that decide for themselves: by what each knows, over a medium that may lose it.

use experiments::experiment::with_settings;
use rayon::prelude::*;
use scenario::{AtHome, BeliefSharing, ClaimRule, Coin, Decider, Loss, MediumRules, Scenario};
use serde_json::json;
use teaming::protocol::{Act, Choice, Say, Stays, Turn, Undecided};
use teaming::{Asked, Assignment, Decision, PolicyError, Session, TaskId};
use usar_sim::event::Event;
use usar_sim::record::TrialRecord;
use usar_sim::simulation::{Advance, Ask, Simulation};

use xtask::journeys::{Journeys, STANDSTILL_S};

use crate::support::{policy, root};

/// A scenario of the repository with these settings.
pub fn world(name: &str, settings: &[&str]) -> Scenario {
    let (scenario, _) = Scenario::load(&root().join("scenarios").join(name)).unwrap();
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    with_settings(&scenario, &settings).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A checked trial, with all its events.
pub fn run(scenario: &Scenario, name: &str, seed: u64) -> (TrialRecord, Vec<Event>) {
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
                assert!(
                    joins.flat_map(|join| join.ages_s.values()).all(|age| *age == Some(0.0)),
                    "{name} {by}"
                );
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
        let Advance::Asks(Ask::Turns(turns)) = trial.advance() else { panic!("robots decide") };
        turns.iter().map(|turn| turn.question.clone()).collect::<Vec<_>>()
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
        let robots = "mission.decides=Robots()";
        let scenario = world("trust/tunnel.ron", &["duration_s=600", robots, "reports=()", lossy]);
        let (record, events) = run(&scenario, by, 1);
        let first = &record.decisions[0];
        let mut session = policy(by);
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        while trial.time_s() < 120.0 {
            assert_eq!(trial.step(&mut *session), None);
        }
        let again = Simulation::restore(&scenario, &trial.snapshot(by)).unwrap();
        assert_eq!(again.run(&mut *session, |_, _, _| {}).state_hash, record.state_hash, "{by}");
        assert!(events.iter().any(|event| matches!(event, Event::Delivered { .. })), "{by}");
        let pairs = first.joins.iter().flat_map(|a| first.joins.iter().map(move |b| a.sees == b.sees));
        pairs.filter(|agree| *agree).count()
    };
    let (alone, gossip) = (agreement("HP_DIS"), agreement("HP_DIS by Gossip(exchanges: 4)"));
    assert!(alone < gossip, "{alone} of 144 pairs agree alone, {gossip} after gossip");
    assert_eq!(gossip, 144, "after four exchanges all have heard all");
}

/// Of a team in which nobody goes, robots ask again after a while, and not in every step.
#[test]
fn a_team_of_which_nobody_goes_asks_again_later() {
    let stays = |_: &Turn| Act { joins: Some(Choice::Stays(Stays::AtHome)), ..Act::default() };
    let settings = ["mission.decides=Robots(retry_s: 20)", "duration_s=100"];
    let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap();
    let mut asked_s = Vec::new();
    loop {
        let acts: Vec<Act> = match trial.advance() {
            Advance::Running => continue,
            Advance::Over(_) => break,
            Advance::Asks(Ask::Turns(turns)) => turns.iter().map(stays).collect(),
            Advance::Asks(Ask::Grouping(_)) => panic!("robots decide"),
        };
        asked_s.push(trial.time_s().round());
        trial.act(acts).unwrap();
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
        let by = match pick(5) {
            0 => String::new(),
            3 => " by Majority".to_owned(),
            4 => " by Leader(by: Energy, wait_s: 0.3)".to_owned(),
            more => format!(" by Gossip(exchanges: {more}, every_s: {})", [0.0, 0.5, 2.0][pick(3) as usize]),
        };
        let undecided = [Undecided::OwnView, Undecided::Base, Undecided::Stays][pick(11) as usize % 3];
        let deadline_s = [30.0, 0.5][pick(13) as usize % 2];
        file.mission.decides = Decider::Robots { coin: Coin::Own, deadline_s, undecided, retry_s: 10.0 };
        let lost = [0.0, 0.3, 0.7, 1.0][pick(4) as usize];
        file.medium = (pick(5) > 0).then(|| MediumRules {
            range_m: Some([4.0, 10.0, 100.0][pick(3) as usize]),
            loss: Loss::GilbertElliott { p: 0.5, r: 0.5, good: lost, bad: lost },
            delay_s: [0.0, 0.3, 5.0][pick(7) as usize % 3],
            kbps: (pick(2) == 0).then_some(20.0),
            at_home: [AtHome::Medium, AtHome::Perfect][pick(2) as usize],
            ..MediumRules::default()
        });
        if file.medium.is_some() && pick(17) < 9 {
            file.mission.belief_sharing = BeliefSharing::ByRadio;
            file.mission.claims = ClaimRule::ByRadio { again_s: 5.0 };
        }
        let scenario = Scenario::try_from(file).unwrap_or_else(|wrong| panic!("world {seed}: {wrong:?}"));
        let policy = format!("{}{by}", ["HP_DIS", "RANDOM", "RNE"][pick(3) as usize]);
        let journeys = Journeys::run(&scenario, &policy, seed);
        let journeys = journeys.unwrap_or_else(|reason| panic!("world {seed}, {policy}: {reason}"));
        assert!(journeys.standstill_s <= STANDSTILL_S, "world {seed}: {} s", journeys.standstill_s);
    });
}

/// Answers the turns of robots until somebody is told something, or nobody asks any more.
fn told_after(trial: &mut Simulation, mut act: impl FnMut(&Turn) -> Act) -> Vec<Turn> {
    while trial.time_s() < 20.0 {
        let acts: Vec<Act> = match trial.advance() {
            Advance::Asks(Ask::Turns(turns)) if turns.iter().any(|turn| !turn.told.is_empty()) => {
                return turns.to_vec();
            }
            Advance::Asks(Ask::Turns(turns)) => turns.iter().map(&mut act).collect(),
            Advance::Running => continue,
            _ => break,
        };
        trial.act(acts).unwrap();
    }
    Vec::new()
}

/// What a robot says is heard by those whom its radio reaches, later by a late medium, and by nobody else.
#[test]
fn what_a_robot_says_is_heard_by_those_in_reach() {
    let says = |turn: &Turn| {
        let (all, one) = (json!(["all", turn.robot]), json!(["one", turn.robot]));
        let to_7 = Say { to: Some(7), what: one };
        let says = [Some(Say { to: None, what: all }), (turn.robot != 7).then_some(to_7)];
        Act { says: says.into_iter().flatten().collect(), wake_in_s: Some(5.0), ..Act::default() }
    };
    for (medium, metres, age_s) in [
        ("medium=None", f64::INFINITY, 0.1),
        ("medium=(at_home: Medium, range_m: 3)", 3.0, 0.1),
        ("medium=(at_home: Medium, delay_s: 2)", f64::INFINITY, 2.0),
    ] {
        let reports = if metres.is_finite() || age_s > 1.0 { "reports=()" } else { "duration_s=900" };
        let scenario = world("trust/tunnel.ron", &["mission.decides=Robots()", medium, reports]);
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        let turns = told_after(&mut trial, says);
        assert_eq!(turns.len(), 12, "{medium}");
        let homes: Vec<[f64; 2]> = turns[0].question.members.iter().map(|member| member.home).collect();
        let distance = |a: u32, b: u32| {
            let [x, y] = [0, 1].map(|axis| homes[a as usize][axis] - homes[b as usize][axis]);
            x.hypot(y)
        };
        let mut heard = 0;
        for turn in &turns {
            let others = (0..12).filter(|from| *from != turn.robot && distance(*from, turn.robot) <= metres);
            let one = |from: u32| (turn.robot == 7).then(|| (from, json!(["one", from])));
            let expected: Vec<(u32, serde_json::Value)> =
                others.flat_map(|from| [(from, json!(["all", from]))].into_iter().chain(one(from))).collect();
            let told: Vec<_> = turn.told.iter().map(|told| (told.from, told.what.clone())).collect();
            assert_eq!(told, expected, "{medium}: robot {}", turn.robot);
            let ages = turn.told.iter().map(|told| (told.age_s - age_s).abs());
            assert!(ages.fold(0.0, f64::max) < 0.11, "{medium}: {:?}", turn.told.first());
            heard += told.len();
        }
        assert!(heard > 10 && (heard < 143) == metres.is_finite(), "{medium}: {heard} of 143 were heard");
    }
}

/// Robots that never decide are out of time at the deadline, and do as the scenario says.
#[test]
fn who_has_not_decided_by_the_deadline_does_as_the_scenario_says() {
    for (undecided, expected) in [("OwnView", 12), ("Base", 12), ("Stays", 0)] {
        let decides = format!("mission.decides=Robots(deadline_s: 3, undecided: {undecided})");
        let settings = [&decides, "duration_s=100", "reports=()"];
        let mut never = Never(policy("HP_DIS"));
        let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap().checked();
        while trial.time_s() < 5.0 {
            assert_eq!(trial.step(&mut never), None);
        }
        let record = trial.finish();
        let joins = &record.decisions[0].joins;
        let went = record.decisions[0].decision.assignment.groups.iter().map(Vec::len).sum::<usize>();
        assert_eq!((joins.len(), went), (12, expected), "{undecided}");
        assert!(joins.iter().all(|join| join.is_late && (join.after_s - 3.1).abs() < 1e-9), "{:?}", joins[0]);
        if undecided == "Base" {
            let seen = joins.iter().map(|join| &join.sees);
            assert!(seen.into_iter().all(|sees| *sees == joins[0].sees));
        }
    }
}

/// A robot that has decided is not overruled when another is out of time.
#[test]
fn who_has_decided_before_the_deadline_goes_where_it_said() {
    let settings = ["mission.decides=Robots(deadline_s: 2)", "duration_s=100"];
    let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap();
    let act = |turn: &Turn| {
        let joins = (turn.robot != 11).then_some(Choice::Group(TaskId(u16::from(turn.robot > 5))));
        Act { joins, wake_in_s: Some(0.5), ..Act::default() }
    };
    while trial.time_s() < 5.0 {
        let acts: Vec<Act> = match trial.advance() {
            Advance::Asks(Ask::Turns(turns)) => turns.iter().map(act).collect(),
            _ => continue,
        };
        trial.act(acts).unwrap();
    }
    let record = trial.finish();
    let groups = &record.decisions[0].decision.assignment;
    assert_eq!(groups.groups, [vec![0, 1, 2, 3, 4, 5], vec![6, 7, 8, 9, 10]]);
    assert_eq!(groups.idle, [11], "who never decides, and whom nobody helps, stays");
    let late = record.decisions[0].joins.iter().filter(|join| join.is_late).map(|join| join.robot);
    assert_eq!(late.collect::<Vec<_>>(), [11]);
}

/// What robots tell of a round counts, if it is heard before they decide, however late it comes.
#[test]
fn what_is_heard_of_a_round_in_a_negotiation_counts() {
    let late = "medium=(at_home: Medium, delay_s: 0.7)";
    let settings = ["mission.decides=Robots()", "reports=()", late, "duration_s=400"];
    let mut trial = Simulation::new(&world("trust/tunnel.ron", &settings), 1).unwrap();
    let mut looks = Looks { it: policy("HP_DIS by Gossip"), first: Vec::new(), last: Vec::new() };
    while trial.step(&mut looks).is_none() {}
    assert!(looks.first.len() > 10 && looks.last.len() > 10);
    assert!(looks.first.iter().all(|known| *known < 12), "only its own group at first: {:?}", looks.first);
    assert!(looks.last.iter().all(|known| *known == 12), "all in the end: {:?}", looks.last);
}

/// Counts the robots in the last round of each robot's history.
struct Looks {
    it: Box<dyn Session>,
    first: Vec<usize>,
    last: Vec<usize>,
}

impl Session for Looks {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.it.decide(asked)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        for turn in turns {
            let Some(round) = turn.question.history.last() else { continue };
            let known = round.groups.iter().map(|group| group.members.len()).sum();
            if turn.since_s <= 0.0 {
                self.first.push(known);
            } else if turn.since_s >= 2.0 {
                self.last.push(known);
            }
        }
        self.it.act(turns, base)
    }
}

/// Robots that wait for each other, until they are out of time.
struct Never(Box<dyn Session>);

impl Session for Never {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.0.decide(asked)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        match turns[0].late {
            Some(_) => self.0.act(turns, base),
            None => Ok(turns.iter().map(|_| Act::default()).collect()),
        }
    }
}

#[test]
fn an_act_that_cannot_be_done_is_refused_and_changes_nothing() {
    let mut trial = Simulation::new(&world("trust/tunnel.ron", &["mission.decides=Robots()"]), 1).unwrap();
    let Advance::Asks(Ask::Turns(turns)) = trial.advance() else { panic!("robots decide") };
    let (before, tasks) = (turns.to_vec(), turns[0].question.tasks.len());
    let groups = |groups: Vec<Vec<u32>>| Act::joins(Assignment::new(groups));
    let stays = Act { joins: Some(Choice::Stays(Stays::AtHome)), ..Act::default() };
    for (act, expected) in [
        (Act { wake_in_s: Some(f64::NAN), ..Act::default() }, "robot 0: wake_in_s must be 0 to 86400"),
        (Act { asks: true, ..Act::default() }, "robot 0: asks must be false: there is no rule before `by`"),
        (
            Act { state: json!("x".repeat(17_000)), ..Act::default() },
            "robot 0: state must have at most 16 KiB",
        ),
        (
            Act { joins: Some(Choice::Group(TaskId(9))), ..Act::default() },
            "joins must be the number of a task",
        ),
        (groups(vec![vec![0]; tasks + 1]), "a group for each of the 2 tasks, found 3"),
        (groups(vec![vec![0], vec![0]]), "robot 0 must be in exactly one group, found it twice"),
        (groups(vec![vec![0], vec![99]]), "robot 99 is not a member"),
        (groups(vec![vec![1], vec![2]]), "robot 0 must be in exactly one group, found it in none"),
    ] {
        let acts = [vec![act], vec![stays.clone(); 11]].concat();
        let error = trial.act(acts).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        let Advance::Asks(Ask::Turns(turns)) = trial.advance() else { panic!("the turns wait") };
        assert_eq!(before, turns, "{expected}");
    }
    assert_eq!(trial.act(vec![stays.clone(); 3]).unwrap_err().to_string(), "no question waits for an answer");
    let again = |_| trial.act(vec![Act { wake_in_s: Some(0.0), ..Act::default() }; 12]).err();
    let endless = (0..200).find_map(again).unwrap().to_string();
    assert_eq!(endless, "robot 0: wake_in_s must not be 0 again and again");
}
