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
    /// A level: its row in the table of levels, and its place in every list of levels.
    LevelId
);
row_id!(
    /// A need: its row in the table of needs, and its place in every needs vector.
    NeedId
);

/// The place of an id in a list whose ids ascend. It takes one look where the ids count from 0 without a gap.
#[must_use]
pub fn place_of<T>(list: &[T], id: u32, id_of: impl Fn(&T) -> u32) -> Option<usize> {
    let guess = id as usize;
    let is_there = list.get(guess).is_some_and(|entry| id_of(entry) == id);
    if is_there { Some(guess) } else { list.binary_search_by_key(&id, id_of).ok() }
}

/// The ids of a table with this many rows, in order.
pub(crate) fn rows(count: usize) -> impl DoubleEndedIterator<Item = u16> + Clone {
    0..u16::try_from(count).unwrap_or(u16::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_found_with_and_without_gaps() {
        for list in [vec![0, 1, 2, 3], vec![1, 2, 3], vec![0, 2, 5, 9], vec![7], Vec::new()] {
            for id in 0..11 {
                assert_eq!(place_of(&list, id, |id| *id), list.iter().position(|known| *known == id));
            }
        }
    }
}
