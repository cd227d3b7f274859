//! Broken files, each with its exact message: `broken.txt`.
//!
//! A block is a title, the kind of file (`scenario`: paper.ron; `sweep`: a sweep file over it), what takes
//! the place of what in it (`<` and `>`, with `\n` for the end of a line), and the message (`=`).
//! `USAR_BLESS=1 cargo test --package tests broken` writes the messages anew:
//! read the difference.

use std::fmt::Write;
use std::path::Path;

use experiments::experiment::{Experiment, Overrides, with_oracle};
use scenario::Scenario;

use crate::support::{paper_text, root};

const SWEEP: &str = "(\n    name: \"s\",\n    scenario: \"paper.ron\",\n    policies: \
    [\"RNE\", \"DIS\"],\n    trials: 3,\n    axes: {\"mission.rest_s\": [20.0, 30.0]},\n)\n";

struct Block {
    title: String,
    kind: String,
    edits: Vec<(String, String)>,
    message: String,
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for line in text.lines() {
        let rest = line.get(2..).unwrap_or_default();
        let plain = rest.replace("\\n", "\n");
        match (line.get(..2), blocks.last_mut()) {
            (Some("# "), _) => blocks.push(Block {
                title: rest.to_owned(),
                kind: String::new(),
                edits: Vec::new(),
                message: String::new(),
            }),
            (Some("< "), Some(block)) => block.edits.push((plain, String::new())),
            (Some("> "), Some(block)) => block.edits.last_mut().unwrap().1 = plain,
            (Some("= "), Some(block)) => block.message.extend([rest, "\n"]),
            (Some(_), Some(block)) => line.clone_into(&mut block.kind),
            _ => {}
        }
    }
    blocks
}

fn written(blocks: &[Block]) -> String {
    let mut text = String::new();
    for Block { title, kind, edits, message } in blocks {
        let _ = writeln!(text, "# {title}\n{kind}");
        for (from, to) in edits {
            let _ = writeln!(text, "< {}\n> {}", from.replace('\n', "\\n"), to.replace('\n', "\\n"));
        }
        message.lines().for_each(|line| text.extend(["= ", line, "\n"]));
        text.push('\n');
    }
    text
}

/// What is said of a block's file.
fn said(block: &Block) -> String {
    let mut text = if block.kind == "sweep" { SWEEP.to_owned() } else { paper_text() };
    for (from, to) in &block.edits {
        assert!(text.contains(from.as_str()), "{}: {from:?} is not in the file", block.title);
        text = text.replacen(from.as_str(), to, 1);
    }
    let folder = root().join("scenarios");
    let error = match block.kind.as_str() {
        "sweep" => Experiment::parse(
            text,
            &folder.join("s.ron"),
            &Overrides::default(),
            &with_oracle(policies::standard()),
        )
        .err()
        .map(|error| error.to_string()),
        _ => Scenario::parse(&text, Path::new("s.ron")).err().map(|error| error.to_string()),
    };
    let error = error.unwrap_or_else(|| "NOTHING".to_owned());
    let lines = error.lines().map(|line| line.trim_end().replace(&format!("{}/", folder.display()), ""));
    lines.map(|line| line + "\n").collect()
}

#[test]
fn every_broken_file_gives_its_exact_message() {
    let path = root().join("tests/broken.txt");
    let mut blocks = blocks(&std::fs::read_to_string(&path).unwrap());
    assert!(blocks.len() >= 120, "{} broken files", blocks.len());
    if std::env::var_os("USAR_BLESS").is_some() {
        blocks.iter_mut().for_each(|block| block.message = said(block));
        std::fs::write(&path, written(&blocks)).unwrap();
        return;
    }
    for block in &blocks {
        assert_eq!(said(block), block.message, "{}", block.title);
    }
}

/// Every word that is one edit away: a letter left out, added, changed, or swapped with the next.
fn typos(word: &str) -> Vec<String> {
    let letters: Vec<char> = word.chars().collect();
    let mut typos = Vec::new();
    for i in 0..=letters.len() {
        let (start, rest): (String, &[char]) = (letters[..i].iter().collect(), &letters[i..]);
        let text = |rest: &[char]| rest.iter().collect::<String>();
        for new in ['a', 'e', 's', 'm', '_', '2'] {
            typos.push(format!("{start}{new}{}", text(rest)));
            if !rest.is_empty() {
                typos.push(format!("{start}{new}{}", text(&rest[1..])));
            }
        }
        if let [first, after @ ..] = rest {
            typos.push(format!("{start}{}", text(after)));
            if let [second, after @ ..] = after {
                typos.push(format!("{start}{second}{first}{}", text(after)));
            }
        }
    }
    typos.retain(|typo| typo != word);
    typos
}

/// Names of each section of a scenario in full, of policies and of variants.
fn vocabularies() -> Vec<Vec<String>> {
    let tree = crate::support::paper().tree();
    let sections = [
        "",
        "mission",
        "planning",
        "costs",
        "costs.energy",
        "sampled",
        "roles.carrier",
        "team[0]",
        "tasks.hard",
        "debris[4]",
    ];
    let owned = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect::<Vec<_>>();
    let mut all: Vec<Vec<String>> =
        sections.iter().map(|section| tree.get(section).unwrap().names()).collect();
    all.push(owned(policies::standard().names()));
    all.push(owned(vec!["Reciprocal", "Rotation", "Swap", "None"]));
    all.push(owned(vec!["AtOnce", "WhenHome", "BeforeRound"]));
    all.push(owned(vec!["carrier", "supplier", "observer"]));
    all
}

#[test]
fn nineteen_of_twenty_mistyped_words_are_known_again() {
    let (mut known, mut all) = (0, 0);
    for words in vocabularies() {
        for word in &words {
            for typo in typos(word).iter().filter(|typo| !words.contains(typo)) {
                all += 1;
                known += u32::from(ron_tree::nearest(typo, words.iter().map(String::as_str)) == Some(word));
            }
        }
    }
    let share = f64::from(known) / f64::from(all);
    println!("{known} of {all} typos: {:.1} %", 100.0 * share);
    assert!(share >= 0.95, "{known} of {all}");
}
