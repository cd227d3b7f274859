//! Policies as one text: `RULE`, `RULE <- ESTIMATOR` or `RULE <- ESTIMATOR | USE`.

use std::sync::Arc;

use crate::guided::Guided;
use crate::made::{Made, MadePolicy};
use crate::registry::{Registry, parts};
use crate::registry_error::RegistryError;
use crate::session::Session;
use crate::trust_use::TrustUse;

/// The parts of a policy as they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Written<'t> {
    /// The policy that is asked, with its options.
    pub rule: &'t str,
    /// What stands behind the arrow: an estimator with its options, and the use of its trust after a bar.
    pub guide: Option<&'t str>,
}

impl<'t> Written<'t> {
    /// Takes a text apart. Arrows in brackets and in quotes do not count.
    #[must_use]
    pub fn of(text: &'t str) -> Self {
        match outside(text, "<-") {
            Some(at) => Self { rule: text[..at].trim(), guide: Some(text[at + 2..].trim()) },
            None => Self { rule: text.trim(), guide: None },
        }
    }
}

impl Registry {
    /// Makes a policy from one text: `DIS`, `RNE(score: Sum)`, `HP_DIS <- Kalman`, `RNE <- Both(level:
    /// Kalman, trust: Brs) | Exclude(below: 0.3)`. A policy behind an estimator is asked what the estimator
    /// thinks of the team. Without an arrow it is asked the question as it is, which is what `<- LastReport`
    /// means as well. `Ignore` is the default of the use.
    ///
    /// # Errors
    /// Those of [`Registry::make`] and of [`Registry::estimator`]; a use that there is not; or an arrow of a
    /// driver that plays the running trial on, and looks at no level of the question.
    pub fn parse(&self, text: &str) -> Result<MadePolicy, RegistryError> {
        let written = Written::of(text);
        let refused = |reason: String| RegistryError::Arrow { text: text.trim().to_owned(), reason };
        let [name, options] = parts(written.rule);
        let Some(guide) = written.guide else {
            if outside(text, "|").is_some() {
                return Err(refused(
                    "`|` must stand behind an estimator: RULE <- ESTIMATOR | USE".to_owned(),
                ));
            }
            return self.make(name, options);
        };
        if written.rule.is_empty() || guide.is_empty() {
            let side =
                if guide.is_empty() { "an estimator must follow" } else { "a policy must stand before" };
            return Err(refused(format!("{side} `<-`: RULE <- ESTIMATOR | USE")));
        }
        let rule = self.make(name, options)?;
        if rule.it.needs_trial() {
            let reason =
                "it plays the running trial on and looks at no report; leave out what is behind `<-`";
            return Err(refused(format!("policy {name}: {reason}")));
        }
        let (estimator, trust_use) = match outside(guide, "|") {
            Some(at) => (guide[..at].trim(), TrustUse::parse(&guide[at + 1..]).map_err(refused)?),
            None => (guide, TrustUse::Ignore),
        };
        let estimator = self.estimator(estimator)?;
        let shown = match trust_use {
            TrustUse::Ignore => String::new(),
            of => format!(" | {of}"),
        };
        let label = format!("{} <- {}{shown}", rule.label, estimator.label);
        let options = format!("{} <- {}{} | {trust_use}", rule.options, estimator.name, estimator.options);
        let it = Arc::new(Guided { label: label.clone(), rule, estimator, trust_use });
        Ok(Made { name: name.to_owned(), label, options, it, sources: None })
    }

    /// Opens a session of a policy that is named in one text.
    ///
    /// # Errors
    /// Those of [`Registry::parse`], or the session cannot be opened.
    pub fn open(&self, text: &str) -> Result<Box<dyn Session>, RegistryError> {
        let made = self.parse(text)?;
        made.open().map_err(|source| RegistryError::Open { policy: made.name, source })
    }
}

/// Where a sign stands first outside of brackets and of quotes.
fn outside(text: &str, sign: &str) -> Option<usize> {
    let (mut depth, mut is_quoted, mut is_escaped) = (0_i32, false, false);
    for (at, c) in text.char_indices() {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' if is_quoted => is_escaped = true,
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ if depth == 0 && text[at..].starts_with(sign) => return Some(at),
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_in_brackets_or_quotes_is_none() {
        let parts = |text| (Written::of(text).rule, Written::of(text).guide);
        assert_eq!(
            parts(" RNE(sort: true) <- Kalman | Ignore "),
            ("RNE(sort: true)", Some("Kalman | Ignore"))
        );
        assert_eq!(parts("A<-B"), ("A", Some("B")));
        assert_eq!(parts("RNE"), ("RNE", None));
        for text in ["A(then: \"B <- C\")", "A(b: (c <- d))", "A(b: \"\\\" <- \")"] {
            assert_eq!(parts(text), (text, None));
        }
        assert_eq!(outside("Kalman(q: 1) | Exclude(below: 0.3)", "|"), Some(13));
    }
}
