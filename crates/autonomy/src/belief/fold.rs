//! A belief as a fold over reports.

use std::ops::Range;
use std::sync::OnceLock;

use parry2d::math::Vector;
use scenario::shapes::{Outline, RadiationZone};
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::known::{KnownDebris, KnownRescuee, KnownTask, KnownWreck, KnownZone};
use super::news::{News, Opening, Seen};
use super::table::Table;
use crate::hash::part;
use crate::ids::RescueeId;
use crate::planning::{Inflation, KnownObstacle, ObstacleKey, ObstacleMap};
use crate::report::{Report, Statement, gate_m};

/// A belief about the things of the world, by their numbers.
#[derive(Clone, Serialize, Deserialize)]
pub struct Belief {
    /// Debris.
    pub debris: Table<KnownDebris>,
    /// Radiation zones.
    pub zones: Table<KnownZone>,
    /// Rescuees.
    pub rescuees: Table<KnownRescuee>,
    /// Robots that have stopped for good.
    pub wrecks: Table<KnownWreck>,
    /// Tasks that were said to be open or closed.
    pub tasks: Table<KnownTask>,
    /// Number of times that this belief was pooled. Between two poolings, each group's belief extends the
    /// team's.
    pool: u32,
    /// The news that concern routes, in the order in which they were heard.
    news: Vec<News>,
    /// Follows from the other fields.
    #[serde(skip)]
    maps: Maps,
    /// The hash of the other fields, once it was asked for. Taken away by whatever changes them.
    #[serde(skip)]
    digest: OnceLock<u128>,
}

/// What a belief holds true, as planning needs it.
#[derive(Clone, Default)]
struct Maps {
    /// The known obstacles, for each class of radii.
    obstacles: Vec<ObstacleMap>,
    /// The radiation zones that are held to be on.
    zones_on: Vec<(u32, RadiationZone)>,
    /// The rescuees that are held to wait, in order.
    waiting: Vec<(RescueeId, Vector)>,
}

impl Belief {
    /// A belief about nothing.
    pub fn nothing(inflation: &Inflation) -> Self {
        Self {
            debris: Table::default(),
            zones: Table::default(),
            rescuees: Table::default(),
            wrecks: Table::default(),
            tasks: Table::default(),
            pool: 0,
            news: Vec::new(),
            maps: Maps { obstacles: inflation.maps(), ..Maps::default() },
            digest: OnceLock::new(),
        }
    }

    /// The known obstacles, inflated for a robot of this radius, in metres: those of the smallest class whose
    /// radius is at least as large.
    pub fn obstacles(&self, radius: f32) -> &ObstacleMap {
        let maps = &self.maps.obstacles;
        let class = maps.partition_point(|map| map.radius < radius);
        &maps[class.min(maps.len() - 1)]
    }

    /// The radiation zones that are held to be on, with their numbers.
    pub fn zones_on(&self) -> &[(u32, RadiationZone)] {
        &self.maps.zones_on
    }

    /// The rescuees with numbers in a range that are held to wait, in order, and where.
    pub(crate) fn waiting_among(&self, numbers: &Range<usize>) -> &[(RescueeId, Vector)] {
        let waiting = &self.maps.waiting;
        let [from, to] =
            [numbers.start, numbers.end].map(|end| waiting.partition_point(|(id, _)| id.index() < end));
        &waiting[from..to]
    }

    /// The rescuee that is held to wait nearest to a place, as near as may be one and the same. Where both
    /// places are exact, numbers alone tell rescuees apart.
    pub fn rescuee_near(&self, at: Vector, sd_m: f32) -> Option<(RescueeId, &KnownRescuee)> {
        let near = self.maps.waiting.iter().filter_map(|(id, waits_at)| {
            let known = self.rescuees.get(id.index())?;
            let apart = (*waits_at - at).length();
            (sd_m + known.sd_m > 0.0 && apart <= gate_m([sd_m, known.sd_m])).then_some((apart, *id, known))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id, known)| (id, known))
    }

    /// Number of rescuees that are believed to wait in a task with these rescuees: as many as were said to,
    /// without those that were reported gone since. None if nobody said.
    pub fn waiting(&self, task: TaskId, rescuees: Range<usize>) -> Option<u32> {
        let said = self.tasks.get(task.index())?;
        let is_gone = |known: &&KnownRescuee| known.waits_at.is_none() && known.at_step > said.at_step;
        let gone = rescuees.filter_map(|id| self.rescuees.get(id)).filter(is_gone).count();
        Some(said.waiting.saturating_sub(gone as u32))
    }

