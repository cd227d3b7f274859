use std::collections::BTreeMap;

use clap::Command;

use super::{Cli, command};

/// Calls a function for each command, with the words that a user types.
fn each(command: &Command, words: &str, visit: &mut dyn FnMut(&Command, &str)) {
    visit(command, words);
    for verb in command.get_subcommands() {
        each(verb, &format!("{words} {}", verb.get_name()), visit);
    }
}

#[test]
fn the_command_line_is_sound() {
    command().debug_assert();
}

#[test]
fn the_overview_has_every_command_and_fits_a_screen() {
    let help = command().render_help().to_string();
    let lines: Vec<&str> = help.lines().collect();
    assert!(lines.len() <= 24 && lines.iter().all(|line| line.chars().count() <= 80), "{help}");
    let words: Vec<&str> = help.split(|c: char| c.is_whitespace() || "()".contains(c)).collect();
    each(&command(), "usar", &mut |verb, words_of| {
        assert!(verb.is_hide_set() || words.contains(&verb.get_name()), "{words_of} is not in\n{help}");
    });
}

/// What an option means: its help without its default and without how often it can be given.
fn meaning(help: &str) -> String {
    let help = help.split(" [default").next().unwrap_or_default();
    help.replace("; can be given several times", "")
}

#[test]
fn an_option_means_the_same_everywhere() {
    let mut meanings: BTreeMap<String, (String, String)> = BTreeMap::new();
    each(&command(), "usar", &mut |verb, words| {
        for option in verb.get_opts() {
            let name = option.get_long().unwrap_or_else(|| panic!("{words}: an option without a name"));
            let help = meaning(&option.get_help().map(ToString::to_string).unwrap_or_default());
            let (first, known) = meanings.entry(name.to_owned()).or_insert((words.to_owned(), help.clone()));
            assert_eq!(*known, help, "--{name} of {first}, and of {words}");
        }
    });
    assert!(meanings.len() > 60 && meanings.contains_key("policy"), "{meanings:?}");
}

#[test]
fn every_command_has_examples_of_itself() {
    each(&<Cli as clap::CommandFactory>::command(), "usar", &mut |verb, words| {
        if verb.has_subcommands() {
            return;
        }
        let help = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
        let examples = help.split("Example").nth(1).unwrap_or_else(|| panic!("{words} has no examples"));
        assert!(examples.contains(words), "{words}: {examples}");
    });
}
