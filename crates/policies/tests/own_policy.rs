//! A custom policy, written outside the crate: a model for your own.

use serde::{Deserialize, Serialize};
use teaming::{Decision, Member, Policy, PolicyError, PolicyKind, Question, Registry};

/// The options: a struct with defaults that serde can read and write.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct SpeedOptions {
    /// Name of the need that says how fast a robot is.
    need: String,
}

impl Default for SpeedOptions {
    fn default() -> Self {
        Self { need: "v".to_owned() }
    }
}

/// Per role, sends the faster robots to the harder tasks; ties go to the lower id.
struct Speed {
    options: SpeedOptions,
}

impl Speed {
    /// Checks the options. The error message is shown to the user who wrote them.
    fn new(options: SpeedOptions) -> Result<Self, String> {
        if options.need.is_empty() { Err("need must be a name".to_owned()) } else { Ok(Self { options }) }
    }
}

impl Policy for Speed {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let name = &self.options.need;
        let Some(speed) = question.needs.iter().position(|need| need.name == *name) else {
            return Err(PolicyError::Other(format!("policy SPEED: the team has no need {name:?}")));
        };
        let mut groups = vec![Vec::new(); question.tasks.len()];
        for (role, quota) in question.role_ids().zip(&question.quotas) {
            let mut robots: Vec<&Member> = question.of_role(role).collect(); // by id
            robots.sort_by(|a, b| b.needs.values()[speed].total_cmp(&a.needs.values()[speed]));
            let mut fastest_first = robots.iter().map(|robot| robot.id);
            for task in question.hardest_first() {
                let seats = quota.members[task.index()];
                groups[task.index()].extend(fastest_first.by_ref().take(seats));
            }
        }
        Ok(Decision::unscored(groups))
    }
}

/// The built-in policies and this one.
fn registry() -> Registry {
    let mut registry = policies::standard();
    let speed = PolicyKind::with_options("SPEED", "the faster robots take the harder tasks", Speed::new);
    registry.add(speed).expect("no built-in policy has this name");
    registry
}

const TEAM: &str = r#"{
    "schema_version": 3,
    "round": 1,
    "roles": ["carrier"],
    "needs": [{"name": "hp", "weight": 1.0}, {"name": "v", "weight": 1.0}],
    "tasks": [{"name": "easy", "difficulty": 1}, {"name": "hard", "difficulty": 2}],
    "quotas": [{"members": [1, 2], "sizes": "Parts"}],
    "members": [
        {"id": 1, "role": 0, "home": [0.0, 0.0], "needs": [90.0, 1.5]},
        {"id": 2, "role": 0, "home": [2.0, 0.0], "needs": [60.0, 2.0]},
        {"id": 3, "role": 0, "home": [4.0, 0.0], "needs": [80.0, 1.0]}
    ],
    "history": [],
    "random_seed": "0000000000000000000000000000000000000000000000000000000000000000"
}"#;

#[test]
fn the_fastest_robots_take_the_hard_task() {
    let speed = registry().parse(r#"SPEED(need: "v")"#).unwrap();
    let question = Question::from_json(TEAM).unwrap();
    let decision = speed.decide(&question).unwrap();
    decision.assignment.check(&question).unwrap();
    assert_eq!(decision.assignment.groups, [vec![3], vec![1, 2]]);
}

#[test]
fn options_have_defaults_and_wrong_ones_are_refused_with_those_that_there_are() {
    let registry = registry();
    assert_eq!(registry.names().last(), Some(&"SPEED"));
    assert_eq!(registry.parse("SPEED").unwrap().options, r#"(need: "v")"#);
    let refused = |text| registry.parse(text).unwrap_err().to_string();
    assert_eq!(
        refused(r#"SPEED(speed: "v")"#),
        "policy SPEED: speed is no field, found \"(speed: \\\"v\\\")\"; did you mean need? There are need; \
         options and defaults: (need: \"v\")"
    );
    assert_eq!(
        refused(r#"SPEED(need: "")"#),
        "policy SPEED: need must be a name, found \"(need: \\\"\\\")\"; options and defaults: (need: \"v\")"
    );
}

#[test]
fn a_need_that_the_team_does_not_report_is_named() {
    let speed = registry().parse(r#"SPEED(need: "wings")"#).unwrap();
    let error = speed.decide(&Question::from_json(TEAM).unwrap()).unwrap_err();
    assert_eq!(error.to_string(), "policy SPEED: the team has no need \"wings\"");
}
