//! Estimators that are made of others: each option is an estimator, with options of its own.

use std::sync::Arc;

use ron_tree::{Node, Value, nearest};

use crate::estimate::Estimator;
use crate::made::MadeEstimator;
use crate::registry::{EstimatorKind, Registry};

/// An option that is an estimator.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Name of the option.
    pub name: &'static str,
    /// The estimator that it is by default.
    pub default: &'static str,
}

impl EstimatorKind {
    /// An estimator that is made of others, such as `Both(level: Kalman, trust: Brs(q: 0.02))`. `make` gets
    /// them in the order of the parts. The estimator says what it leans on in its
    /// [fingerprint](Estimator::fingerprint).
    pub fn of_others(
        name: &str,
        about: &str,
        parts: &'static [Part],
        make: impl Fn(Vec<MadeEstimator>) -> Arc<dyn Estimator> + Send + Sync + 'static,
    ) -> Self {
        let defaults: Vec<String> =
            parts.iter().map(|part| format!("{}: {}", part.name, part.default)).collect();
        let make = move |options: &str, registry: &Registry| {
            let others = others(options.trim(), parts, registry)?;
            let named = parts.iter().zip(&others);
            let all = named.map(|(part, made)| format!("{}: {}{}", part.name, made.name, made.options));
            let all = format!("({})", all.collect::<Vec<_>>().join(", "));
            Ok((make(others), all))
        };
        Self::new([name, about], format!("({})", defaults.join(", ")), Arc::new(make))
    }
}

/// The estimators of the parts.
fn others(options: &str, parts: &[Part], registry: &Registry) -> Result<Vec<MadeEstimator>, String> {
    let written = written_parts(options, parts)?;
    let text = |part: &Part| {
        let own = written.iter().rev().find(|(name, _)| *name == part.name);
        own.map_or(part.default, |(_, text)| text.as_str()).to_owned()
    };
    let made = |part: &Part| {
        registry.estimator(&text(part)).map_err(|error| format!("{}: {error}, found {options:?}", part.name))
    };
    parts.iter().map(made).collect()
}

/// The parts that are written, each with its text.
fn written_parts(options: &str, parts: &[Part]) -> Result<Vec<(String, String)>, String> {
    let wrong =
        || format!("options must be written as (name: estimator, name: estimator), found {options:?}");
    if options.is_empty() {
        return Ok(Vec::new());
    }
    let node = Node::parse(options).map_err(|_| wrong())?;
    let fields = match &node.value {
        Value::Struct(name, fields) if name.is_empty() => fields,
        Value::Tuple(name, entries) if name.is_empty() && entries.is_empty() => return Ok(Vec::new()),
        _ => return Err(wrong()),
    };
    let part = |(name, value): &(Node, Node)| {
        let name = name.to_string();
        let known = || parts.iter().map(|part| part.name);
        if known().all(|known| known != name) {
            let meant = nearest(&name, known()).map(|meant| format!("; did you mean {meant}?"));
            return Err(format!("{name} is no field, found {options:?}{}", meant.unwrap_or_default()));
        }
        Ok((name, value.as_text().map_or_else(|| options[value.bytes()].to_owned(), str::to_owned)))
    };
    fields.iter().map(part).collect()
}
