//! Right of way in narrow passages: which robots may enter, and which wait outside.
//!
//! The order is: robots inside; robots that may enter and are about to; robots that have waited too long;
//! robots that follow a robot inside in the same direction; and all others, the nearest first. So robots go
//! through in platoons, and the turn of a direction ends when a robot of another direction has waited too
//! long. Robots of one direction queue before the mouth, in this order.

use parry2d::math::Vector;

use crate::conflict::Mover;
use crate::planning::Passage;

/// Robots ask for a passage from this distance on, in metres, plus their stopping distance.
const ASK_FROM_M: f32 = 3.0;

/// A robot that may enter is no longer stopped within this distance of the passage, in metres.
const COMMITTED_M: f32 = 0.4;

/// Head start of a robot that may enter over robots that may not, in metres.
const KEPT_PLACE_M: f32 = 1.0;

/// Robots go the same way if the cosine between their directions in a passage is larger than this.
const SAME_WAY: f32 = 0.5;

/// Passages meet if they come nearer than this share of the distance at which the robots touch. The share is
/// less than 1, so that a bay between two passages keeps them apart.
const MEETING: f32 = 0.5;

/// A wide place between two passages is a bay, in which robots pass one another, if it is shorter than this,
/// in metres. At a bay, nobody queues.
const BAY_M: f32 = 2.5;

/// The first of two robots that come to a bay from both sides begins to make room this far before it, in
/// metres. Earlier, its way would hold up the second robot.
const BAY_AHEAD_M: f32 = 1.0;

/// Robots queue within this distance of a passage, in metres.
const QUEUE_M: f32 = 2.0;

/// A robot in a narrow passage, or soon in one.
pub(super) struct Entrant<'a> {
    /// Index of the robot.
    pub(super) i: usize,
    /// Distance to the passage along the route, in metres; negative inside.
    pub(super) ahead: f32,
    passage: &'a Passage,
    /// Whether a bay lies before or behind the passage.
    is_at_bay: bool,
    /// The passage behind the bay at the end of this one.
    behind_bay: Option<&'a Passage>,
    /// Distance to the end of the passage along the route, in metres.
    to_exit: f32,
    radius: f32,
    /// The box that holds the passage.
    low: Vector,
    high: Vector,
}

/// The state of a robot at a passage, from step to step.
#[derive(Debug, Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Entry {
    /// Steps that the robot has waited.
    pub(super) waited_steps: u32,
    /// Whether it may enter, or is inside.
    pub(super) is_granted: bool,
}

/// The turn of a robot at a passage in one step.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::conflict) struct Turn {
    /// Its place in the order of all robots at passages; none for a robot that is not at a passage.
    pub(super) rank: Option<usize>,
    /// The robot for which it waits.
    pub(super) waits_for: Option<usize>,
    /// The robot behind which it queues.
    pub(super) follows: Option<Follows>,
}

/// The robot ahead in a queue before a passage.
#[derive(Debug, Clone, Copy)]
pub(super) struct Follows {
    /// Index of the robot ahead.
    pub(super) robot: usize,
    /// Difference of the robots' ways to the mouths of their own passages, less their radii, in metres: the
    /// free way between them if both have the same mouth.
    pub(super) gap: f32,
}

/// Whether the wide place between a passage and the next one is a bay.
fn is_bay(passage: &Passage, next: &Passage) -> bool {
    passage.leaves_at - next.enters_at < BAY_M
}

/// Whether a bay lies before or behind one of these passages.
fn is_at_bay(passages: &[Passage], at: usize) -> bool {
    let is_pair = |pair: &[Passage]| is_bay(&pair[0], &pair[1]);
    (at > 0 && is_pair(&passages[at - 1..=at])) || passages.get(at..at + 2).is_some_and(is_pair)
}

/// How two robots relate whose passages meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meeting {
    /// One follows the other.
    SameWay,
    /// Only one of the two can be inside.
    Opposed,
}

/// The class of a claim to a passage. The smaller class goes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Class {
    Inside,
    Committed,
    WaitedTooLong,
    Follows,
    Comes,
}

