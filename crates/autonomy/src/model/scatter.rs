//! Places of scattered things, drawn anew in every trial.

use rand::RngExt;
use scenario::seed::{Purpose, stream};
use scenario::shapes::{Outline, Places, vector};
use scenario::{DebrisFile, DebrisShape, LayoutError, Placement, Point, Scatter, Scattered, ZoneFile};

use super::layout::{Attempt, KeepClear, Layout, SAMPLING_TRIES};

impl Layout {
    /// Places the things of all entries of `scatter`, entry by entry.
    pub(super) fn scatter(&mut self, trial: &Attempt) -> Result<(), LayoutError> {
        let &Attempt { scenario, keep_clear, seed, attempt } = trial;
        if scenario.scatter.is_empty() {
            return Ok(());
        }
        let mut ground = Ground::of(&self.debris);
        for (number, entry) in (0..).zip(&scenario.scatter) {
            let [debris, zones] = [self.debris.len(), self.zones.len()];
            for i in 0..entry.count {
                // Each thing has a stream of its own, so that one more thing leaves the others where they
                // are.
                let entity = number << 48 | u64::from(attempt) << 32 | u64::from(i);
                let mut draws = stream(seed, Purpose::Scatter, entity);
                let radius = entry.radius_m.draw(&mut draws);
                let placed =
                    Placed { ground: &ground, zones: &self.zones[zones..], first: debris, entry, keep_clear };
                let found = match entry.place {
                    Placement::Grid => {
                        Some(cell(entry, scenario.arena_m, i)).filter(|at| placed.allows(*at, radius))
                    }
                    Placement::Anywhere | Placement::Poisson(_) => {
                        let [low, high] = entry.region(scenario.arena_m);
                        let mut place = || {
                            let [t, u] = [(); 2].map(|()| draws.random::<f64>());
                            [low[0] + (high[0] - low[0]) * t, low[1] + (high[1] - low[1]) * u]
                        };
                        (0..SAMPLING_TRIES)
                            .map(|_| place())
                            .find(|at| is_inside(*at, radius, scenario.arena_m) && placed.allows(*at, radius))
                    }
                };
                let at = found.ok_or_else(|| no_place(entry, number, i))?;
                self.put(entry, at, radius);
                self.debris[ground.outlines.len()..].iter().for_each(|piece| ground.add(piece));
            }
        }
        Ok(())
    }

    fn put(&mut self, entry: &Scatter, at: Point, radius_m: f64) {
        match entry.what {
            Scattered::Debris => {
                let piece = DebrisFile::fixed(DebrisShape::Disc(radius_m), at);
                self.debris.push(DebrisFile { movable: entry.movable, ..piece });
            }
            Scattered::Radiation => self.zones.push(ZoneFile { at, radius_m, name: None }),
        }
    }
}

/// The debris that is placed already, by place.
struct Ground {
    outlines: Vec<Outline>,
    places: Places,
}

impl Ground {
    fn of(debris: &[DebrisFile]) -> Self {
        let mut ground = Self { outlines: Vec::new(), places: Places::default() };
        debris.iter().for_each(|piece| ground.add(piece));
        ground
    }

    fn add(&mut self, piece: &DebrisFile) {
        let outline = piece.outline();
        self.places.put(self.outlines.len(), outline.shape.compute_aabb(&outline.pose));
        self.outlines.push(outline);
    }
}

/// The things that are placed already.
struct Placed<'l> {
    ground: &'l Ground,
    /// The zones of this entry.
    zones: &'l [ZoneFile],
    /// Number of the first piece of debris of this entry.
    first: usize,
    entry: &'l Scatter,
    keep_clear: &'l KeepClear,
}

impl Placed<'_> {
    /// Whether a thing of this radius may be placed at this point.
    fn allows(&self, at: Point, radius: f64) -> bool {
        let gap = self.entry.gap_m();
        let is_clear = self.keep_clear.allows(at, radius);
        is_clear
            && match self.entry.what {
                Scattered::Debris => {
                    let point = vector(at);
                    let free = radius + gap.unwrap_or_default();
                    // The gap holds between things of this entry; other debris is only not overlapped.
                    self.ground.places.near(point, free as f32).into_iter().all(|number| {
                        let least = if number >= self.first { free } else { radius };
                        f64::from(self.ground.outlines[number].distance_to(point)) >= least
                    })
                }
                Scattered::Radiation => gap.is_none_or(|gap| {
                    self.zones.iter().all(|other| {
                        libm::hypot(at[0] - other.at[0], at[1] - other.at[1]) >= radius + other.radius_m + gap
                    })
                }),
            }
    }
}

fn is_inside(at: Point, radius: f64, arena: Point) -> bool {
    (0..2).all(|k| at[k] >= radius && at[k] <= arena[k] - radius)
}

/// The middle of the `i`-th cell of an entry's grid.
fn cell(entry: &Scatter, arena_m: Point, i: u32) -> Point {
    let [low, high] = entry.region(arena_m);
    let size = [high[0] - low[0], high[1] - low[1]];
    let share = if size[1] > 0.0 { size[0] / size[1] } else { f64::from(entry.count) };
    let columns =
        (f64::from(entry.count) * share).sqrt().round().clamp(1.0, f64::from(entry.count.max(1))) as u32;
    let rows = entry.count.div_ceil(columns);
    let along = |k: usize, i: u32, count: u32| low[k] + size[k] * (f64::from(i) + 0.5) / f64::from(count);
    [along(0, i % columns, columns), along(1, i / columns, rows)]
}

fn no_place(entry: &Scatter, number: u64, i: u32) -> LayoutError {
    let what = match entry.what {
        Scattered::Debris => "debris",
        Scattered::Radiation => "radiation",
    };
    let tried = match entry.place {
        Placement::Grid => ", whose cell of the grid is not free".to_owned(),
        Placement::Anywhere | Placement::Poisson(_) => format!(" after {SAMPLING_TRIES} tries"),
    };
    LayoutError::NoPlace {
        field: format!("scatter[{number}]"),
        what,
        number: i + 1,
        count: entry.count,
        tried,
    }
}
