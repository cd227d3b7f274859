//! `usar study`: studies of scenarios and of decisions, and those of single papers.

mod deceit;
mod regret;
mod room;
mod sensitivity;
mod yang2021;

use super::verbs;

verbs!(Verb {
    Deceit: deceit::Arguments,
    Regret: regret::Arguments,
    Room: room::Arguments,
    Sensitivity: sensitivity::Arguments,
    /// The paper that started this laboratory: its claims, readings and calibration
    #[command(subcommand, disable_help_subcommand = true)]
    Yang2021: yang2021::Verb,
});
