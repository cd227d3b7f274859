//! A mean with the interval that is drawn as a band around a line.

use statistics::Moments;
use statistics::paired::t_half_width;

/// The mean of some values and half the width of its 95 % t interval.
pub(super) struct Band {
    n: usize,
    mean: f64,
    half: Option<f64>,
}

impl Band {
    /// `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        Some(Self { n: values.len(), mean: Moments::of(values).mean?, half: t_half_width(values) })
    }

    /// The point of a line at this place.
    pub fn at(&self, x: f64) -> (f64, f64, f64) {
        (x, self.mean, self.half.unwrap_or(0.0))
    }

    /// A row of the table behind a figure: what it is of, then the columns n, mean and `half_width`.
    pub fn row<const N: usize>(&self, of: [&str; N]) -> Vec<String> {
        let half = self.half.map_or(String::new(), |half| half.to_string());
        let numbers = [self.n.to_string(), self.mean.to_string(), half];
        of.map(str::to_owned).into_iter().chain(numbers).collect()
    }
}
