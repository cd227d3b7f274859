//! Questions and decisions as JSON: texts that are written can be read again, and texts that are not
//! questions are refused with a reason.

use teaming::{Assignment, AssignmentError, Decision, Question, QuestionError, Task};

const BEFORE_LEVELS: &str = "schema_version must be 3, found 2; since version 3, levels stand in lists with \
    a table of their names, and no question has the truth";

const TEAM: &str = r#"{
  "schema_version": 3, "round": 2,
  "roles": ["carrier", "observer"], "needs": [{"name": "hp", "weight": 1.0}, {"name": "v", "weight": 0.5}],
  "levels": [{"name": "energy", "unit": "%"}, {"name": "hp", "unit": "%"}],
  "tasks": [
    {"name": "easy", "difficulty": 1, "place": [70.0, 50.0]},
    {"name": "hard", "difficulty": 2, "place": [15.0, 60.0]}],
  "quotas": [{"members": [1, 2], "sizes": "Parts"}, {"members": [0, 1], "sizes": "Binding"}],
  "members": [
    {"id": 4, "role": 0, "home": [0.0, 0.0], "needs": [90.1, 1.5], "levels": [33.3, 90.1]},
    {"id": 2, "role": 0, "home": [2.0, 0.0], "needs": [60.0, 2.0], "levels": [44.4, 60.0]},
    {"id": 3, "role": 0, "home": [4.0, 0.1], "needs": [80.0, 1.0], "levels": [55.5, 80.0]},
    {"id": 1, "role": 1, "home": [6.0, 0.0], "needs": [50.0, 0.0], "levels": [66.6, 99.9]}],
  "history": [{"round": 1, "duration_s": 99.5, "groups": [
    {"task": 0, "rescued": 3, "energy": 12.5, "hp": 0.1, "members": [
      {"id": 4, "rescued": 3, "energy": 12.5, "hp": 0.1, "turned_back": false, "lost": false}]},
    {"task": 1, "rescued": 0, "energy": 0.0, "hp": 0.0, "members": []}]}],
  "random_seed": "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1eff"
}"#;

#[test]
fn a_question_is_read_as_it_was_written() {
    let question = Question::from_json(TEAM).unwrap();
    let ids: Vec<u32> = question.members.iter().map(|member| member.id).collect();
    assert_eq!(ids, [1, 2, 3, 4], "members stand in the order of their ids");
    assert_eq!(question.random_seed.0[30..], [0x1e, 0xff]);
    for text in [serde_json::to_string(&question), serde_json::to_string_pretty(&question)] {
        assert_eq!(Question::from_json(&text.unwrap()).unwrap(), question);
    }
}

#[test]
fn the_robot_that_asks_is_told_where_there_is_one_and_is_a_member() {
    let by = |asker| Question { asker: Some(asker), ..Question::from_json(TEAM).unwrap() };
    let text = serde_json::to_string(&by(3)).unwrap();
    assert!(text.contains("\"asker\":3"), "{text}");
    assert_eq!(Question::from_json(&text).unwrap(), by(3));
    assert!(!serde_json::to_string(&Question::from_json(TEAM).unwrap()).unwrap().contains("asker"));
    let error = by(9).checked().unwrap_err().to_string();
    assert_eq!(error, "asker must be one of the members, found robot 9");
}

#[test]
fn what_was_written_before_levels_had_names_is_refused_in_one_sentence() {
    let former =
        r#"{"schema_version": 2, "members": [{"id": 4, "energy_level": 33.3}], "evidence": {"truth": []}}"#;
    let refused = Question::from_json(former).unwrap_err().to_string();
    assert_eq!(refused, format!("not the JSON of a question: {BEFORE_LEVELS} at line 1 column 20"));
    let truth = TEAM.replace("\"random_seed\"", "\"evidence\": {\"truth\": []}, \"random_seed\"");
    assert!(Question::from_json(&truth).unwrap_err().to_string().contains("unknown field `truth`"));
}

