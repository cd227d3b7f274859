//! Good and bad outcomes, and the Beta distribution that they speak for.

/// Sums of graded outcomes: an outcome of 0.7 is 0.7 good and 0.3 bad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Counts {
    pub(super) good: f64,
    pub(super) bad: f64,
}

impl Counts {
    /// Adds an outcome from 0 to 1.
    pub(super) fn add(&mut self, outcome: f64) {
        self.good += outcome;
        self.bad += 1.0 - outcome;
    }

    /// Adds other counts.
    pub(super) fn join(&mut self, other: Self) {
        self.good += other.good;
        self.bad += other.bad;
    }

    /// Makes all that was counted so far weigh so much less.
    pub(super) fn forget(&mut self, factor: f64) {
        self.good *= factor;
        self.bad *= factor;
    }

    /// The parameters of the Beta distribution, from an even first guess.
    pub(super) fn beta(self) -> [f64; 2] {
        [1.0 + self.good, 1.0 + self.bad]
    }

    /// Mean of the Beta distribution.
    pub(super) fn mean(self) -> f64 {
        let [a, b] = self.beta();
        a / (a + b)
    }

    /// Standard deviation of the Beta distribution.
    pub(super) fn sd(self) -> f64 {
        let [a, b] = self.beta();
        let n = a + b;
        (a * b / (n * n * (n + 1.0))).sqrt()
    }
}
