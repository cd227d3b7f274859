//! Keeps each robot on a route to its goal: plans routes when needed, and gives the preferred velocity.

mod trail;
mod traveller;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::belief::{Belief, News};
use crate::ids::RobotId;
use crate::planning::{KnownObstacle, Planner, Query, Route, Walls, polygon_contains};
use crate::robot::{Robot, STANDING_MPS};
use crate::scenario::{ResolverRule, Scenario};
use trail::Trail;
use traveller::{Attempt, PROGRESS_M};
pub use traveller::{Goal, Traveller};

/// Steps between two checks that the path to a robot's next waypoint is still free.
const ROUTE_CHECK_STEPS: u64 = 25;

/// A robot that has come no nearer to its goal for this long, in seconds, plans a detour round the robots
/// that stand in its way. After four times as long it plans without a detour again, and so on in turn: robots
/// that it does not see may block the detour as well.
const DETOUR_AFTER_S: f64 = 4.0;

/// A detour leads round standing robots within this distance, in metres.
const DETOUR_RANGE_M: f32 = 8.0;

/// Share of the drive's acceleration that robots plan to brake with; the rest is in reserve.
pub const PLANNED_BRAKING: f32 = 0.8;

/// The effect of news on a route.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// The route stays as good as it was.
    None,
    /// The route is cut, or leads through radiation.
    Cut,
    /// There may be a cheaper route, or a first one.
    Cheaper,
}

/// The journeys of all robots.
#[derive(Serialize, Deserialize)]
pub struct Navigator {
    travellers: Vec<Traveller>,
    trails: Vec<Trail>,
    #[serde(skip)]
    planner: Planner,
    #[serde(skip)]
    detour_steps: u64,
    #[serde(skip)]
    clearance: f32,
    /// Width and height of the arena, in metres, if the resolver needs the narrow passages of routes;
    /// otherwise none.
    #[serde(skip)]
    narrow_in: Option<Vector>,
}

impl Navigator {
    /// A navigator of robots without goals.
    #[must_use]
    pub fn new(scenario: &Scenario, robots: usize) -> Self {
        let mut navigator = Self {
            travellers: vec![Traveller::to(None); robots],
            trails: vec![Trail::default(); robots],
            planner: Planner::default(),
            detour_steps: 0,
            clearance: 0.0,
            narrow_in: None,
        };
        navigator.restore(scenario);
        navigator
    }

    /// Restores the fields that a snapshot leaves out: they follow from the scenario.
    pub(crate) fn restore(&mut self, scenario: &Scenario) {
        self.planner = Planner::new(scenario);
        self.detour_steps = (DETOUR_AFTER_S / scenario.dt_s).round() as u64;
        self.clearance = scenario.planning.clearance_m as f32;
        let arena = Vector::new(scenario.arena_m[0] as f32, scenario.arena_m[1] as f32);
        self.narrow_in = (scenario.conflicts.resolver == ResolverRule::Reciprocal).then_some(arena);
    }

    /// The journey of one robot.
    #[must_use]
    pub fn traveller(&self, robot: RobotId) -> &Traveller {
        &self.travellers[robot.index()]
    }

    /// Places that a robot passed, the latest last.
    #[must_use]
    pub fn trail(&self, robot: RobotId) -> &[Vector] {
        self.trails[robot.index()].points()
    }

    /// Sets the goal of a robot, or none. Setting the same goal again changes nothing.
    pub fn set_goal(&mut self, robot: RobotId, goal: Option<Goal>) {
        let traveller = &mut self.travellers[robot.index()];
        if traveller.goal != goal {
            *traveller = Traveller::to(goal);
        }
    }

