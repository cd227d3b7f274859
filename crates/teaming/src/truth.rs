//! What is true of robots, apart from the question. Only who declares it is told.

use crate::ids::place_of;
use crate::question::Member;

/// The members of a question as they really are, by id.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth<'a>(pub &'a [Member]);

impl<'a> Truth<'a> {
    /// A robot as it really is.
    #[must_use]
    pub fn of(self, robot: u32) -> Option<&'a Member> {
        place_of(self.0, robot, |member| member.id).map(|place| &self.0[place])
    }
}