    /// Takes a report into account. Returns whether it is newer than what was heard of the thing before.
    pub fn hear(&mut self, report: &Report) -> bool {
        let is_news = self.take(report);
        if is_news {
            self.digest.take();
        }
        is_news
    }

    /// A hash of the whole belief.
    pub(super) fn digest(&self) -> u128 {
        let Self { debris, zones, rescuees, wrecks, tasks, pool, news, maps: _, digest } = self;
        let rescuees = || rescuees.digest(KnownRescuee::words);
        *digest.get_or_init(|| part(&(debris, zones, rescuees(), wrecks, tasks, pool, news)))
    }

    fn take(&mut self, report: &Report) -> bool {
        let (at_step, sd_m) = (report.at_step, report.sd_m);
        match &report.says {
            Statement::DebrisLies { debris, shape, pose } => {
                let known = KnownDebris { shape: shape.clone(), pose: *pose, at_step, sd_m };
                self.hear_of_debris(*debris, known)
            }
            Statement::ZoneIs { zone, disc, on } => {
                self.hear_of_zone(*zone, KnownZone { disc: *disc, on: *on, at_step, sd_m })
            }
            Statement::RescueeWaits { rescuee, at } => {
                let known = KnownRescuee { waits_at: Some(*at), at_step, sd_m };
                let near = self.rescuee_near(*at, sd_m).map(|(number, near)| (number.index(), near.sd_m));
                match near {
                    Some((_, near_m)) if near_m <= sd_m => return false,
                    Some((number, _)) if sd_m > 0.0 => return self.hear_of_rescuee(number, known),
                    // An exact sight has the true number.
                    Some((number, _)) => {
                        self.hear_of_rescuee(number, KnownRescuee { waits_at: None, ..known });
                    }
                    None => {}
                }
                self.hear_of_rescuee(rescuee.index(), known)
            }
            Statement::RescueeIsGone { rescuee } => {
                self.hear_of_rescuee(rescuee.index(), KnownRescuee { waits_at: None, at_step, sd_m })
            }
            Statement::TaskIs { task, open, waiting } => {
                let known = KnownTask { open: *open, waiting: *waiting, at_step };
                self.hear_of_task(task.index(), known)
            }
            Statement::WreckLies { robot, at, radius, is_aerial } => {
                let known = KnownWreck { at: *at, radius: *radius, is_aerial: *is_aerial, at_step };
                self.hear_of_wreck(robot.0, known)
            }
            // The base keeps an account of its own of what robots say of themselves and of their mates, and a
            // robot of its mates' claims.
            Statement::Claims(_)
            | Statement::GivesUp { .. }
            | Statement::LevelsAre(_)
            | Statement::MateGoes(_)
            | Statement::RoundWas(_)
            | Statement::StaysOut { .. }
            | Statement::HasHeard(_)
            | Statement::Protocol { .. } => false,
        }
    }

    fn hear_of_debris(&mut self, number: u32, heard: KnownDebris) -> bool {
        let known = self.debris.get(number as usize);
        if known.is_some_and(|known| known.at_step >= heard.at_step) {
            return false;
        }
        let is_moved = known.is_none_or(|known| known.pose != heard.pose);
        let outline = heard.outline();
        self.debris.set(number as usize, heard);
        if is_moved {
            self.insert(|map| debris_obstacle(number, &outline, map));
        }
        true
    }

    fn hear_of_zone(&mut self, number: u32, heard: KnownZone) -> bool {
        let known = self.zones.get(number as usize);
        if known.is_some_and(|known| known.at_step >= heard.at_step) {
            return false;
        }
        let was_on = known.is_some_and(|known| known.on);
        self.zones.set(number as usize, heard);
        let at = self.maps.zones_on.partition_point(|(other, _)| *other < number);
        if heard.on && !was_on {
            self.maps.zones_on.insert(at, (number, heard.disc));
            self.news.push(News::Zone(number));
        } else if was_on && !heard.on {
            self.maps.zones_on.remove(at);
            self.news.push(News::Opening(Opening { center: heard.disc.center, reach: heard.disc.radius }));
        }
        true
    }

