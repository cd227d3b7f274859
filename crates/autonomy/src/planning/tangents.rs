//! The shortest way among convex outlines, which may overlap: an A* search from tangent to tangent.
//!
//! A shortest way bends only at corners of outlines, and goes from one outline to the next along a tangent of
//! both (Liu & Arimoto, "Path planning using a tangent graph for mobile robots among polygonal and curved
//! obstacles", IJRR 1992). A leg is tested for what it runs into only when it is the most promising one (lazy
//! search, Dellin & Srinivasa, ICAPS 2016).
//!
//! Few outlines are looked at. An outline that no promising leg runs into may be left out, because a shortest
//! way round more outlines is no shorter. When the most promising leg runs into an outline, ways round it are
//! looked at from every place that was reached.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use parry2d::math::Vector;

use super::obstacles::GRAZE_M;

/// Rounding of the distances of corners from tangents, in metres.
const ROUNDING_M: f32 = 1.0e-3;

/// An edge counts as seen from points so much behind it, in metres.
const SEEN_M: f32 = 1.0e-4;

/// Which way is wanted.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Wanted {
    /// The shortest.
    Shortest,
    /// Any: it is found sooner.
    Any,
}

/// The plane within a border, among the outlines that count.
pub(super) struct Plane<'a> {
    /// The lowest and the highest corner of the border.
    border: [Vector; 2],
    outlines: Vec<Outline<'a>>,
}

/// A convex outline.
struct Outline<'a> {
    /// Anticlockwise.
    corners: &'a [Vector],
    /// Middle and half diagonal of its bounding box, in metres: a circle that holds it.
    middle: Vector,
    reach: f32,
    /// Number of its first corner among the corners of all outlines.
    first: usize,
}

/// A corner, and the way round it.
#[derive(Clone, Copy)]
struct Bend {
    outline: usize,
    corner: usize,
    /// Whether the way turns left there, so that the outline is to its left.
    is_left: bool,
}

/// A bend, and the directions in which a taut way leaves it.
#[derive(Clone, Copy)]
struct Turn {
    bend: Bend,
    /// The direction in which the way arrives there, and that of the next edge of the outline: unit vectors.
    between: [Vector; 2],
}

/// Where a leg ends.
#[derive(Clone, Copy)]
enum End {
    Bend(Bend),
    Goal,
}

/// A leg that may be part of the way.
struct Leg {
    /// The least length of a way that it is part of, or what is left beyond the leg where any way will do, in
    /// metres. The leg with the least is the most promising one.
    estimate: f32,
    /// Length of the way to its end, in metres.
    length: f32,
    /// Number of the place where it starts.
    from: usize,
    to: Vector,
    end: End,
    /// The number of legs noted before it.
    number: usize,
}

/// A place that was reached.
struct Place {
    at: Vector,
    /// Length of the way to it, in metres.
    length: f32,
    /// Number of the place before it; its own for the start.
    before: usize,
    /// None at the start, from which a way leads in any direction.
    turn: Option<Turn>,
}

/// What is under way in a search.
struct Search<'p, 'a> {
    plane: &'p Plane<'a>,
    goal: Vector,
    wanted: Wanted,
    places: Vec<Place>,
    legs: BinaryHeap<Leg>,
    /// The number of legs noted so far.
    noted: usize,
    /// Numbers of the outlines that legs ran into: ways may lead round them.
    heeded: Vec<usize>,
    /// For each corner, whether it was reached turning right, and left.
    is_reached: Vec<[bool; 2]>,
}

