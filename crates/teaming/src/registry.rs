//! The registry: policies, trust measures, estimators and protocols by name, each with its options. It is a
//! value: whoever has one adds kinds to it, and kinds look into the registry that makes them.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use ron_tree::{Node, Problem};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::estimate::Estimator;
use crate::made::{Made, MadeEstimator, MadeMeasure, MadePolicy};
use crate::measure::TrustMeasure;
use crate::policy::Policy;
use crate::registry_error::{Entry, RegistryError};
use crate::session::{Absent, Driver, Pure};

/// Policies, trust measures, estimators and protocols by name.
#[derive(Debug, Clone, Default)]
pub struct Registry {
    policies: Vec<PolicyKind>,
    measures: Vec<MeasureKind>,
    estimators: Vec<EstimatorKind>,
    protocols: Vec<ProtocolKind>,
    /// See [`Registry::choose_measure`].
    chosen: Option<MadeMeasure>,
}

impl Registry {
    /// Adds a policy.
    ///
    /// # Errors
    /// The name is taken.
    pub fn add(&mut self, kind: PolicyKind) -> Result<(), RegistryError> {
        add(&mut self.policies, kind, Entry::Policy)
    }

    /// Adds a trust measure.
    ///
    /// # Errors
    /// The name is taken.
    pub fn add_measure(&mut self, kind: MeasureKind) -> Result<(), RegistryError> {
        add(&mut self.measures, kind, Entry::TrustMeasure)
    }

    /// Adds an estimator.
    ///
    /// # Errors
    /// The name is taken.
    pub fn add_estimator(&mut self, kind: EstimatorKind) -> Result<(), RegistryError> {
        add(&mut self.estimators, kind, Entry::Estimator)
    }

    /// Adds a protocol.
    ///
    /// # Errors
    /// The name is taken.
    pub fn add_protocol(&mut self, kind: ProtocolKind) -> Result<(), RegistryError> {
        add(&mut self.protocols, kind, Entry::Protocol)
    }

    /// All kinds of policies, in the order in which they were added.
    #[must_use]
    pub fn kinds(&self) -> &[PolicyKind] {
        &self.policies
    }

    /// All kinds of trust measures, in the order in which they were added.
    #[must_use]
    pub fn measures(&self) -> &[MeasureKind] {
        &self.measures
    }

    /// All kinds of estimators, in the order in which they were added.
    #[must_use]
    pub fn estimators(&self) -> &[EstimatorKind] {
        &self.estimators
    }

    /// All kinds of protocols, in the order in which they were added.
    #[must_use]
    pub fn protocols(&self) -> &[ProtocolKind] {
        &self.protocols
    }

