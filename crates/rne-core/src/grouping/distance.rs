//! `DIS`: the nearest task from the initial position until its group is full (paper: Section VI; baseline).

use super::{Difficulty, Grouping, GroupingPolicy, Member, Role, RoleQuota, Team, missing, squared_distance};
use crate::error::GroupingError;

/// Per role, takes the pairs robot-task in order of distance and assigns each robot to the first of its tasks whose quota is
/// not yet full. Exact ties of distance go to the lower id, then to the hard task.
pub(super) struct Distance;

impl GroupingPolicy for Distance {
    fn name(&self) -> &'static str {
        "DIS"
    }

    fn group(&self, team: &Team, _: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        let tasks = team.tasks().ok_or_else(|| missing(self.name(), "the positions of both tasks", None))?;
        let (mut easy, mut hard) = (Vec::new(), Vec::new());
        for role in Role::ALL {
            let robots: Vec<&Member> = team.of_role(role).collect();
            let mut open = RoleQuota::halves(robots.len());
            let mut pairs: Vec<(f64, u32, Difficulty)> = robots
                .iter()
                .flat_map(|robot| {
                    [(tasks.hard, Difficulty::Hard), (tasks.easy, Difficulty::Easy)]
                        .map(|(at, task)| (squared_distance(robot.position, at), robot.id, task))
                })
                .collect();
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(b.2.cmp(&a.2)));
            let mut assigned = Vec::with_capacity(robots.len());
            for (_, id, task) in pairs {
                let (slots, group) = match task {
                    Difficulty::Easy => (&mut open.easy, &mut easy),
                    Difficulty::Hard => (&mut open.hard, &mut hard),
                };
                if *slots > 0 && !assigned.contains(&id) {
                    *slots -= 1;
                    group.push(id);
                    assigned.push(id);
                }
            }
        }
        Ok(Grouping::unscored(easy, hard))
    }
}
