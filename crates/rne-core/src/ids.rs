//! Rows of tables: tasks, roles and needs are small integers; the scenario has their names.

use serde::{Deserialize, Serialize};

macro_rules! row_id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
            schemars::JsonSchema,
        )]
        pub struct $name(pub u16);

        impl $name {
            /// The row's place in its table.
            #[must_use]
            pub fn index(self) -> usize {
                usize::from(self.0)
            }
        }
    };
}

row_id!(
    /// A task: its row in the table of tasks.
    TaskId
);
row_id!(
    /// A role: its row in the table of roles. Roles are merged in this order (the paper's Algorithm 1).
    RoleId
);
row_id!(
    /// A need: its row in the table of needs, and its place in every needs vector.
    NeedId
);

/// The ids of a table with this many rows, in order.
pub(crate) fn rows(count: usize) -> impl DoubleEndedIterator<Item = u16> + Clone {
    0..u16::try_from(count).unwrap_or(u16::MAX)
}
