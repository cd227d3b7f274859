//! `usar cluster`: sweeps on a cluster.

mod estimate;
mod merge;
mod slurm;
mod status;
mod submit;

use super::verbs;

verbs!(Verb {
    Estimate: estimate::Arguments,
    Submit: submit::Arguments,
    Status: status::Arguments,
    Merge: merge::Arguments,
});
