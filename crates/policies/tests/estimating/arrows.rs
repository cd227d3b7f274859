//! Policies behind estimators: `RULE <- ESTIMATOR | USE`.

use teaming::{Asked, Decision, GroupSizes, MadePolicy, PolicyError, Question, Quota, RoleId, TaskId};

use crate::support::{BRAGGER, CHEAT, question, team};

fn made(text: &str) -> MadePolicy {
    policies::standard().parse(text).unwrap_or_else(|error| panic!("{error}"))
}

fn decide(text: &str, question: &Question) -> Decision {
    let decision = made(text)
        .open()
        .unwrap()
        .decide(&Asked::of(question).knowing(&team()))
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    decision.assignment.check(question).unwrap_or_else(|error| panic!("{text}: {error}"));
    decision
}

/// Whether a robot is sent to the far task.
fn is_far(text: &str, robot: u32) -> bool {
    decide(text, &question()).assignment.of(TaskId(1)).contains(&robot)
}

#[test]
fn the_last_report_is_what_a_policy_goes_by_without_an_arrow() {
    for rule in ["RNE", "HP_DIS", "ENG", "RANDOM"] {
        let guided = decide(&format!("{rule} <- LastReport"), &question());
        assert_eq!(guided.believed.as_ref().map(Vec::len), Some(question().members.len()));
        assert_eq!(decide(rule, &question()), Decision { believed: None, ..guided }, "{rule}");
    }
}

#[test]
fn a_liar_is_sent_where_it_belongs() {
    assert!(
        is_far("HP_DIS", BRAGGER)
            && !is_far("HP_DIS <- Truth", BRAGGER)
            && !is_far("HP_DIS <- Wmsr", BRAGGER)
    );
    assert!(is_far("ENG", CHEAT) && !is_far("ENG <- Truth", CHEAT));
    assert!(!is_far("ENG <- Kalman(restart: 0)", CHEAT) && is_far("ENG <- Kalman", CHEAT), "believed again");
    assert!(is_far("HP_DIS <- Beta", BRAGGER), "trust alone changes nothing");
    assert!(decide("RNE", &question()) != decide("RNE <- Truth", &question()));
}

/// The trust of the bragger by `Cusum` is 0, so that it counts as the mean of the trusted of its role.
#[test]
fn a_discounted_robot_counts_as_the_mean_of_the_trusted() {
    use teaming::{Account, TrustUse};
    let question = question();
    let estimates = policies::standard().estimator("Cusum").unwrap().it.estimate(&question).unwrap();
    assert!(estimates[BRAGGER as usize].trust == 0.0);
    let trusted = |place: &usize| *place < 6 && estimates[*place].trust >= 0.5;
    let hp: Vec<f64> = (0..6).filter(trusted).map(|place| estimates[place].levels[1]).collect();
    let mean = hp.iter().sum::<f64>() / hp.len() as f64;
    let judged = TrustUse::Discount.judged(&question, estimates.clone()).unwrap();
    let bragger = &judged.question.members[BRAGGER as usize];
    assert!((bragger.levels[1].unwrap() - mean).abs() < 1e-9);
    assert!((bragger.needs.values()[0] - mean).abs() < 1e-9, "the need follows");
    assert!((bragger.needs.values()[3] - 5.0).abs() < 1e-12, "what it can carry does not");
    assert_eq!(hp.len(), 5);
    let Account::Ranking(ranking) = decide("HP_DIS <- Cusum | Discount", &question).account else { panic!() };
    let shown = ranking.roles[0].iter().find(|ranked| ranked.id == BRAGGER).unwrap();
    assert!((shown.value - mean).abs() < 1e-9);
}

