//! Keeps each robot on a route to its goal: plans routes when needed, and gives the preferred velocity.

mod trail;
mod traveller;
mod way_out;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::belief::KnownRobot;
use crate::belief::{Belief, News};
use crate::executor::Executor;
use crate::ids::RobotId;
use crate::model::{Model, RuleKind};
use crate::planning::{KnownObstacle, Planner, Query, Route, Walls, polygon_contains};
use crate::robot::STANDING_MPS;
use trail::Trail;
use traveller::{Attempt, PROGRESS_M};
pub use traveller::{Goal, Traveller};
use way_out::way_out;

/// A robot that has come no nearer to its goal for this long, in seconds, plans a detour round the robots
/// that stand in its way. After four times as long it plans without a detour again, and so on in turn: robots
/// that it does not see may block the detour as well.
const DETOUR_AFTER_S: f64 = 4.0;

/// Time between two checks that the way to a robot's next waypoint is still free, in seconds.
const CHECK_EVERY_S: f64 = 0.5;

/// A detour leads round standing robots within this distance, in metres.
const DETOUR_RANGE_M: f32 = 8.0;

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
}

/// What robots plan their routes by in one step.
pub struct Outlook<'o, B, S> {
    /// The fixed part of the trial.
    pub model: &'o Model,
    /// The robots as they said they are.
    pub team: &'o [KnownRobot],
    /// Steps done.
    pub step: u64,
    /// The belief that a robot shares.
    pub belief_of: B,
    /// A robot's present top speed, in metres per second.
    pub speed_of: S,
}

impl Navigator {
    /// A navigator of robots without goals.
    pub fn new(robots: usize) -> Self {
        Self { travellers: vec![Traveller::to(None); robots], trails: vec![Trail::default(); robots] }
    }

    /// The journeys as they count in the hash chain.
    pub fn to_hash(&self) -> impl Serialize + '_ {
        (&self.travellers, self.trails.iter().map(Trail::digest).collect::<Vec<_>>())
    }

    /// The journey of one robot.
    pub fn traveller(&self, robot: RobotId) -> &Traveller {
        &self.travellers[robot.index()]
    }

    /// Length of the route ahead of a robot, in metres (none without a route), and whether the robot is at
    /// its goal or has none.
    pub(crate) fn way_left(&mut self, robot: RobotId, from: Vector) -> (Option<f32>, bool) {
        let traveller = &mut self.travellers[robot.index()];
        (traveller.measure(from), traveller.settle(from))
    }

    /// Places that a robot passed, the latest last.
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
    /// dearer or cheaper, or if it makes no progress.
    pub fn plan<'o, B, S>(&mut self, outlook: &Outlook<'o, B, S>, executor: Executor)
    where
        B: Fn(RobotId) -> &'o Belief + Sync,
        S: Fn(&KnownRobot) -> f64 + Sync,
    {
        let Self { travellers, trails } = self;
        let executor = executor.for_team(outlook.team.len());
        let part = executor.part(outlook.team.len());
        let journeys = travellers.chunks_mut(part).zip(trails.chunks_mut(part));
        executor.run(outlook.team.chunks(part).zip(journeys), |(team, (travellers, trails))| {
            outlook.plan(team, travellers, trails);
        });
    }

    /// The velocity that takes a robot along its route: at most `speed`, less before turns and the end. Zero
    /// if the robot has no route or has arrived.
    pub fn preferred_velocity(&self, robot: &KnownRobot, speed: f32) -> Vector {
        let traveller = &self.travellers[robot.id.index()];
        let Some(route) = traveller.route.as_ref().filter(|_| !traveller.has_arrived(robot.position)) else {
            return Vector::ZERO;
        };
        let brakes = robot.spec.brakes;
        let ahead = route.ahead();
        let to_next = ahead[0] - robot.position;
        let distance = to_next.length();
        let direction = to_next.normalize_or_zero();
        if distance > brakes.way(speed) * 1.001 {
            return direction * speed; // the next waypoint is farther than the way that it takes to stop
        }
        let left = traveller.length(robot.position).unwrap_or(0.0);
        let mut wished = speed.min(brakes.speed_before(0.0, left));
        if let Some(after) = ahead.get(1) {
            let turn = direction.dot((*after - ahead[0]).normalize_or_zero());
            let in_turn = speed * f32::midpoint(1.0, turn).max(0.3);
            wished = wished.min(brakes.speed_before(in_turn, distance));
        }
        direction * wished
    }
}

