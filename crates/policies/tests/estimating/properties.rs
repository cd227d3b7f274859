//! What all estimators have in common, and what each of them sees of two liars.

use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use teaming::{Estimate, Evidence, Extent, Question, Rest};

use crate::support::{BRAGGER, CHEAT, ROUND, estimates, estimates_where, names, question, said_levels, team};

fn trust(estimator: &str) -> Vec<f64> {
    estimates(estimator, &question()).iter().map(|estimate| estimate.trust).collect()
}

fn levels(estimator: &str, robot: u32) -> Vec<f64> {
    estimates(estimator, &question())[robot as usize].levels.clone()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
}

fn evidence(question: &mut Question) -> &mut Evidence {
    question.evidence.as_mut().unwrap()
}

#[test]
fn there_are_fourteen_and_each_brings_a_hash_of_its_own_sources() {
    let registry = policies::standard();
    let made: Vec<_> = names().iter().map(|name| registry.estimator(name).unwrap()).collect();
    assert_eq!(made.len(), 14);
    let mut hashes: Vec<String> = made.iter().map(|made| made.fingerprint().unwrap()).collect();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), 14);
}

#[test]
fn without_evidence_everybody_is_as_said_and_believed() {
    let question = Question { evidence: None, ..question() };
    for name in names() {
        let found = estimates(&name, &question);
        for (member, estimate) in question.members.iter().zip(found) {
            let expected = Estimate {
                levels: said_levels(member.id, ROUND).to_vec(),
                sd: vec![0.0; 2],
                needs: member.needs.clone(),
                trust: 1.0,
            };
            assert_eq!(estimate, expected, "{name}");
        }
    }
}

#[test]
fn a_member_without_a_level_is_named() {
    let mut question = question();
    question.members[3].levels[1] = None;
    let last = policies::standard().estimator("LastReport").unwrap();
    let error = last.it.estimate(&question).unwrap_err().to_string();
    assert_eq!(error, "an estimate needs the level hp of robot 3, which is missing");
}

/// The bragger has 30 % health, said 100 %, and lost a point a round; the cheat has 43 % energy less than
/// said.
#[test]
fn estimators_of_levels_see_what_is_theirs_to_see() {
    let roughly = |found: f64, expected: f64| assert!((found - expected).abs() < 3.0, "{found} {expected}");
    near(levels("Truth", BRAGGER)[1], 23.0);
    near(levels("LastReport", BRAGGER)[1], 100.0);
    near(levels("Smooth", BRAGGER)[1], 100.0);
    roughly(levels("Wmsr", 0)[1], 88.0);
    assert!(levels("Wmsr", BRAGGER)[1] < 55.0, "mates saw 24 %, itself said 100 %");
    near(levels("Truth", CHEAT)[0], 43.0);
    near(levels("LastReport", CHEAT)[0], 83.0);
    roughly(levels("Kalman(restart: 0)", CHEAT)[0], 43.0);
    roughly(levels("Kalman", CHEAT)[0], 83.0);
    roughly(levels("Kalman", 0)[0], 48.0);
    near(levels("DeadReckoning", 0)[0], 80.0 - 42.0);
    assert!(trust("Kalman(restart: 0)")[CHEAT as usize] < 0.8 && trust("Kalman")[0] > 0.9);
    for name in ["Truth", "DeadReckoning", "LastReport", "Smooth", "Wmsr"] {
        assert_eq!(trust(name), [1.0; 12], "{name}");
    }
}

/// Mates see the bragger's speed round by round. Of the cheat there is only the round in which its lie began.
#[test]
fn estimators_of_trust_find_the_bragger() {
    for name in ["Beta", "Brs", "Travos", "EigenTrust", "Hmm", "Cusum", "Rne"] {
        let trust = trust(name);
        let others = (0..12).filter(|robot| *robot != BRAGGER).map(|robot| trust[robot as usize]);
        let least = others.fold(1.0, f64::min);
        assert!(trust[BRAGGER as usize] < least, "{name}: {trust:?}");
        near(levels(name, BRAGGER)[1], 100.0);
    }
    for name in ["Beta", "Brs", "Rne"] {
        let trust = trust(name);
        assert!(trust[CHEAT as usize] < trust[0], "{name}: {trust:?}");
    }
}

