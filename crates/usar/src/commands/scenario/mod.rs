//! `usar scenario`: scenario files.

mod draw;
mod fmt;
mod list;
mod resolve;
mod schema;

use super::verbs;

verbs!(Verb {
    List: list::Arguments,
    Draw: draw::Arguments,
    Fmt: fmt::Arguments,
    Resolve: resolve::Arguments,
    Schema: schema::Arguments,
});
