//! `usar study`: studies of scenarios and of decisions.

mod deceit;
mod regret;
mod room;
mod sensitivity;

use super::verbs;

verbs!(Verb {
    Deceit: deceit::Arguments,
    Regret: regret::Arguments,
    Room: room::Arguments,
    Sensitivity: sensitivity::Arguments,
});
