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
        format!("{about}\n\nUsage: usar COMMAND ...    (-h: how to use COMMAND, --help: all of it)\n\n");
    for command in command.get_subcommands() {
        let name = command.get_name();
        let group = GROUPS.iter().find(|(_, first)| *first == name).map_or("", |(group, _)| group);
        let _ = writeln!(text, "{group:<7} {name:<8} {}", describe(command));
    }
    text
}

/// What a command does; of a noun, its verbs.
fn describe(command: &Command) -> String {
    if !command.has_subcommands() {
        return command.get_about().map_or(String::new(), ToString::to_string);
    }
    let verb = |command: &Command| {
        let name = command.get_name();
        if command.has_subcommands() { format!("{name} ({})", describe(command)) } else { name.to_owned() }
    };
    command.get_subcommands().map(verb).collect::<Vec<_>>().join(" ")
}
