//! The stages of a step by name, to measure the time of each.

ron_tree::named! {
    /// The stages of a step, in their order.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Stage {
        /// Robots notice what is in range.
        Sense = "sense",
        /// Rounds, grouping, claims, goals.
        Mission = "mission",
        /// Routes.
        Plan = "plan",
        /// Right of way.
        Resolve = "resolve",
        /// Changes of velocity.
        Drive = "drive",
        /// The physics.
        Integrate = "integrate",
        /// Energy for moving, HP for radiation.
        Exposure = "exposure",
        /// Loading, delivering, resting.
        Rescue = "rescue",
        /// Metrics, hash chain, invariants.
        Record = "record",
    }
}
