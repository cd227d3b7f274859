//! Tables whose columns are declared once: name, type, unit, meaning, and how a row is read. The file in CSV,
//! its dictionary and its other forms follow from it. A [`Table`] has texts, as people read them, and is
//! written in any [`Format`].
//!
//! ```
//! use tables::{Cell, Columns, Csv, abouts, columns};
//!
//! let squares = || -> Columns<u32> {
//!     columns! { u32:
//!         "side_m", Natural, "m", "Length of a side.", |side| *side;
//!         "half_m", Number, "m", "Half of it.", |side| Cell::short(f64::from(*side) / 2.0);
//!     }
//! };
//! let mut csv = Csv::new(Vec::new());
//! csv.add_names(&abouts(squares()))?;
//! csv.add(&[], &squares(), 2..=3)?;
//! assert_eq!(csv.finish()?, b"side_m,half_m\n2,1\n3,1.5\n");
//! # Ok::<(), std::io::Error>(())
//! ```

mod blocks;
mod column;
mod format;
mod page;
mod rows;
mod text;

pub use column::{About, Cell, Column, Columns, Kind, abouts};
pub use format::{Format, fold_at, is_wide, show_as, shown_as};
pub use page::section;
pub use rows::{Csv, csv};
pub use text::{Entry, Table, labelled, or_dash, right, right_or_dash, valued};
