//! Results on disk that survive kills, full disks and forged digits.
//!
//! A job that can be resumed keeps a [`Log`]: a checked line for each piece of work that is done. It holds a
//! [`lock`] while it works, writes its results as [`files`] that appear whole, and refuses folders that are
//! not its own ([`owned`]). The crate knows nothing of what it keeps.
//!
//! ```
//! # fn main() -> Result<(), store::Failure> {
//! # let place = tempfile::tempdir()?;
//! # let folder = place.path();
//! use std::sync::Arc;
//! use store::lock::Lock;
//! use store::{Header, Log};
//!
//! let header = Header::new("count", "to three");
//! let lock = Arc::new(Lock::of_folder(folder)?);
//! let (mut log, done) = Log::resume::<u32>(&folder.join("count.jsonl"), &header, lock)?;
//! for number in done.len() as u32 + 1..=3 {
//!     log.add(&[number])?; // on disk when it returns
//! }
//! assert_eq!(store::read::<u32>(&folder.join("count.jsonl"), &header)?, [1, 2, 3]);
//! # Ok(())
//! # }
//! ```

pub mod archive;
mod failure;
pub mod files;
pub mod lock;
mod log;
pub mod machine;
mod medium;
pub mod owned;

pub use failure::{Failure, at};
pub use log::{Header, LINE_BYTES, Line, LineError, Log, checked, entry_of, read};
pub use medium::Medium;
