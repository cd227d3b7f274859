//! `EigenTrust(a)`: robots are believed by robots that are believed.
//!
//! `s_ij` is the sum of `2 o - 1` over the outcomes `o` of the ratings of robot `j` by robot `i`; `c_ij =
//! max(s_ij, 0)` over the sum of its row; a row without any is `p`; `t <- (1 - a) C' t + a p` until nothing
//! changes by more than 1e-12; trust is `t / max t` (Kamvar, Schlosser, Garcia-Molina 2003, *The `EigenTrust`
//! Algorithm for Reputation Management in P2P Networks*). `p` is what the base itself found, by the same
//! formula over its own outcomes, and the same for all robots while it found nothing.

use teaming::ids::place_of;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::counts::Counts;
use super::last_said::{last_said, last_said_with};
use super::outcomes::{Outcome, Outcomes, TOLERANCE, by_rater};

/// The greatest change of a trust at which the iteration ends.
const STILL: f64 = 1e-12;

/// Iterations at most. With `a` of 0.01 it takes about 2,750.
const MOST_TURNS: u32 = 10_000;

teaming::options! {
    /// Believes robots by the principal eigenvector of their ratings; levels are those said last.
    #[derive(Copy)]
    pub struct EigenTrust {
        /// Weight of the base's own outcomes, above 0 and at most 1.
        pub a: f64 = 0.15,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("EigenTrust", "trust by those who are trusted", EigenTrust::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_EIGEN_TRUST"))
}

impl EigenTrust {
    fn checked(self) -> Result<Self, &'static str> {
        let is_weight = self.a > 0.0 && self.a <= 1.0;
        if is_weight { Ok(self) } else { Err("a must be above 0 and at most 1") }
    }
}

impl Estimator for EigenTrust {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let outcomes = Outcomes::of(question, evidence, TOLERANCE);
        let robots = robots(question, outcomes.all());
        let place = |robot: u32| place_of(&robots, robot, |robot| *robot);
        let (mut base, mut local) = (vec![0.0; robots.len()], Vec::new());
        for about_one in outcomes.all().chunk_by(|a, b| a.of == b.of) {
            let Some(of) = place(about_one[0].of) else { continue };
            let (own, raters) = by_rater(about_one);
            base[of] = satisfaction(own);
            let link =
                |(by, counts): (u32, Counts)| Some(Link { by: place(by)?, of, value: satisfaction(counts) });
            local.extend(raters.into_iter().filter_map(link));
        }
        let trust = eigenvector(&positive(local, robots.len()), &pre_trusted(base), self.a);
        let most = trust.iter().copied().fold(0.0, f64::max);
        let of = |id: u32| place(id).map_or(1.0, |place| (trust[place] / most).clamp(0.0, 1.0));
        last_said_with(question, question.members.iter().map(|member| of(member.id)))
    }
}

/// The robots that rate or are rated, and the members, ascending.
fn robots(question: &Question, outcomes: &[Outcome]) -> Vec<u32> {
    let named = outcomes.iter().flat_map(|outcome| [Some(outcome.of), outcome.by]).flatten();
    let mut robots: Vec<u32> = question.members.iter().map(|member| member.id).chain(named).collect();
    robots.sort_unstable();
    robots.dedup();
    robots
}

/// How far one robot is satisfied with another, by their places.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Link {
    by: usize,
    of: usize,
    value: f64,
}

/// The sum of `2 o - 1` over outcomes.
fn satisfaction(counts: Counts) -> f64 {
    counts.good - counts.bad
}

/// The normalised rows: links above 0 as shares of their row, and the rows that have none.
struct Rows {
    links: Vec<Link>,
    silent: Vec<usize>,
}

/// A rater has no say about itself.
fn positive(links: Vec<Link>, robots: usize) -> Rows {
    let mut sums = vec![0.0; robots];
    let mut links = links;
    links.retain(|link| link.value > 0.0 && link.by != link.of);
    links.iter().for_each(|link| sums[link.by] += link.value);
    links.iter_mut().for_each(|link| link.value /= sums[link.by]);
    let silent = (0..robots).filter(|robot| sums[*robot] <= 0.0).collect();
    Rows { links, silent }
}

/// The shares of the base's own outcomes; the same for all if none is above 0.
fn pre_trusted(own: Vec<f64>) -> Vec<f64> {
    let positive: Vec<f64> = own.into_iter().map(|value| value.max(0.0)).collect();
    let sum: f64 = positive.iter().sum();
    let even = 1.0 / positive.len() as f64;
    positive.into_iter().map(|value| if sum > 0.0 { value / sum } else { even }).collect()
}

/// The trust that does not change any more.
fn eigenvector(rows: &Rows, p: &[f64], a: f64) -> Vec<f64> {
    let mut trust = p.to_vec();
    let mut next = vec![0.0; p.len()];
    for _ in 0..MOST_TURNS {
        let silent: f64 = rows.silent.iter().map(|robot| trust[*robot]).sum();
        next.iter_mut().zip(p).for_each(|(next, p)| *next = ((1.0 - a) * silent + a) * p);
        rows.links.iter().for_each(|link| next[link.of] += (1.0 - a) * link.value * trust[link.by]);
        let change = next.iter().zip(&trust).map(|(next, before)| (next - before).abs()).fold(0.0, f64::max);
        std::mem::swap(&mut trust, &mut next);
        if change <= STILL {
            break;
        }
    }
    trust
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trust(local: &[&[f64]], p: &[f64], a: f64) -> Vec<f64> {
        let row = |(by, row): (usize, &&[f64])| -> Vec<Link> {
            row.iter().enumerate().map(|(of, value)| Link { by, of, value: *value }).collect()
        };
        let links = local.iter().enumerate().flat_map(row).collect();
        eigenvector(&positive(links, local.len()), p, a)
    }

    /// Reference: an independent implementation in Python.
    #[test]
    fn eigenvectors_are_as_computed_elsewhere() {
        let even = pre_trusted(vec![0.0; 4]);
        let first = trust(
            &[&[0.0, 4.0, 1.0, 0.0], &[3.0, 0.0, 2.0, 0.0], &[5.0, 5.0, 0.0, 0.0], &[0.0, 0.0, 9.0, 0.0]],
            &even,
            0.15,
        );
        let expected = [0.335_652_641_927_435_2, 0.373_441_349_958_828_94, 0.253_406_008_113_735_3, 0.0375];
        assert!(first.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-9));
        let silent = trust(&[&[0.0, 2.0, 0.0], &[1.0, 0.0, 1.0], &[0.0, 0.0, 0.0]], &[0.5, 0.5, 0.0], 0.2);
        let expected = [0.357_142_857_142_861_4, 0.459_183_673_469_287_23, 0.183_673_469_387_893_08];
        assert!(silent.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-9));
    }

    #[test]
    fn bad_pairs_and_oneself_count_nothing() {
        let link = |by, of, value| Link { by, of, value };
        let rows = positive(vec![link(0, 1, 0.5), link(1, 0, -1.0), link(0, 2, 1.5), link(2, 2, 1.0)], 3);
        assert_eq!(rows.links, [link(0, 1, 0.25), link(0, 2, 0.75)]);
        assert_eq!(rows.silent, [1, 2]);
        assert_eq!(pre_trusted(vec![3.0, -1.0, 1.0]), [0.75, 0.0, 0.25]);
    }
}
