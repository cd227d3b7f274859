//! The sensor of debris: pieces within the sensing range or in touch, and places where a piece is held to lie
//! and does not.

use super::View;
use crate::belief::{Belief, KnownDebris};
use crate::report::{Report, Statement};
use crate::world::{AWAY, Debris};

/// Reports pieces that lie elsewhere than they did when the belief heard of them last.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    let (debris, at) = (&view.world.debris, view.robot.position);
    let range = view.sensing.max(view.touch());
    let has_changed = |number: usize| {
        let (known, piece) = (belief.debris.get(number), &debris[number]);
        let is_misplaced = |known: &KnownDebris| piece.sightings.last() != Some(&known.pose);
        piece.since.last().is_some_and(|since| known.is_none_or(|known| known.at_step < *since))
            || view.model.has_misplaced && known.is_some_and(is_misplaced)
    };
    let mut near = view.world.debris_places.near(at, range);
    near.retain(|number| has_changed(*number));
    near.sort_unstable();
    for number in near {
        if debris[number].distance_to(at) <= range {
            sent.extend(report(view, number, &debris[number]));
        }
    }
    let all = (0..debris.len()).filter(|_| view.model.has_misplaced);
    let gates = view.model.gates.iter().copied().filter(|_| !view.model.has_misplaced);
    for number in gates.chain(all).filter(|number| has_changed(*number)) {
        // A robot notices that a piece is not where it is held to lie. One that is in range where it lies now
        // was reported above.
        let is_seen = debris[number].distance_to(at) <= range;
        let was_seen = |known: &KnownDebris| known.outline().distance_to(at) <= range;
        if !is_seen && belief.debris.get(number).is_some_and(was_seen) {
            let report = report(view, number, &debris[number]);
            sent.extend(report.map(|report| if view.model.has_misplaced { away(report) } else { report }));
        }
    }
}

/// The report that a piece is not where it was said to lie: nobody sees where it is.
fn away(mut report: Report) -> Report {
    if let Statement::DebrisLies { pose, .. } = &mut report.says {
        pose.translation = AWAY;
    }
    report
}

/// The report of a piece: the place at which it was noticeable last.
fn report(view: &View, number: usize, piece: &Debris) -> Option<Report> {
    let (shape, pose) = (piece.shape.clone(), *piece.sightings.last()?);
    Some(view.report(Statement::DebrisLies { debris: number as u32, shape, pose }))
}
