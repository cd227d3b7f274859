//! Features of an assignment that may predict the outcome: of the team as it really is before the decision.

use teaming::{Assignment, MadeMeasure, Member, Question, TeamTrust};

use crate::rounds::{energy, hp};

/// A feature: a number computed for each assignment.
pub struct Feature {
    /// Name in words; `{}` stands for the name of the trust measure.
    name: &'static str,
    value: fn(&Seen, &Assignment) -> Option<f64>,
}

/// The data from which features are computed.
struct Seen<'q> {
    question: &'q Question,
    trust: Box<dyn TeamTrust + 'q>,
}

/// All features. The hardest group is the group of the hardest task.
pub const FEATURES: [Feature; 9] = [
    Feature { name: "mean energy of the hardest group", value: |seen, a| seen.mean(a, energy) },
    Feature { name: "lowest energy of the hardest group", value: |seen, a| seen.lowest(a, energy) },
    Feature { name: "spread of energy in the hardest group", value: |seen, a| seen.spread(a, energy) },
    Feature { name: "mean HP of the hardest group", value: |seen, a| seen.mean(a, hp) },
    Feature { name: "spread of HP in the hardest group", value: |seen, a| seen.spread(a, hp) },
    Feature { name: "capability of the hardest group", value: |seen, a| seen.capability(a) },
    Feature { name: "{} between the groups", value: |seen, a| seen.between(a) },
    Feature { name: "{} within the groups", value: |seen, a| seen.within(a) },
    Feature { name: "way from the homes to the tasks", value: |seen, a| seen.way(a) },
];

impl Feature {
    /// Name in words, with this trust measure.
    pub fn name(&self, measure: &MadeMeasure) -> String {
        self.name.replace("{}", &measure.label)
    }
}

/// The value of each feature for each assignment; `None` where it is undefined.
pub fn values(
    question: &Question,
    assignments: &[&Assignment],
    measure: &MadeMeasure,
) -> Vec<Vec<Option<f64>>> {
    let Ok(trust) = measure.it.of_team(question) else { return Vec::new() };
    let seen = Seen { question, trust };
    FEATURES.iter().map(|feature| assignments.iter().map(|a| (feature.value)(&seen, a)).collect()).collect()
}

impl Seen<'_> {
    fn hardest<'a>(&'a self, assignment: &'a Assignment) -> impl Iterator<Item = &'a Member> {
        let hardest = self.question.hardest_first().first().copied().unwrap_or_default();
        let group = assignment.of(hardest);
        self.question.members.iter().filter(move |member| group.contains(&member.id))
    }

    fn mean(&self, assignment: &Assignment, level: fn(&Member) -> f64) -> Option<f64> {
        let levels: Vec<f64> = self.hardest(assignment).map(level).collect();
        (!levels.is_empty()).then(|| levels.iter().sum::<f64>() / levels.len() as f64)
    }

    fn lowest(&self, assignment: &Assignment, level: fn(&Member) -> f64) -> Option<f64> {
        self.hardest(assignment).map(level).reduce(f64::min)
    }

    fn spread(&self, assignment: &Assignment, level: fn(&Member) -> f64) -> Option<f64> {
        let mean = self.mean(assignment, level)?;
        let squares: Vec<f64> =
            self.hardest(assignment).map(|member| (level(member) - mean).powi(2)).collect();
        Some((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    }

    /// The sum over the hardest group's members of their weighted needs, weighted as the trust
    /// measure does. Undefined for a measure without weights.
    fn capability(&self, assignment: &Assignment) -> Option<f64> {
        let weights = self.trust.weights();
        let of = |member: &Member| member.needs.values().iter().zip(weights).map(|(n, w)| n * w).sum::<f64>();
        (!weights.is_empty()).then(|| self.hardest(assignment).map(of).sum())
    }

    fn between(&self, assignment: &Assignment) -> Option<f64> {
        self.trust.between(assignment).ok()?.filter(|value| value.is_finite())
    }

    /// The mean over all robots of their distrust towards their own group.
    fn within(&self, assignment: &Assignment) -> Option<f64> {
        let mut values = Vec::new();
        for group in &assignment.groups {
            for member in self.question.members.iter().filter(|member| group.contains(&member.id)) {
                let towards = self.trust.towards(&[member.id], group).ok()?;
                values.push(Some(towards).filter(|value| value.is_finite())?);
            }
        }
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// The sum over all robots of the straight-line distance from their homes to their tasks, in metres.
    fn way(&self, assignment: &Assignment) -> Option<f64> {
        let mut sum = 0.0;
        for member in &self.question.members {
            let task = assignment.task_of(member.id)?;
            let place = self.question.tasks[task.index()].place?;
            sum += (member.home[0] - place[0]).hypot(member.home[1] - place[1]);
        }
        Some(sum)
    }
}
