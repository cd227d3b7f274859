//! `usar export`: sweeps and trials for papers, slides and other programs.

mod csv;
mod ffmpeg;
mod figure;
mod film;
mod frames;
mod mcap;
mod parquet;
mod table;
mod trial;
mod video;

use super::verbs;

verbs!(Verb {
    Figure: figure::Arguments,
    Table: table::Arguments,
    Mcap: mcap::Arguments,
    Csv: csv::Arguments,
    Parquet: parquet::Arguments,
    Frames: frames::Arguments,
    Video: video::Arguments,
});
