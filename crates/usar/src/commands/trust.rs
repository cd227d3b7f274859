//! `usar trust`: the trust of all pairs of a team, its groups by a policy, or Relative Needs Entropy from
//! needs on the command line.

mod groups;
mod matrix;
mod pair;
mod table;
mod team;

use crate::arguments::{MeasureArgument, PictureFile, ReplaceArgument, ShownArguments, parse_policy};
use crate::prelude::*;

/// Trust in a team from a table (CSV), and its groups by a policy
#[derive(Debug, Args)]
#[command(after_help = "\
The table (CSV with a header) has a row for each robot: id (any text) and needs, which are numbers >= 0. \
Each column is a need but for these, which may be left out: role (policies split each role; the roles are \
merged in the order in which the table names them first), x and y (metres, for policies that look at \
distances), energy_level and hp_level (percent, for ENG and HP_DIS). Cells are separated by commas, or by \
`;` or tabs, with decimal commas or points. A file that ends with .json is a question (docs/decisions.md).

Without --policy, all pairs are shown: the RNE of the robot of each row towards the robot of each column, in \
nats. Lower RNE means more trust; trust is exp(-RNE). It is not symmetric. With a table, each need is \
divided by its largest value in the team first, so that no unit dominates (--measure 'RNE(scale: false)': as \
it is).

The maths takes more of a need for better. --less-is-better damage=100 says that of damage less is better \
and 100 is the worst: it counts as 100 - damage, what is left. A robot at the worst has none of that need, \
and the RNE towards it from a robot that has some is infinite.

--json prints all pairs in the tables `distrust` (infinite: null) and `trust`, a row for each robot that \
trusts. With --policy it prints the groups by the ids of the table, and as `decision` the \
decision, whose ids are numbers: those of the table, or, if any is a text, 1 for the first robot, and so on. \
A question in JSON is answered by the decision alone.

Examples:
  usar trust robots.csv                                          all pairs
  usar trust robots.csv --less-is-better damage=100,cost=500 --out matrix.svg
  usar trust robots.csv --weights 6,4,2 --format csv
  usar trust robots.csv --policy RNE                             the team in two groups
  usar trust robots.csv --policy 'RNE(score: JensenShannon, hard_rule: Capability)' --json
  usar trust question.json --policy 'HP_DIS <- Kalman | Discount' --json
  usar trust robots.csv --policy ENG --task a,3 --task b,2 --task c,1    three tasks by difficulty
  usar trust robots.csv --policy DIS --task far,2,15.6,64.2 --task near,1,73.4,51.6
  usar trust question.json --policy ENG --json
  usar trust --weights 6,4,2 --trustor 86,120,30 --trustee 20,30,10      no table: needs as they are
  usar trust --trustor 82,114,24 --trustee 79,117,23 --trustee 40,56,12       towards a group of two")]
pub(crate) struct Arguments {
    /// The team (CSV), or a question (JSON)
    #[arg(required_unless_present_any = ["trustor", "trustee"], conflicts_with_all = ["trustor", "trustee"])]
    file: Option<PathBuf>,
    /// Policy that decides, with its options in brackets [default: none, all pairs are shown]
    #[arg(long, conflicts_with_all = ["measure", "out", "trustor"])]
    policy: Option<String>,
    /// Weight of each need, separated by commas; only their ratios matter [default: all 1]
    #[arg(long, allow_hyphen_values = true)]
    weights: Option<String>,
    #[command(flatten)]
    team: team::TeamArguments,
    #[command(flatten)]
    measure: MeasureArgument,
    /// File or folder to write [default: none; else a picture of all pairs]
    #[arg(long, value_name = "FILE.svg|png|pdf", conflicts_with = "trustor")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgument,
    #[command(flatten)]
    pair: pair::PairArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let weights = self.weights.as_deref();
        let Some(file) = &self.file else { return self.pair.told(weights) };
        if let Some(policy) = &self.policy {
            let spec = parse_policy("--policy", policy, registry)?;
            return groups::told(&self.team.read(file, weights)?, &spec, self.shown.is_json());
        }
        let registry = self.measure.chosen_in(registry)?;
        let picture = |path: &PathBuf| PictureFile::of("--out", path, &["svg", "png", "pdf"], self.replace);
        let picture = self.out.as_ref().map(picture).transpose()?;
        let team = self.team.read(file, weights)?;
        let matrix = matrix::Matrix::of(&team, &registry)?;
        if let Some(picture) = &picture {
            picture.write(&matrix.drawn())?;
        }
        matrix.told()
    }
}
