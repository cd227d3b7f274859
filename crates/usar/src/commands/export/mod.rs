//! `usar export`: sweeps and trials for papers, slides and other programs.

mod ffmpeg;
mod figure;
mod film;
mod frames;
mod mcap;
mod table;
mod tables;
mod trial;
mod video;

use super::verbs;

verbs!(Verb {
    Figure: figure::Arguments,
    Table: table::Arguments,
    Mcap: mcap::Arguments,
    /// Write the tables of a trial as CSV
    #[command(after_help = tables::help("csv"))]
    Csv: tables::Arguments<false>,
    /// Write the tables of a trial as Parquet
    #[command(after_help = tables::help("parquet"))]
    Parquet: tables::Arguments<true>,
    Frames: frames::Arguments,
    Video: video::Arguments,
});
