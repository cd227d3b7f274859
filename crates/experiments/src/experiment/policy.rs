//! Policies as a sweep names them: `RNE`, `RNE(score: Sum)`, `label=RNE(score: Sum, sort: true)`, or
//! `label=RNE <- Kalman | Discount`.

use std::fmt;

use ron_tree::{Node, Value, is_unseen};
use scenario::{Scenario, is_mistaken};
use teaming::arrow::Written;
use teaming::{MadeMeasure, MadePolicy, Registry};

use crate::oracle;
use crate::{Failure, refuse};

/// A registry with the oracle, unless it has one of its own.
pub fn with_oracle(mut registry: Registry) -> Registry {
    // A caller's policy with the oracle's name stays.
    let _ = registry.add(oracle::kind());
    registry
}

/// A policy with its options.
#[derive(Clone)]
pub struct PolicySpec {
    /// Its name in tables and figures.
    pub label: String,
    /// Its name in the registry.
    pub name: String,
    /// The written options, with their values in RON.
    options: Vec<(String, String)>,
    /// What stands behind its arrow: an estimator, and the use of its trust.
    guide: Option<String>,
    /// What stands behind `by`: how its robots talk.
    protocol: Option<String>,
    /// Text that reads to the same policy.
    written: String,
    made: MadePolicy,
    /// The trust measure of the same name and options, by which the policy groups; none for another policy.
    measure: Option<MadeMeasure>,
}

impl fmt::Debug for PolicySpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written)
    }
}

impl PolicySpec {
    /// Reads a policy of a registry.
    ///
    /// # Errors
    /// An unknown name, options that the policy does not have, or unclosed brackets; in one sentence.
    pub fn parse(text: &str, registry: &Registry) -> Result<Self, Failure> {
        let text = text.trim();
        let (label, rest) = label_and_rest(text);
        if let (Some(second), _) = label_and_rest(rest) {
            refuse!("a policy has one label before `=`, found two in {text:?}: the second is {second:?}");
        }
        let (name, options) = name_and_options(rest);
        if !registry.names().contains(&name) {
            registry.parse(rest).map_err(Failure::input)?;
        }
        let options = parse_options(options)?;
        let spaced = |part: &str| part.split_whitespace().collect::<Vec<_>>().join(" ");
        let Written { guide, protocol, .. } = Written::of(rest);
        let (guide, protocol) = (guide.map(spaced), protocol.map(str::to_owned));
        let plain = before(&behind(&plain(name, &options), guide.as_deref()), protocol.as_deref());
        let made = registry.parse(&plain).map_err(Failure::input)?;
        if let Some(rule) = label.and_then(|label| broken_rule(label, name, registry)) {
            refuse!("the label before `=` must {rule}, found {text:?}");
        }
        let written = label.map_or(plain.clone(), |label| format!("{label}={plain}"));
        let label = label.map_or(plain, str::to_owned);
        let made = made.labelled(&label);
        let measure = registry.measure(&self::plain(name, &options)).ok();
        Ok(Self { label, name: name.to_owned(), options, guide, protocol, written, made, measure })
    }

    /// The policy.
    pub fn made(&self) -> &MadePolicy {
        &self.made
    }

    /// Whether it answers from the question; a policy that plays in the trial that asks does not.
    pub fn is_of_question(&self) -> bool {
        !self.made.it.needs_trial()
    }

    /// The trust measure that explains this policy's decisions: the one that the registry has chosen, or
    /// else the one with the policy's name and options, by which it groups. `None` if there is neither.
    pub fn own_measure<'m>(&'m self, registry: &'m Registry) -> Option<&'m MadeMeasure> {
        registry.chosen_measure().or(self.measure.as_ref())
    }

    /// The trust measure for a look at this policy's decisions: [its own](Self::own_measure), or else the
    /// first of the registry. `None` if the registry has none.
    pub fn measure(&self, registry: &Registry) -> Option<MadeMeasure> {
        self.own_measure(registry).cloned().or_else(|| registry.a_measure())
    }

    /// Refuses a policy that may not run in a scenario.
    ///
    /// # Errors
    /// The scenario allows only another policy, or the policy leaves robots idle and the scenario does not
    /// allow that.
    pub fn check_allowed(&self, scenario: &Scenario) -> Result<(), Failure> {
        if self.made.it.leaves_idle() && !scenario.mission.may_idle {
            return Err(Failure::input(format!(
                "{}: mission.may_idle must be true for {}, which leaves robots idle, found false",
                scenario.name, self.label
            )));
        }
        if scenario.allows(&self.plain()) {
            return Ok(());
        }
        let only = &scenario.only_policy;
        Err(Failure::input(format!(
            "{}: only_policy allows {only} alone, found {}; a candidate of a calibration runs no other \
             policy before it is chosen",
            scenario.name, self.label
        )))
    }

