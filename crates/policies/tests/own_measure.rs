//! A model for a trust measure of one's own: what it measures, its options, and its place in a registry.

use serde::{Deserialize, Serialize};
use teaming::levels::ENERGY;
use teaming::{Assignment, MeasureKind, PolicyError, Question, TeamTrust, TrustMeasure};

/// Options, with their defaults.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Options {
    /// Distrust of each percent point by which energy levels differ.
    per_point: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { per_point: 1.0 }
    }
}

/// Robots trust those whose energy is like theirs.
struct Alike {
    options: Options,
}

/// The measure in one team.
struct InTeam<'q> {
    question: &'q Question,
    per_point: f64,
}

impl TrustMeasure for Alike {
    fn unit(&self) -> &'static str {
        "points"
    }

    fn of_team<'q>(&'q self, question: &'q Question) -> Result<Box<dyn TeamTrust + 'q>, PolicyError> {
        Ok(Box::new(InTeam { question, per_point: self.options.per_point }))
    }
}

impl TeamTrust for InTeam<'_> {
    fn towards(&self, from: &[u32], to: &[u32]) -> Result<f64, PolicyError> {
        let mean = |group: &[u32]| {
            let members = self.question.members.iter().filter(|member| group.contains(&member.id));
            let levels: Vec<f64> =
                members.filter_map(|member| self.question.level_of(member, ENERGY)).collect();
            levels.iter().sum::<f64>() / levels.len() as f64
        };
        let apart = (mean(from) - mean(to)).abs();
        if apart.is_finite() {
            return Ok(self.per_point * apart);
        }
        Err(PolicyError::Other("a group is empty or has no energy levels".to_owned()))
    }
}

const TEAM: &str = r#"{
    "schema_version": 3,
    "round": 1,
    "roles": ["robot"],
    "needs": [{"name": "energy", "weight": 1.0}],
    "levels": [{"name": "energy", "unit": "%"}],
    "tasks": [{"name": "near", "difficulty": 1}, {"name": "far", "difficulty": 2}],
    "quotas": [{"members": [1, 2], "sizes": "Parts"}],
    "members": [
        {"id": 1, "role": 0, "home": [0.0, 0.0], "needs": [90.0], "levels": [90.0]},
        {"id": 2, "role": 0, "home": [2.0, 0.0], "needs": [60.0], "levels": [60.0]},
        {"id": 3, "role": 0, "home": [4.0, 0.0], "needs": [80.0], "levels": [80.0]}
    ],
    "history": [],
    "random_seed": "0000000000000000000000000000000000000000000000000000000000000000"
}"#;

#[test]
fn a_measure_of_ones_own_measures_robots_and_groups() {
    let mut registry = policies::standard();
    let make = |options: Options| Ok::<_, String>(Alike { options });
    registry.add_measure(MeasureKind::with_options("ALIKE", "likeness of energy", make)).unwrap();
    let names: Vec<&str> = registry.measures().iter().map(|kind| kind.name.as_str()).collect();
    assert_eq!(names, ["RNE", "ALIKE"]);
    let question = Question::from_json(TEAM).unwrap();
    let alike = registry.measure("ALIKE(per_point: 0.5)").unwrap();
    let trust = alike.it.of_team(&question).unwrap();
    assert_eq!(trust.towards(&[1], &[2]).ok(), Some(15.0));
    // 60 % against a mean of 85 %, in both directions: the larger one counts once.
    assert_eq!(trust.between(&Assignment::new(vec![vec![2], vec![1, 3]])).unwrap(), Some(12.5));
    assert_eq!(trust.between(&Assignment::new(vec![vec![], vec![1, 2, 3]])).unwrap(), None);
    assert!(trust.towards(&[], &[1]).is_err());
    registry.choose_measure("ALIKE").unwrap();
    assert_eq!(registry.a_measure().unwrap().options, "(per_point: 1.0)");
    let unknown = registry.measure("LIKE").unwrap_err().to_string();
    assert_eq!(
        unknown,
        "unknown trust measure \"LIKE\"; known trust measures: RNE, ALIKE; did you mean ALIKE?"
    );
}
