//! `usar cluster`: sweeps on a cluster.

mod merge;
mod submit;

use super::verbs;

verbs!(Verb { Submit: submit::Arguments, Merge: merge::Arguments });