impl<'a> Entrant<'a> {
    /// The entrant for a robot that is in a narrow passage of its route or near the next one; `None` for
    /// other robots.
    pub(super) fn new(i: usize, me: &Mover<'a>) -> Option<Self> {
        if !me.wishes_to_move() || me.retreat_left.is_some() || me.passages.is_empty() {
            return None;
        }
        let left = me.way_left();
        let at = me.passages.iter().position(|passage| left > passage.leaves_at - me.radius)?;
        let passage = &me.passages[at];
        let ahead = left - passage.enters_at;
        let stopping = me.brakes.way(me.speed);
        let corner = |pick: fn(Vector, Vector) -> Vector| passage.points.iter().copied().reduce(pick);
        let border = Vector::splat(me.radius);
        (ahead <= ASK_FROM_M + stopping).then_some(Self {
            i,
            ahead,
            passage,
            is_at_bay: is_at_bay(me.passages, at),
            behind_bay: me.passages.get(at + 1).filter(|next| is_bay(passage, next)),
            to_exit: left - passage.leaves_at,
            radius: me.radius,
            low: corner(Vector::min)? - border,
            high: corner(Vector::max)? + border,
        })
    }

    fn is_inside(&self) -> bool {
        self.ahead <= 0.0
    }

    /// How the robots relate at the place where their passages come nearest, without the parts that they have
    /// left behind; `None` if the passages do not meet.
    fn meets(&self, other: &Self) -> Option<Meeting> {
        if self.low.cmpgt(other.high).any() || self.high.cmplt(other.low).any() {
            return None;
        }
        let apart = self.radius + other.radius;
        let touch = MEETING * apart;
        let (mut nearest, mut at) = (touch * touch, None);
        let (mine, its) = (self.left_behind(apart), other.left_behind(apart));
        for (a, here) in self.passage.points.iter().enumerate().skip(mine) {
            for (b, there) in other.passage.points.iter().enumerate().skip(its) {
                let apart = (*here - *there).length_squared();
                if apart < nearest {
                    (nearest, at) = (apart, Some((a, b)));
                }
            }
        }
        let (a, b) = at?;
        let is_same = self.direction(a).dot(other.direction(b)) > SAME_WAY;
        Some(if is_same { Meeting::SameWay } else { Meeting::Opposed })
    }

    /// Number of points of the passage that lie farther behind the robot than `clearance`, less one.
    fn left_behind(&self, clearance: f32) -> usize {
        let lengths = self.passage.points.windows(2).map(|pair| (pair[1] - pair[0]).length());
        let from_mouth = lengths.scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        });
        from_mouth.take_while(|way| *way < -self.ahead - clearance).count()
    }

    /// Whether this robot has to make room in a bay for another robot that comes to it from the other side:
    /// it is inside, near the bay, and the first to be there.
    pub(super) fn makes_room_in_bay(&self, other: &Self, movers: &[Mover]) -> bool {
        let (Some(mine), Some(its)) = (self.behind_bay, other.behind_bay) else { return false };
        let touch = MEETING * (self.radius + other.radius);
        let by_priority = || movers[other.i].priority.precedence(&movers[self.i].priority);
        let is_first = self.to_exit.total_cmp(&other.to_exit).then_with(by_priority).is_lt();
        let is_near = self.is_inside() && other.is_inside() && self.to_exit < BAY_AHEAD_M;
        is_first && is_near && come_near(mine, other.passage, touch) && come_near(its, self.passage, touch)
    }

    /// The free way to the robot ahead, if this robot queues behind it.
    fn follows(&self, first: &Self) -> Option<Follows> {
        let queues = !self.is_at_bay && self.ahead >= 0.0 && self.ahead <= QUEUE_M;
        let gap = self.ahead - first.ahead - self.radius - first.radius;
        queues.then_some(Follows { robot: first.i, gap })
    }

    fn direction(&self, at: usize) -> Vector {
        let points = &self.passage.points;
        let (from, to) = (at.saturating_sub(1), (at + 1).min(points.len() - 1));
        (points[to] - points[from]).normalize_or_zero()
    }
}