    /// Plans routes. A robot plans if it has no route yet, if new knowledge cuts its route or may make it
    /// dearer or cheaper, or if it makes no progress. `team` are the robots as they said they are. `speed_of`
    /// is a robot's present top speed, in metres per second.
    pub fn plan<'k>(
        &mut self,
        team: &[Robot],
        belief_of: impl Fn(RobotId) -> &'k Belief,
        speed_of: impl Fn(&Robot) -> f64,
        step: u64,
    ) {
        for robot in team {
            self.trails[robot.id.index()].note(robot.position);
            let traveller = &mut self.travellers[robot.id.index()];
            let Some(goal) = traveller.goal else { continue };
            if !robot.is_able() || traveller.has_arrived(robot.position) {
                continue;
            }
            let belief = belief_of(robot.id);
            if let Some(route) = &mut traveller.route {
                route.advance(robot.position);
            }
            traveller.note_progress(robot.position);

            let query = || Query {
                from: robot.position,
                to: goal.point,
                aerial: robot.is_aerial(),
                speed: speed_of(robot) as f32,
                radius: robot.radius(),
                obstacles: belief.obstacles(robot.radius()),
                so_far: &[],
                in_the_way: &[],
                zones: belief.zones_on(),
            };
            let check_due = (step + robot.id.0 as u64).is_multiple_of(ROUTE_CHECK_STEPS);
            let attempt = traveller.attempt(self.detour_steps);
            let news = belief.news_since(traveller.seen);
            traveller.seen = belief.seen();
            let (replan, effect) = match &traveller.route {
                None => (
                    !news.is_empty() || check_due,
                    if news.is_empty() { Effect::None } else { Effect::Cheaper },
                ),
                Some(route) => {
                    let effect = effect(&self.planner, query, route, (news, belief), robot);
                    let cut_ahead = || check_due && first_leg_cut(belief, route, robot);
                    (attempt.is_some() || effect != Effect::None || cut_ahead(), effect)
                }
            };
            if replan || !traveller.is_planned {
                let fresh = effect != Effect::None || !traveller.is_planned;
                let in_the_way = match attempt {
                    Some(Attempt::Detour) => standing_near(team, robot, goal, self.clearance),
                    _ => Vec::new(),
                };
                let cut = traveller.route.as_ref().filter(|_| effect == Effect::Cut);
                let so_far = cut.map_or(&[][..], Route::ahead);
                let query = Query { so_far, in_the_way: &in_the_way, ..query() };
                let route = find_route(&mut self.planner, &query);
                if attempt == Some(Attempt::Detour) && !traveller.is_as_near(route.as_ref(), goal) {
                    continue;
                }
                traveller.set_route(route, robot.position, fresh);
                if let (Some(arena), Some(route), false) =
                    (self.narrow_in, &traveller.route, robot.is_aerial())
                {
                    let walls =
                        Walls { known: belief.obstacles(robot.radius()), arena, radius: robot.radius() };
                    traveller.passages = walls.passages(robot.position, route);
                }
            }
        }
    }

    /// The velocity that takes a robot along its route: at most `speed`, less before turns and the end. Zero
    /// if the robot has no route or has arrived.
    #[must_use]
    pub fn preferred_velocity(&self, robot: &Robot, speed: f32) -> Vector {
        let traveller = &self.travellers[robot.id.index()];
        let Some(route) = traveller.route.as_ref().filter(|_| !traveller.has_arrived(robot.position)) else {
            return Vector::ZERO;
        };
        let braking = PLANNED_BRAKING * robot.spec.acceleration_mps2 as f32;
        let reachable = |target: f32, distance: f32| (target * target + 2.0 * braking * distance).sqrt();
        let ahead = route.ahead();
        let to_next = ahead[0] - robot.position;
        let distance = to_next.length();
        let direction = to_next.normalize_or_zero();
        if 2.0 * braking * distance > speed * speed * 1.001 {
            return direction * speed; // the next waypoint is farther than the way that it takes to stop
        }
        let mut wished = speed.min(reachable(0.0, route.length(robot.position)));
        if let Some(after) = ahead.get(1) {
            let turn = direction.dot((*after - ahead[0]).normalize_or_zero());
            let in_turn = speed * f32::midpoint(1.0, turn).max(0.3);
            wished = wished.min(reachable(in_turn, distance));
        }
        direction * wished
    }
}

/// Robots of the same layer that stand nearby, as obstacles. Robots at the goal are left out, so that the
/// goal stays where it is.
fn standing_near(team: &[Robot], robot: &Robot, goal: Goal, clearance: f32) -> Vec<KnownObstacle> {
    let stands = |other: &&Robot| {
        other.id != robot.id
            && other.is_aerial() == robot.is_aerial()
            && other.velocity.length() < STANDING_MPS
            && (other.position - robot.position).length() < DETOUR_RANGE_M
    };
    let obstacle = |other: &Robot| {
        KnownObstacle::wreck(other.id.0, other.position, other.radius(), robot.radius(), clearance)
    };
    let is_off_goal = |other: &KnownObstacle| !polygon_contains(&other.planned, goal.point);
    team.iter().filter(stands).map(obstacle).filter(is_off_goal).collect()
}

/// The cheapest route round the standing robots. If there is none, the cheapest route through them, because
/// they may move.
fn find_route(planner: &mut Planner, query: &Query) -> Option<Route> {
    let route = planner.route(query);
    if route.is_some() || query.in_the_way.is_empty() {
        return route;
    }
    planner.route(&Query { in_the_way: &[], ..*query })
}

/// The effect of news on a route.
fn effect<'q>(
    planner: &Planner,
    query: impl Fn() -> Query<'q>,
    route: &Route,
    (news, belief): (&[News], &Belief),
    robot: &Robot,
) -> Effect {
    if news.iter().any(|news| concerns(*news, belief, route, robot)) {
        Effect::Cut
    } else if !robot.is_aerial() && may_cheapen(planner, query, route, news) {
        Effect::Cheaper
    } else {
        Effect::None
    }
}

/// Whether a piece of news cuts the route ahead, or shows that it leads through radiation.
fn concerns(news: News, belief: &Belief, route: &Route, robot: &Robot) -> bool {
    match news {
        News::Obstacle(key) => {
            let obstacle = belief.obstacles(robot.radius()).get(key).filter(|_| !robot.is_aerial());
            obstacle.is_some_and(|obstacle| route.legs(robot.position).any(|(a, b)| obstacle.cuts(a, b)))
        }
        News::Zone(number) => {
            let zone = belief.zones_on().iter().find(|(other, _)| *other == number);
            zone.is_some_and(|(_, zone)| route.length_inside(robot.position, zone) > 0.0)
        }
        News::Opening(_) => false,
    }
}

/// Whether debris was pushed away from a place through which a cheaper route of a ground robot may lead now.
/// Never `false` if there is a route that is cheaper by [`PROGRESS_M`] or more.
fn may_cheapen<'q>(planner: &Planner, query: impl Fn() -> Query<'q>, route: &Route, news: &[News]) -> bool {
    news.iter().any(|news| match news {
        News::Opening(opening) => {
            let query = query();
            opening.least_way(query.from, query.to) < planner.cost(&query, route) - PROGRESS_M
        }
        News::Obstacle(_) | News::Zone(_) => false,
    })
}

/// Whether the path to the next waypoint is cut, for a robot that was pushed or had to step aside.
fn first_leg_cut(belief: &Belief, route: &Route, robot: &Robot) -> bool {
    let next = route.ahead()[0];
    !robot.is_aerial() && belief.obstacles(robot.radius()).cuts(robot.position, next)
}
