//! Reports, the medium and lies: what they change, and what they leave as it is.

use experiments::metric::Catalogue;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Normal};
use rayon::prelude::*;
use scenario::Scenario;
use teaming::{Asked, Assignment, Question, Truth};
use usar_sim::hash::PARTS;
use usar_sim::record::TrialRecord;
use usar_sim::robot::HP;
use usar_sim::simulation::{Advance, Simulation};

use crate::support::{paper_with, policy, root};

/// paper.ron with these sections in addition.
fn paper_and(sections: &str) -> Scenario {
    paper_with(&[(
        "    // Normal distributions, clamped",
        &format!("{sections}\n    // Normal distributions, clamped"),
    )])
}

fn run(scenario: &Scenario, name: &str, seed: u64) -> TrialRecord {
    let record = Simulation::new(scenario, seed).unwrap().checked().run(&mut *policy(name), |_, _, _| {});
    assert_eq!(record.status.name(), "completed", "{:?}", record.status);
    record
}

/// Names of the parts of the state in which two trials ever differ.
fn differing(a: &TrialRecord, b: &TrialRecord) -> Vec<&'static str> {
    let pairs = || a.chain.links().iter().zip(b.chain.links());
    PARTS.into_iter().filter(|part| pairs().any(|(a, b)| a.differing_parts(b).contains(part))).collect()
}

const NEUTRAL: &str = "reports: (every_s: 10, sensors: {\"carrier\": (energy: (sd: 0))}),
    medium: (loss: GilbertElliott(p: 0, r: 0.25, good: 0, bad: 1), at_home: Medium),
    deceit: [(who: Count(4), lie: Exaggerate(by: 0), on: [Energy, Hp])],";

#[test]
fn exact_gauges_a_medium_without_loss_and_lies_of_nothing_change_no_decision() {
    for name in ["RNE", "HP_DIS"] {
        let (plain, reported) = (run(&paper_and(""), name, 1), run(&paper_and(NEUTRAL), name, 1));
        assert_eq!(differing(&plain, &reported), ["evidence"], "{name}");
        let groups = |record: &TrialRecord| -> Vec<Assignment> {
            record.decisions.iter().map(|made| made.decision.assignment.clone()).collect()
        };
        assert_eq!(groups(&plain), groups(&reported));
        assert!(plain.heard.is_none() && reported.decisions.iter().all(|made| made.truth.is_none()));
        let history = &reported.heard.as_ref().unwrap().history;
        for (said, known) in history.iter().zip(&reported.ledger) {
            for (said, known) in said.groups.iter().zip(&known.groups) {
                for (said, known) in said.members.iter().zip(&known.members) {
                    // Between two reports before a rest, a part of what was spent is never said.
                    let untold = known.energy - said.energy;
                    let most = if known.turned_back { 10.0 } else { 1e-9 };
                    assert!((-1e-9..=most).contains(&untold), "{said:?} {known:?}");
                }
            }
        }
        assert_eq!(history.len(), reported.ledger.len());
    }
}

/// DIS looks at no level, so that no lie about oneself changes what it does.
#[test]
fn under_dis_a_lie_about_oneself_changes_evidence_and_events_only() {
    let honest = run(&paper_and("reports: (every_s: 10),"), "DIS", 2);
    let lies = [
        "Exaggerate(by: 0.5)",
        "Understate(by: 0.5)",
        "Offset(points: -30)",
        "Scale(factor: 0.1)",
        "Stuck",
        "Complement",
        "Uniform(low: 0, high: 100)",
        "Copycat",
        "OnOff(period_s: 120, duty: 0.5, lie: Complement)",
        "Impersonate(as: 0)",
        "Whitewash(at_rest: true)",
        "BadMouth(of: All)",
    ];
    lies.par_iter().for_each(|lie| {
        let on = if lie.contains("as:") || lie.contains("at_rest") || lie.contains("of:") {
            ""
        } else {
            ", on: [Energy, Hp, Need(\"v\")]"
        };
        let liar = format!("reports: (every_s: 10), deceit: [(who: Robots([3, 7]), lie: {lie}{on})],");
        let found = run(&paper_and(&liar), "DIS", 2);
        let parts = differing(&honest, &found);
        assert!(parts.iter().all(|part| ["evidence", "events"].contains(part)), "{lie}: {parts:?}");
        assert!(parts.contains(&"evidence"), "{lie} changes nothing");
    });
}