/// Whether two passages come nearer to each other than this, in metres.
fn come_near(a: &Passage, b: &Passage, touch: f32) -> bool {
    let is_near = |here: &Vector, there: &Vector| (*here - *there).length_squared() < touch * touch;
    a.points.iter().any(|here| b.points.iter().any(|there| is_near(here, there)))
}

/// Which robots at passages meet, and how.
struct Meetings {
    count: usize,
    of: Vec<Option<Meeting>>,
}

impl Meetings {
    fn new(entrants: &[Entrant]) -> Self {
        let count = entrants.len();
        let mut of = vec![None; count * count];
        for a in 0..count {
            for b in a + 1..count {
                let meeting = entrants[a].meets(&entrants[b]);
                of[a * count + b] = meeting;
                of[b * count + a] = meeting;
            }
        }
        Self { count, of }
    }

    fn between(&self, a: usize, b: usize) -> Option<Meeting> {
        self.of[a * self.count + b]
    }
}

/// Decides which robots may enter their passages, and notes it in their turns. A robot has waited too long
/// after `turn_steps` steps.
pub(super) fn decide(
    entrants: &[Entrant],
    movers: &[Mover],
    entries: &[Entry],
    turns: &mut [Turn],
    turn_steps: u32,
) {
    let meetings = Meetings::new(entrants);
    let claim = |a: usize| claim(a, entrants, &meetings, entries[entrants[a].i], turn_steps);
    let claims: Vec<(Class, f32)> = (0..entrants.len()).map(claim).collect();
    let precedence = |a: &usize, b: &usize| {
        let (x, y) = (claims[*a], claims[*b]);
        let priority = |a: usize| movers[entrants[a].i].priority;
        let by_priority = || priority(*a).precedence(&priority(*b));
        x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)).then_with(by_priority)
    };
    let mut order: Vec<usize> = (0..entrants.len()).collect();
    order.sort_by(precedence);
    let waited_too_long = |claim: &(Class, f32)| claim.0 == Class::WaitedTooLong;
    for (rank, a) in order.iter().enumerate() {
        let enters = |b: usize| turns[entrants[b].i].waits_for.is_none();
        // A robot that has waited too long stops the robots behind it, even while it waits for robots inside.
        let stops = |b: &&usize| {
            meetings.between(*a, **b) == Some(Meeting::Opposed)
                && (enters(**b) || waited_too_long(&claims[**b]))
        };
        let waits_for = order[..rank].iter().find(stops).map(|b| entrants[*b].i);
        let goes_first = |b: &&usize| meetings.between(*a, **b) == Some(Meeting::SameWay) && enters(**b);
        let farthest = |b: &&usize, c: &&usize| entrants[**b].ahead.total_cmp(&entrants[**c].ahead);
        let first = order[..rank].iter().filter(goes_first).max_by(farthest).filter(|_| waits_for.is_none());
        let follows = first.and_then(|b| entrants[*a].follows(&entrants[*b]));
        turns[entrants[*a].i] = Turn { rank: Some(rank), waits_for, follows };
    }
}

