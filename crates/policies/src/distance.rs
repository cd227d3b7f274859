//! `DIS`: the nearest task from the initial position until its group is full (paper: Section VI; baseline).

use crate::facts::{missing, squared_distance};
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::ids::TaskId;
use teaming::policy::Policy;
use teaming::question::{Member, Question};
use teaming::registry::PolicyKind;

const NAME: &str = "DIS";

/// Per role, takes the pairs robot-task in order of distance and assigns each robot to the first of its tasks
/// whose quota is not yet full. Exact ties of distance go to the lower id, then to the harder task.
#[derive(Debug, Clone, Copy)]
pub struct Distance;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain(NAME, "the task nearest to a robot's home, until its group is full", Distance)
        .from_sources(env!("SOURCES_DISTANCE"))
}

impl Policy for Distance {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let place = |task: &TaskId| question.tasks[task.index()].place;
        let hardest_first = question.hardest_first();
        let places = hardest_first.iter().map(|task| place(task).map(|place| (*task, place)));
        let places: Vec<(TaskId, [f64; 2])> =
            places.collect::<Option<_>>().ok_or_else(|| missing(NAME, "the place of each task", None))?;
        let mut groups = vec![Vec::new(); question.tasks.len()];
        for (role, quota) in question.role_ids().zip(&question.quotas) {
            let robots: Vec<&Member> = question.of_role(role).collect();
            fill_nearest_first(&robots, &places, quota.members.clone(), &mut groups);
        }
        Ok(Decision::unscored(groups))
    }
}

/// Assigns the robots of one role, nearest pairs first. The order of `places` settles ties.
fn fill_nearest_first(
    robots: &[&Member],
    places: &[(TaskId, [f64; 2])],
    mut open: Vec<usize>,
    groups: &mut [Vec<u32>],
) {
    let pairs_of = |robot: &&Member| {
        let (id, home) = (robot.id, robot.home);
        places.iter().enumerate().map(move |(rank, (_, at))| (squared_distance(home, *at), id, rank))
    };
    let mut pairs: Vec<(f64, u32, usize)> = robots.iter().flat_map(pairs_of).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut assigned = Vec::with_capacity(robots.len());
    for (_, id, rank) in pairs {
        let task = places[rank].0.index();
        if open[task] > 0 && !assigned.contains(&id) {
            open[task] -= 1;
            groups[task].push(id);
            assigned.push(id);
        }
    }
}