#[test]
fn both_takes_levels_from_one_and_trust_from_the_other() {
    let both = estimates("Both(level: Kalman(q: 2), trust: Hmm)", &question());
    let (kalman, hmm) = (estimates("Kalman(q: 2)", &question()), estimates("Hmm", &question()));
    for ((both, kalman), hmm) in both.iter().zip(kalman).zip(hmm) {
        assert_eq!(*both, Estimate { trust: hmm.trust, ..kalman });
    }
}

/// Needs that were said by themselves stay under `LastReport`; others compute them from the level.
#[test]
fn needs_said_by_themselves_count_as_long_as_nobody_estimates_the_level() {
    let mut question = question();
    let mut needs = question.members[0].needs.values().to_vec();
    (needs[1], needs[3]) = (9.0, 7.0);
    question.members[0].needs = rne_core::NeedVector::new(needs).unwrap();
    for name in ["LastReport", "Beta"] {
        near(estimates(name, &question)[0].needs.values()[1], 9.0);
    }
    for name in ["Truth", "Kalman", "Smooth", "Wmsr", "DeadReckoning"] {
        let needs = estimates(name, &question)[0].needs.clone();
        assert!(needs.values()[1] <= 2.0, "{name}: {needs:?}");
        near(needs.values()[3], 7.0); // no level says what it can carry
    }
}

/// A robot that stayed at home and had said that it is tired has rested: its level is full, and its report
/// passes.
#[test]
fn a_robot_that_rests_at_home_is_expected_to_be_full() {
    let mut question = question();
    question
        .history
        .last_mut()
        .unwrap()
        .groups
        .iter_mut()
        .for_each(|group| group.members.retain(|m| m.id != 0));
    evidence(&mut question).ledger.retain(|entry| (entry.robot, entry.round) != (0, ROUND - 1));
    let last = |round| move |report: &&mut teaming::LevelReport| report.of == 0 && report.round == round;
    evidence(&mut question).reports.iter_mut().find(last(ROUND)).unwrap().levels[0] = 100.0;
    assert!(estimates("Kalman", &question)[0].levels[0] < 60.0, "it was not tired, and says 100");
    evidence(&mut question).reports.iter_mut().find(last(ROUND - 1)).unwrap().levels[0] = 19.0;
    assert!(estimates("Kalman", &question)[0].levels[0] > 99.0);
}

#[test]
fn a_robot_with_a_new_name_begins_anew() {
    let mut question = question();
    let evidence = evidence(&mut question);
    evidence.known_since.insert(0, ROUND);
    let (reports, ratings, ledger) = (evidence.reports.len(), evidence.ratings.len(), evidence.ledger.len());
    let known_since = evidence.known_since.clone();
    *evidence = evidence.as_of(&Extent { round: ROUND, reports, ratings, ledger, known_since });
    for round in &mut question.history {
        round.groups.iter_mut().for_each(|group| group.members.retain(|member| member.id != 0));
    }
    let kalman = &estimates("Kalman", &question)[0];
    // The first guess of 80 +- 20 hears 48: 80 - 400 / 425 * 32
    assert!((kalman.levels[0] - (80.0 - 400.0 / 425.0 * 32.0)).abs() < 1e-9, "{kalman:?}");
    assert!((estimates("Beta", &question)[0].trust - 0.5).abs() < 1e-12);
}

