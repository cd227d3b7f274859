//! Pictures of worlds and trials without a display: maps, moments and trails as SVG and PNG, and sequences
//! of moments as GIF.
//!
//! [`plan`] draws the world before the trial, [`moment`] the state at a frame of a recording, and
//! [`trails`] the trajectories of all robots on one map. Each function gives a [`Picture`], which is SVG
//! and can be rendered to pixels. The font is embedded, so that a picture is the same on every machine.
//! Colours and shapes are those of the page of `usar view`.
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
