//! Whether groups are large enough for the estimators of policies.

use std::collections::BTreeSet;

use scenario::Scenario;
use teaming::arrow::Written;
use teaming::question::hardest_first;
use teaming::{GroupSizes, Quota};

use super::Experiment;
use super::policy::PolicySpec;

impl Experiment {
    /// What is doubtful about policies in the scenarios of the sweep, each once: estimators that have nothing
    /// to judge, or need more raters of a robot than a group has.
    pub fn doubts(&self) -> BTreeSet<String> {
        let of_case = |scenario: &Scenario| -> Vec<String> {
            self.policies.iter().filter_map(|policy| policy.doubt(scenario)).collect()
        };
        self.cases.iter().flat_map(|case| of_case(&case.scenario)).collect()
    }
}

impl PolicySpec {
    /// A sentence about a policy whose estimator has nothing to judge in a scenario, or needs more raters
    /// than the smallest group has.
    pub fn doubt(&self, scenario: &Scenario) -> Option<String> {
        let (label, name) = (&self.label, &scenario.name);
        if Written::of(self.written()).guide.is_some() && !scenario.goes_by_reports() {
            return Some(format!(
                "{label}: {name} has no reports, medium or deceit: the estimator judges nothing"
            ));
        }
        let least = self.made().it.least_raters()?;
        let size = smallest_group(scenario)?;
        let raters = size - 1;
        (raters < least as usize).then(|| {
            format!(
                "{label}: the estimator needs {least} raters of each robot, and a group of {name} may have \
                 {size} members: {raters} raters"
            )
        })
    }
}

/// Members of the smallest group, with all robots fit and sizes as equal as possible where no quota asks for
/// others. Groups without members do not count.
fn smallest_group(scenario: &Scenario) -> Option<usize> {
    let order = hardest_first(scenario.tasks.iter().map(|task| task.difficulty));
    let mut sizes = vec![0; scenario.tasks.len()];
    for role in &scenario.roles {
        let count: u32 = scenario.team.iter().filter(|row| row.role == role.name).map(|row| row.count).sum();
        let asked: Vec<Option<usize>> = scenario
            .tasks
            .iter()
            .map(|task| task.quota.get(&role.name).map(|quota| *quota as usize))
            .collect();
        let quota = Quota::share(count as usize, &asked, &order, GroupSizes::Parts);
        sizes.iter_mut().zip(quota.members).for_each(|(size, members)| *size += members);
    }
    sizes.into_iter().filter(|size| *size > 0).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_small_groups_are_told_with_their_size() {
        let path = "../../scenarios/paper.ron".as_ref();
        let (paper, text) = Scenario::load(path).unwrap();
        let text = text.replace("    duration_s: 600.0,", "    duration_s: 600.0,\n    medium: (),");
        let scenario = Scenario::parse(&text, path).unwrap();
        let silent = PolicySpec::parse("RNE <- Kalman", &policies::standard()).unwrap().doubt(&paper);
        assert!(silent.unwrap().ends_with("has no reports, medium or deceit: the estimator judges nothing"));
        let doubt = |text| PolicySpec::parse(text, &policies::standard()).unwrap().doubt(&scenario);
        assert_eq!(doubt("RNE <- Wmsr(f: 2)"), None, "6 members are 5 raters");
        assert_eq!(
            doubt("RNE <- Both(level: Wmsr(f: 3))").unwrap(),
            "RNE <- Both(level: Wmsr(f: 3)): the estimator needs 7 raters of each robot, and a group of \
             paper may have 6 members: 5 raters"
        );
        assert_eq!(doubt("RNE <- Kalman"), None);
    }
}
