//! Pages of `docs/` hold the output of commands: each block after a line `<!-- $ usar ... -->` is what that command prints.

use std::path::Path;
use std::process::Command;

/// What stands before a block.
pub const MARK: &str = "<!-- $ usar ";

fn command_of(line: &str) -> Option<&str> {
    Some(line.strip_prefix(MARK)?.strip_suffix(" -->")?.trim())
}

/// The page with the block of each command that `run` answers replaced by the answer.
pub fn renewed(page: &str, mut run: impl FnMut(&str) -> Option<String>) -> String {
    let mut new = String::new();
    let mut lines = page.split_inclusive('\n');
    while let Some(line) = lines.next() {
        new.push_str(line);
        let Some(answer) = command_of(line.trim_end()).and_then(&mut run) else { continue };
        assert_eq!(lines.next(), Some("```text\n"), "a block follows {line}");
        assert!(lines.any(|line| line == "```\n"), "the block after {line} ends");
        new.extend(["```text\n", answer.trim_end(), "\n```\n"]);
    }
    new
}

/// The words of a command, of which some stand in single quotes.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('\'').enumerate();
    parts
        .flat_map(|(i, part)| if i % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect()
}

/// What `usar` prints when it is run in this folder.
pub fn answer(usar: &Path, folder: &Path, arguments: &str) -> String {
    let output = Command::new(usar).args(words(arguments)).current_dir(folder).output();
    let output = output.expect("usar runs");
    assert!(output.status.success(), "usar {arguments}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}
