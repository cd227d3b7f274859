//! How policies group teams: properties of every answer, and brute force for small teams.

mod account;
mod baselines;
mod large_teams;
mod many_tasks;
mod oracle;
mod pairs;
mod properties;
mod quotas;
mod rival_figures;
mod rivals;
mod support;
mod two_tasks;