impl<'o, B, S> Outlook<'o, B, S>
where
    B: Fn(RobotId) -> &'o Belief,
    S: Fn(&KnownRobot) -> f64,
{
    /// Plans the routes of some of the robots, whose journeys these are.
    fn plan(&self, team: &'o [KnownRobot], travellers: &mut [Traveller], trails: &mut [Trail]) {
        let detour_steps = self.model.control_steps_in(DETOUR_AFTER_S);
        for ((robot, traveller), trail) in team.iter().zip(travellers).zip(trails) {
            trail.note(robot.position);
            let Some(goal) = traveller.goal else { continue };
            if !robot.is_able() || traveller.has_arrived(robot.position) {
                continue;
            }
            if let Some(route) = &mut traveller.route {
                route.advance(robot.position);
            }
            traveller.note_progress(robot.position);
            let (belief, trail) = ((self.belief_of)(robot.id), trail.points());
            let wayfinder = Wayfinder { outlook: self, robot, goal, belief, trail };
            wayfinder.keep_on_route(traveller, detour_steps);
        }
    }
}

/// One robot on its way to a goal, and what it knows.
struct Wayfinder<'w, 'o, B, S> {
    outlook: &'w Outlook<'o, B, S>,
    robot: &'o KnownRobot,
    goal: Goal,
    belief: &'o Belief,
    /// Places that it passed, the latest last.
    trail: &'w [Vector],
}

impl<B, S: Fn(&KnownRobot) -> f64> Wayfinder<'_, '_, B, S> {
    /// Plans a route if one is due.
    fn keep_on_route(&self, traveller: &mut Traveller, detour_steps: u64) {
        let Self { outlook, robot, belief, .. } = self;
        let turn = outlook.step / outlook.model.control_steps + robot.id.0 as u64;
        let check_due = turn.is_multiple_of(outlook.model.control_steps_in(CHECK_EVERY_S).max(1));
        let attempt = traveller.attempt(detour_steps);
        let news = belief.news_since(traveller.seen);
        traveller.seen = belief.seen();
        let (replan, effect) = match &traveller.route {
            None if news.is_empty() => (check_due && !traveller.is_lost_at(robot.position), Effect::None),
            None => (true, Effect::Cheaper),
            Some(route) => {
                let effect = self.effect(news, route);
                let cut_ahead = || check_due && self.is_first_leg_cut(route);
                (attempt.is_some() || effect != Effect::None || cut_ahead(), effect)
            }
        };
        if replan || !traveller.is_planned {
            self.plan_anew(traveller, attempt, effect);
        }
        self.examine_ahead(traveller);
    }

    /// Plans a route.
    fn plan_anew(&self, traveller: &mut Traveller, attempt: Option<Attempt>, effect: Effect) {
        let Self { outlook, robot, .. } = self;
        let is_detour = attempt == Some(Attempt::Detour);
        let in_the_way = if is_detour { self.standing_near() } else { Vec::new() };
        let query = Query { in_the_way: &in_the_way, ..self.query() };
        let planner = &outlook.model.planner;
        let way_out = || if robot.is_aerial() { None } else { way_out(planner, &query, self.trail) };
        let route = find_route(planner, &query).or_else(way_out);
        if is_detour && !traveller.is_as_near(route.as_ref(), self.goal) {
            return;
        }
        traveller.set_route(route, robot.position, effect != Effect::None || !traveller.is_planned);
    }