impl<'a> Plane<'a> {
    /// The plane within a border (its lowest and its highest corner), among convex outlines (anticlockwise).
    pub(super) fn new(border: [Vector; 2], outlines: impl IntoIterator<Item = &'a [Vector]>) -> Self {
        let mut first = 0;
        let outline = |corners: &'a [Vector]| {
            let mins = corners.iter().copied().fold(Vector::INFINITY, Vector::min);
            let maxs = corners.iter().copied().fold(Vector::NEG_INFINITY, Vector::max);
            let (middle, reach) = (0.5 * (mins + maxs), 0.5 * (maxs - mins).length());
            first += corners.len();
            Outline { corners, middle, reach, first: first - corners.len() }
        };
        let outlines = outlines.into_iter().filter(|corners| !corners.is_empty());
        Self { border, outlines: outlines.map(outline).collect() }
    }

    /// The way from one point to another, without its start; `None` if there is none.
    pub(super) fn way(&self, [from, to]: [Vector; 2], wanted: Wanted) -> Option<Vec<Vector>> {
        let corners = self.outlines.last().map_or(0, |last| last.first + last.corners.len());
        let start = Place { at: from, length: 0.0, before: 0, turn: None };
        let search = Search {
            plane: self,
            goal: to,
            wanted,
            places: vec![start],
            legs: BinaryHeap::new(),
            noted: 0,
            heeded: Vec::new(),
            is_reached: vec![[false; 2]; corners],
        };
        search.way()
    }

    /// The turn at a bend of a way that comes from a point.
    fn turn(&self, bend: Bend, from: Vector) -> Turn {
        let corners = self.outlines[bend.outline].corners;
        let at = corners[bend.corner];
        let next = bend.next(corners.len())[usize::from(bend.is_left)].map_or(at, |next| corners[next]);
        Turn { bend, between: [at - from, next - at].map(Vector::normalize_or_zero) }
    }

    /// Whether a point is within the border.
    fn holds(&self, at: Vector) -> bool {
        at.cmpge(self.border[0] - ROUNDING_M).all() && at.cmple(self.border[1] + ROUNDING_M).all()
    }
}

impl Search<'_, '_> {
    fn way(mut self) -> Option<Vec<Vector>> {
        self.look_on(0);
        while let Some(leg) = self.legs.pop() {
            if self.was_reached(leg.end) || self.is_cut(&leg) {
                continue;
            }
            let End::Bend(bend) = leg.end else { return Some(self.way_to(leg.from)) };
            *self.reached(bend) = true;
            let turn = Some(self.plane.turn(bend, self.places[leg.from].at));
            self.places.push(Place { at: leg.to, length: leg.length, before: leg.from, turn });
            self.look_on(self.places.len() - 1);
        }
        None
    }

    fn reached(&mut self, Bend { outline, corner, is_left }: Bend) -> &mut bool {
        &mut self.is_reached[self.plane.outlines[outline].first + corner][usize::from(is_left)]
    }

    fn was_reached(&mut self, end: End) -> bool {
        matches!(end, End::Bend(bend) if *self.reached(bend))
    }

    /// Whether a leg runs into an outline. If it is a new one, ways may lead round it from now on.
    fn is_cut(&mut self, leg: &Leg) -> bool {
        let (a, b, outlines) = (self.places[leg.from].at, leg.to, &self.plane.outlines);
        if self.heeded.iter().any(|number| outlines[*number].is_entered(a, b)) {
            return true;
        }
        let Some(new) = outlines.iter().position(|outline| outline.is_entered(a, b)) else { return false };
        self.heeded.push(new);
        (0..self.places.len()).for_each(|from| self.look_round(from, new));
        true
    }

    /// Notes the legs that may lead on from a place.
    fn look_on(&mut self, from: usize) {
        self.note(from, self.goal, End::Goal);
        for at in 0..self.heeded.len() {
            self.look_round(from, self.heeded[at]);
        }
    }

    /// Notes the legs that may lead from a place round an outline.
    fn look_round(&mut self, from: usize, number: usize) {
        let (outline, place) = (&self.plane.outlines[number], &self.places[from]);
        let corners = match place.turn {
            Some(turn) if turn.bend.outline == number => turn.bend.next(outline.corners.len()),
            Some(turn) if !turn.leads_to(outline.middle - place.at, outline.reach) => return,
            _ => outline.tangents(place.at),
        };
        for (corner, is_left) in corners.into_iter().zip([false, true]) {
            let Some(corner) = corner else { continue };
            let (to, end) = (outline.corners[corner], End::Bend(Bend { outline: number, corner, is_left }));
            if self.plane.holds(to) && !self.was_reached(end) {
                self.note(from, to, end);
            }
        }
    }

