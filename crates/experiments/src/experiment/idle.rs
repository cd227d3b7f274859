//! Fields that change nothing in a trial, each with who reads it.

use scenario::Scenario;

use super::policy::PolicySpec;

/// The policies that weigh tasks by what they are worth and what they need. Programs and policies of other
/// crates may read anything.
const UTILITY: &[&str] = &["OPTIMAL", "GRAPE", "GREEDY"];

/// A field that may change nothing.
struct Field {
    path: &'static str,
    read_by: ReadBy,
}

/// Who reads a field.
enum ReadBy {
    /// These policies, where a task has the field.
    Policies(fn(&scenario::TaskFile) -> bool, &'static [&'static str]),
    /// The radio, unless this sentence says why not.
    Radio(fn(&Scenario) -> Option<String>),
}

const FIELDS: [Field; 7] = [
    of_task("tasks[*].value", |task| task.value.is_some(), UTILITY),
    of_task("tasks[*].requires", |task| !task.requires.is_empty(), UTILITY),
    of_task("tasks[*].duration_s", |task| task.duration_s.is_some(), &[]),
    of_task("tasks[*].after", |task| !task.after.is_empty(), &[]),
    Field { path: "medium.range_m", read_by: ReadBy::Radio(range) },
    Field { path: "medium.delay_s", read_by: ReadBy::Radio(delay) },
    Field { path: "medium.kbps", read_by: ReadBy::Radio(capacity) },
];

const fn of_task(
    path: &'static str,
    is_there: fn(&scenario::TaskFile) -> bool,
    policies: &'static [&'static str],
) -> Field {
    Field { path, read_by: ReadBy::Policies(is_there, policies) }
}

/// The fields of a scenario that change nothing under a policy, each with the reason, in a sentence.
pub(super) fn idle_fields(scenario: &Scenario, policy: &PolicySpec) -> Vec<String> {
    let may_read_all = policy.made().fingerprint().is_none() || policy.made().it.program().is_some();
    let idle = |field: &Field| match &field.read_by {
        ReadBy::Radio(reason) => reason(scenario).map(|reason| format!("{}: {reason}", field.path)),
        ReadBy::Policies(is_there, policies) => {
            let reads = may_read_all || policies.contains(&policy.name.as_str());
            let is_idle = !reads && scenario.tasks.iter().any(is_there);
            is_idle.then(|| format!("{}: {} does not read it", field.path, policy.label))
        }
    };
    FIELDS.iter().filter_map(idle).collect()
}

fn range(scenario: &Scenario) -> Option<String> {
    let range = scenario.medium.as_ref()?.range_m?;
    let [x, y] = scenario.arena_m;
    let farthest = x.hypot(y);
    (range >= farthest)
        .then(|| format!("no two places of the arena are farther apart than {farthest:.1} m, found {range}"))
}

fn delay(scenario: &Scenario) -> Option<String> {
    let (delay, end) = (scenario.medium.as_ref()?.delay_s, scenario.duration_s);
    (delay >= end).then(|| format!("what is sent by radio is heard after the end at {end} s, found {delay}"))
}

fn capacity(scenario: &Scenario) -> Option<String> {
    let medium = scenario.medium.as_ref()?;
    let every_s = scenario.reports.as_ref().map_or_else(Default::default, Clone::clone).every_s;
    let message_s = f64::from(medium.bytes) * 8.0 / (1000.0 * medium.kbps?) + medium.overhead_ms / 1000.0;
    let all_s = message_s * f64::from(scenario.robots());
    (all_s > every_s).then(|| {
        format!(
            "a report of all robots takes {all_s:.1} s, and they report every {every_s} s: it comes later \
             each time"
        )
    })
}