    /// The names of all policies.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.policies.iter().map(|kind| kind.name.as_str()).collect()
    }

    /// Makes a policy from its name and its options in RON, such as `(score: Sum)`; empty for the defaults.
    ///
    /// # Errors
    /// An unknown name, with the known names; or options that the policy does not have or cannot use, with
    /// the options that it has.
    pub fn make(&self, name: &str, options: &str) -> Result<MadePolicy, RegistryError> {
        self.made(&self.policies, Entry::Policy, [name, options])
    }

    /// Makes an estimator from one text: `Kalman`, `Beta(forget: 0.8)`.
    ///
    /// # Errors
    /// Those of [`Registry::make`].
    pub fn estimator(&self, text: &str) -> Result<MadeEstimator, RegistryError> {
        self.made(&self.estimators, Entry::Estimator, parts(text))
    }

    /// Makes a protocol from one text: `Gossip(exchanges: 3)`.
    ///
    /// # Errors
    /// Those of [`Registry::make`].
    pub fn protocol(&self, text: &str) -> Result<MadePolicy, RegistryError> {
        self.made(&self.protocols, Entry::Protocol, parts(text))
    }

    /// Makes a trust measure from one text: `RNE`, `RNE(sort: true)`.
    ///
    /// # Errors
    /// Those of [`Registry::make`].
    pub fn measure(&self, text: &str) -> Result<MadeMeasure, RegistryError> {
        self.made(&self.measures, Entry::TrustMeasure, parts(text))
    }

    /// Chooses the trust measure by which decisions are looked at, whatever policy made them.
    ///
    /// # Errors
    /// Those of [`Registry::make`].
    pub fn choose_measure(&mut self, text: &str) -> Result<(), RegistryError> {
        self.chosen = Some(self.measure(text)?);
        Ok(())
    }

    /// The [chosen](Registry::choose_measure) trust measure.
    #[must_use]
    pub fn chosen_measure(&self) -> Option<&MadeMeasure> {
        self.chosen.as_ref()
    }

    /// The chosen trust measure, or else the first with its defaults; `None` if there is none.
    #[must_use]
    pub fn a_measure(&self) -> Option<MadeMeasure> {
        let first = || self.measures.first().and_then(|kind| self.measure(&kind.name).ok());
        self.chosen.clone().or_else(first)
    }

    fn made<T: ?Sized>(
        &self,
        kinds: &[Kind<T>],
        entry: Entry,
        [name, options]: [&str; 2],
    ) -> Result<Made<T>, RegistryError> {
        let kind = kinds.iter().find(|kind| kind.name == name).ok_or_else(|| {
            let known = kinds.iter().map(|kind| kind.name.clone()).collect();
            RegistryError::Unknown { entry, found: name.to_owned(), known }
        })?;
        // What is chosen for a look at decisions decides none.
        let unchosen = Self { chosen: None, ..self.clone() };
        let (it, all) = (kind.make)(options, &unchosen).map_err(|reason| RegistryError::Options {
            entry,
            name: name.to_owned(),
            reason,
            options: kind.defaults.clone(),
        })?;
        let is_default = all == kind.defaults;
        let label = if is_default { name.to_owned() } else { format!("{name}{}", options.trim()) };
        Ok(Made { name: name.to_owned(), label, options: all, it, sources: kind.sources.clone() })
    }
}

/// A kind of policy: its name, what it does, and its options.
pub type PolicyKind = Kind<dyn Driver>;

/// A kind of trust measure: its name, what it measures, and its options.
pub type MeasureKind = Kind<dyn TrustMeasure>;

/// A kind of estimator: its name, what it does, and its options.
pub type EstimatorKind = Kind<dyn Estimator>;

/// A kind of protocol: its name, how robots talk by it, and its options.
pub type ProtocolKind = Kind<dyn Driver>;

/// An entry of a registry: `T` is what it makes.
pub struct Kind<T: ?Sized> {
    /// Name on the command line, in sweep files and in tables.
    pub name: String,
    /// What it does, in one line.
    pub about: String,
    /// Its options with their defaults in RON; empty where there are none.
    pub defaults: String,
    /// Hash of its sources, see [`Kind::from_sources`].
    pub(crate) sources: Option<String>,
    pub(crate) make: Arc<Make<T>>,
}

/// Makes a `T` from its options in RON, in a registry. Returns it and all its options in RON, including the
/// defaults.
pub(crate) type Make<T> = dyn Fn(&str, &Registry) -> Result<(Arc<T>, String), String> + Send + Sync;

impl<T: ?Sized> fmt::Debug for Kind<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.name, self.defaults)
    }
}

impl<T: ?Sized> Clone for Kind<T> {
    fn clone(&self) -> Self {
        let Self { name, about, defaults, sources, make } = self;
        let (name, about, defaults) = (name.clone(), about.clone(), defaults.clone());
        Self { name, about, defaults, sources: sources.clone(), make: Arc::clone(make) }
    }
}

impl PolicyKind {
    /// A stand-in for a policy of another program, so that its results can be read here. Of each of its
    /// options as they are written, `spelled_out` has all options with the defaults. It never answers.
    #[must_use]
    pub fn absent(name: &str, spelled_out: BTreeMap<String, String>) -> Self {
        let driver: Arc<dyn Driver> = Arc::new(Absent(name.to_owned()));
        let make = move |options: &str, _: &Registry| {
            let all = spelled_out.get(options.trim()).map_or(options, String::as_str);
            Ok((Arc::clone(&driver), all.to_owned()))
        };
        Self::new([name, "a policy of another program"], String::new(), Arc::new(make))
    }
}

/// What an entry can be made of: a policy, a trust measure or an estimator.
pub trait Makes<T: ?Sized> {
    /// As the registry keeps it.
    fn shared(self) -> Arc<T>;
}

impl<P: Policy + 'static> Makes<dyn Driver> for P {
    fn shared(self) -> Arc<dyn Driver> {
        Arc::new(Pure(Arc::new(self)))
    }
}