#[test]
fn robots_that_are_not_believed_stay_at_home() {
    let question = question();
    let decision = decide("HP_DIS <- Cusum | Exclude", &question);
    assert_eq!(decision.assignment.idle, [BRAGGER]);
    let sizes: Vec<usize> = decision.assignment.groups.iter().map(Vec::len).collect();
    assert_eq!(sizes, [5, 6], "the harder task keeps three of each role");
    assert_eq!(
        decide("HP_DIS <- Cusum | Exclude(most: 0.1)", &question).assignment.idle,
        [0_u32; 0],
        "0.6 of 6"
    );
    let all = decide("DIS <- Beta | Exclude(below: 1)", &placed(question.clone())).assignment.idle;
    assert_eq!(all.len(), 4, "2 of 6, of each role");
    assert!(all.contains(&BRAGGER) && !all.contains(&11), "the only guide stays in");
    let by_bragger = Question { asker: Some(BRAGGER), ..question };
    let idle = decide("HP_DIS <- Cusum | Exclude", &by_bragger).assignment.idle;
    assert_eq!(idle, [0_u32; 0], "who asks is in its team");
}

/// The same with places, which DIS needs.
fn placed(mut question: Question) -> Question {
    for (task, x) in question.tasks.iter_mut().zip([0.0, 12.0]) {
        task.place = Some([x, 5.0]);
    }
    question
}

#[test]
fn sizes_that_bind_are_shared_over_the_others() {
    let mut question = question();
    question.quotas[0] = Quota { members: vec![2, 4], sizes: GroupSizes::Binding };
    let of_movers = |decision: &Decision, task: usize| {
        let ids = &decision.assignment.groups[task];
        question.of_role(RoleId(0)).filter(|member| ids.contains(&member.id)).count()
    };
    let decision = decide("HP_DIS <- Cusum | Exclude", &question);
    assert_eq!([0, 1].map(|task| of_movers(&decision, task)), [2, 3]);
    let mut free = question.clone();
    free.quotas[0].sizes = GroupSizes::Free;
    decide("RNE <- Cusum | Exclude", &free);
}

/// Nobody is believed, all may stay at home, and one robot alone can carry.
#[test]
fn the_last_that_can_carry_and_the_last_member_are_never_excluded() {
    let mut question = placed(question());
    let evidence = question.evidence.as_mut().unwrap();
    for rating in &mut evidence.ratings {
        rating.speed_mps = 0.0;
    }
    evidence
        .bodies
        .iter_mut()
        .for_each(|body| (body.carries, body.guides) = (body.robot == 4, body.robot == 4));
    let all = "DIS <- Hmm | Exclude(below: 1, most: 1)";
    assert_eq!(decide(all, &question).assignment.groups.concat(), [4]);
    question
        .evidence
        .as_mut()
        .unwrap()
        .bodies
        .iter_mut()
        .for_each(|body| (body.carries, body.guides) = (false, false));
    assert_eq!(decide(all, &question).assignment.groups.concat().len(), 1);
}

#[test]
fn excluding_needs_a_question_that_allows_idle_robots() {
    let question = Question { may_idle: false, ..question() };
    let error = made("HP_DIS <- Cusum | Exclude").decide(&question).unwrap_err();
    assert!(matches!(error, PolicyError::MayNotIdle { .. }));
    assert_eq!(
        error.to_string(),
        "HP_DIS <- Cusum | Exclude(below: 0.3, most: 0.34) leaves robots idle, which this question does not \
         allow; set mission.may_idle: true"
    );
    decide("HP_DIS <- Cusum | Discount", &question);
    let plain = Question { evidence: None, ..question };
    assert_eq!(decide("HP_DIS <- Cusum | Exclude", &plain), decide("HP_DIS", &plain), "nothing to judge by");
}

#[test]
fn names_and_options_tell_what_was_made() {
    let plain = made(" ENG<-Kalman|Ignore ");
    assert_eq!((plain.name.as_str(), plain.label.as_str()), ("ENG", "ENG <- Kalman"));
    assert_eq!(made(&format!("ENG{}", plain.options)).options, plain.options);
    let nested = made("ENG <- Both(level: Both(trust: Hmm), trust: Travos(error: 0.1)) | Discount");
    assert_eq!(nested.label, "ENG <- Both(level: Both(trust: Hmm), trust: Travos(error: 0.1)) | Discount");
    assert_eq!(made(&format!("ENG{}", nested.options)).options, nested.options);
    assert!(made("ENG <- Kalman").fingerprint() != made("ENG").fingerprint());
    assert!(made("ENG <- Kalman | Exclude").it.leaves_idle() && !made("ENG <- Kalman").it.leaves_idle());
}