    /// The policy without the label; the text reads to the same policy.
    pub fn plain(&self) -> String {
        let rule = behind(&plain(&self.name, &self.options), self.guide.as_deref());
        before(&rule, self.protocol.as_deref())
    }

    /// What stands behind `by`: how its robots talk.
    pub fn protocol(&self) -> Option<&str> {
        self.protocol.as_deref()
    }

    /// The written options, with their values in RON.
    pub fn options(&self) -> &[(String, String)] {
        &self.options
    }

    /// The policy as text; it reads to the same policy.
    pub fn written(&self) -> &str {
        &self.written
    }
}

/// The label of a written policy, if it has one, and the rest.
fn label_and_rest(written: &str) -> (Option<&str>, &str) {
    let open = written.find(['(', '<']).unwrap_or(written.len());
    match written[..open].find('=') {
        Some(at) => (Some(written[..at].trim()), written[at + 1..].trim()),
        None => (None, written),
    }
}

/// The name of a written policy, with or without a label, and its options as they are written, without what
/// stands behind its arrow.
pub(crate) fn name_and_options(written: &str) -> (&str, &str) {
    let (_, rest) = label_and_rest(written.trim());
    let rest = Written::of(rest).rule;
    let (name, options) = rest.split_at(rest.find('(').unwrap_or(rest.len()));
    (name.trim(), options)
}

/// What stands behind `by` in a written policy, with or without a label.
pub(crate) fn protocol_of(written: &str) -> Option<&str> {
    Written::of(label_and_rest(written.trim()).1).protocol
}

/// The rule that a label breaks, if any.
fn broken_rule(label: &str, name: &str, registry: &Registry) -> Option<&'static str> {
    if label.is_empty() || label.contains(|c: char| c.is_control() || is_unseen(c)) {
        return Some("be visible characters");
    }
    if label.starts_with(['=', '+', '-', '@']) {
        return Some("not begin like a formula, with =, +, - or @");
    }
    if is_mistaken(label) {
        return Some("not be what readers of tables take for a number, or for nothing");
    }
    let is_other = label != name && registry.names().contains(&label);
    is_other.then_some("not be the name of another policy")
}

fn plain(name: &str, options: &[(String, String)]) -> String {
    let named: Vec<String> = options.iter().map(|(option, value)| format!("{option}: {value}")).collect();
    if named.is_empty() { name.to_owned() } else { format!("{name}({})", named.join(", ")) }
}

/// A policy behind an estimator.
fn behind(rule: &str, guide: Option<&str>) -> String {
    guide.map_or_else(|| rule.to_owned(), |guide| format!("{rule} <- {guide}"))
}

/// A policy before a protocol.
fn before(rule: &str, protocol: Option<&str>) -> String {
    let with = |protocol| format!("{rule} by {protocol}").trim().to_owned();
    protocol.map_or_else(|| rule.to_owned(), with)
}

fn parse_options(text: &str) -> Result<Vec<(String, String)>, Failure> {
    if text.is_empty() {
        return Ok(Vec::new());
    }
    let form = "(name: value, name: value), each once";
    let wrong = || Failure::input(format!("options must be written as {form}, found {text:?}"));
    let written = Node::parse(text).map_err(|_| wrong())?;
    match &written.value {
        Value::Struct(name, fields) if name.is_empty() => {
            let option = |(name, value): &(Node, Node)| (name.to_string(), text[value.bytes()].to_owned());
            Ok(fields.iter().map(option).collect())
        }
        Value::Tuple(name, entries) if name.is_empty() && entries.is_empty() => Ok(Vec::new()),
        _ => Err(wrong()),
    }
}

