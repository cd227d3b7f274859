//! A cell of a sweep.

/// A cell of a sweep: the places of a case and of a policy.
pub type Cell = (usize, usize);
