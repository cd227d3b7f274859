//! What robots cannot reach from the start of a trial on. It is allowed, and worth a note.

use parry2d::math::Vector;
use scenario::shapes::{Outline, vector};
use scenario::{Errand, Problem, RoleFile, RoleKind, Scenario, TaskFile};

use super::{Layout, rescuee_places};
use crate::planning::{Planner, Ways};

impl Layout {
    /// The first place of each errand to which no way is wide enough for its robot, and tasks whose rescuees
    /// are all inside debris. Pieces that events place or remove are left out.
    pub fn out_of_reach(&self, scenario: &Scenario) -> Vec<Problem> {
        let (planner, outlines) = (Planner::new(scenario), self.lasting());
        let bodies = scenario.bodies().flat_map(|(body, count)| std::iter::repeat_n(body, count as usize));
        let bodies: Vec<RoleFile> = bodies.collect();
        let mut problems = Vec::new();
        for (number, errand) in scenario.errands.iter().enumerate() {
            let (body, home) = (&bodies[errand.robot as usize], self.robots[errand.robot as usize].home);
            if body.kind == RoleKind::Ground
                && let Some(place) = lost_place(errand, home, &planner.ways(body.radius_m as f32, &outlines))
            {
                problems.push(Problem {
                    field: format!("errands[{number}].to[{place}]"),
                    rule: format!("has no way to it that is wide enough for robot {}", errand.robot),
                    found: format!("{:?}", errand.to[place]),
                    hint: wide_enough(body, scenario),
                    ..Problem::default()
                });
            }
        }
        problems.extend(buried(scenario, &bodies, &planner, &outlines));
        problems
    }
}

/// The width of a way of a robot.
fn wide_enough(body: &RoleFile, scenario: &Scenario) -> String {
    let width_m = 2.0 * (body.radius_m + scenario.planning.clearance_m);
    format!("with planning.clearance_m on both sides it takes {width_m:.2} m; it gives up on the place")
}

/// Number of the first place of an errand to which no way leads. A robot is at a place that it covers.
fn lost_place(errand: &Errand, home: Vector, ways: &Ways) -> Option<usize> {
    let places: Vec<Vector> = errand.to.iter().map(|at| vector(*at)).collect();
    let from = std::iter::once(home).chain(places.iter().copied());
    let leads = |(from, to): (Vector, Vector)| {
        ways.off_m(to) <= ways.radius && ways.first_unreachable(from, &[((), to)]).is_none()
    };
    from.zip(places.iter().copied()).position(|leg| !leads(leg))
}

/// Tasks whose rescuees are all inside debris, out of reach of every robot that can carry.
fn buried(scenario: &Scenario, bodies: &[RoleFile], planner: &Planner, outlines: &[Outline]) -> Vec<Problem> {
    let bearers = || bodies.iter().filter(|body| body.capacity > 0);
    if bearers().any(|body| body.kind == RoleKind::Aerial) {
        return Vec::new();
    }
    let Some(smallest) = bearers().map(|body| body.radius_m).min_by(f64::total_cmp) else {
        return Vec::new();
    };
    let (ways, reach_m) = (planner.ways(smallest as f32, outlines), scenario.mission.reach_m);
    let problem = |(number, task): (usize, &TaskFile)| {
        let mut count = 0;
        let own = rescuee_places(scenario).filter(|(of, _)| of.index() == number).inspect(|_| count += 1);
        let is_buried = own.map(|(_, at)| at).all(|at| ways.off_m(at) > reach_m as f32) && count > 0;
        is_buried.then(|| Problem {
            field: format!("tasks[{number}].grid"),
            rule: format!("puts all rescuees of task {} inside debris, out of reach", task.name),
            found: format!("{count} rescuees"),
            hint: format!("a robot loads them from mission.reach_m, {reach_m} m, and cannot come so near"),
            ..Problem::default()
        })
    };
    scenario.tasks.iter().enumerate().filter_map(problem).collect()
}
