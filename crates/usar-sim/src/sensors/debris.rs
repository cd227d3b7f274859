//! The sensor of debris: pieces within the sensing range or in touch, and places from which a piece was taken
//! away.

use super::View;
use crate::belief::{Belief, KnownDebris};
use crate::report::{Report, Statement};
use crate::world::Debris;

/// Reports pieces that lie elsewhere than they did when the belief heard of them last.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    let (debris, at) = (&view.world.debris, view.robot.position);
    let range = view.sensing.max(view.touch());
    let has_changed = |number: usize| {
        let heard = belief.debris.get(number).map(|known| known.at_step);
        debris[number].since.last().is_some_and(|since| heard.is_none_or(|heard| heard < *since))
    };
    let mut near = view.world.debris_places.near(at, range);
    near.retain(|number| has_changed(*number));
    near.sort_unstable();
    for number in near {
        if debris[number].distance_to(at) <= range {
            sent.extend(report(view, number, &debris[number]));
        }
    }
    for number in view.model.gates.iter().copied().filter(|number| has_changed(*number)) {
        // A robot notices that a piece was taken away where the piece was seen last. A piece that is in range
        // where it lies now was reported above.
        let is_seen = debris[number].distance_to(at) <= range;
        let was_seen = |known: &KnownDebris| known.outline().distance_to(at) <= range;
        if !is_seen && belief.debris.get(number).is_some_and(was_seen) {
            sent.extend(report(view, number, &debris[number]));
        }
    }
}

/// The report of a piece: the place at which it was noticeable last.
fn report(view: &View, number: usize, piece: &Debris) -> Option<Report> {
    let (shape, pose) = (piece.shape.clone(), *piece.sightings.last()?);
    Some(view.report(Statement::DebrisLies { debris: number as u32, shape, pose }))
}
