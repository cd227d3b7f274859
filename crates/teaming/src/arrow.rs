//! Policies as one text: `RULE`, `RULE <- ESTIMATOR` or `RULE <- ESTIMATOR | USE`, and behind each of them,
//! if robots that decide are to talk first, `by PROTOCOL`.

use std::sync::Arc;

use crate::by::By;
use crate::guided::Guided;
use crate::made::{Made, MadePolicy};
use crate::registry::{Registry, parts};
use crate::registry_error::RegistryError;
use crate::session::Session;
use crate::trust_use::TrustUse;

/// What stands before a protocol.
const BY: &str = " by ";

/// The parts of a policy as they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Written<'t> {
    /// The policy that is asked, with its options.
    pub rule: &'t str,
    /// What stands behind the arrow: an estimator with its options, and the use of its trust after a bar.
    pub guide: Option<&'t str>,
    /// What stands behind `by`: a protocol with its options.
    pub protocol: Option<&'t str>,
}

impl<'t> Written<'t> {
    /// Takes a text apart. What is in brackets and in quotes does not count.
    #[must_use]
    pub fn of(text: &'t str) -> Self {
        let text = text.trim();
        let (text, protocol) = match outside(text, BY) {
            Some(at) => (&text[..at], Some(text[at + BY.len()..].trim())),
            None if text.starts_with("by ") => ("", Some(text[3..].trim())),
            None => text.strip_suffix(" by").map_or((text, None), |rule| (rule, Some(""))),
        };
        let (rule, guide) = match outside(text, "<-") {
            Some(at) => (&text[..at], Some(text[at + 2..].trim())),
            None => (text, None),
        };
        Self { rule: rule.trim(), guide, protocol }
    }
}

impl Registry {
    /// Makes a policy from one text: `DIS`, `RNE(score: Sum)`, `HP_DIS <- Kalman`, `RNE <- Both(level:
    /// Kalman, trust: Brs) | Exclude(below: 0.3)`. A policy behind an estimator is asked what the estimator
    /// thinks of the team. Without an arrow it is asked the question as it is, which is what `<- LastReport`
    /// means as well. `Ignore` is the default of the use. Behind `by` stands how robots talk before they
    /// decide: `HP_DIS by Gossip(exchanges: 2)`; a protocol that needs no rule may stand alone.
    ///
    /// # Errors
    /// Those of [`Registry::make`], [`Registry::estimator`] and [`Registry::protocol`]; a use that there is
    /// not; or an arrow or a protocol of a driver that plays the running trial on.
    pub fn parse(&self, text: &str) -> Result<MadePolicy, RegistryError> {
        let written = Written::of(text);
        match written.protocol {
            Some(protocol) => self.parse_by(protocol, written, text),
            None => self.parse_rule(written, text),
        }
    }

    fn parse_by(&self, protocol: &str, rule: Written<'_>, text: &str) -> Result<MadePolicy, RegistryError> {
        let protocol = self.protocol(protocol)?;
        let is_alone = rule.rule.is_empty() && rule.guide.is_none();
        let rule =
            (!is_alone).then(|| self.parse_rule(Written { protocol: None, ..rule }, text)).transpose()?;
        if let Some(rule) = rule.as_ref().filter(|rule| rule.it.needs_trial()) {
            let reason = format!("policy {}: it plays the running trial on, which no robot can", rule.name);
            return Err(RegistryError::Arrow { text: text.trim().to_owned(), reason });
        }
        let with = |part: &dyn Fn(&MadePolicy) -> String, of_protocol: String| {
            let rule = rule.as_ref().map(part).unwrap_or_default();
            format!("{rule} by {of_protocol}").trim().to_owned()
        };
        let label = with(&|rule| rule.label.clone(), protocol.label.clone());
        let options = with(&|rule| rule.options.clone(), format!("{}{}", protocol.name, protocol.options));
        let name = rule.as_ref().unwrap_or(&protocol).name.clone();
        Ok(Made { name, label, options, it: Arc::new(By { rule, protocol }), sources: None })
    }

    fn parse_rule(&self, written: Written<'_>, text: &str) -> Result<MadePolicy, RegistryError> {
        let refused = |reason: String| RegistryError::Arrow { text: text.trim().to_owned(), reason };
        let [name, options] = parts(written.rule);
        let Some(guide) = written.guide else {
            if outside(written.rule, "|").is_some() {
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
        let by = Written::of("RNE <- Kalman | Discount by Gossip(exchanges: 2)");
        assert_eq!(
            (by.rule, by.guide, by.protocol),
            ("RNE", Some("Kalman | Discount"), Some("Gossip(exchanges: 2)"))
        );
        let alone = Written::of("by Sorted");
        assert_eq!((alone.rule, alone.protocol), ("", Some("Sorted")));
        assert_eq!(outside("Kalman(q: 1) | Exclude(below: 0.3)", "|"), Some(13));
    }
}