    /// Notes a leg, unless the way would not be taut where it starts.
    fn note(&mut self, from: usize, to: Vector, end: End) {
        let place = &self.places[from];
        let way = to - place.at;
        if place.turn.is_none_or(|turn| turn.leads_to(way, 0.0)) {
            let (length, left) = (place.length + way.length(), (self.goal - to).length());
            let estimate = if self.wanted == Wanted::Shortest { length + left } else { left };
            self.legs.push(Leg { estimate, length, from, to, end, number: self.noted });
            self.noted += 1;
        }
    }

    /// The places on the way to one after the start, and the goal.
    fn way_to(&self, last: usize) -> Vec<Vector> {
        let before = |number: &usize| Some(self.places[*number].before);
        let numbers = std::iter::successors(Some(last), before).take_while(|number| *number > 0);
        let mut way = vec![self.goal];
        way.extend(numbers.map(|number| self.places[number].at));
        way.reverse();
        way
    }
}

impl Turn {
    /// Whether a taut way may lead to a point at this offset from the bend, or to one within `range` metres
    /// of it.
    fn leads_to(&self, offset: Vector, range: f32) -> bool {
        let aside = [self.between[0].perp_dot(offset), offset.perp_dot(self.between[1])];
        let aside = if self.bend.is_left { aside } else { aside.map(|aside| -aside) };
        aside.into_iter().all(|aside| aside >= -ROUNDING_M - range)
    }
}

impl Bend {
    /// The next corner of an outline with so many corners: where a way turns right, or left.
    fn next(self, corners: usize) -> [Option<usize>; 2] {
        if self.is_left {
            [None, Some((self.corner + 1) % corners)]
        } else {
            [Some((self.corner + corners - 1) % corners), None]
        }
    }
}

impl Outline<'_> {
    /// The corners at which lines from a point outside touch the outline: where a way turns right, and left.
    fn tangents(&self, from: Vector) -> [Option<usize>; 2] {
        let mut found = [None; 2];
        let last = self.corners.len() - 1;
        let mut before = self.faces(last, 0, from);
        for corner in 0..=last {
            let faces = self.faces(corner, if corner == last { 0 } else { corner + 1 }, from);
            if faces != before {
                found[usize::from(before)] = Some(corner);
            }
            before = faces;
        }
        found
    }

    /// Whether the edge between two corners can be seen from a point.
    fn faces(&self, corner: usize, next: usize, from: Vector) -> bool {
        let edge = self.corners[next] - self.corners[corner];
        edge.perp_dot(from - self.corners[corner]) < SEEN_M * edge.length()
    }

    /// Whether the line from `a` to `b` leads through the outline, and not just along it.
    fn is_entered(&self, a: Vector, b: Vector) -> bool {
        let (way, middle) = (b - a, self.middle - 0.5 * (a + b));
        let aside = way.perp_dot(middle);
        aside * aside <= self.reach * self.reach * way.length_squared()
            && middle.abs().max_element() <= self.reach + 0.5 * way.abs().max_element()
            && self.is_crossed(a, b)
    }

    /// The same for a line near the outline. Only the two edges with an end on each side of the line clip it.
    fn is_crossed(&self, a: Vector, b: Vector) -> bool {
        let (way, mut p) = (b - a, self.corners[self.corners.len() - 1]);
        let mut before = way.perp_dot(p - a);
        let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
        let (mut rightmost, mut leftmost) = (0.0_f32, 0.0_f32);
        for q in self.corners.iter().copied() {
            let aside = way.perp_dot(q - a);
            if (before < 0.0) != (aside < 0.0) {
                let edge = q - p;
                let depth = edge.perp_dot(a - p) - ROUNDING_M * edge.length(); // positive inside
                let change = edge.perp_dot(way);
                if change > 0.0 {
                    enter = enter.max(-depth / change);
                } else {
                    leave = leave.min(-depth / change);
                }
            }
            (rightmost, leftmost) = (rightmost.min(aside), leftmost.max(aside));
            (p, before) = (q, aside);
        }
        let length = way.length();
        leftmost.min(-rightmost) > ROUNDING_M * length && (leave - enter) * length > GRAZE_M
    }
}

