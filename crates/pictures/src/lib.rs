//! Pictures of worlds and trials without a display: maps, moments and trails as SVG, as PNG, and moments in
//! a row as GIF.
//!
//! [`plan`] draws the world before anything runs, [`moment`] the state at a frame of a recording, [`trails`]
//! the ways of all robots on
//! one map. Each gives a [`Picture`], which is SVG and can be made pixels. The font is embedded: a picture
//! is the same on
//! every machine. Colours and shapes are those of the page of `usar view`.
//!
//! ```no_run
//! use pictures::{Look, moment};
//! use recording::Recording;
//!
//! let recording = Recording::read(&std::fs::read("paper.usrec")?)?;
//! let picture = moment(&recording, recording.frame_at(120.0), &Look::default())?;
//! std::fs::write("frame.svg", picture.svg())?;
//! std::fs::write("frame.png", picture.png()?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod animation;
mod error;
mod font;
mod ground;
mod legend;
mod moment;
mod pdf;
mod picture;
mod plan;
mod shapes;
mod sheet;
mod svg;
mod team;
mod theme;
mod trails;

pub use animation::Animation;
pub use error::PictureError;
pub use moment::moment;
pub use picture::{Look, Picture, Pixels, Width};
pub use plan::{Plan, plan};
pub use trails::trails;
