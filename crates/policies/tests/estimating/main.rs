//! Estimators on whole questions, and policies behind them.

mod arrows;
mod properties;
mod support;
