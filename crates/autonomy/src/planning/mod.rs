//! Routes: shortest any-angle paths that keep clear of known debris and walls, and avoid radiation where that
//! is cheaper.
//!
//! Obstacles are inflated by the robot's radius and the scenario's clearance. A route is searched for among
//! few obstacles: at first none, then the obstacles that the best route so far runs into, until it runs into
//! none. A shortest path among some of the obstacles that keeps clear of all obstacles is the shortest among
//! all, so the result is optimal. The cost of a search depends on the surroundings of the route, not on the
//! size of the map. Among the few obstacles, the search goes from tangent to tangent (`tangents`).
//!
//! Radiation has a price: a route costs its length plus `exposure_price_m` metres for each second inside each
//! zone. A route either crosses a zone or leads round it. The search starts from the route that ignores all
//! zones. It closes each crossed zone for a try, and keeps the zone closed if the new route costs less.

mod map;
mod obstacles;
mod passage;
mod route;
mod search;
mod tangents;

pub use map::{Inflation, ObstacleMap};
pub use obstacles::{
    KnownObstacle, ObstacleKey, contains as polygon_contains, crosses as polygon_crossed,
    nearest_border_point, outward_normal,
};
pub(crate) use passage::Passages;
pub use passage::{Passage, Walls};
pub use route::Route;

use parry2d::math::Vector;
use scenario::shapes::{Outline, RadiationZone, vector};
use scenario::{RoleKind, Scenario};

use obstacles::ZONE_MARGIN_M;
use search::Search;
use tangents::Wanted;

/// The planner of one trial: its settings.
#[derive(Debug)]
pub struct Planner {
    arena: Vector,
    /// For each class of ground robots, in ascending order: its radius, and the distance of its routes from
    /// obstacles and from the border, in metres.
    ground: Vec<(f32, f32)>,
    /// Distance of aerial routes from the arena's walls, in metres.
    aerial_offset: f32,
    exposure_price_m: f32,
}

/// A question to the planner.
#[derive(Clone, Copy)]
pub struct Query<'a> {
    /// Where the robot is.
    pub from: Vector,
    /// Where it is to go.
    pub to: Vector,
    /// Whether it flies over debris.
    pub aerial: bool,
    /// Its radius, in metres.
    pub radius: f32,
    /// Its speed, in metres per second, for the price of exposure.
    pub speed: f32,
    /// The obstacles that it knows, inflated for its radius; robots that fly pass over them.
    pub obstacles: &'a ObstacleMap,
    /// Temporary obstacles, such as standing robots.
    pub in_the_way: &'a [KnownObstacle],
    /// The radiation zones that it knows, with their numbers.
    pub zones: &'a [(u32, RadiationZone)],
}

