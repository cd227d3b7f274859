//! Trust between robots as *Relative Needs Entropy* (RNE), and the question how a mixed team is to be grouped
//! over any number of tasks, with its answer.
//!
//! The mathematics of Yang & Parasuraman, *How Can Robots Trust Each Other For Better Cooperation?* (IEEE SMC
//! 2021, arXiv 2105.07443), with every ambiguity of the text as a named option. This crate has no world,
//! reads no files and no clock.
//!
//! ```
//! use rne_core::{NeedDistribution, NeedVector, NeedWeights, relative_entropy};
//!
//! let weights = NeedWeights::new(vec![6.0, 4.0, 2.0])?;
//! let r1 = NeedDistribution::of_agent(&NeedVector::new(vec![86.0, 120.0, 30.0])?, &weights)?;
//! let r2 = NeedDistribution::of_agent(&NeedVector::new(vec![20.0, 30.0, 10.0])?, &weights)?;
//! let rne = relative_entropy(&r1, &r2)?; // the paper's Example 1 prints 0.00373
//! assert!((rne.nats().unwrap() - 0.003_725_460_660_859_402).abs() < 1e-12);
//! assert!(rne.trust() > 0.996);
//! # Ok::<(), rne_core::NeedsError>(())
//! ```
//!
//! A [`Policy`] answers a [`Question`] with a [`Decision`]. Policies and [trust measures](TrustMeasure) have
//! names in a [`Registry`]. Whoever asks opens a [`Session`] of a [`Driver`]; a policy is the simplest one.
//! Where robots may be wrong or lie, an [`Estimator`] says what is true and whom to believe.

pub mod arrow;
pub mod assignments;
pub mod decision;
pub mod divergence;
pub mod error;
pub mod estimate;
pub mod evidence;
pub mod guided;
pub mod hierarchy;
pub mod history;
pub mod ids;
pub mod made;
pub mod measure;
pub mod needs;
pub mod nested;
pub mod policy;
pub mod question;
pub mod registry;
pub mod registry_error;
pub mod said;
pub mod schema;
pub mod session;
pub mod trust;
pub mod trust_use;

pub use decision::{Account, Alternative, Assignment, Decision};
pub use divergence::{
    jeffreys, jensen_shannon, mutual_information, relative_entropy, relative_entropy_by_need,
};
pub use error::{AssignmentError, NeedsError, PolicyError, QuestionError};
pub use estimate::{Estimate, Estimator};
pub use evidence::{
    Body, Evidence, Expected, Extent, Level, LevelNeed, LevelReport, Rating, RobotRound, TrueLevels,
};
pub use history::{GroupOutcome, MemberOutcome, RoundOutcome};
pub use ids::{NeedId, RoleId, TaskId};
pub use made::{Made, MadeEstimator, MadeMeasure, MadePolicy};
pub use measure::{NeedPart, TeamTrust, TrustMeasure};
pub use needs::{NeedDistribution, NeedVector, NeedWeights};
pub use policy::Policy;
pub use question::{GroupSizes, Member, Need, Question, Quota, RandomSeed, SCHEMA_VERSION, Task};
pub use registry::{EstimatorKind, Kind, Makes, MeasureKind, PolicyKind, Registry};
pub use registry_error::RegistryError;
pub use said::{EnergyOutcome, SaidRounds, Used};
pub use session::{Asked, Basis, Deadline, Driver, Session, TrialStart};
pub use trust::{LogBase, RelativeNeedsEntropy};
pub use trust_use::TrustUse;

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