#[test]
fn options_out_of_range_are_refused_with_the_rule_and_what_was_found() {
    let registry = policies::standard();
    let refused = |text: &str| registry.estimator(text).unwrap_err().to_string();
    for (text, rule) in [
        ("Smooth(alpha: 0)", "alpha must be above 0 and at most 1"),
        ("Smooth(alpha: 1.5)", "alpha must be above 0 and at most 1"),
        ("Kalman(q: 0)", "q must be a number above 0"),
        ("Kalman(r: -1)", "r must be a number above 0"),
        ("Kalman(gate: 0)", "gate must be a number above 0"),
        ("Beta(forget: 0)", "forget must be above 0 and at most 1"),
        ("Beta(tolerance: 0)", "tolerance must be a number above 0"),
        ("Brs(q: 0.5)", "q must be above 0 and below 0.5"),
        ("Travos(error: 1)", "error must be above 0 and below 1"),
        ("Travos(confidence: 0)", "confidence must be above 0 and below 1"),
        ("EigenTrust(a: 0)", "a must be above 0 and at most 1"),
        ("Cusum(k: -1)", "k must be a number from 0"),
        ("Cusum(h: 0)", "h must be a number above 0"),
        ("Rne(t0: 0)", "t0 must be a number above 0"),
    ] {
        let (name, options) = text.split_at(text.find('(').unwrap());
        let start = format!("estimator {name}: {rule}, found {options:?}; options and defaults: (");
        assert!(refused(text).starts_with(&start), "{}", refused(text));
    }
    assert_eq!(refused("Truth(a: 1)"), "estimator Truth: it has no options, found \"(a: 1)\"");
    assert!(refused("Wmsr(f: -1)").contains("estimator Wmsr: "));
    assert!(refused("Kalmann").ends_with("Wmsr, Both; did you mean Kalman?"), "{}", refused("Kalmann"));
}

/// A question with evidence of any kind: levels, speeds and outcomes are drawn.
fn drawn(seed: u64) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let mut question = question();
    let evidence = evidence(&mut question);
    evidence.reports.retain(|_| draws.random_range(0..4_u32) > 0);
    for report in &mut evidence.reports {
        report.levels.fill_with(|| draws.random_range(0.0..=100.0));
        report.heard_s += draws.random_range(0.0..150.0);
    }
    evidence.ratings.retain(|_| draws.random_range(0..3_u32) > 0);
    for rating in &mut evidence.ratings {
        rating.speed_mps = [0.0, 1e-9, draws.random_range(0.0..5.0)][draws.random_range(0..3_u32) as usize];
        rating.said_mps = [0.0, draws.random_range(0.0..2.0)][draws.random_range(0..2_u32) as usize];
    }
    for entry in &mut evidence.ledger {
        entry.turned_back = draws.random_range(0..6_u32) == 0;
        entry.rested = draws.random_range(0..6_u32) == 0;
        entry.lost = draws.random_range(0..20_u32) == 0;
    }
    question.rest = if draws.random() { Rest::Low } else { Rest::All };
    question
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn estimates_are_finite_and_trust_is_a_share(seed in any::<u64>()) {
        let question = drawn(seed);
        for name in names() {
            for estimate in estimates(&name, &question) {
                let Estimate { levels, sd, trust, .. } = estimate;
                prop_assert!((0.0..=1.0).contains(&trust), "{name}: trust {trust}");
                prop_assert!(levels.iter().all(|level| (0.0..=100.0).contains(level)), "{name}: {levels:?}");
                prop_assert!(sd.iter().all(|sd| sd.is_finite() && *sd >= 0.0), "{name}: {sd:?}");
            }
        }
    }

    /// Ratings of one round come in any order, and so do entries of the ledger and reports of several robots.
    #[test]
    fn the_order_within_a_round_does_not_matter(seed in any::<u64>()) {
        let question = drawn(seed);
        let mut shuffled = question.clone();
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let own = evidence(&mut shuffled);
        own.ratings.shuffle(&mut draws);
        own.ledger.shuffle(&mut draws);
        own.reports.sort_by_key(|report| (report.round, 12 - report.of));
        for name in names() {
            prop_assert_eq!(estimates(&name, &question), estimates(&name, &shuffled), "{}", name);
        }
    }

    /// Nobody but the control sees the truth.
    #[test]
    fn no_estimator_sees_the_truth(seed in any::<u64>()) {
        let question = drawn(seed);
        let mut other = team();
        other.iter_mut().for_each(|member| member.levels[0] = member.levels[0].map(|energy| energy / 2.0));
        for name in names() {
            let is_same = estimates(&name, &question) == estimates_where(&name, &question, &other);
            prop_assert_eq!(is_same, name != "Truth", "{}", name);
        }
    }
}