fn claim(a: usize, entrants: &[Entrant], meetings: &Meetings, entry: Entry, turn_steps: u32) -> (Class, f32) {
    let entrant = &entrants[a];
    let follows =
        |b: usize| b != a && entrants[b].is_inside() && meetings.between(a, b) == Some(Meeting::SameWay);
    if entrant.is_inside() {
        (Class::Inside, entrant.to_exit)
    } else if entry.is_granted && entrant.ahead < COMMITTED_M {
        (Class::Committed, entrant.ahead)
    } else if entry.waited_steps >= turn_steps {
        (Class::WaitedTooLong, -(entry.waited_steps as f32))
    } else if (0..entrants.len()).any(follows) {
        (Class::Follows, entrant.ahead)
    } else {
        (Class::Comes, if entry.is_granted { entrant.ahead - KEPT_PLACE_M } else { entrant.ahead })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conflict::testing::mover;

    /// A passage along the x axis from `from` to `to`, which begins `enters_at` metres before the end of the
    /// route.
    fn passage(from: f32, to: f32, enters_at: f32) -> Passage {
        let points =
            (0..=10_u8).map(|i| Vector::new(from + (to - from) * f32::from(i) / 10.0, 0.0)).collect();
        Passage { points, enters_at, leaves_at: enters_at - (to - from).abs() }
    }

    /// The entries of robots at these places with these preferred velocities, whose routes lead 10 m on
    /// through a passage between x = 10 and x = 12.
    fn decided(robots: &[(f32, f32)], before: &[Entry]) -> Vec<Turn> {
        let passages: Vec<[Passage; 1]> = robots
            .iter()
            .map(|(x, preferred)| {
                let way = if *preferred > 0.0 { 10.0 - x } else { x - 12.0 };
                let (from, to) = if *preferred > 0.0 { (10.0, 12.0) } else { (12.0, 10.0) };
                [passage(from, to, 10.0 - way)]
            })
            .collect();
        let movers: Vec<Mover> = (0..)
            .zip(robots)
            .zip(&passages)
            .map(|((i, (x, preferred)), passages)| Mover {
                passages,
                ..mover(i, [*x, 0.0], [*preferred, 0.0])
            })
            .collect();
        let entrants: Vec<Entrant> =
            movers.iter().enumerate().filter_map(|(i, me)| Entrant::new(i, me)).collect();
        let mut entries = before.to_vec();
        entries.resize(robots.len(), Entry::default());
        let mut turns = vec![Turn::default(); robots.len()];
        decide(&entrants, &movers, &entries, &mut turns, 100);
        turns
    }

    fn waits(entries: &[Turn]) -> Vec<Option<usize>> {
        entries.iter().map(|entry| entry.waits_for).collect()
    }

    #[test]
    fn the_nearest_of_two_that_meet_enters_and_a_robot_inside_is_before_all() {
        assert_eq!(waits(&decided(&[(9.0, 1.0), (12.8, -1.0)], &[])), [Some(1), None]);
        assert_eq!(waits(&decided(&[(10.5, 1.0), (12.1, -1.0)], &[])), [None, Some(0)]);
    }

    #[test]
    fn robots_of_one_direction_go_through_together() {
        let entries = decided(&[(10.5, 1.0), (9.0, 1.0), (12.5, -1.0)], &[]);
        assert_eq!(waits(&entries), [None, None, Some(0)]);
        assert_eq!(entries[1].rank, Some(1), "the follower is before the one that is nearer");
    }

    #[test]
    fn a_robot_that_has_waited_too_long_ends_the_turn_of_the_others() {
        let waited = Entry { waited_steps: 100, ..Entry::default() };
        let entries =
            decided(&[(10.5, 1.0), (9.0, 1.0), (12.5, -1.0)], &[Entry::default(), Entry::default(), waited]);
        assert_eq!(waits(&entries), [None, Some(2), Some(0)]);
    }

    #[test]
    fn robots_of_one_direction_queue_in_their_order() {
        let entries = decided(&[(9.5, 1.0), (8.5, 1.0), (9.0, 1.0), (10.5, 1.0)], &[]);
        let ahead: Vec<Option<usize>> =
            entries.iter().map(|entry| entry.follows.map(|first| first.robot)).collect();
        assert_eq!(ahead, [Some(3), Some(2), Some(0), None]);
        let gap = entries[2].follows.unwrap().gap;
        assert!(
            (gap - (0.5 - 0.8)).abs() < 1e-5,
            "radii of 0.4 m, half a metre from centre to centre: {gap}"
        );
    }

    /// Entries of a robot on the x axis and of one that is about to cross its way at x = 11, upwards.
    fn crossed(x: f32) -> Vec<Turn> {
        let points = (0..=10_u8).map(|i| Vector::new(11.0, f32::from(i) / 5.0 - 1.0)).collect();
        let across = [Passage { points, enters_at: 9.5, leaves_at: 7.5 }];
        let along = [passage(10.0, 14.0, x)];
        let movers = [
            Mover { passages: &along, ..mover(0, [x, 0.0], [1.0, 0.0]) },
            Mover { passages: &across, ..mover(1, [11.0, -1.5], [0.0, 1.0]) },
        ];
        let entrants: Vec<Entrant> =
            movers.iter().enumerate().filter_map(|(i, me)| Entrant::new(i, me)).collect();
        let mut turns = vec![Turn::default(); 2];
        decide(&entrants, &movers, &[Entry::default(); 2], &mut turns, 100);
        turns
    }

    #[test]
    fn a_short_wide_place_between_two_passages_is_a_bay() {
        let with_gap = |gap: f32| [passage(0.0, 4.0, 20.0), passage(4.0 + gap, 8.0, 16.0 - gap)];
        assert!(is_at_bay(&with_gap(2.0), 0) && is_at_bay(&with_gap(2.0), 1));
        assert!(!is_at_bay(&with_gap(3.0), 0) && !is_at_bay(&with_gap(3.0), 1));
        assert!(!is_at_bay(&with_gap(2.0)[..1], 0));
    }

    #[test]
    fn a_robot_that_has_left_a_crossing_behind_is_no_longer_awaited() {
        assert_eq!(waits(&crossed(10.5)), [None, Some(0)], "before the crossing");
        assert_eq!(waits(&crossed(11.5)), [None, Some(0)], "just behind it");
        assert_eq!(waits(&crossed(12.6)), [None, None], "clear of it");
    }

    /// Whether each of two robots in a corridor from x = 0 to 10, with a bay from 4.5 to 5.5, has to make
    /// room in the bay. The first drives east, the second west if `meets`, otherwise east.
    fn makes_room_in_bay(first: f32, second: f32, meets: bool) -> [bool; 2] {
        let east = [passage(0.0, 4.5, 10.0), passage(5.5, 10.0, 4.5)];
        let west = [passage(10.0, 5.5, 10.0), passage(4.5, 0.0, 4.5)];
        let on_the_way = |id: u32, left: f32, preferred: f32| {
            let at = if preferred > 0.0 { 10.0 - left } else { left };
            mover(id, [at, 0.0], [preferred, 0.0])
        };
        let (x, way) = if meets { (-1.0, &west) } else { (1.0, &east) };
        let movers = [
            Mover { passages: &east, ..on_the_way(0, first, 1.0) },
            Mover { passages: way, ..on_the_way(1, second, x) },
        ];
        // Routes of test robots lead 10 m on, so that the passages are shifted by the way that is left.
        let shifted = movers.map(|me| {
            let shift = me.way_left() - if me.robot.0 == 0 { first } else { second };
            let passages = me.passages.iter().map(|passage| Passage {
                enters_at: passage.enters_at + shift,
                leaves_at: passage.leaves_at + shift,
                ..passage.clone()
            });
            passages.collect::<Vec<Passage>>()
        });
        let movers = [0, 1].map(|i| Mover { passages: &shifted[i], ..movers[i] });
        let entrants = [0, 1].map(|i| Entrant::new(i, &movers[i]).unwrap());
        [0, 1].map(|i| entrants[i].makes_room_in_bay(&entrants[1 - i], &movers))
    }

    #[test]
    fn the_first_of_two_robots_at_a_bay_makes_room_in_it() {
        assert_eq!(makes_room_in_bay(6.3, 7.0, true), [true, false]);
        assert_eq!(makes_room_in_bay(7.0, 6.3, true), [false, true]);
        assert_eq!(makes_room_in_bay(6.3, 6.3, true), [false, true], "as near: the worse claim");
        assert_eq!(makes_room_in_bay(7.0, 8.0, true), [false, false], "still far from the bay");
        assert_eq!(makes_room_in_bay(6.3, 7.0, false), [false, false], "the same way");
    }

    #[test]
    fn a_robot_far_from_any_passage_is_none_of_its_business() {
        assert_eq!(decided(&[(2.0, 1.0)], &[])[0].rank, None);
    }
}
