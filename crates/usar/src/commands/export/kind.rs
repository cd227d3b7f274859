//! What is written: the ending of --to and a few options say it.

use clap::parser::ValueSource;
use clap::{ArgMatches, Command, FromArgMatches, Id};

use super::Arguments;
use crate::builds::check_kind;
use crate::prelude::*;

/// What is written.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// Everything that a sweep measured, as one table.
    Long,
    /// One figure of a sweep.
    Figure,
    /// The tables of a trial.
    Tables,
    /// An MCAP log of a trial.
    #[cfg(feature = "exports")]
    Log,
    /// A moment of a trial.
    Moment,
    /// The trajectories of all robots of a trial.
    Trails,
    /// Pictures of a trial one after the other.
    Series,
    /// The same as an animation.
    #[cfg(feature = "pictures")]
    Animation,
}

/// Names of options: which trial is exported, how it is drawn, and others.
const TRIAL: &[&str] = &["policy", "seed", "case", "set", "allow_expensive"];
const LOOK: &[&str] = &["width", "dpi", "no_title", "no_legend"];
const PACE: &[&str] = &["every", "begin", "end"];
const FIGURE: &[&str] =
    &["figure", "metric", "baseline", "policies", "case", "width", "dpi", "height", "grey", "measure"];
const OTHERS: &[&str] = &["at", "trails", "fps"];

impl Kind {
    pub(super) fn of(arguments: &Arguments) -> Result<Self, Failure> {
        let Arguments { file, to, given, .. } = arguments;
        let path = to.display();
        let is_long = file.is_dir() && !given.has("policy") && !given.has("seed");
        let ending = to.extension().and_then(|ending| ending.to_str());
        check_kind("--to", ending.unwrap_or_default())?;
        Ok(match ending {
            Some("csv") if is_long => Self::Long,
            None if is_long && to == Path::new("-") => Self::Long,
            Some("parquet") if is_long => refuse!(
                "--to: all of a sweep is one .csv, found {path}; --policy and --seed name one trial of it"
            ),
            Some("csv" | "parquet") => Self::Tables,
            #[cfg(feature = "exports")]
            Some("mcap") => Self::Log,
            #[cfg(feature = "pictures")]
            Some("gif") if given.has("every") => Self::Animation,
            Some("gif") => refuse!("--to: {path} needs --every, the time between two pictures"),
            Some("png" | "svg" | "pdf") => {
                match ["figure", "at", "trails", "every"].map(|one| given.has(one)) {
                    [true, ..] if file.is_dir() => Self::Figure,
                    [true, ..] => refuse!("--figure: {} is no folder of a sweep", file.display()),
                    [_, true, ..] => Self::Moment,
                    [.., true, _] => Self::Trails,
                    [.., true] => Self::Series,
                    _ => refuse!("--to: {path} needs --at, --trails or --every, or --figure of a sweep"),
                }
            }
            _ => refuse!(
                "--to: must end with .csv, .parquet, .mcap, .png, .svg, .pdf or .gif, or be - for the table \
                 of a sweep, found {path}"
            ),
        })
    }

    /// Refuses options that say nothing about it.
    pub(super) fn check(self, given: &Given, to: &Path) -> Result<(), Failure> {
        let (what, taken) = match self {
            Self::Long => ("the long table of a sweep", vec![]),
            Self::Figure => ("a figure of a sweep", vec![FIGURE]),
            Self::Tables => ("the tables of a trial", vec![TRIAL, &["every"]]),
            #[cfg(feature = "exports")]
            Self::Log => ("the log of a trial", vec![TRIAL, &["every"]]),
            Self::Moment => ("the picture of a moment", vec![TRIAL, LOOK, &["at"]]),
            Self::Trails => ("the picture of trajectories", vec![TRIAL, LOOK, &["trails"]]),
            Self::Series => ("a series of pictures", vec![TRIAL, LOOK, PACE]),
            #[cfg(feature = "pictures")]
            Self::Animation => ("an animation", vec![TRIAL, LOOK, PACE, &["fps"]]),
        };
        let taken = taken.concat();
        let all = [TRIAL, LOOK, PACE, FIGURE, OTHERS].concat();
        let Some(name) = all.into_iter().find(|name| given.has(name) && !taken.contains(name)) else {
            return Ok(());
        };
        let (option, to) = (name.replace('_', "-"), to.display());
        refuse!("--{option}: is no option of {what}, which --to {to} asks for")
    }
}

/// The names of the options on the command line.
#[derive(Debug)]
pub(super) struct Given(Vec<Id>);

impl Given {
    fn has(&self, name: &str) -> bool {
        self.0.iter().any(|given| given == name)
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given = |name: &&Id| matches.value_source(name.as_str()) == Some(ValueSource::CommandLine);
        Ok(Self(matches.ids().filter(is_given).cloned().collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        Self::from_arg_matches(matches).map(|given| *self = given)
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}
