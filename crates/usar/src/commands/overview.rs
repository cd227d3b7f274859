//! What `usar --help` prints: every command, in groups, on one screen.

use std::fmt::Write;

use clap::Command;

/// The groups, each with the first command of it.
const GROUPS: [(&str, &str); 5] =
    [("start", "new"), ("compare", "sweep"), ("ask", "why"), ("maths", "trust"), ("more", "scenario")];

/// The text.
pub(super) fn text(command: &Command) -> String {
    let about = command.get_about().map_or(String::new(), ToString::to_string);
    let mut text =
        format!("{about}\nUsage: usar COMMAND ...    (-h: how to use COMMAND, --help: all of it)\n\n");
    for command in command.get_subcommands() {
        let name = command.get_name();
        let group = GROUPS.iter().find(|(_, first)| *first == name).map_or("", |(group, _)| group);
        let _ = writeln!(text, "{group:<7} {name:<8} {}", wrapped(&describe(command)));
    }
    text
}

/// Length of a line on the narrowest screen.
const WIDTH: usize = 80;

/// Where the descriptions begin in a line.
const START: usize = 17;

/// A description, on as many lines as it takes.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if START + lines[last].len() + word.len() >= WIDTH {
            lines.push(" ".repeat(START) + word);
        } else {
            let gap = if lines[last].is_empty() { "" } else { " " };
            lines[last].extend([gap, word]);
        }
    }
    lines.join("\n")
}

/// What a command does; of a noun, its verbs.
fn describe(command: &Command) -> String {
    if !command.has_subcommands() || command.get_positionals().next().is_some() {
        return command.get_about().map_or(String::new(), ToString::to_string);
    }
    let verb = |command: &Command| {
        let name = command.get_name();
        if command.has_subcommands() { format!("{name} ({})", describe(command)) } else { name.to_owned() }
    };
    command.get_subcommands().map(verb).collect::<Vec<_>>().join(" ")
}
