//! Whether groups are large enough for the estimators of policies.

use std::collections::BTreeSet;

use scenario::Scenario;
use teaming::arrow::Written;
use teaming::question::hardest_first;
use teaming::{GroupSizes, Quota};

use super::Experiment;
use super::idle::idle_fields;
use super::policy::PolicySpec;

impl Experiment {
    /// What is doubtful about policies in the scenarios of the sweep, each once: estimators that have nothing
    /// to judge, are not used, or need more raters of a robot than a group has; and fields that nobody reads.
    pub fn doubts(&self) -> BTreeSet<String> {
        let of_case = |scenario: &Scenario| -> Vec<String> {
            self.policies.iter().flat_map(|policy| policy.doubts(scenario)).collect()
        };
        self.cases.iter().flat_map(|case| of_case(&case.scenario)).collect()
    }
}

impl PolicySpec {
    /// What is doubtful about a policy in a scenario, each in a sentence.
    pub fn doubts(&self, scenario: &Scenario) -> Vec<String> {
        let unused = self.made().it.idle_part().map(|part| format!("{}: {part}", self.label));
        self.doubt(scenario).into_iter().chain(unused).chain(idle_fields(scenario, self)).collect()
    }

    /// A sentence about a policy whose estimator has nothing to judge in a scenario, or needs more raters
    /// than the smallest group has, or whose robots have nothing to talk about.
    fn doubt(&self, scenario: &Scenario) -> Option<String> {
        let (label, name) = (&self.label, &scenario.name);
        if Written::of(&self.plain()).guide.is_some() && !scenario.goes_by_reports() {
            return Some(format!(
                "{label}: {name} has no reports, medium or deceit: the estimator judges nothing"
            ));
        }
        if self.protocol().is_some() && scenario.mission.decides.is_base() {
            return Some(format!("{label}: in {name} the base decides: what is behind `by` does nothing"));
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
        let parse = |text| PolicySpec::parse(text, &policies::standard()).unwrap();
        let silent = parse("RNE <- Kalman").doubt(&paper);
        assert!(silent.unwrap().ends_with("has no reports, medium or deceit: the estimator judges nothing"));
        let doubt = |text| parse(text).doubt(&scenario);
        assert_eq!(doubt("RNE <- Wmsr(f: 2)"), None, "6 members are 5 raters");
        assert_eq!(
            doubt("RNE <- Both(level: Wmsr(f: 3))").unwrap(),
            "RNE <- Both(level: Wmsr(f: 3)): the estimator needs 7 raters of each robot, and a group of \
             paper may have 6 members: 5 raters"
        );
        assert_eq!(doubt("RNE <- Kalman"), None);
    }

    #[test]
    fn what_does_nothing_is_told_with_the_reason() {
        let path = "../../scenarios/paper.ron".as_ref();
        let text = Scenario::load(path).unwrap().1;
        let doubts = |medium: &str, task: &str, policy| {
            let text = text
                .replace(
                    "    duration_s: 600.0,",
                    &format!("    duration_s: 600.0,\n    medium: ({medium}),"),
                )
                .replacen("name: \"hard\",", &format!("name: \"hard\", {task}"), 1);
            let scenario = Scenario::parse(&text, path).unwrap();
            PolicySpec::parse(policy, &policies::standard()).unwrap().doubts(&scenario)
        };
        let unused =
            "HP_DIS <- Beta: Beta judges trust only, and nothing uses it: add `| Discount` or `| Exclude`";
        assert_eq!(doubts("", "", "HP_DIS <- Beta"), [unused]);
        for used in ["HP_DIS <- Beta | Discount", "HP_DIS <- Kalman", "HP_DIS <- Both(level: Wmsr)"] {
            assert_eq!(doubts("range_m: 30, delay_s: 1, kbps: 100", "", used), [] as [&str; 0]);
        }
        let starts = |medium: &str, task: &str, policy, start: &str| {
            let found = doubts(medium, task, policy);
            assert!(found.len() == 1 && found[0].starts_with(start), "{found:?}");
        };
        starts("range_m: 500", "", "DIS", "medium.range_m: no two places of the arena");
        starts("delay_s: 600", "", "DIS", "medium.delay_s: what is sent by radio is heard after the end");
        starts("kbps: 0.1", "", "DIS", "medium.kbps: a report of all robots takes");
        starts("", "value: 3,", "DIS", "tasks[*].value: DIS does not read it");
        starts("", "after: [\"easy\"],", "GREEDY", "tasks[*].after: GREEDY does not read it");
        assert_eq!(doubts("", "value: 3, requires: {\"hp\": 100},", "GREEDY"), [] as [&str; 0]);
    }
}