    fn hear_of_rescuee(&mut self, number: usize, heard: KnownRescuee) -> bool {
        let is_newer = self.rescuees.get(number).is_none_or(|known| known.at_step < heard.at_step);
        if is_newer {
            self.rescuees.set(number, heard);
            let (waiting, id) = (&mut self.maps.waiting, RescueeId(number as u32));
            let place = waiting.partition_point(|(other, _)| *other < id);
            let is_known = waiting.get(place).is_some_and(|(other, _)| *other == id);
            waiting.splice(place..place + usize::from(is_known), heard.waits_at.map(|at| (id, at)));
        }
        is_newer
    }

    /// A task may begin and end in one step: the last report counts.
    fn hear_of_task(&mut self, number: usize, heard: KnownTask) -> bool {
        let is_newer = self.tasks.get(number).is_none_or(|known| known.at_step <= heard.at_step);
        if is_newer {
            self.tasks.set(number, heard);
        }
        is_newer
    }

    /// A wreck lies for good: the first report of it counts.
    fn hear_of_wreck(&mut self, number: u32, heard: KnownWreck) -> bool {
        if self.wrecks.get(number as usize).is_some() {
            return false;
        }
        self.wrecks.set(number as usize, heard);
        if !heard.is_aerial {
            self.insert(|map| wreck_obstacle(number, &heard, map));
        }
        true
    }

    /// Takes over all that others have heard and this belief has not.
    pub(super) fn pool(&mut self, others: &[Self]) {
        for other in others {
            other.debris.iter().for_each(|(number, known)| {
                self.hear_of_debris(number, known.clone());
            });
            other.zones.iter().for_each(|(number, known)| {
                self.hear_of_zone(number, *known);
            });
            other.wrecks.iter().for_each(|(number, known)| {
                self.hear_of_wreck(number, *known);
            });
            other.rescuees.iter().for_each(|(number, known)| {
                self.hear_of_rescuee(number as usize, *known);
            });
            other.tasks.iter().for_each(|(number, known)| {
                self.hear_of_task(number as usize, *known);
            });
        }
        self.pool += 1;
        self.digest.take();
    }

    /// The mark after all present news.
    pub(crate) fn seen(&self) -> Seen {
        Seen { pool: self.pool, news: self.news.len() }
    }

    /// The news since a mark. All news, if the groups have pooled their beliefs since the mark.
    pub(crate) fn news_since(&self, seen: Seen) -> &[News] {
        let from = if seen.pool == self.pool { seen.news.min(self.news.len()) } else { 0 };
        &self.news[from..]
    }

    /// Draws the maps again, after the other fields were read.
    pub(super) fn draw_maps(&mut self, inflation: &Inflation) {
        let mut obstacles = inflation.maps();
        for map in &mut obstacles {
            for (number, known) in self.debris.iter() {
                map.insert(debris_obstacle(number, &known.outline(), map));
            }
            for (number, known) in self.wrecks.iter().filter(|(_, known)| !known.is_aerial) {
                map.insert(wreck_obstacle(number, known, map));
            }
        }
        let on = self.zones.iter().filter(|(_, known)| known.on);
        let waits = |(number, known): (u32, &KnownRescuee)| Some((RescueeId(number), known.waits_at?));
        self.maps = Maps {
            obstacles,
            zones_on: on.map(|(number, known)| (number, known.disc)).collect(),
            waiting: self.rescuees.iter().filter_map(waits).collect(),
        };
    }

    /// Adds an obstacle to the maps of all classes. The news use its outline for the largest robots.
    fn insert(&mut self, obstacle: impl Fn(&ObstacleMap) -> KnownObstacle) {
        let mut news = None;
        for map in &mut self.maps.obstacles {
            let obstacle = obstacle(map);
            let key = obstacle.key;
            let before = map.insert(obstacle);
            news = Some((key, before.map(|before| before.middle_and_reach())));
        }
        let Some((key, opening)) = news else { return };
        let opening = opening.map(|(center, reach)| News::Opening(Opening { center, reach }));
        self.news.extend(opening.into_iter().chain([News::Obstacle(key)]));
    }
}

fn debris_obstacle(number: u32, outline: &Outline, on: &ObstacleMap) -> KnownObstacle {
    KnownObstacle::new(ObstacleKey::Debris(number), outline, on.radius, on.clearance)
}

fn wreck_obstacle(number: u32, wreck: &KnownWreck, on: &ObstacleMap) -> KnownObstacle {
    KnownObstacle::wreck(number, wreck.at, wreck.radius, on.radius, on.clearance)
}
