//! The question how a mixed team is to be grouped over any number of tasks, its answer, and who may be asked.
//!
//! A [`Policy`] answers a [`Question`] with a [`Decision`]. Policies and [trust measures](TrustMeasure) have
//! names in a [`Registry`]. Whoever asks opens a [`Session`] of a [`Driver`]; a policy is the simplest one.
//! Where robots may be wrong or lie, an [`Estimator`] says what is true and whom to believe. This crate has
//! no world, reads no files and no clock; the maths of trust is the crate `rne-core`.

pub mod arrow;
pub mod assignments;
pub mod by;
pub mod decision;
pub mod error;
pub mod estimate;
pub mod evidence;
pub mod guided;
pub mod history;
pub mod ids;
pub mod levels;
pub mod made;
pub mod measure;
pub mod nested;
mod options;
pub mod policy;
pub mod protocol;
pub mod question;
pub mod registry;
pub mod registry_error;
pub mod said;
pub mod schema;
pub mod session;
pub mod talk;
pub mod trust_use;
pub mod truth;

pub use decision::{Account, Alternative, Assignment, Decision};
pub use error::{AssignmentError, PolicyError, QuestionError};
pub use estimate::{Estimate, Estimator};
pub use evidence::{Body, Evidence, Extent, LevelNeed, LevelReport, Rating, RobotRound};
pub use history::{GroupOutcome, MemberOutcome, RoundOutcome};
pub use ids::{LevelId, NeedId, RoleId, TaskId};
pub use levels::{Expected, Level, Rest};
pub use made::{Made, MadeEstimator, MadeMeasure, MadePolicy};
pub use measure::{NeedPart, TeamTrust, TrustMeasure};
pub use policy::Policy;
pub use protocol::{Act, Choice, Protocol, Say, Stays, Told, Turn, Undecided};
pub use question::{GroupSizes, Member, Need, Question, Quota, RandomSeed, SCHEMA_VERSION, Task};
pub use registry::{EstimatorKind, Kind, Makes, MeasureKind, PolicyKind, ProtocolKind, Registry};
pub use registry_error::RegistryError;
pub use said::{EnergyOutcome, SaidRounds, Used};
pub use session::{Asked, Basis, Deadline, Driver, Session, TrialStart};
pub use talk::Talk;
pub use trust_use::TrustUse;
pub use truth::Truth;