#[test]
fn a_decision_needs_no_more_than_its_groups() {
    let decision =
        Decision::from_json(r#"{"schema_version": 3, "assignment": {"groups": [[3], [4, 1, 2]]}}"#);
    let decision = decision.unwrap();
    assert_eq!(decision, Decision::unscored(vec![vec![3], vec![1, 2, 4]]));
    assert_eq!(decision.assignment, Assignment::new(vec![vec![3], vec![4, 2, 1]]));
}

#[test]
fn what_is_no_decision_is_refused() {
    let refused = |text: &str| Decision::from_json(text).unwrap_err().to_string();
    assert_eq!(
        refused(r#"{"schema_version": 2, "assignment": {"groups": []}}"#),
        format!("not the JSON of a decision: {BEFORE_LEVELS} at line 1 column 20")
    );
    assert_eq!(
        refused(r#"{"schema_version": 3, "groups": []}"#),
        "not the JSON of a decision: unknown field `groups`, expected one of `schema_version`, `assignment`, \
         `score`, `proven_optimal`, `alternatives`, `account`, `believed`"
    );
    let former =
        r#"{"schema_version": 3, "assignment": {"groups": []}, "upper_bound": null, "gap_percent": 0.0}"#;
    assert!(Decision::from_json(former).is_ok(), "older recordings and programs may say so");
    assert_eq!(
        refused(r#"{"schema_version": 3}"#),
        "not the JSON of a decision: missing field `assignment` at line 1 column 21"
    );
}

#[test]
fn what_is_no_question_is_refused_with_the_reason() {
    let not_json = |reason: &str| format!("not the JSON of a question: {reason}");
    for (from, to, message) in [
        (
            "\"schema_version\": 3",
            "\"schema_version\": 7",
            not_json("schema_version must be 3, found 7 at line 2 column 21"),
        ),
        (
            "\"round\": 2",
            "\"turn\": 2",
            not_json(
                "unknown field `turn`, expected one of `schema_version`, `round`, `asker`, `roles`, `needs`, \
                 `levels`, `rest`, `tasks`, `quotas`, `members`, `may_idle`, `history`, `random_seed`, \
                 `evidence` at line 2 column 29",
            ),
        ),
        (
            "\"id\": 4, \"role\"",
            "\"id\": 4, \"colour\": 1, \"role\"",
            not_json(
                "unknown field `colour`, expected one of `id`, `role`, `home`, `needs`, `levels` \
                 at line 10 column 22",
            ),
        ),
        (" \"round\": 2,", "", not_json("missing field `round` at line 19 column 1")),
        ("90.1, 1.5", "NaN, 1.5", not_json("expected value at line 10 column 56")),
        ("90.1, 1.5", "1e999, 1.5", not_json("number out of range at line 10 column 60")),
        (
            "90.1, 1.5",
            "-1.0, 1.5",
            not_json("needs[0] must be a finite number >= 0, found -1 at line 10 column 65"),
        ),
        ("90.1, 1.5", "90.1", "robot 4: needs must have 2 entries, found 1".to_owned()),
        ("\"id\": 3", "\"id\": 2", "robot id 2 stands twice in the team; ids must be unique".to_owned()),
        (
            "\"id\": 1, \"role\": 1",
            "\"id\": 1, \"role\": 2",
            "robot 1: its role must be a row of the table of 2 roles (from 0), found 2".to_owned(),
        ),
        (
            "[1, 2], \"sizes\"",
            "[1, 1], \"sizes\"",
            "the quota of role \"carrier\" must share its 3 members out over all tasks, found [1, 1]"
                .to_owned(),
        ),
        (
            "[1, 2], \"sizes\"",
            "[18446744073709551615, 4], \"sizes\"",
            "the quota of role \"carrier\" must share its 3 members out over all tasks, \
             found [18446744073709551615, 4]"
                .to_owned(),
        ),
        (
            "[0, 1], \"sizes\"",
            "[1], \"sizes\"",
            "the quota of role \"observer\" must share its 1 members out over all tasks, found [1]"
                .to_owned(),
        ),
        (
            ", {\"members\": [0, 1], \"sizes\": \"Binding\"}",
            "",
            "there must be a quota for each of the 2 roles, found 1".to_owned(),
        ),
        (
            "\"difficulty\": 1,",
            "\"difficulty\": 1, \"value\": -2.5,",
            "value of task \"easy\" must be finite and >= 0, found -2.5".to_owned(),
        ),
        (
            "\"difficulty\": 1,",
            "\"difficulty\": 1, \"requires\": {\"v\": 1, \"wings\": 2},",
            "task \"easy\" requires \"wings\", which is not in the table of needs".to_owned(),
        ),
        (
            "\"difficulty\": 1,",
            "\"difficulty\": 1, \"after\": [2],",
            "task \"easy\" comes after task 2, which is not in the table of tasks".to_owned(),
        ),
        (
            "\"hp\", \"unit\": \"%\"",
            "\"hp\", \"unit\": \"J\"",
            "a level must have the unit \"%\" and finite numbers, found Level { name: \"hp\", unit: \"J\", \
             threshold: 0.0, expected: None }"
                .to_owned(),
        ),
        ("[33.3, 90.1]", "[33.3]", "robot 4: levels must have 2 entries, found 1".to_owned()),
        (
            "\"weight\": 0.5",
            "\"weight\": -0.5",
            "the weight of need \"v\" must be a finite number >= 0, found -0.5".to_owned(),
        ),
        ("1d1eff", "1d1e", not_json("random_seed must be 64 hexadecimal digits at line 19 column 1")),
    ] {
        assert!(TEAM.contains(from), "{from}");
        let error = Question::from_json(&TEAM.replace(from, to)).unwrap_err();
        assert_eq!(error.to_string(), message, "{from} -> {to}");
    }
}

#[test]
fn numbers_that_json_cannot_write_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Question)| {
        let mut question = Question::from_json(TEAM).unwrap();
        change(&mut question);
        question.checked().unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|q| q.members[1].home[1] = f64::NAN),
        "y of robot 2 must be a finite number of at most 1e100 in size, found NaN"
    );
    assert_eq!(
        refused(&|q| q.members[0].levels[1] = Some(f64::INFINITY)),
        "hp of robot 1 must be a finite number of at most 1e100 in size, found inf"
    );
    assert_eq!(
        refused(&|q| q.tasks[1].place = Some([1.0, f64::NAN])),
        "the place of task \"hard\" must be two finite numbers of at most 1e100 in size, found [1.0, NaN]"
    );
    assert_eq!(
        refused(&|q| q.needs[0].weight = f64::NAN),
        "the weight of need \"hp\" must be a finite number >= 0, found NaN"
    );
}

#[test]
fn a_question_has_1_to_64_tasks() {
    for tasks in [0, 65] {
        let mut question = Question::from_json(TEAM).unwrap();
        question.tasks = (0..tasks).map(|i| Task::new(&format!("{i}"), i)).collect();
        assert_eq!(question.checked(), Err(QuestionError::Tasks { found: tasks as usize }));
    }
}

#[test]
fn an_answer_keeps_the_sizes_that_the_question_asks_for() {
    let parts = Question::from_json(TEAM).unwrap();
    let check = |question: &Question, groups: [&[u32]; 2], idle: &[u32]| {
        let groups = groups.map(<[u32]>::to_vec).to_vec();
        Assignment { groups, idle: idle.to_vec() }.check(question)
    };
    assert_eq!(check(&parts, [&[2], &[1, 3, 4]], &[]), Ok(()));
    assert_eq!(check(&parts, [&[2, 3], &[1, 4]], &[]), Ok(()), "any task may get any part");
    let refused = check(&parts, [&[2, 3, 4], &[1]], &[]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "role \"carrier\" must be split into parts of [1, 2] members, found [0, 3]"
    );
    let refused = check(&parts, [&[1, 2], &[3, 4]], &[]).unwrap_err();
    assert_eq!(refused.to_string(), "task \"easy\" must get 0 members of role \"observer\", found 1");

    let mut free = parts.clone();
    free.quotas.iter_mut().for_each(|quota| quota.sizes = teaming::GroupSizes::Free);
    assert_eq!(check(&free, [&[1, 2, 3, 4], &[]], &[]), Ok(()));
    assert_eq!(check(&free, [&[1, 2, 3], &[]], &[4]), Err(AssignmentError::Idle { robot: 4 }));

    let may_idle = Question { may_idle: true, ..parts };
    assert_eq!(check(&may_idle, [&[2], &[1, 3]], &[4]), Ok(()), "with idle robots, groups may be smaller");
    assert_eq!(check(&may_idle, [&[], &[1]], &[2, 3, 4]), Ok(()));
    assert!(matches!(check(&may_idle, [&[], &[1, 2, 3, 4]], &[]), Err(AssignmentError::Parts { .. })));
    assert_eq!(check(&may_idle, [&[2], &[1, 3]], &[3]), Err(AssignmentError::Twice { robot: 3 }));
    assert_eq!(check(&may_idle, [&[], &[]], &[1, 2, 3, 4]), Err(AssignmentError::AllIdle));
}
