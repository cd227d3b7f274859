//! Identities: small integers, so that a robot is never mistaken for a rescuee.

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
            schemars::JsonSchema,
        )]
        pub struct $name(pub u32);

        impl $name {
            /// Position in the world's list of its kind.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}", self.0)
            }
        }
    };
}

id!(
    /// A robot: its place in the team's rows, from 0.
    RobotId
);
id!(
    /// A person or valuable to rescue, from 0: task by task, in the order of the table of tasks.
    RescueeId
);
