//! Pictures of worlds and trials without a display: maps, moments and trails as SVG; with the feature
//! `raster` also as PNG and PDF, and sequences of moments as GIF.
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
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "raster")]
mod animation;
mod error;
mod ground;
mod legend;
mod moment;
mod picture;
mod plan;
#[cfg(feature = "raster")]
mod raster;
mod shapes;
mod sheet;
mod svg;
mod team;
mod theme;
mod trails;

#[cfg(feature = "raster")]
pub use animation::Animation;
pub use error::PictureError;
pub use moment::moment;
pub use picture::{Look, Picture, Width};
pub use plan::{Plan, plan};
#[cfg(feature = "raster")]
pub use raster::Pixels;
pub use trails::trails;
