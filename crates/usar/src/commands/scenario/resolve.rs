//! `usar scenario resolve`: prints every resolved value of a scenario, and its origin.

use ron_tree::{Node, Value};
use scenario::{parse_tree, read_text};

use crate::arguments::SetArguments;
use crate::library;
use crate::prelude::*;

/// Print every value that a scenario ends up with, and where it comes from
#[derive(Debug, Args)]
#[command(after_help = "\
A line for each value: its path, the value, and its origin: file and line, --set, or default. The path is \
that of --set and of axes.

Examples:
  usar scenario resolve scenarios/three-tasks.ron
  usar scenario resolve scenarios/paper.ron --set mission.rest_s=10 | grep rest_s")]
pub(crate) struct Arguments {
    /// Scenario file (RON)
    #[arg(value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    set: SetArguments,
}

/// A text that contains values.
struct Source {
    path: PathBuf,
    tree: Node,
}

impl Source {
    fn read(path: &Path) -> Result<Self, Failure> {
        let text = read_text(path).map_err(Failure::input)?;
        Ok(Self { path: path.to_owned(), tree: parse_tree(&text, path).map_err(Failure::input)? })
    }

    /// The path of the base that the text names.
    fn base(&self) -> Option<PathBuf> {
        let name = self.tree.get("base")?.as_text()?;
        Some(self.path.parent().unwrap_or(Path::new("")).join(name))
    }

    /// Whether a list in this text replaces the base's list that contains this path.
    fn has_list_around(&self, path: &str) -> bool {
        let first = path.split(['.', '[']).next().unwrap_or_default();
        self.tree.get(first).is_some_and(|node| matches!(node.value, Value::List(_)))
    }

    /// The place of a value in this text, if it is written here, with the name that stands for it there.
    fn origin(&self, path: &str, named: &str) -> Option<String> {
        let place = format!("{}:{}", self.path.display(), self.line(path, named)?);
        let value = [path, named].into_iter().find_map(|path| self.tree.get(path));
        let word = value.and_then(Node::as_word).unwrap_or_default();
        let name = format!("values.{word}");
        Some(match self.tree.get(&name).and_then(|_| self.tree.line(&name)) {
            Some(line) => format!("{place}, {word} of line {line}"),
            None => place,
        })
    }

    /// The line of a value, if it is written here; `named` is its path with names instead of indices.
    fn line(&self, path: &str, named: &str) -> Option<usize> {
        let written = [path, named].into_iter().find(|path| self.tree.get(path).is_some());
        if let Some(path) = written {
            return self.tree.line(path);
        }
        // `((0, 0), (10, 0))` is a wall without field names.
        let entry = &path[..=path.find(']')?];
        let is_short = matches!(self.tree.get(entry)?.value, Value::Tuple(..));
        (is_short && !path.ends_with("thickness_m")).then(|| self.tree.line(entry)).flatten()
    }
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let scenario = self.set.load(&self.file)?;
        let tree = scenario.tree();
        let own = Source::read(&self.file)?;
        let base = own.base().map(|path| Source::read(&path)).transpose()?;
        let set: Vec<String> = self.set.set.iter().filter_map(|set| canonical(&tree, set)).collect();
        let leaves = tree.leaves();
        let width = leaves.iter().map(|(path, _)| path.len()).max().unwrap_or_default();
        let (mut drawn, mut out) = (None, Report::default());
        for (path, value) in &leaves {
            // A distribution is one value, even if it contains several numbers.
            let around =
                scenario.draws.keys().find(|key| path.strip_prefix(key.as_str()).is_some_and(ends_a_segment));
            if around.is_some() && around == drawn {
                continue;
            }
            drawn = around;
            let whole = around.and_then(|key| Some((key, tree.get(key)?)));
            let (path, value) = whole.unwrap_or((path, value));
            let named = named(&tree, path);
            let from = |source: &Source| source.origin(path, &named);
            let is_set = set.iter().any(|set| path.strip_prefix(set.as_str()).is_some_and(ends_a_segment));
            let origin = if is_set {
                Some("--set".to_owned())
            } else {
                let of_base = base.as_ref().filter(|_| !own.has_list_around(path));
                from(&own).or_else(|| from(of_base?))
            };
            let origin = origin.unwrap_or_else(|| "default".to_owned());
            out.say(format!("{path:width$} = {value}  # {origin}"));
        }
        Ok(out)
    }
}

fn ends_a_segment(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['.', '['])
}

/// The path of a setting, with indices instead of names.
fn canonical(tree: &Node, setting: &str) -> Option<String> {
    Some(tree.canonical(setting.split('=').next()?.trim()))
}

/// A path with the name of the table's entry instead of its index: `roles.carrier.hp` for `roles[0].hp`.
fn named(tree: &Node, path: &str) -> String {
    let name = || {
        let end = path.find(']')? + 1;
        let name = tree.get(&format!("{}.name", &path[..end]))?.as_text()?;
        let table = &path[..path.find('[')?];
        Some(format!("{table}.{name}{}", &path[end..]))
    };
    name().unwrap_or_else(|| path.to_owned())
}