/// A robot whose radio is broken from the start is never heard: nothing of its level is in any question.
#[test]
fn no_policy_sees_the_truth() {
    let text = |energy: f64| {
        format!(
            "timeline: [(at_s: 0, event: RobotDrops(5)), \
             (at_s: 100, event: RobotLoses(robot: 5, energy: {energy}))],"
        )
    };
    let questions = |energy: f64| -> Vec<Question> {
        let scenario = paper_and(&text(energy));
        let mut trial = Simulation::new(&scenario, 3).unwrap();
        let mut dis = policy("DIS");
        let mut questions = Vec::new();
        while questions.len() < 3 {
            match trial.advance() {
                Advance::Running => {}
                Advance::Over(status) => panic!("{status:?}"),
                Advance::Asks(_) => {
                    let question = trial.question().unwrap().clone();
                    trial.assign(dis.decide(&Asked::of(&question)).unwrap()).unwrap();
                    questions.push(question);
                }
            }
        }
        questions
    };
    let (full, empty) = (questions(0.0), questions(5.0));
    assert_eq!(full[0], empty[0]);
    let of = |question: &Question| question.members.iter().find(|member| member.id == 5).cloned();
    let never_heard = of(&full[2]).unwrap();
    assert_eq!(never_heard.levels, [Some(80.0), Some(90.0)]);
    assert_eq!(of(&full[2]), of(&empty[2]), "5 points less, and nobody heard of it");
    assert_eq!(
        full[2].evidence.as_ref().map(|evidence| evidence.reports.iter().any(|report| report.of == 5)),
        Some(false)
    );
}

#[test]
fn a_record_gives_each_question_back_with_its_evidence() {
    let scenario = paper_and(
        "reports: (every_s: 5, sensors: {\"supplier\": (hp: (sd: 3, dropout: 0.1))}),
    medium: (range_m: 60, loss: GilbertElliott(p: 0.02, r: 0.25, good: 0, bad: 1), delay_s: 0.2, kbps: 50),
    deceit: [(who: Share(0.25), lie: Understate(by: 0.3), on: [Hp]),
        (who: Robots([1]), lie: Whitewash(at_rest: true))],",
    );
    let mut trial = Simulation::new(&scenario, 4).unwrap();
    let mut rne = policy("RNE");
    let mut asked = Vec::new();
    loop {
        match trial.advance() {
            Advance::Running => {}
            Advance::Over(_) => break,
            Advance::Asks(_) => {
                if asked.len() == 2 {
                    trial = Simulation::restore(&scenario, &trial.snapshot("RNE")).unwrap();
                }
                let question = trial.question().unwrap().clone();
                trial.assign(rne.decide(&Asked::of(&question)).unwrap()).unwrap();
                asked.push(question);
            }
        }
    }
    let record = trial.finish();
    let text = serde_json::to_string(&record).unwrap();
    let read: TrialRecord = serde_json::from_str(&text).unwrap();
    let again: Vec<Question> = read.decisions.iter().map(|made| read.question(made)).collect();
    assert!(asked.len() > 3);
    assert_eq!(asked, again);
    let last = asked.last().unwrap();
    assert_eq!(Question::from_json(&serde_json::to_string(last).unwrap()).unwrap(), *last);
    let evidence = last.evidence.as_ref().unwrap();
    assert!(evidence.reports.len() > 100 && evidence.ratings.len() > 20 && evidence.ledger.len() > 20);
    let heard = record.heard.unwrap();
    let unheard: u64 = heard.links.iter().map(|link| link.sent - link.heard).sum();
    assert!(unheard > 10 && heard.links.iter().all(|link| link.delay_s.unwrap() >= 0.2), "{:?}", heard.links);
}