impl<M: TrustMeasure + 'static> Makes<dyn TrustMeasure> for M {
    fn shared(self) -> Arc<dyn TrustMeasure> {
        Arc::new(self)
    }
}

impl<E: Estimator + 'static> Makes<dyn Estimator> for E {
    fn shared(self) -> Arc<dyn Estimator> {
        Arc::new(self)
    }
}

impl<T: ?Sized + Send + Sync + 'static> Kind<T> {
    /// An entry without options.
    pub fn plain(name: &str, about: &str, it: impl Makes<T>) -> Self {
        Self::without_options(name, about, it.shared())
    }

    /// An entry that is made from options: a struct with defaults, read from RON such as `(score: Sum)`.
    /// `make` checks the options.
    pub fn with_options<O, M, E>(
        name: &str,
        about: &str,
        make: impl Fn(O) -> Result<M, E> + Send + Sync + 'static,
    ) -> Self
    where
        O: Default + Serialize + DeserializeOwned,
        M: Makes<T>,
        E: fmt::Display,
    {
        Self::made(name, about, move |options: O, _| make(options).map(Makes::shared))
    }

    /// An entry that is made from options, and that may look for others in the registry that makes it. A
    /// driver that leans on others says so in its [fingerprint](Driver::fingerprint), with theirs.
    pub fn made<O, E>(
        name: &str,
        about: &str,
        make: impl Fn(O, &Registry) -> Result<Arc<T>, E> + Send + Sync + 'static,
    ) -> Self
    where
        O: Default + Serialize + DeserializeOwned,
        E: fmt::Display,
    {
        let make = move |options: &str, registry: &Registry| {
            let given: O = match options.trim() {
                "" => O::default(),
                text => read(text).map_err(|problem| {
                    // The options are quoted as a whole.
                    Problem { found: format!("{text:?}"), ..*problem }.to_string()
                })?,
            };
            let all = written(&given);
            let it = make(given, registry).map_err(|error| format!("{error}, found {:?}", options.trim()))?;
            Ok((it, all))
        };
        Self::new([name, about], written(&O::default()), Arc::new(make))
    }

    /// An entry without options.
    pub fn without_options(name: &str, about: &str, it: Arc<T>) -> Self {
        let make = move |options: &str, _: &Registry| match options.trim() {
            "" | "()" => Ok((Arc::clone(&it), String::new())),
            text => Err(format!("it has no options, found {text:?}")),
        };
        Self::new([name, about], String::new(), Arc::new(make))
    }

    /// The same entry with a hash of the sources that decide its answers. Without one, results know it by
    /// the file of the running program, and are run again whenever that changes.
    #[must_use]
    pub fn from_sources(self, hash: impl Into<String>) -> Self {
        Self { sources: Some(hash.into()), ..self }
    }

    pub(crate) fn new([name, about]: [&str; 2], defaults: String, make: Arc<Make<T>>) -> Self {
        Self { name: name.into(), about: about.into(), defaults, sources: None, make }
    }
}

fn add<T: ?Sized>(kinds: &mut Vec<Kind<T>>, kind: Kind<T>, entry: Entry) -> Result<(), RegistryError> {
    if kinds.iter().any(|known| known.name == kind.name) {
        return Err(RegistryError::DuplicateName { entry, name: kind.name });
    }
    kinds.push(kind);
    Ok(())
}

/// The name and the options in a text.
pub(crate) fn parts(text: &str) -> [&str; 2] {
    let (name, options) = text.trim().split_at(text.trim().find('(').unwrap_or(text.trim().len()));
    [name.trim(), options]
}

/// Reads options in RON.
pub(crate) fn read<O: DeserializeOwned>(text: &str) -> Result<O, Box<Problem>> {
    let whole = |problem: Problem| match problem.field.as_str() {
        "" => Problem { field: "the text of the options".to_owned(), ..problem },
        _ => problem,
    };
    let node = Node::parse(text).map_err(|error| Box::new(whole(Problem::new("", error.message, ""))))?;
    node.read_as().map_err(|problem| Box::new(whole(*problem)))
}

/// A value in RON.
pub(crate) fn written(options: &impl Serialize) -> String {
    Node::of(options).map(|node| node.to_string()).unwrap_or_default()
}