/// The most promising leg is the greatest; of equally promising ones, that noted first.
impl Ord for Leg {
    fn cmp(&self, other: &Self) -> Ordering {
        other.estimate.total_cmp(&self.estimate).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Leg {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Leg {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Leg {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planning::obstacles::crosses;

    /// An axis-parallel box between two corners.
    fn rectangle([left, bottom]: [f32; 2], [right, top]: [f32; 2]) -> Vec<Vector> {
        [[left, bottom], [right, bottom], [right, top], [left, top]].map(Vector::from).to_vec()
    }

    /// The way from (1, 5) to (9, 5) in a square of 10 m.
    fn way(outlines: &[Vec<Vector>], wanted: Wanted) -> Option<Vec<Vector>> {
        let border = [Vector::splat(0.5), Vector::splat(9.5)];
        let plane = Plane::new(border, outlines.iter().map(Vec::as_slice));
        plane.way([Vector::new(1.0, 5.0), Vector::new(9.0, 5.0)], wanted)
    }

    fn at(places: &[[f32; 2]]) -> Vec<Vector> {
        places.iter().copied().map(Vector::from).collect()
    }

    #[test]
    fn the_shortest_way_bends_at_corners_of_what_it_would_run_into() {
        let shortest = |outlines: &[Vec<Vector>]| way(outlines, Wanted::Shortest).unwrap();
        assert_eq!(shortest(&[]), at(&[[9.0, 5.0]]));
        let (low, beside) = (rectangle([4.0, 0.0], [5.0, 6.0]), rectangle([6.0, 6.5], [7.0, 8.0]));
        assert_eq!(shortest(&[low.clone(), beside.clone()]), at(&[[4.0, 6.0], [5.0, 6.0], [9.0, 5.0]]));
        // The second box reaches into the way round the first, and the way under it is longer.
        let above = rectangle([6.0, 5.5], [7.0, 10.0]);
        let between = at(&[[4.0, 6.0], [5.0, 6.0], [6.0, 5.5], [9.0, 5.0]]);
        assert_eq!(shortest(&[low.clone(), above.clone()]), between);
        assert_eq!(shortest(&[above, low, beside]), between, "in whatever order, and with more of them");
    }

    #[test]
    fn boxes_that_overlap_leave_no_way_between_them() {
        let (low, high) = (rectangle([4.0, 0.0], [5.0, 4.0]), rectangle([4.5, 3.0], [5.5, 9.0]));
        let over = at(&[[4.5, 9.0], [5.5, 9.0], [9.0, 5.0]]);
        assert_eq!(way(&[low.clone(), high], Wanted::Shortest), Some(over));
        let closing = rectangle([4.0, 3.99], [5.0, 9.6]);
        for wanted in [Wanted::Shortest, Wanted::Any] {
            assert_eq!(way(&[low.clone(), closing.clone()], wanted), None, "the border is beyond");
        }
    }

    #[test]
    fn where_any_way_will_do_one_is_found() {
        let outlines = [rectangle([4.0, 0.0], [5.0, 8.0]), rectangle([6.0, 2.0], [7.0, 10.0])];
        let found = way(&outlines, Wanted::Any).unwrap();
        let start = Vector::new(1.0, 5.0);
        let mut legs = std::iter::once(&start).chain(&found).zip(&found);
        let is_crossed = |a, b| outlines.iter().any(|outline| crosses(outline, a, b));
        assert!(!legs.any(|(a, b)| is_crossed(*a, *b)), "{found:?}");
    }
}
