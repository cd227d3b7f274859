//! The values of a trial's metrics, in the memory that a million trials leave for them.

use std::fmt;

/// Values of all metrics of a trial, in the order of the experiment's catalogue. A value takes eight bytes:
/// no metric is NaN, so that NaN stands for an undefined one.
#[derive(Clone)]
pub struct Values(Box<[f64]>);

impl Values {
    /// The value of the metric at this place; `None` where it is undefined.
    ///
    /// # Panics
    /// The catalogue has no such place.
    pub fn get(&self, metric: usize) -> Option<f64> {
        Some(self.0[metric]).filter(|value| !value.is_nan())
    }

    /// All values in order.
    pub fn iter(&self) -> impl Iterator<Item = Option<f64>> {
        (0..self.0.len()).map(|metric| self.get(metric))
    }
}

impl FromIterator<Option<f64>> for Values {
    fn from_iter<I: IntoIterator<Item = Option<f64>>>(values: I) -> Self {
        Self(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl fmt::Debug for Values {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undefined_values_are_kept_apart_from_zeros() {
        let values: Values = [Some(0.0), None, Some(-1.5)].into_iter().collect();
        assert_eq!(values.iter().collect::<Vec<_>>(), [Some(0.0), None, Some(-1.5)]);
        assert_eq!(values, values.clone());
        assert_ne!(values, [Some(0.0), Some(0.0), Some(-1.5)].into_iter().collect());
        assert_eq!(format!("{values:?}"), "[Some(0.0), None, Some(-1.5)]");
        assert_eq!(size_of::<Values>(), 16);
    }
}
