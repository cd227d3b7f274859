//! What a text that is no problem is told.

use mrta::{earliest, optimum, read, write};

/// A sound problem, with one field replaced.
fn told(field: &str, value: &str) -> String {
    let fields = [
        ("Q", "[[1,0],[0,1]]"),
        ("R", "[[0,0],[1,0],[1,1],[0,0]]"),
        ("T_e", "[0,5,6,0]"),
        ("task_locations", "[[0,0],[1,1],[2,2],[3,3]]"),
        ("precedence_constraints", "[[1,2]]"),
    ];
    let known = fields.iter().any(|(name, _)| *name == field);
    let fields = fields.into_iter().chain((!known).then_some((field, value)));
    let fields = fields.map(|(name, old)| format!("\"{name}\": {}", if name == field { value } else { old }));
    match read("x", &format!("{{{}}}", fields.collect::<Vec<_>>().join(", "))) {
        Ok(_) => "sound".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_bad_field_is_told_with_rule_and_found_value() {
    let cases = [
        ("Q", "[[1,0],[0,1]]", "sound"),
        ("Q", "3", "Q: must be a list of lists of numbers, found 3"),
        ("Q", "[]", "Q: must have a row for each robot with 1 to 64 skills, found []"),
        ("Q", "[[1,0],[0]]", "Q[1]: must have a number for each of the 2 skills of Q[0], found 1"),
        ("Q", "[[1,0],[0,2]]", "Q[1]: must have 0 or 1 for each skill, found 2"),
        (
            "Q",
            "[[1,0],[1,0]]",
            "R[2]: must require only skills that a robot has, found skill 2, which nobody has",
        ),
        ("R", "[[0,0],[1,0],[0,0],[0,0]]", "R[2]: must require a skill, found [0.0, 0.0]"),
        (
            "R",
            "[[1,0],[1,1]]",
            "R: must have a first and a last row of zeros, and a row for each task between them, found 2",
        ),
        (
            "R",
            "[[1,0],[1,0],[1,1],[1,1]]",
            "R[0]: must be 0: the first and the last row are no tasks, found [1.0, 0.0]\n\
             R[3]: must be 0: the first and the last row are no tasks, found [1.0, 1.0]",
        ),
        ("T_e", "[0,5,NaN,0]", "T_e[2]: must be a finite number, found \"NaN\""),
        ("T_e", "[0,-Infinity,1,0]", "T_e[1]: must be a finite number, found \"-infinite\""),
        ("T_e", "[0,5,-1,0]", "T_e[2]: must be at least 0, found -1"),
        ("T_e", "[0,5,1e101,0]", "T_e[2]: must be at most 1e100 in size, found 1e+101"),
        ("T_e", "[5,6]", "T_e: must have a number for each of the 4 rows of R, found 2"),
        (
            "task_locations",
            "[[0,0]]",
            "task_locations: must have a place for each of the 4 rows of R, found 1",
        ),
        ("task_locations", "[[0,0],[1,1],[2],[3,3]]", "task_locations[2]: must be two numbers, found 1"),
        (
            "precedence_constraints",
            "[[1,2],[2,1]]",
            "precedence_constraints: must have no circle, found a circle in or before the rows [1, 2]",
        ),
        (
            "precedence_constraints",
            "[[0,2]]",
            "precedence_constraints[0]: must be two rows of tasks, from 1 to 2, found [0.0, 2.0]",
        ),
        ("T_t", "[[0,1],[1,0]]", "T_t: must have a row for each of the 4 rows of R, found 2"),
        ("T_t", "[[0,1,1,1],[1,0,1,1],[1,1,0,1],[1,1,-1,0]]", "T_t[3]: must have no time below 0, found -1"),
    ];
    for (field, value, expected) in cases {
        let found = told(field, value);
        assert!(found.starts_with(expected), "{field} {value}\n{found}\n{expected}");
    }
    assert!(read("x", "{").unwrap_err().to_string().starts_with("the text is not JSON: "));
}

#[test]
fn several_bad_fields_are_told_at_once() {
    let told = told("Q", "[[1,3],[0,2,4]]");
    assert_eq!(told.lines().count(), 3, "{told}");
}

/// A sound problem in the form of HeteroMRTA, with a part of its text replaced.
fn told_of_hetero(part: &str, by: &str) -> String {
    let sound = r#"{"setup": {"robots": 2, "tasks": 2, "num_skills": 2},
        "tasks": {"0": {"pos": {"x": 1, "y": 2}, "skillset": {"0": 1, "1": 0}, "duration": 5},
            "1": {"pos": {"x": 3, "y": 4}, "skillset": {"0": 1, "1": 1}, "duration": 6}},
        "robots": {"0": {"pose": {"x": 7, "y": 8}, "skillset": {"0": 1, "1": 0.0}},
            "1": {"pose": {"x": 9, "y": 0}, "skillset": {"0": 0, "1": 1.0}}}}"#;
    assert!(sound.contains(part), "{part}");
    match read("x", &sound.replacen(part, by, 1)) {
        Ok(_) => "sound".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_bad_field_of_the_second_form_is_told_with_rule_and_found_value() {
    let keys = "must have the keys 0 to 1 (see setup), found";
    let cases = [
        ("5", "5", "sound".to_owned()),
        ("setup", "set", "setup.num_skills: must be a whole number, 1 to 64, found nothing".to_owned()),
        (
            r#""tasks": 2"#,
            r#""tasks": 2.5"#,
            "setup.tasks: must be a whole number, at least 1, found 2.5".to_owned(),
        ),
        (
            r#""robots": 2"#,
            r#""robots": 0"#,
            "setup.robots: must be a whole number, at least 1, found 0".to_owned(),
        ),
        (
            r#"skills": 2"#,
            r#"skills": 65"#,
            "setup.num_skills: must be a whole number, 1 to 64, found 65".to_owned(),
        ),
        (
            r#"skills": 2"#,
            r#"skills": 3"#,
            "robots.0.skillset: must have the keys 0 to 2 (see setup), found 2 in all".to_owned(),
        ),
        (r#""tasks": {"#, r#""works": {"#, format!("tasks: {keys} nothing")),
        (r#""robots": {"0": {"#, r#""bots": {"0": {"#, format!("robots: {keys} nothing")),
        (
            r#""tasks": 2"#,
            r#""tasks": 3"#,
            "tasks: must have the keys 0 to 2 (see setup), found 2 in all".to_owned(),
        ),
        (r#""1": {"pose""#, r#""2": {"pose""#, format!("robots: {keys} 2 in all, one of them \"2\"")),
        (r#""1": {"pos""#, r#""01": {"pos""#, format!("tasks: {keys} 2 in all, one of them \"01\"")),
        (r#"{"0": 1, "1": 1}"#, r#"{"0": 1}"#, format!("tasks.1.skillset: {keys} 1 in all")),
        (r#"{"0": 1, "1": 1}"#, "[1, 1]", format!("tasks.1.skillset: {keys} [1,1]")),
        (
            r#"{"0": 1, "1": 1}"#,
            r#"{"0": 1, "1": 0.5}"#,
            "tasks.1.skillset.1: must be 0 or 1, found 0.5".to_owned(),
        ),
        (r#""1": 1.0"#, r#""1": true"#, "robots.1.skillset.1: must be 0 or 1, found true".to_owned()),
        (
            r#"{"0": 1, "1": 1}"#,
            r#"{"0": 0, "1": 0}"#,
            "tasks.1.skillset: must require a skill, found only 0".to_owned(),
        ),
        (
            r#""1": 1.0"#,
            r#""1": 0"#,
            "tasks.1.skillset.1: must be 0, because no robot has this skill, found 1".to_owned(),
        ),
        (
            r#""duration": 6"#,
            r#""duration": -6"#,
            "tasks.1.duration: must be at least 0, found -6".to_owned(),
        ),
        (
            r#""duration": 6"#,
            r#""duration": NaN"#,
            "tasks.1.duration: must be a finite number, found \"NaN\"".to_owned(),
        ),
        (r#", "duration": 6"#, "", "tasks.1.duration: must be a finite number, found nothing".to_owned()),
        (r#""y": 4"#, r#""z": 4"#, "tasks.1.pos.y: must be a finite number, found nothing".to_owned()),
        (
            r#""x": 9"#,
            r#""x": Infinity"#,
            "robots.1.pose.x: must be a finite number, found \"Infinity\"".to_owned(),
        ),
    ];
    for (part, by, expected) in cases {
        let found = told_of_hetero(part, by);
        assert!(found.starts_with(&expected), "{part} -> {by}\n{found}\n{expected}");
        assert!(
            found.lines().count() == 1 || part == "setup" || by.ends_with('3'),
            "{part} -> {by}\n{found}"
        );
    }
    let both = told_of_hetero(r#""duration": 5}"#, r#""duration": -5, "skillset": {"0": 2, "1": 1}}"#);
    assert_eq!(both.lines().count(), 2, "{both}");
}

#[test]
fn robots_of_the_second_form_begin_and_end_at_their_own_places_and_move_at_a_fifth() {
    let text = r#"{"setup": {"robots": 2, "tasks": 1, "num_skills": 1},
        "tasks": {"0": {"pos": {"x": 3, "y": 4}, "skillset": {"0": 1}, "duration": 5}},
        "robots": {"0": {"pose": {"x": 0, "y": 0}, "skillset": {"0": 1}},
            "1": {"pose": {"x": 3, "y": 1}, "skillset": {"0": 1}}}}"#;
    let problem = read("x", text).unwrap();
    // The nearer robot goes there and back, 3 each way.
    for found in [optimum(&problem).unwrap(), earliest(&problem)] {
        assert!((found - 35.0).abs() < 1e-9, "{found}");
    }
    assert_eq!(write(&problem), None);
}
