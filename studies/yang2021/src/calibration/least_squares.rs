//! Least squares without derivatives, for noisy residuals.
//!
//! Each residual is modelled as linear in the parameters, by a regression on the evaluated candidates near
//! the centre. The model's minimum within a box around the centre is the next centre. The box shrinks as
//! the search proceeds. Every second candidate is a step from the centre along one of the axes, so that the
//! regression has data in all directions. The method is a response surface as in Box and Wilson (1951),
//! with the residual model of DFO-LS (Cartis, Fiala, Marteau and Roberts 2019, ACM TOMS 45:32).

use nalgebra::{DMatrix, DVector};

/// The smallest box, as a share of the first.
const LAST_REACH: f64 = 0.25;

/// Number of candidates after which the box is half as wide.
const HALVED_AFTER: f64 = 45.0;

/// Weight of flat slopes in the regression, in units of one candidate at the edge of the box.
const RIDGE: f64 = 0.05;

/// Rounds of descent along the axes in the search for a model's minimum.
const ROUNDS: usize = 200;

/// An evaluated candidate: its place in the unit box, and its residuals, which the search minimises.
struct Known {
    place: DVector<f64>,
    residuals: DVector<f64>,
}

/// A search. It proposes places and is told their residuals.
pub(super) struct LeastSquares {
    known: Vec<Known>,
    centre: DVector<f64>,
    /// Half of the first box, as a share of each range.
    first_reach: f64,
    proposed: usize,
}

impl LeastSquares {
    /// A search from a place in the unit box.
    pub(super) fn new(start: Vec<f64>, first_reach: f64) -> Self {
        Self { known: Vec::new(), centre: DVector::from_vec(start), first_reach, proposed: 0 }
    }

    /// Half of the current box, as a share of each range.
    fn reach(&self) -> f64 {
        self.first_reach * (-(self.proposed as f64) / HALVED_AFTER).exp2().max(LAST_REACH)
    }

    /// The next place to evaluate. The first is the start; then comes a step along each axis.
    pub(super) fn propose(&mut self) -> Vec<f64> {
        let (number, axes) = (self.proposed, self.centre.len());
        self.proposed += 1;
        if number == 0 {
            return self.centre.as_slice().to_vec();
        }
        if number <= axes {
            return self.aside(number - 1, false);
        }
        let step = number - axes - 1;
        if step.is_multiple_of(2) {
            self.centre = self.minimum();
            return self.centre.as_slice().to_vec();
        }
        self.aside(step / 2 % axes, (step / 2 / axes).is_multiple_of(2))
    }

    /// A place beside the centre along an axis: towards the middle of the range, or away from it.
    fn aside(&self, axis: usize, is_outwards: bool) -> Vec<f64> {
        let mut place = self.centre.as_slice().to_vec();
        let is_upwards = (place[axis] < 0.5) != is_outwards;
        place[axis] = (place[axis] + if is_upwards { self.reach() } else { -self.reach() }).clamp(0.0, 1.0);
        place
    }

    /// Stores the residuals of a proposed place.
    pub(super) fn tell(&mut self, place: &[f64], residuals: Vec<f64>) {
        let (place, residuals) = (DVector::from_column_slice(place), DVector::from_vec(residuals));
        self.known.push(Known { place, residuals });
    }

    /// The model's minimum within the box around the centre.
    fn minimum(&self) -> DVector<f64> {
        let Some((level, slopes)) = self.model() else { return self.centre.clone() };
        let reach = self.reach();
        let mut step = DVector::zeros(self.centre.len());
        let mut residuals = level;
        for _ in 0..ROUNDS {
            for axis in 0..step.len() {
                let slope = slopes.row(axis).transpose();
                let steepness = slope.norm_squared();
                if steepness <= 0.0 {
                    continue;
                }
                let (low, high) = ((-reach).max(-self.centre[axis]), reach.min(1.0 - self.centre[axis]));
                let wish: f64 = step[axis] - slope.dot(&residuals) / steepness;
                let moved = wish.clamp(low, high) - step[axis];
                step[axis] += moved;
                residuals += slope * moved;
            }
        }
        &self.centre + step
    }

