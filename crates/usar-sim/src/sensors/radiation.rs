//! The sensor of radiation: zones whose border is within the sensing range.

use super::View;
use crate::belief::Belief;
use crate::report::{Report, Statement};

/// Reports zones that were switched since the belief heard of them last.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    for (number, zone) in view.model.zones.iter().map(|zone| &zone.disc).enumerate() {
        let heard = belief.zones.get(number).map(|known| known.at_step);
        let since = view.world.zone_since(number);
        if since.is_some_and(|since| heard.is_none_or(|heard| heard < since))
            && (zone.center - view.robot.position).length() <= view.sensing + zone.radius
        {
            let on = view.world.is_on(number);
            sent.push(view.report(Statement::ZoneIs { zone: number as u32, disc: *zone, on }));
        }
    }
}
