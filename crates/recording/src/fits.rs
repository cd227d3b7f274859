//! Whether the parts of a recording fit each other: no part names a task, a role or a robot that is not
//! there.

use ron_tree::Problem;
use usar_sim::fit::Tables;

use crate::header::{RobotPlace, TaskPlace, World};
use crate::reader::TimedDecision;
use crate::trust::Trust;

impl World {
    /// The tables of the recorded trial.
    pub(crate) fn tables(&self) -> Tables<'_> {
        Tables {
            tasks: self.tasks.iter().map(|task| task.name.as_str()).collect(),
            roles: self.roles.iter().map(|role| role.name.as_str()).collect(),
            needs: self.needs.len(),
            robots: self.robots.len(),
        }
    }

    /// Whether the tables of a world name only what is there: roles, rest places of each task, and rescuees.
    pub(crate) fn fits(&self) -> bool {
        let of_robot =
            |robot: &RobotPlace| robot.role < self.roles.len() && robot.rest.len() == self.tasks.len();
        let of_task = |task: &TaskPlace| {
            task.first_rescuee.checked_add(task.rescuees).is_some_and(|end| end <= self.rescuees.len())
        };
        let is_there = |numbers: &[usize], count: usize| numbers.iter().all(|number| *number < count);
        self.robots.iter().all(of_robot)
            && self.tasks.iter().all(of_task)
            && is_there(&self.debris_later, self.debris.len())
            && is_there(&self.zones_later, self.zones.len())
            && is_there(&self.rescuees_later, self.rescuees.len())
    }
}

impl TimedDecision {
    /// Checks that the decision and its matrices fit these tables.
    pub(crate) fn check(&self, tables: &Tables) -> Result<(), Box<Problem>> {
        tables.check_decision(&self.question, &self.decision, &self.joins, self.truth.as_deref())?;
        let Some(Trust { members, robots, groups, .. }) = &self.trust else { return Ok(()) };
        let is_square = |matrix: &[Vec<Option<f64>>], size: usize| {
            matrix.len() == size && matrix.iter().all(|row| row.len() == size)
        };
        if !is_square(robots, members.len()) || !is_square(groups, tables.tasks.len()) {
            return Err(Box::new(Problem::new(
                "trust",
                "must have a row and a column for each member and group",
                "",
            )));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use scenario::Scenario;
    use usar_sim::simulation::Simulation;

    use super::*;

    #[test]
    fn a_world_names_only_what_is_there() {
        let text = include_str!("../../../scenarios/gallery/one-task.ron");
        let scenario = Scenario::parse(text, "one-task.ron".as_ref()).unwrap();
        let sound = World::of(&Simulation::new(&scenario, 1).unwrap());
        assert!(sound.fits());
        let changes: [fn(&mut World); 5] = [
            |world| world.robots[0].role = world.roles.len(),
            |world| world.robots[0].rest.clear(),
            |world| world.tasks[0].first_rescuee = usize::MAX,
            |world| world.tasks.clear(),
            |world| world.rescuees_later.push(world.rescuees.len()),
        ];
        for change in changes {
            let mut world = sound.clone();
            change(&mut world);
            assert!(!world.fits());
        }
    }
}