/// The entries of a comma-separated list. Commas inside brackets and quotes do not separate.
pub fn split_list(text: &str) -> Vec<&str> {
    let (mut depth, mut is_text, mut is_escaped) = (0_i32, false, false);
    let splits = |c: char| {
        let escapes = is_text && !is_escaped && c == '\\';
        is_text ^= c == '"' && !is_escaped;
        is_escaped = escapes;
        if is_text {
            return false;
        }
        depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
        c == ',' && depth == 0
    };
    text.split(splits).map(str::trim).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn policies_have_names_options_and_labels() {
        let spec = |text| PolicySpec::parse(text, &policies::standard()).unwrap();
        assert_eq!(spec("DIS").label, "DIS");
        let options = spec("RNE( score : Sum, weights: [1, 2, 3, 4, 5, 6, 7], )");
        assert_eq!(options.label, "RNE(score: Sum, weights: [1, 2, 3, 4, 5, 6, 7])");
        let labelled = spec("sum=RNE(score: Sum)");
        assert_eq!((labelled.label.as_str(), labelled.name.as_str()), ("sum", "RNE"));
        assert_eq!(split_list("DIS, a=RNE(sort: true, scale: false),ENG").len(), 3);
        assert_eq!(split_list(r#"a=X(b: ["(", "\"]", ","]),ENG"#).len(), 2);
    }

    #[test]
    fn a_policy_may_stand_behind_an_estimator() {
        let spec = |text: &str| PolicySpec::parse(text, &policies::standard()).unwrap();
        let plain = spec(" HP_DIS<-Kalman ( q: 2 ) ");
        assert_eq!((plain.label.as_str(), plain.name.as_str()), ("HP_DIS <- Kalman ( q: 2 )", "HP_DIS"));
        assert_eq!(plain.made().options, " <- Kalman(q: 2.0, r: 25.0, gate: 6.6349, restart: 2) | Ignore");
        let text = "x=RNE(hard_rule: MeanHp) <- Both(level: Kalman, trust: Brs) | Exclude(below: 0.3)";
        let labelled = spec(text);
        assert_eq!((labelled.label.as_str(), labelled.written()), ("x", text));
        assert_eq!(spec(&labelled.plain()).made().options, labelled.made().options);
        let end = "<- Both(level: Kalman(q: 4.0, r: 25.0, gate: 6.6349, restart: 2), trust: Brs(q: 0.01)) | \
                   Exclude(below: 0.3, most: 0.34)";
        assert!(labelled.made().options.ends_with(end), "{}", labelled.made().options);
        assert_eq!(labelled.options(), [("hard_rule".to_owned(), "MeanHp".to_owned())]);
        assert_eq!(split_list("DIS <- Kalman, a=RNE <- Both(level: Kalman, trust: Brs) | Discount").len(), 2);
        let fingerprint = |text: &str| spec(text).made().fingerprint().unwrap();
        assert!(fingerprint("DIS <- Kalman") != fingerprint("DIS <- Beta"));
        assert!(fingerprint("DIS <- Both(trust: Beta)") != fingerprint("DIS <- Both(trust: Brs)"));
    }

    #[test]
    fn what_stands_behind_an_arrow_is_checked() {
        let registry = with_oracle(policies::standard());
        let refused = |text| PolicySpec::parse(text, &registry).unwrap_err().to_string();
        let is = |text, end: &str| assert!(refused(text).ends_with(end), "{text}: {}", refused(text));
        is("RNE <- Kalmann", "; did you mean Kalman?");
        is(
            "RNE <- Kalman | Exlude",
            "unknown use \"Exlude\"; known uses: Ignore, Discount, Exclude; did you mean Exclude?",
        );
        is("RNE | Exclude", "`|` must stand behind an estimator: RULE <- ESTIMATOR | USE");
        is("RNE <- Kalman | Exclude(below: 2)", "Exclude: below must be from 0 to 1, found 2");
        is("RNE <- Kalman | Discount(by: 2)", "Discount has no options, found \"(by: 2)\"");
        is(
            "ORACLE <- Kalman",
            "policy ORACLE: it plays the running trial on and looks at no report; leave out what is behind \
             `<-`",
        );
        assert!(refused("RNE <- Both(lvl: Kalman)").contains("lvl is no field"));
        assert!(refused("RNE <- Both(level: Kalmann)").contains("level: unknown estimator \"Kalmann\""));
        assert!(refused("RNF <- Kalman").ends_with("did you mean RNE?"));
    }

    #[test]
    fn bad_policies_are_refused() {
        let refused = |text| PolicySpec::parse(text, &policies::standard()).unwrap_err().to_string();
        assert!(refused("NEAREST").contains("unknown policy"));
        assert!(refused("DIS(score: Sum)").contains("policy DIS: it has no options"));
        assert!(refused("RNE(luck: 3)").contains("policy RNE: "));
        assert!(refused("=RNE").contains("label"));
        assert!(refused("a=b=RNE").ends_with("found two in \"a=b=RNE\": the second is \"b\""));
        assert!(refused("NA=RNE").contains("take for a number, or for nothing"));
        assert!(refused("@x=RNE").contains("must not begin like a formula"));
        assert!(refused("-1=RNE").contains("must not begin like a formula"));
        for text in
            ["RNE(", "RNE(Sum)", "RNE(sort: true", "RNE(sort: true, sort: false)", "RNE(sort: true) x"]
        {
            assert!(refused(text).contains("options must be written as"), "{text}");
        }
    }
}
