//! Broken programs, each with its exact message: `broken.txt`.
//!
//! A block is a title, the lines of a program in Python (`|`) or another policy (`$`), and the message (`=`).
//! `USAR_BLESS=1 cargo test --package programs broken` writes the messages anew: read the difference.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use teaming::MadePolicy;

use crate::support::{ask, python, registry_until, small};

#[derive(Default)]
struct Block {
    title: String,
    policy: Option<String>,
    program: String,
    message: String,
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken.txt")
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for line in text.lines() {
        let rest = line.get(2..).unwrap_or_default();
        match (line.get(..1), blocks.last_mut()) {
            (Some("#"), _) => blocks.push(Block { title: rest.to_owned(), ..Block::default() }),
            (Some("|"), Some(block)) => block.program.extend([rest, "\n"]),
            (Some("$"), Some(block)) => block.policy = Some(rest.to_owned()),
            (Some("="), Some(block)) => block.message.extend([rest, "\n"]),
            _ => {}
        }
    }
    blocks
}

fn written(blocks: &[Block]) -> String {
    let mut text = String::new();
    for Block { title, policy, program, message } in blocks {
        let _ = writeln!(text, "# {title}");
        policy.iter().for_each(|policy| text.extend(["$ ", policy, "\n"]));
        program.lines().for_each(|line| text.extend(["| ", line, "\n"]));
        message.lines().for_each(|line| text.extend(["= ", line, "\n"]));
        text.push('\n');
    }
    text
}

/// What is said of a block's program.
fn said(block: &Block) -> String {
    let folder = tempfile::tempdir().unwrap();
    let answer = |policy: MadePolicy| {
        let mut session = policy.open()?;
        ask(&mut *session, 3, &small())
    };
    let answer = match &block.policy {
        None => answer(python(folder.path(), &block.program, ", timeout_s: 1, start_s: 2")),
        Some(policy) => match registry_until(&Arc::default()).parse(policy) {
            Ok(policy) => answer(policy),
            Err(error) => return error.to_string(),
        },
    };
    answer.map_or_else(|error| error.to_string(), |_| "NOTHING".to_owned())
}

#[test]
fn every_broken_program_gives_its_exact_message() {
    let text = std::fs::read_to_string(path()).unwrap();
    let mut blocks = blocks(&text);
    assert!(blocks.len() >= 30, "{}", blocks.len());
    for block in &mut blocks {
        block.message = said(block);
        assert!(block.message != "NOTHING", "{}: nothing is wrong with it", block.title);
    }
    let now = written(&blocks);
    if std::env::var_os("USAR_BLESS").is_some() {
        return std::fs::write(path(), now).unwrap();
    }
    let differs = text.lines().zip(now.lines()).find(|(there, now)| there != now);
    assert!(text == now, "broken.txt differs: {differs:#?}\n{now}");
}
