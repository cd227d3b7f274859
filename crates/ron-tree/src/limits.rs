//! Limits as data: constants that check values, and from which an always current page can be made.

use std::ops::RangeInclusive;

/// A limit of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Path of the field, with `*` for any entry, or a description of the limited object.
    pub of: &'static str,
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub most: f64,
    /// Meaning of the value, with its unit, and the reason for the limit.
    pub what: &'static str,
}

impl Limit {
    /// The range from the least to the greatest value.
    pub fn range(&self) -> RangeInclusive<f64> {
        self.least..=self.most
    }

    /// The greatest value of a count.
    pub const fn count(&self) -> usize {
        self.most as usize
    }

    /// Whether a count is within the limit.
    pub fn allows(&self, count: usize) -> bool {
        (self.least as usize..=self.count()).contains(&count)
    }
}

/// Declares constants of type [`Limit`](crate::limits::Limit), and `ALL` with all of them in order. The
/// first line of each comment describes the value.
///
/// ```
/// ron_tree::limits! {
///     /// Robots of a team.
///     ROBOTS: "team" = 1, 20_000;
/// }
/// assert!(ROBOTS.allows(12) && !ROBOTS.allows(0) && ALL[0] == ROBOTS);
/// ```
#[macro_export]
macro_rules! limits {
    ($($(#[doc = $what:literal])+ $name:ident: $of:literal = $least:expr, $most:expr;)+) => {
        $(
            $(#[doc = $what])+
            pub const $name: $crate::limits::Limit = $crate::limits::Limit {
                of: $of,
                least: $least as f64,
                most: $most as f64,
                what: concat!($($what),+),
            };
        )+

        /// All of them.
        pub const ALL: &[$crate::limits::Limit] = &[$($name),+];
    };
}

limits! {
    /// Bytes of a text: a scenario, a sweep file, a table.
    TEXT_BYTES: "a text" = 1, 4 << 20;
    /// Brackets within brackets.
    NESTING: "a RON text" = 0, 64;
    /// Values of a text: entries of lists, fields, and what is in brackets.
    VALUES: "a RON text" = 0, 200_000;
    /// Bytes of one string, or of one name.
    STRING_BYTES: "a RON text" = 0, 65_536;
}
