//! A kind of policy: the entry of a registry, from which policies are made.

use std::fmt;
use std::panic::Location;
use std::sync::Arc;

use ron::extensions::Extensions;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::policy::Policy;

/// A kind of policy: its name, what it does, and its options.
#[derive(Clone)]
pub struct PolicyKind {
    /// Name on the command line, in sweep files and in tables.
    pub name: String,
    /// What it does, in one line.
    pub about: String,
    /// Its options with their defaults in RON; empty for a policy without options.
    pub defaults: String,
    /// The source file that made this entry, as the compiler names it. Results are kept as long as it does
    /// not change.
    pub file: &'static str,
    pub(crate) make: Arc<Make>,
}

/// Makes the policy from its options in RON. Returns the policy and all its options in RON, including the
/// defaults.
pub(crate) type Make = dyn Fn(&str) -> Result<(Arc<dyn Policy>, String), String> + Send + Sync;

impl fmt::Debug for PolicyKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.name, self.defaults)
    }
}

impl PolicyKind {
    /// A policy without options.
    #[track_caller]
    pub fn plain<P: Policy + Clone + 'static>(name: &str, about: &str, policy: P) -> Self {
        let make = move |options: &str| match options.trim() {
            "" | "()" => Ok((Arc::new(policy.clone()) as Arc<dyn Policy>, String::new())),
            _ => Err("it has no options".to_owned()),
        };
        Self::new(name, about, String::new(), Arc::new(make))
    }

    /// A policy that is made from options: a struct with defaults, read from RON such as `(score: Sum)`.
    /// `make` checks the options.
    #[track_caller]
    pub fn with_options<O, P, E>(
        name: &str,
        about: &str,
        make: impl Fn(O) -> Result<P, E> + Send + Sync + 'static,
    ) -> Self
    where
        O: Default + Serialize + DeserializeOwned,
        P: Policy + 'static,
        E: fmt::Display,
    {
        let defaults = written(&O::default());
        let make = move |options: &str| {
            let options: O = match options.trim() {
                "" => O::default(),
                text => {
                    let ron = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
                    ron.from_str(text).map_err(|error| error.code.to_string())?
                }
            };
            let all = written(&options);
            let policy = make(options).map_err(|error| error.to_string())?;
            Ok((Arc::new(policy) as Arc<dyn Policy>, all))
        };
        Self::new(name, about, defaults, Arc::new(make))
    }

    #[track_caller]
    fn new(name: &str, about: &str, defaults: String, make: Arc<Make>) -> Self {
        Self { name: name.into(), about: about.into(), defaults, file: Location::caller().file(), make }
    }
}

/// A value in RON, its fields separated by a comma and a blank.
fn written(options: &impl Serialize) -> String {
    let ron = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    let style = ron::ser::PrettyConfig::new().depth_limit(0).separator(" ");
    ron.to_string_pretty(options, style).unwrap_or_default()
}
