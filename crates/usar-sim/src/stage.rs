//! The stages of a step by name, to measure the time of each.

/// The stages of a step, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Robots notice what is in range.
    Sense,
    /// Rounds, grouping, claims, goals.
    Mission,
    /// Routes.
    Plan,
    /// Right of way.
    Resolve,
    /// Changes of velocity.
    Drive,
    /// The physics.
    Integrate,
    /// Energy for moving, HP for radiation.
    Exposure,
    /// Loading, delivering, resting.
    Rescue,
    /// Metrics, hash chain, invariants.
    Record,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 9] = [
        Self::Sense,
        Self::Mission,
        Self::Plan,
        Self::Resolve,
        Self::Drive,
        Self::Integrate,
        Self::Exposure,
        Self::Rescue,
        Self::Record,
    ];

    /// The stage as one word, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sense => "sense",
            Self::Mission => "mission",
            Self::Plan => "plan",
            Self::Resolve => "resolve",
            Self::Drive => "drive",
            Self::Integrate => "integrate",
            Self::Exposure => "exposure",
            Self::Rescue => "rescue",
            Self::Record => "record",
        }
    }
}
