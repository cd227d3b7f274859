//! Routes: shortest any-angle ways that keep clear of known debris and walls and go round radiation where that is cheaper.
//!
//! Obstacles are inflated by the robot's radius and the scenario's clearance, then the free plane is triangulated and
//! searched by Polyanya (Cui, Harabor & Grastien, IJCAI 2017; the `polyanya` crate). Radiation is priced: a route costs its length
//! plus `exposure_price_m` metres a second inside each zone. A zone is either crossed or gone round: starting from the route
//! that ignores all zones, each zone that is crossed is closed for a try, and stays closed when the new route costs less.

mod knowledge;
mod navigator;
mod obstacles;
mod route;
mod trail;

pub use knowledge::{Knowledge, Opening};
pub use navigator::{Goal, Navigator, PLANNED_BRAKING, Traveller};
pub use obstacles::{
    KnownObstacle, ObstacleKey, contains as polygon_contains, crosses as polygon_crossed, outward_normal,
};
pub use route::Route;

use std::collections::BTreeMap;

use parry2d::math::Vector;
use polyanya::{Mesh, Triangulation};
use serde::{Deserialize, Serialize};

use crate::scenario::Scenario;
use crate::world::{Outline, RadiationZone};
use obstacles::{ZONE_MARGIN_M, push_out};

/// Meshes kept; when there are more, all are dropped and made anew on demand.
const MAX_MESHES: usize = 64;

/// Planner of one trial. Meshes are shared by all robots that know the same.
#[derive(Serialize, Deserialize)]
pub struct Planner {
    arena: Vector,
    /// Distance of ground and of aerial routes from obstacles, in metres.
    offsets: [f32; 2],
    exposure_price_m: f32,
    /// Follows from what is known: kept to save time only.
    #[serde(skip)]
    meshes: BTreeMap<MeshKey, Mesh>,
}

/// What a mesh was made of: the layer, the obstacles with the version in which they are known, and the zones that are closed.
type MeshKey = (bool, Vec<ObstacleKey>, Vec<u32>);

/// A question to the planner.
#[derive(Clone, Copy)]
pub struct Query<'a> {
    /// Where the robot is.
    pub from: Vector,
    /// Where it wants to go.
    pub to: Vector,
    /// Whether it flies over debris.
    pub aerial: bool,
    /// Its speed, in metres per second, for the price of exposure.
    pub speed: f32,
    /// The obstacles that it knows, in order of their keys.
    pub obstacles: &'a [KnownObstacle],
    /// Obstacles that are there for the moment only.
    pub in_the_way: &'a [KnownObstacle],
    /// The radiation zones that it knows, with their numbers.
    pub zones: &'a [(u32, RadiationZone)],
}

impl Planner {
    /// A planner for a scenario.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let clearance = scenario.planning.clearance_m;
        Self {
            arena: Vector::new(scenario.arena_m[0] as f32, scenario.arena_m[1] as f32),
            offsets: [scenario.ground_radius_m() + clearance, scenario.aerial_radius_m() + clearance]
                .map(|offset| offset as f32),
            exposure_price_m: scenario.planning.exposure_price_m as f32,
            meshes: BTreeMap::new(),
        }
    }

    /// Distance of routes from obstacles, in metres.
    #[must_use]
    pub fn offset(&self, aerial: bool) -> f32 {
        self.offsets[usize::from(aerial)]
    }

    /// The cheapest route, or `None` where there is none. Its last waypoint is the goal, or the nearest free point to it where the
    /// goal lies within the clearance of an obstacle.
    pub fn route(&mut self, query: &Query) -> Option<Route> {
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

    /// The first of these places that the largest ground robot cannot reach from `from` among these outlines.
    #[must_use]
    pub fn first_unreachable<'p, T>(
        &self,
        outlines: &[Outline],
        from: Vector,
        places: &'p [(T, Vector)],
    ) -> Option<&'p (T, Vector)> {
        let offset = self.offset(false);
        let corners: Vec<Vec<Vector>> = outlines.iter().map(|outline| outline.inflated(offset)).collect();
        let free = |point| push_out(point, &corners, self.arena, offset);
        let mesh = mesh(self.arena, &corners, offset);
        places.iter().find(|(_, to)| mesh.path(free(from), free(*to)).is_none())
    }

    /// Length of a route and the price of its exposure, in metres.
    #[must_use]
    pub fn cost(&self, query: &Query, route: &Route) -> f32 {
        let inside: f32 = query.zones.iter().map(|(_, zone)| route.length_inside(query.from, zone)).sum();
        route.length(query.from) + self.exposure_price_m * inside / query.speed.max(0.01)
    }

    fn route_around(&mut self, query: &Query, closed: &[u32]) -> Option<Route> {
        let offset = self.offset(query.aerial);
        let obstacles: &[KnownObstacle] = if query.aerial { &[] } else { query.obstacles };
        let zones: Vec<Vec<Vector>> = query
            .zones
            .iter()
            .filter(|(number, _)| closed.contains(number))
            .map(|(_, zone)| Outline::disc(zone.center, zone.radius).inflated(ZONE_MARGIN_M))
            .collect();
        let corners: Vec<&Vec<Vector>> = obstacles
            .iter()
            .chain(query.in_the_way)
            .map(|obstacle| &obstacle.planned)
            .chain(&zones)
            .collect();
        let from = push_out(query.from, &corners, self.arena, offset);
        let to = push_out(query.to, &corners, self.arena, offset);
        let mut waypoints = if from == query.from { Vec::new() } else { vec![from] };
        if !corners.iter().any(|polygon| obstacles::crosses(polygon, from, to)) {
            waypoints.push(to);
        } else if query.in_the_way.is_empty() {
            let key = (query.aerial, obstacles.iter().map(|o| o.key).collect(), closed.to_vec());
            waypoints.extend(self.shared_mesh(key, &corners, offset).path(from, to)?.path);
        } else {
            waypoints.extend(mesh(self.arena, &corners, offset).path(from, to)?.path);
        }
        Some(Route::new(waypoints))
    }

    /// The mesh of this key, made if it is not yet there.
    fn shared_mesh(&mut self, key: MeshKey, obstacles: &[&Vec<Vector>], offset: f32) -> &Mesh {
        if self.meshes.len() >= MAX_MESHES && !self.meshes.contains_key(&key) {
            self.meshes.clear();
        }
        let arena = self.arena;
        self.meshes.entry(key).or_insert_with(|| mesh(arena, obstacles, offset))
    }
}

/// The free plane among obstacles, as a navigation mesh.
fn mesh<P: AsRef<[Vector]>>(arena: Vector, obstacles: &[P], offset: f32) -> Mesh {
    let (w, h) = (arena.x - offset, arena.y - offset);
    let border = [[offset, offset], [w, offset], [w, h], [offset, h]].map(Vector::from);
    let mut triangulation = Triangulation::from_outer_edges(&border);
    triangulation.add_obstacles(obstacles.iter().map(|polygon| polygon.as_ref().to_vec()));
    let mut mesh = triangulation.as_navmesh();
    mesh.merge_polygons();
    mesh.bake();
    mesh.set_search_delta(0.01);
    mesh
}
