//! Programs at work: they answer as the built-in policies do, say what is wrong with them, and leave no
//! process behind. These tests need `python3`; those in another language are left out where it is missing.

mod support;
mod turns;

mod error_messages;
mod other_languages;
mod processes;
mod spellings;