    /// The slopes of the residuals at the centre, with a row for each axis.
    pub(super) fn slopes(&self) -> Option<DMatrix<f64>> {
        self.model().map(|(_, slopes)| slopes)
    }

    /// The residuals at the centre, and their slopes with a row for each axis, by a weighted ridge
    /// regression.
    fn model(&self) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let count = self.known.first()?.residuals.len();
        let (axes, reach) = (self.centre.len(), self.reach());
        let mut normal = DMatrix::zeros(axes + 1, axes + 1);
        let mut moments = DMatrix::zeros(axes + 1, count);
        for Known { place, residuals } in &self.known {
            let offset = place - &self.centre;
            let weight = (-(offset.amax() / (2.0 * reach)).powi(2)).exp();
            let row = offset.insert_row(0, 1.0);
            normal += weight * &row * row.transpose();
            moments += weight * &row * residuals.transpose();
        }
        for axis in 1..=axes {
            normal[(axis, axis)] += RIDGE * reach * reach;
        }
        let solved = normal.cholesky()?.solve(&moments);
        Some((solved.row(0).transpose(), solved.rows(1, axes).into_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen curved residuals of eight parameters, with noise of standard deviation 1 that looks random
    /// but is the same each time.
    fn residuals(place: &[f64], with_noise: bool) -> Vec<f64> {
        let noise = |i: usize| {
            let mix: f64 = place.iter().enumerate().map(|(k, x)| x * (12.9898 + k as f64 * 78.233)).sum();
            let fraction = ((mix + i as f64 * 3.7).sin() * 43_758.545_3).fract();
            (fraction.abs() - 0.5) * 12_f64.sqrt()
        };
        let truth = |k: usize| 0.35 + 0.04 * k as f64;
        let one = |i: usize| {
            let linear: f64 = (0..8)
                .map(|k| ((i * 7 + k * 5) % 11) as f64 / 11.0 * 40.0 * (place[k].powi(2) - truth(k).powi(2)))
                .sum();
            let own = 60.0 * (place[i % 8] - truth(i % 8));
            linear + own + if with_noise { noise(i) } else { 0.0 }
        };
        (0..16).map(one).collect()
    }

    fn least(with_noise: bool, most: usize) -> f64 {
        let mut search = LeastSquares::new(vec![0.5; 8], 0.1);
        let mut least = f64::INFINITY;
        for _ in 0..most {
            let place = search.propose();
            search.tell(&place, residuals(&place, with_noise));
            least = least.min(residuals(&place, false).iter().map(|r| r * r).sum());
        }
        least
    }

    #[test]
    fn the_minimum_is_found_with_few_candidates_and_with_noise_nearly() {
        let start: f64 = residuals(&[0.5; 8], false).iter().map(|r| r * r).sum();
        assert!(start > 400.0, "{start}");
        assert!(least(false, 60) < 1.0, "{}", least(false, 60));
        assert!(least(true, 60) < 20.0, "{}", least(true, 60));
    }

    #[test]
    fn proposals_stay_in_the_box() {
        let mut search = LeastSquares::new(vec![0.02, 0.99], 0.3);
        for _ in 0..25 {
            let place = search.propose();
            assert!(place.iter().all(|x| (0.0..=1.0).contains(x)), "{place:?}");
            search.tell(&place, vec![1e3 * (place[0] + 1.0), -5.0 * place[1]]);
        }
    }

    #[test]
    fn a_place_that_cannot_be_run_is_passed_by() {
        let mut search = LeastSquares::new(vec![0.5], 0.1);
        let mut least = f64::INFINITY;
        for _ in 0..12 {
            let place = search.propose();
            if place[0] < 0.45 {
                continue; // nothing is told
            }
            search.tell(&place, vec![10.0 * (place[0] - 0.6)]);
            least = least.min((place[0] - 0.6).abs());
        }
        assert!(least < 0.01, "{least}");
    }
}
