//! Groups under construction.

use super::scorer::add;

/// A group under construction: members as indices into the team, and the sum of their weighted needs.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) members: Vec<usize>,
    pub(super) sum: Vec<f64>,
}

impl Group {
    pub(super) fn joined(&self, other: &Self) -> Self {
        let mut joined = self.clone();
        joined.members.extend(&other.members);
        add(&mut joined.sum, &other.sum);
        joined
    }
}
