//! What a text that is no problem is told.

use mrta::read;

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
