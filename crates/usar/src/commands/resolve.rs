//! `usar resolve`: prints every resolved value of a scenario, and its origin.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use experiments::Failure;
use experiments::experiment::with_settings;
use ron_fields::Fields;
use usar_sim::scenario::read_text;

use super::load;

/// Print every value that a scenario ends up with, and where it comes from
#[derive(Debug, Args)]
#[command(after_help = "\
A line for each value: its path, the value, and its origin: file and line, --set, or default. The path is \
that of --set and of axes.

Examples:
  usar resolve scenarios/three-tasks.ron
  usar resolve scenarios/paper.ron --set mission.rest_s=10 | grep rest_s")]
pub(crate) struct Arguments {
    /// Scenario file (RON)
    file: PathBuf,
    /// Set a field of the scenario, by its path, to a value in RON; can be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// A text that contains values.
struct Source {
    path: PathBuf,
    text: String,
    fields: Fields,
}

impl Source {
    fn read(path: &Path) -> Result<Self, Failure> {
        let text = read_text(path).map_err(Failure::input)?;
        Ok(Self { path: path.to_owned(), fields: Fields::of(&text), text })
    }

    /// The path of the base that the text names.
    fn base(&self) -> Option<PathBuf> {
        let name = self.text[self.fields.value("base")?].trim_matches('"');
        Some(self.path.parent().unwrap_or(Path::new("")).join(name))
    }

    /// Whether a list in this text replaces the base's list that contains this path.
    fn has_list_around(&self, path: &str) -> bool {
        let first = path.split(['.', '[']).next().unwrap_or_default();
        self.fields.value(first).is_some_and(|place| self.text[place].starts_with('['))
    }

    /// The place of a value in this text, if it is written here, with the name that stands for it there.
    fn origin(&self, path: &str, named: &str) -> Option<String> {
        let place = format!("{}:{}", self.path.display(), self.line(path, named)?);
        let value = [path, named].into_iter().find_map(|path| self.fields.value(path));
        let word = &self.text[value.unwrap_or_default()];
        let name = format!("values.{word}");
        Some(match self.fields.value(&name).and_then(|_| self.fields.line(&name)) {
            Some(line) => format!("{place}, {word} of line {line}"),
            None => place,
        })
    }

    /// The line of a value, if it is written here; `named` is its path with names instead of indices.
    fn line(&self, path: &str, named: &str) -> Option<usize> {
        let written = [path, named].into_iter().find(|path| self.fields.value(path).is_some());
        if let Some(path) = written {
            return self.fields.line(path);
        }
        // `((0, 0), (10, 0))` is a wall without field names.
        let entry = &path[..=path.find(']')?];
        let place = self.fields.value(entry)?;
        let is_short = self.text[place].starts_with("((");
        (is_short && !path.ends_with("thickness_m")).then(|| self.fields.line(entry)).flatten()
    }
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let (scenario, _) = load(&self.file)?;
        let scenario = with_settings(&scenario, &self.set)?;
        let resolved = scenario.resolved();
        let fields = Fields::of(&resolved);
        let own = Source::read(&self.file)?;
        let base = own.base().map(|path| Source::read(&path)).transpose()?;
        let set: Vec<String> = self.set.iter().filter_map(|set| canonical(&fields, set)).collect();
        let width = fields.leaves().map(|(path, _)| path.len()).max().unwrap_or_default();
        let mut drawn = None;
        for (path, place) in fields.leaves() {
            // A distribution is one value, even if it contains several numbers.
            let around =
                scenario.draws.keys().find(|key| path.strip_prefix(key.as_str()).is_some_and(ends_a_segment));
            if around.is_some() && around == drawn {
                continue;
            }
            drawn = around;
            let whole = around.and_then(|key| Some((key.as_str(), fields.value(key)?)));
            let (path, place) = whole.unwrap_or((path, place));
            let named = named(&fields, &resolved, path);
            let from = |source: &Source| source.origin(path, &named);
            let is_set = set.iter().any(|set| path.strip_prefix(set.as_str()).is_some_and(ends_a_segment));
            let origin = if is_set {
                Some("--set".to_owned())
            } else {
                let of_base = base.as_ref().filter(|_| !own.has_list_around(path));
                from(&own).or_else(|| from(of_base?))
            };
            let origin = origin.unwrap_or_else(|| "default".to_owned());
            writeln!(out, "{path:width$} = {}  # {origin}", &resolved[place])?;
        }
        Ok(())
    }
}

fn ends_a_segment(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['.', '['])
}

/// The path of a setting, with indices instead of names.
fn canonical(fields: &Fields, setting: &str) -> Option<String> {
    fields.canonical(setting.split('=').next()?.trim())
}

/// A path with the name of the table's entry instead of its index: `roles.carrier.hp` for `roles[0].hp`.
fn named(fields: &Fields, text: &str, path: &str) -> String {
    let name = || {
        let end = path.find(']')? + 1;
        let name = text[fields.value(&format!("{}.name", &path[..end]))?].trim_matches('"');
        let table = &path[..path.find('[')?];
        Some(format!("{table}.{name}{}", &path[end..]))
    };
    name().unwrap_or_else(|| path.to_owned())
}
