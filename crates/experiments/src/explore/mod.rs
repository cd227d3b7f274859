//! Parameters of a scenario, varied within ranges: which of them matter ([`Sensitivity`]), and where a policy
//! fails ([`Hunt`]).

mod descent;
mod design;
mod hunt;
mod parameter;
mod sensitivity;
mod space;

pub use descent::{Descent, WORST};
pub use design::Method;
pub use hunt::{Candidate, FOUND, Hunt, Trail};
pub use parameter::Parameter;
pub use sensitivity::{CHANCE, Evaluations, FIGURE, INDICES, Index, Row, Sensitivity};
pub use space::{Outcome, Point, PointError, Space, Values, scenario_with};
