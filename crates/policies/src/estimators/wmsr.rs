//! `Wmsr(f, aged)`: what mates saw of a robot's health, without the values that stand farthest out.
//!
//! Each rater of a robot measures its health by its speed. Of these values the `f` farthest above and the
//! `f` farthest below the base's own estimate are dropped (all, if fewer lie on that side); the health is
//! the mean of the others and of the base's own estimate, the level that the robot said last (`LeBlanc`,
//! Zhang, Koutsoukos, Sundaram 2013, *Resilient Asymptotic Consensus in Robust Networks*). Where the base
//! has none, because it never heard the robot, the `f` largest and the `f` smallest values are dropped. It
//! withstands `f` liars among at least `2 f + 1` raters. Values of the last round in which the robot was
//! rated count; `aged`, less what the robot says to have lost since that round began (0 to 100 %): a value
//! is of the moment at which the robot went fastest, and health has changed since.

use teaming::{Estimate, Estimator, EstimatorKind, Evidence, PolicyError, Question, SaidRounds};

use super::last_said::{last_said, member_of};

teaming::options! {
    /// Takes the health that mates saw, and the energy that was said last; believes everybody.
    #[derive(Copy, Eq)]
    pub struct Wmsr {
        /// Number of liars to withstand: values that are dropped on each side.
        pub f: u32 = 1,
        /// Whether values are less what the robot says to have lost since.
        pub aged: bool = false,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    let make = |options: Wmsr| Ok::<_, &'static str>(options);
    EstimatorKind::with_options("Wmsr", "health as mates see it, without the values farthest out", make)
        .from_sources(env!("SOURCES_ESTIMATOR_WMSR"))
}

impl Estimator for Wmsr {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let mut estimates = last_said(question)?;
        let Some(evidence) = &question.evidence else { return Ok(estimates) };
        let was_heard = was_heard(question, evidence);
        let said = self.aged.then(|| SaidRounds::new(question, evidence));
        let all = question.members.iter().zip(measured(question, evidence)).zip(was_heard);
        for (estimate, ((member, (round, mut values)), was_heard)) in estimates.iter_mut().zip(all) {
            let Some(level) = evidence.body(member.id).map(|body| body.slowed_by.index()) else { continue };
            let begun = said.as_ref().and_then(|said| said.first(member.id, round)?.get(level).copied());
            if let (Some(begun), Some(last)) = (begun, estimate.levels.get(level)) {
                values.iter_mut().for_each(|value| *value = (*value - (begun - last)).clamp(0.0, 100.0));
            }
            let own = estimate.levels.get(level).copied().filter(|_| was_heard);
            let kept = kept(own, values, self.f as usize);
            let Some(mean) = mean(&kept) else { continue };
            let sd = (kept.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>()
                / kept.len() as f64)
                .sqrt();
            let (mut levels, mut sds) = (estimate.levels.clone(), estimate.sd.clone());
            (levels[level], sds[level]) = (mean, sd);
            *estimate = Estimate::of_levels(member, evidence, levels, sds)?;
        }
        Ok(estimates)
    }

    fn least_raters(&self) -> Option<u32> {
        Some(self.f.saturating_mul(2).saturating_add(1))
    }
}

/// Whether the base heard each member at all.
fn was_heard(question: &Question, evidence: &Evidence) -> Vec<bool> {
    let mut was_heard = vec![false; question.members.len()];
    for report in &evidence.reports {
        if let Some(member) = member_of(question, report.of) {
            was_heard[member] = true;
        }
    }
    was_heard
}

/// For each member, the last round in which it was rated, and the health that its raters measured then, in
/// percent.
fn measured(question: &Question, evidence: &Evidence) -> Vec<(u32, Vec<f64>)> {
    let mut last: Vec<(u32, Vec<f64>)> = vec![(0, Vec::new()); question.members.len()];
    for rating in &evidence.ratings {
        let body = evidence.body(rating.of);
        let hp = body.and_then(|body| rating.measured_level(body.top_mps, body.floor));
        let Some((member, hp)) = member_of(question, rating.of).zip(hp) else { continue };
        let (round, values) = &mut last[member];
        if rating.round > *round {
            (*round, *values) = (rating.round, Vec::new());
        }
        if rating.round == *round {
            values.push(hp);
        }
    }
    last
}

/// The values that are kept, ascending but for the base's own estimate, which is the last.
fn kept(own: Option<f64>, mut values: Vec<f64>, f: usize) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let (below, above) = match own {
        Some(own) => {
            (values.partition_point(|v| *v < own), values.len() - values.partition_point(|v| *v <= own))
        }
        None => (values.len(), values.len()),
    };
    if values.is_empty() {
        return values;
    }
    let (first, end) = (below.min(f), values.len() - above.min(f));
    let mut kept = values.get(first..end).unwrap_or_default().to_vec();
    kept.extend(own);
    kept
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(own: Option<f64>, values: &[f64], f: usize) -> Option<f64> {
        mean(&kept(own, values.to_vec(), f))
    }

    /// Reference: an independent implementation in Python. The last case has no own estimate.
    #[test]
    fn values_far_out_are_dropped_as_computed_elsewhere() {
        let near = |found: Option<f64>, expected: f64| (found.unwrap() / expected - 1.0).abs() < 1e-9;
        let values = [55.0, 62.0, 100.0, 100.0, 20.0];
        assert!(near(of(Some(60.0), &values, 1), 69.25));
        assert!(near(of(Some(60.0), &values, 2), 61.0));
        assert!(near(of(Some(90.0), &[80.0, 82.0, 85.0], 1), 85.666_666_666_666_67));
        assert!(near(of(None, &[55.0, 62.0, 100.0, 100.0, 20.0, 60.0], 2), 61.0));
        assert_eq!(of(Some(60.0), &[], 1), None, "without ratings, the level stays");
        assert!(near(of(Some(60.0), &[100.0, 100.0], 5), 60.0));
        assert_eq!(of(None, &[50.0, 70.0], 1), None);
    }
}