fn leak_with(sharing: &str, fields: &str) -> Scenario {
    let text = std::fs::read_to_string(crate::support::root().join("scenarios/leak.ron")).unwrap();
    let text = text.replace("    duration_s: 600.0,", &format!("    duration_s: 240.0,\n{fields}"));
    let text = text.replace("mission: (", &format!("mission: (belief_sharing: {sharing}, "));
    Scenario::parse(&text, "leak.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// A shared belief, and a radio that loses and delays nothing.
#[test]
fn by_a_perfect_radio_mates_know_what_a_group_knows() {
    for seed in [1, 2, 3] {
        let sharing = |rule: &str| run(&leak_with(rule, "medium: (),"), "RNE", seed);
        let (shared, radio, alone) = (sharing("WithGroup"), sharing("ByRadio"), sharing("WithNobody"));
        assert_eq!(differing(&shared, &radio), ["beliefs", "evidence"], "seed {seed}");
        assert!(differing(&shared, &alone).contains(&"bodies"), "seed {seed}: the test shows nothing");
        let links = &radio.heard.as_ref().unwrap().links;
        assert!(links.iter().filter(|link| link.to.is_some()).map(|link| link.sent).sum::<u64>() > 500);
    }
}

/// A radio that is late, loses messages and is used by liars: the trial goes on from any moment as it was.
#[test]
fn messages_between_mates_are_part_of_the_state() {
    let scenario = leak_with(
        "ByRadio",
        "medium: (delay_s: 3, range_m: 30, loss: GilbertElliott(p: 0.2, r: 0.5, good: 0, bad: 1)),
    deceit: [(who: Count(2), lie: PhantomRescuee(every_s: 2)), (who: Count(4), lie: HideRadiation)],",
    );
    let whole = run(&scenario, "RNE", 2);
    let mut rne = policy("RNE");
    let mut trial = Simulation::new(&scenario, 2).unwrap();
    while trial.time_s() < 30.0 {
        assert_eq!(trial.step(&mut *rne), None);
    }
    let again = Simulation::restore(&scenario, &trial.snapshot("RNE")).unwrap();
    assert_eq!(again.run(&mut *rne, |_, _, _| {}).state_hash, whole.state_hash);
    let links = &whole.heard.as_ref().unwrap().links;
    let to_mates = || links.iter().filter(|link| link.to.is_some());
    assert!(to_mates().all(|link| link.delay_s.is_none_or(|delay| (delay - 3.0).abs() < 1e-9)));
    assert!(to_mates().map(|link| link.sent - link.heard).sum::<u64>() > 100);
}

/// What the groups of both tasks believe after 60 s, and whether a robot has gone for a rescuee that does not
/// exist.
fn beliefs_after(lie: &str) -> (usize, bool) {
    let scenario = leak_with("ByRadio", &format!("medium: (), deceit: [{lie}],"));
    let mut rne = policy("RNE");
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    let mut went = false;
    while trial.time_s() < 60.0 {
        assert_eq!(trial.step(&mut *rne), None);
        let real = trial.model().rescuees.len();
        let mut agents = trial.mission().crew.agents.iter();
        went |= agents.any(|agent| agent.activity.claim().is_some_and(|rescuee| rescuee.index() >= real));
    }
    let groups = trial.model().task_ids().flat_map(|task| trial.beliefs_of(Some(task)));
    (groups.map(|belief| belief.zones_on().len()).sum(), went)
}

#[test]
fn robots_go_for_phantoms_and_do_not_know_of_hidden_radiation() {
    let (honest, phantoms) =
        (beliefs_after(""), beliefs_after("(who: Count(3), lie: PhantomRescuee(every_s: 1))"));
    let hidden = beliefs_after("(who: Share(1), lie: HideRadiation)");
    assert!(!honest.1 && phantoms.1, "{honest:?} {phantoms:?}");
    assert!(hidden.0 < honest.0 && hidden.0 > 0, "{honest:?} {hidden:?}");
}

/// `Truth` takes the levels of the members as they really were, which the record keeps beside each decision,
/// and bodies say what needs follow from them: together they are these members.
#[test]
fn the_control_has_the_levels_and_needs_of_the_truth() {
    let scenario = paper_and(
        "reports: (every_s: 10), deceit: [(who: Count(5), lie: Complement, on: [Energy, Hp, Need(\"v\")])],",
    );
    let record = run(&scenario, "DIS", 5);
    let truth = policies::standard().estimator("Truth").unwrap();
    let last = policies::standard().estimator("LastReport").unwrap();
    let mut lied = 0;
    for made in &record.decisions {
        let question = record.question(made);
        let estimates = truth.estimate(&question, Some(Truth(made.team()))).unwrap();
        for (member, found) in made.team().iter().zip(&estimates) {
            let levels = found.levels.iter().zip(&member.levels);
            assert!(
                levels.clone().count() == 2
                    && levels.clone().all(|(a, b)| a.to_bits() == b.unwrap().to_bits())
            );
            let pairs = found.needs.values().iter().zip(member.needs.values());
            assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {member:?}");
        }
        let said = last.it.estimate(&question).unwrap();
        lied += said.iter().zip(&estimates).filter(|(said, is)| said.needs != is.needs).count();
        let untold = truth.estimate(&question, None).unwrap_err().to_string();
        assert_eq!(untold, "Truth takes the levels of robots as they really are; here nobody knows them");
        let evidence = question.evidence.unwrap();
        assert!(evidence.bodies.len() == 12 && evidence.bodies[11].guides && !evidence.bodies[11].carries);
        let level = |level: &teaming::Level| {
            let expected = level.expected.unwrap();
            (level.name.clone(), level.threshold, [expected.mean, expected.sd])
        };
        let [energy, hp] = ["energy", "hp"].map(str::to_owned);
        let expected = vec![(energy, 30.0, [80.0, 20.0]), (hp, 30.0, [90.0, 10.0])];
        assert_eq!(question.levels.iter().map(level).collect::<Vec<_>>(), expected);
    }
    assert!(record.decisions.len() > 3 && lied > 10, "{lied}");
}

/// Shares of 1,000 teams of 6, 4 and 2 whose grouping changes when one robot says "HP 31", and the shares
/// that an independent computation found: RNE 73 +- 4 %, HP_DIS 49 +- 5 %, ENG and DIS none.
#[test]
fn one_robot_that_says_hp_31_regroups_the_teams_that_another_computation_found() {
    let policies = ["RNE", "HP_DIS", "ENG", "DIS"];
    let changed: Vec<[bool; 4]> =
        (0..1_000_u64).into_par_iter().map(|team| changes(team, policies)).collect();
    let share = |policy: usize| changed.iter().filter(|changed| changed[policy]).count() as f64 / 10.0;
    let shares = [0, 1, 2, 3].map(share);
    assert!((shares[0] - 73.0).abs() <= 4.0 && (shares[1] - 49.0).abs() <= 5.0, "{shares:?}");
    assert_eq!(shares[2..], [0.0, 0.0]);
}

/// Whether each policy groups this team in another way when one of its robots says "HP 31".
fn changes(team: u64, policies: [&str; 4]) -> [bool; 4] {
    let mut draws = ChaCha8Rng::seed_from_u64(team);
    let mut level = |mean: f64, sd: f64, least: f64| loop {
        let level: f64 = Normal::new(mean, sd).unwrap().sample(&mut draws);
        if level >= least {
            return level.clamp(1.0, 100.0);
        }
    };
    let rows = [("carrier", 6, 12.6, 13.8), ("supplier", 4, 5.0, 16.0), ("observer", 2, 1.0, 18.2)];
    let mut text = String::new();
    for (role, count, width, y) in rows {
        for i in 0..count {
            let x = 46.4 - width / 2.0 + width * f64::from(i) / f64::from(count - 1);
            let (energy, hp) = (level(80.0, 20.0, 30.0), level(90.0, 10.0, 30.0));
            let levels = format!("levels: (energy: {energy}, hp: {hp})");
            text.extend([format!("(role: {role:?}, count: 1, center: ({x}, {y}), width_m: 0, {levels}),")]);
        }
    }
    let liar = draws.random_range(0..12_u32);
    let paper = crate::support::paper_text();
    let (start, end) =
        (paper.find("    team: [").unwrap(), paper.find("    // The ratios between roles").unwrap());
    let question = |deceit: &str| {
        let text = format!("{}    team: [{text}],\n{deceit}\n{}", &paper[..start], &paper[end..]);
        let scenario = Scenario::parse(&text, "paper.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        assert!(matches!(trial.advance(), Advance::Asks(_)));
        trial.question().unwrap().clone()
    };
    let lie = format!("deceit: [(who: Robots([{liar}]), lie: Uniform(low: 31, high: 31), on: [Hp])],");
    let (honest, lied) = (question(""), question(&lie));
    policies.map(|name| {
        let decide = |question: &Question| policy(name).decide(&Asked::of(question)).unwrap().assignment;
        decide(&honest) != decide(&lied)
    })
}

/// In the tunnel health is speed, and speed can be seen: what mates say of two liars and of the others.
#[test]
fn mates_see_that_a_robot_is_slower_than_it_says() {
    let text = std::fs::read_to_string(crate::support::root().join("scenarios/trust/tunnel.ron")).unwrap();
    let lies = "(\n    deceit: [(who: Count(2), lie: Exaggerate(by: 1), on: [Hp])],";
    let text = text.replacen('(', lies, 1).replace("duration_s: 1800.0", "duration_s: 600.0");
    let scenario = Scenario::parse(&text, "tunnel.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let record = run(&scenario, "HP_DIS", 1);
    let truly = |robot: u32| record.decisions[0].truth.as_ref().unwrap()[robot as usize].level(HP).unwrap();
    let said = |robot: u32| record.decisions[0].question.members[robot as usize].level(HP).unwrap();
    let liars: Vec<u32> = (0..12).filter(|robot| said(*robot) - truly(*robot) > 1.0).collect();
    assert_eq!(liars.len(), 2);
    let ratings = &record.heard.as_ref().unwrap().evidence.ratings;
    let outcomes = |robot: u32| ratings.iter().filter(move |rating| rating.of == robot);
    let mut seen = 0;
    for robot in 0..12 {
        let outcomes: Vec<f64> = outcomes(robot).map(|rating| rating.outcome(0.2, 2.25)).collect();
        if outcomes.len() < 8 {
            continue;
        }
        seen += 1;
        let mean = outcomes.iter().sum::<f64>() / outcomes.len() as f64;
        assert_eq!(mean < 0.5, liars.contains(&robot), "robot {robot}: {mean}");
        let rating =
            ratings.iter().filter(|rating| rating.of == robot).max_by(|a, b| a.looks.cmp(&b.looks)).unwrap();
        let measured = rating.measured_level(2.25, 0.1).unwrap();
        assert!((measured - truly(robot)).abs() < 12.0, "robot {robot}: {measured}");
    }
    assert!(seen >= 8, "{seen}");
}

/// A robot that begins to lie after five minutes is honest in the rounds before.
#[test]
fn until_its_lie_begins_a_liar_is_judged_as_honest() {
    let text = std::fs::read_to_string(crate::support::root().join("scenarios/trust/tunnel.ron")).unwrap();
    let lies = "(\n    deceit: [(who: Robots([3]), lie: Exaggerate(by: 1), on: [Hp], since_s: 300)],";
    let text = text.replacen('(', lies, 1).replace("duration_s: 1800.0", "duration_s: 900.0");
    let scenario = Scenario::parse(&text, "tunnel.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let record = run(&scenario, "DIS <- Hmm", 1);
    let metrics = Catalogue::of(&scenario);
    let value = |name: &str| metrics[metrics.named(name).unwrap()].value(&record).unwrap();
    let start_s = |round: u32| record.rounds.iter().find(|it| it.round == round).unwrap().start_s;
    let (mut before, mut after, mut detected) = (0.0, 0.0, None);
    let (mut squares, mut logs, mut bins) = (Vec::new(), Vec::new(), [0.0; 10]);
    for made in &record.decisions {
        let is_lying = start_s(made.question.round) >= 300.0;
        *(if is_lying { &mut after } else { &mut before }) += 1.0;
        for (member, it) in made.question.members.iter().zip(made.decision.believed.as_ref().unwrap()) {
            let is_honest = !(is_lying && member.id == 3);
            let was = f64::from(u8::from(is_honest));
            squares.push((it.trust - was).powi(2));
            logs.push(-f64::max(if is_honest { it.trust } else { 1.0 - it.trust }, 1e-12).ln());
            bins[((it.trust * 10.0) as usize).min(9)] += it.trust - was;
            if !is_honest && it.trust < 0.5 && detected.is_none() {
                detected = Some(after - 1.0);
            }
        }
    }
    assert!(before >= 2.0 && after >= 2.0, "{before} rounds before it lies, {after} after");
    let is = |name: &str, expected: f64| {
        assert!((value(name) - expected).abs() < 1e-12, "{name}: {} {expected}", value(name));
    };
    let count = squares.len() as f64;
    is("trust_brier", squares.iter().sum::<f64>() / count);
    is("trust_log", logs.iter().sum::<f64>() / count);
    is("trust_ece", bins.iter().map(|apart: &f64| apart.abs()).sum::<f64>() / count);
    is("rounds_to_detect", detected.unwrap_or(after));
    is("reports_heard", record.heard.as_ref().unwrap().evidence.reports.len() as f64);
    is("liars", 1.0);
    is("level_crps", value("level_mae")); // levels as they were said, without a spread
}

/// `Exclude` leaves robots at home that have little trust; those that never lie are counted.
#[test]
fn honest_robots_that_are_left_at_home_are_counted() {
    let text = std::fs::read_to_string(crate::support::root().join("scenarios/trust/tunnel.ron")).unwrap();
    let lies = "(\n    deceit: [(who: Robots([3]), lie: Exaggerate(by: 1), on: [Hp])],";
    let text = text.replacen('(', lies, 1).replace("duration_s: 1800.0", "duration_s: 600.0");
    let text = text.replace("mission: (", "mission: (may_idle: true, ");
    let scenario = Scenario::parse(&text, "tunnel.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let record = run(&scenario, "HP_DIS <- Beta | Exclude(below: 0.9)", 1);
    let idle = record.decisions.iter().flat_map(|made| &made.decision.assignment.idle);
    let honest = idle.filter(|robot| **robot != 3).count();
    assert!(honest > 0, "the first round knows nobody: trust 0.5");
    let metrics = Catalogue::of(&scenario);
    let value = metrics[metrics.named("false_exclusions").unwrap()].value(&record).unwrap();
    assert!((value - honest as f64).abs() < 1e-12, "{value} {honest}");
}

/// The mean delay of what each robot sent to the base, by id, in seconds.
fn delays_s(record: &TrialRecord) -> Vec<f64> {
    let links = &record.heard.as_ref().unwrap().links;
    links.iter().filter(|link| link.to.is_none()).filter_map(|link| link.delay_s).collect()
}

#[test]
fn on_a_slow_channel_no_robot_speaks_first_because_of_its_id() {
    let slow = run(&paper_and("reports: (every_s: 10), medium: (kbps: 5, at_home: Medium),"), "DIS", 1);
    let delays = delays_s(&slow);
    assert_eq!(delays.len(), 12);
    let [least, most] =
        [delays.iter().copied().fold(f64::MAX, f64::min), delays.iter().copied().fold(0.0, f64::max)];
    assert!(
        most < 1.5 * least,
        "the last of twelve waits no longer than the first, in the long run: {delays:?}"
    );
}

/// Robot 2 and robot 9 each say how they are under the name of robot 5.
#[test]
fn who_speaks_under_the_name_of_another_is_heard_after_it_whatever_its_id() {
    for liar in [2, 9] {
        let lies = format!(
            "deceit: [(who: Robots([{liar}]), lie: Exaggerate(by: 1), on: [Energy]), \
             (who: Robots([{liar}]), lie: Impersonate(as: 5))],"
        );
        let record = run(&paper_and(&lies), "DIS", 1);
        let asked = &record.decisions[2].question;
        let of = |id: u32| asked.members.iter().find(|member| member.id == id).unwrap().levels[0];
        assert_eq!(of(5), of(liar), "{liar}");
        assert_eq!(of(5), Some(100.0));
    }
}

/// With the rows of the team the other way round, other robots have the low ids: rescuees are distributed as
/// before.
#[test]
fn nothing_depends_on_who_has_the_low_ids() {
    const LIES: &str = "reports: (every_s: 10), medium: (range_m: 60, kbps: 2, delay_s: 0.5),
        deceit: [(who: Count(3), lie: Exaggerate(by: 0.6), on: [Energy, Hp]),
                 (who: Count(2), lie: Flip)],\n)";
    for world in ["aftershocks", "avalanche", "convoy", "flood", "tunnel"] {
        let path = root().join(format!("scenarios/trust/{world}.ron"));
        let mut text = std::fs::read_to_string(&path).unwrap();
        text.truncate(text.trim_end().len() - 1);
        let scenario = Scenario::parse(&(text + LIES), &path).unwrap();
        let mut file = (*scenario).clone();
        file.team.reverse();
        assert!(file.team.len() > 1, "{world}: there are two rows to turn round");
        let rescued = |scenario: &Scenario| -> Vec<f64> {
            let trial = |seed| {
                let trial = Simulation::new(scenario, seed).unwrap();
                f64::from(trial.run(&mut *policy("HP_DIS <- Wmsr"), |_, _, _| {}).rescued())
            };
            (1..=16).into_par_iter().map(trial).collect()
        };
        let [there, renumbered] = [rescued(&scenario), rescued(&file.try_into().unwrap())];
        let moments = [&there, &renumbered].map(|values| {
            let mean = values.iter().sum::<f64>() / 16.0;
            (mean, values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / 15.0)
        });
        let [(a, of_a), (b, of_b)] = moments;
        let error = ((of_a + of_b) / 16.0).sqrt();
        assert!((a - b).abs() <= 4.0 * error, "{world}: {a:.1} and {b:.1} rescuees, by {error:.1}");
    }
}