impl Planner {
    /// A planner for a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let clearance = scenario.planning.clearance_m;
        Self {
            arena: vector(scenario.arena_m),
            ground: scenario
                .ground_radii_m()
                .into_iter()
                .map(|radius| (radius as f32, (radius + clearance) as f32))
                .collect(),
            aerial_offset: (scenario.largest_radius_m(RoleKind::Aerial) + clearance) as f32,
            exposure_price_m: scenario.planning.exposure_price_m as f32,
        }
    }

    /// Distance of the routes of ground robots from obstacles and from the border, in metres: that of the
    /// smallest class whose radius is at least `radius`.
    fn ground_offset(&self, radius: f32) -> f32 {
        let class = self.ground.partition_point(|(other, _)| *other < radius);
        self.ground.get(class).or(self.ground.last()).map_or(0.0, |(_, offset)| *offset)
    }

    /// The cheapest route, or `None` if there is none. Its last waypoint is the goal, or the free point
    /// nearest to the goal if the goal lies within the clearance of an obstacle.
    pub fn route(&self, query: &Query) -> Option<Route> {
        let mut closed = Vec::new();
        let mut best = self.route_around(query, &closed)?;
        let mut best_cost = self.cost(query, &best);
        for _ in 0..query.zones.len() {
            let mut improved = None;
            for (number, zone) in query.zones {
                let inside = zone.contains(query.from) || zone.contains(query.to);
                if inside || closed.contains(number) || best.length_inside(query.from, zone) <= 0.0 {
                    continue;
                }
                let mut trial = closed.clone();
                trial.push(*number);
                trial.sort_unstable();
                let Some(route) = self.route_around(query, &trial) else { continue };
                let cost = self.cost(query, &route);
                if cost < best_cost {
                    (best, best_cost) = (route, cost);
                    improved = Some(trial);
                }
            }
            match improved {
                Some(trial) => closed = trial,
                None => break,
            }
        }
        Some(best)
    }

    /// The ways of ground robots of this radius among these outlines.
    pub(crate) fn ways(&self, radius: f32, outlines: &[Outline]) -> Ways {
        let offset = self.ground_offset(radius);
        let obstacle =
            |(outline, number)| KnownObstacle::new(ObstacleKey::Debris(number), outline, offset, 0.0);
        let known = outlines.iter().zip(0..).map(obstacle).collect();
        Ways { arena: self.arena, radius, offset, known }
    }

    /// Length of a route plus the price of its exposure, in metres.
    pub fn cost(&self, query: &Query, route: &Route) -> f32 {
        let inside: f32 = query.zones.iter().map(|(_, zone)| route.length_inside(query.from, zone)).sum();
        route.length(query.from) + self.exposure_price_m * inside / query.speed.max(0.01)
    }

    /// The shortest route round the closed zones and all obstacles.
    fn route_around(&self, query: &Query, closed: &[u32]) -> Option<Route> {
        let zones = query.zones.iter().filter(|(number, _)| closed.contains(number));
        let zones: Vec<Vec<Vector>> =
            zones.map(|(_, zone)| Outline::disc(zone.center, zone.radius).inflated(ZONE_MARGIN_M)).collect();
        let in_the_way = query.in_the_way.iter().map(|obstacle| &obstacle.planned);
        let search = Search {
            arena: self.arena,
            offset: if query.aerial { self.aerial_offset } else { self.ground_offset(query.radius) },
            known: (!query.aerial).then_some(query.obstacles),
            always: zones.iter().chain(in_the_way).map(Vec::as_slice).collect(),
        };
        let from = search.free_point(query.from);
        let way = search.way([from, search.free_point(query.to)], Wanted::Shortest)?;
        let start = (from != query.from).then_some(from);
        Some(Route::new(start.into_iter().chain(way).collect()))
    }
}

/// The ways of ground robots of one radius among outlines that stay.
pub(crate) struct Ways {
    arena: Vector,
    /// The radius, in metres.
    pub(crate) radius: f32,
    offset: f32,
    known: ObstacleMap,
}

impl Ways {
    fn search(&self) -> Search<'_> {
        Search { arena: self.arena, offset: self.offset, known: Some(&self.known), always: Vec::new() }
    }

    /// Distance of a place from the free point nearest to it, in metres.
    pub(crate) fn off_m(&self, place: Vector) -> f32 {
        (self.search().free_point(place) - place).length()
    }

    /// The first of these places that cannot be reached, neither from `from` nor from a place before it.
    pub(crate) fn first_unreachable<'p, T>(
        &self,
        from: Vector,
        places: &'p [(T, Vector)],
    ) -> Option<&'p (T, Vector)> {
        let search = self.search();
        let mut reached = search.free_point(from);
        places.iter().find(|(_, place)| {
            let place = search.free_point(*place);
            let is_reached = [Wanted::Any, Wanted::Shortest]
                .into_iter()
                .any(|wanted| search.way([reached, place], wanted).is_some());
            reached = if is_reached { place } else { reached };
            !is_reached
        })
    }
}