    /// Looks for narrow passages on the next part of the route, where the right of way depends on them.
    fn examine_ahead(&self, traveller: &mut Traveller) {
        let Self { outlook, robot, belief, .. } = self;
        if outlook.model.right_of_way.rule != RuleKind::Reciprocal || robot.is_aerial() {
            return;
        }
        let left = traveller.length(robot.position);
        if let (Some(route), Some(left)) = (&traveller.route, left) {
            let (known, arena) = (belief.obstacles(robot.radius()), outlook.model.arena);
            let walls = Walls { known, arena, radius: robot.radius() };
            walls.examine(robot.position, left, route, &mut traveller.passages);
        }
    }

    fn query(&self) -> Query<'_> {
        let robot = self.robot;
        Query {
            from: robot.position,
            to: self.goal.point,
            aerial: robot.is_aerial(),
            speed: (self.outlook.speed_of)(robot) as f32,
            radius: robot.radius(),
            obstacles: self.belief.obstacles(robot.radius()),
            in_the_way: &[],
            zones: self.belief.zones_on(),
        }
    }

    /// The effect of news on a route.
    fn effect(&self, news: &[News], route: &Route) -> Effect {
        if news.iter().any(|news| self.concerns(*news, route)) {
            Effect::Cut
        } else if !self.robot.is_aerial() && self.may_cheapen(news, route) {
            Effect::Cheaper
        } else {
            Effect::None
        }
    }

    /// Whether a piece of news cuts the route ahead, or shows that it leads through radiation.
    fn concerns(&self, news: News, route: &Route) -> bool {
        let (robot, at) = (self.robot, self.robot.position);
        match news {
            News::Obstacle(key) => {
                let obstacle = self.belief.obstacles(robot.radius()).get(key).filter(|_| !robot.is_aerial());
                obstacle.is_some_and(|obstacle| route.legs(at).any(|(a, b)| obstacle.cuts(a, b)))
            }
            News::Zone(number) => {
                let zone = self.belief.zones_on().iter().find(|(other, _)| *other == number);
                zone.is_some_and(|(_, zone)| route.length_inside(at, zone) > 0.0)
            }
            News::Opening(_) => false,
        }
    }

    /// Whether debris was pushed away from a place through which a cheaper route of a ground robot may lead
    /// now. Never `false` if there is a route that is cheaper by [`PROGRESS_M`] or more.
    fn may_cheapen(&self, news: &[News], route: &Route) -> bool {
        news.iter().any(|news| match news {
            News::Opening(opening) => {
                let query = self.query();
                let cost = self.outlook.model.planner.cost(&query, route);
                opening.least_way(query.from, query.to) < cost - PROGRESS_M
            }
            News::Obstacle(_) | News::Zone(_) => false,
        })
    }

    /// Whether the path to the next waypoint is cut, for a robot that was pushed or had to step aside.
    fn is_first_leg_cut(&self, route: &Route) -> bool {
        let (robot, next) = (self.robot, route.ahead()[0]);
        !robot.is_aerial() && self.belief.obstacles(robot.radius()).cuts(robot.position, next)
    }

    /// Robots of the same layer that stand nearby, as obstacles. Robots at the goal are left out, so that the
    /// goal stays where it is.
    fn standing_near(&self) -> Vec<KnownObstacle> {
        let (robot, clearance) = (self.robot, self.outlook.model.inflation.clearance);
        let stands = |other: &&KnownRobot| {
            other.id != robot.id
                && other.is_aerial() == robot.is_aerial()
                && other.velocity.length() < STANDING_MPS
                && (other.position - robot.position).length() < DETOUR_RANGE_M
        };
        let obstacle = |other: &KnownRobot| {
            KnownObstacle::wreck(other.id.0, other.position, other.radius(), robot.radius(), clearance)
        };
        let is_off_goal = |other: &KnownObstacle| !polygon_contains(&other.planned, self.goal.point);
        self.outlook.team.iter().filter(stands).map(obstacle).filter(is_off_goal).collect()
    }
}

/// The cheapest route round the standing robots. If there is none, the cheapest route through them, because
/// they may move.
fn find_route(planner: &Planner, query: &Query) -> Option<Route> {
    let route = planner.route(query);
    if route.is_some() || query.in_the_way.is_empty() {
        return route;
    }
    planner.route(&Query { in_the_way: &[], ..*query })
}
