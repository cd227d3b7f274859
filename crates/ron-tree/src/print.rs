//! A tree as text.

use std::fmt::{self, Display, Formatter, Write};

use crate::node::{Node, Value};

/// Brackets within brackets of which the entries stand on lines of their own.
const BROKEN_BRACKETS: usize = 2;

/// Number of blanks of one indent.
pub(crate) const INDENT: usize = 4;

/// On one line.
impl Display for Node {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write_node(f, self, None)
    }
}

impl Node {
    /// The text with the entries of the outermost two brackets on lines of their own.
    pub fn pretty(&self) -> String {
        let mut out = String::new();
        // A `String` takes all that is written.
        let _ = write_node(&mut out, self, Some(0));
        out
    }
}

/// Writes a node; `depth` is the number of brackets around it, if they may have lines of their own. Round
/// brackets without names have none, and are not counted.
fn write_node(out: &mut impl Write, node: &Node, depth: Option<usize>) -> fmt::Result {
    match &node.value {
        Value::Word(word) => out.write_str(word),
        Value::Text(text) => write!(out, "\"{}\"", text.escape_debug()),
        Value::Tuple(name, entries) => {
            write!(out, "{name}(")?;
            for (i, entry) in entries.iter().enumerate() {
                out.write_str(if i > 0 { ", " } else { "" })?;
                write_node(out, entry, depth)?;
            }
            out.write_char(')')
        }
        Value::List(entries) => {
            write_lines(out, "[]", entries.len(), depth, |out, i, depth| write_node(out, &entries[i], depth))
        }
        Value::Struct(name, fields) => {
            out.write_str(name)?;
            write_fields(out, "()", fields, depth)
        }
        Value::Map(fields) => write_fields(out, "{}", fields, depth),
    }
}

fn write_fields(
    out: &mut impl Write,
    brackets: &str,
    fields: &[(Node, Node)],
    depth: Option<usize>,
) -> fmt::Result {
    write_lines(out, brackets, fields.len(), depth, |out, i, depth| {
        let (name, value) = &fields[i];
        write!(out, "{name}: ")?;
        write_node(out, value, depth)
    })
}

/// Writes what is between brackets, each entry by `write`, on lines of their own or on one.
fn write_lines<W: Write>(
    out: &mut W,
    brackets: &str,
    count: usize,
    depth: Option<usize>,
    write: impl Fn(&mut W, usize, Option<usize>) -> fmt::Result,
) -> fmt::Result {
    let (open, close) = brackets.split_at(1);
    let broken = depth.filter(|depth| *depth < BROKEN_BRACKETS && count > 0);
    out.write_str(open)?;
    for i in 0..count {
        match broken {
            Some(depth) => write!(out, "\n{:blanks$}", "", blanks = INDENT * (depth + 1))?,
            None if i > 0 => out.write_char(' ')?,
            None => {}
        }
        write(out, i, depth.map(|depth| depth + 1))?;
        out.write_str(if broken.is_some() || i + 1 < count { "," } else { "" })?;
    }
    if let Some(depth) = broken {
        write!(out, "\n{:blanks$}", "", blanks = INDENT * depth)?;
    }
    out.write_str(close)
}
