//! `usar group`: splits a team from a table over the two tasks, by any policy.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use csv::StringRecord;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rne_core::{
    Grouping, Member, NEED_NAMES, NeedVector, RneOptions, Role, TaskPositions, Team, policy_named,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{SCHEMA_VERSION, numbers};
use crate::failure::Failure;
use crate::input_table::InputTable;

/// Split a team from a table over the easy and the hard task
#[derive(Debug, Args)]
#[command(after_help = "\
The table (CSV with a header) has the columns id, role (Carrier, Supplier or Observer), x, y (metres) and the needs
hp, v, sen, eng, res, cap, obs; also energy_level for ENG and hp_level for HP_DIS (percent). Other columns are ignored.

Examples:
  usar group robots.csv --policy RNE
  usar group robots.csv --policy DIS --easy 73.4,51.6 --hard 15.6,64.2 --json
  usar group robots.csv --policy RNE --score JensenShannon --hard-rule Capability")]
pub(crate) struct Arguments {
    /// The team (CSV)
    file: PathBuf,
    /// Grouping policy
    #[arg(long, default_value = "RNE")]
    policy: String,
    /// Position `x,y` of the easy task, in metres (needed by DIS)
    #[arg(long, allow_hyphen_values = true)]
    easy: Option<String>,
    /// Position `x,y` of the hard task, in metres (needed by DIS)
    #[arg(long, allow_hyphen_values = true)]
    hard: Option<String>,
    /// Seed of the RANDOM policy
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// RNE: weight of each need, separated by commas [default: all 1]
    #[arg(long, allow_hyphen_values = true)]
    weights: Option<String>,
    /// RNE: do not divide each need by its maximum over the team
    #[arg(long)]
    no_scale: bool,
    /// RNE: base of the logarithm in which the score is given: E, Two or Ten
    #[arg(long, default_value = "E")]
    base: String,
    /// RNE: sort distributions before comparing them
    #[arg(long)]
    sort: bool,
    /// RNE: what is maximised: `MaxOfBoth`, `FirstToSecond`, Sum or `JensenShannon`
    #[arg(long, default_value = "MaxOfBoth")]
    score: String,
    /// RNE: how halves are merged: Apart or Together
    #[arg(long, default_value = "Apart")]
    merge: String,
    /// RNE: which group takes the hard task: `IntraGroupTrust`, Capability, `MeanEnergy` or `MeanHp`
    #[arg(long, default_value = "IntraGroupTrust")]
    hard_rule: String,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Output<'a> {
    schema_version: u32,
    policy: &'a str,
    easy: &'a [u32],
    hard: &'a [u32],
    /// RNE between the groups in nats, by the chosen score; null for policies without one, or where it is infinite.
    score: Option<f64>,
    score_in_base: Option<f64>,
    score_is_infinite: bool,
    proven_optimal: bool,
    options: &'a RneOptions,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let options = self.options()?;
        let policy = policy_named(&self.policy, &options).map_err(Failure::input)?;
        let tasks = match (&self.easy, &self.hard) {
            (Some(easy), Some(hard)) => {
                Some(TaskPositions { easy: point("--easy", easy)?, hard: point("--hard", hard)? })
            }
            (None, None) => None,
            _ => return Err(Failure::input("--easy and --hard must be given together")),
        };
        let members = read_team(&self.file)?;
        let named = |error| Failure::input(format!("{}: {error}", self.file.display()));
        let team = Team::new(members, tasks).map_err(named)?;
        let grouping = policy.group(&team, &mut ChaCha8Rng::seed_from_u64(self.seed)).map_err(named)?;
        if self.json {
            self.print_json(out, &grouping, &options)
        } else {
            print_text(out, &grouping, &options, &team)
        }
    }

    fn options(&self) -> Result<RneOptions, Failure> {
        Ok(RneOptions {
            log_base: variant("--base", &self.base)?,
            sort: self.sort,
            score: variant("--score", &self.score)?,
            weights: self.weights.as_ref().map(|text| numbers("--weights", text)).transpose()?,
            scale: !self.no_scale,
            merge: variant("--merge", &self.merge)?,
            hard_rule: variant("--hard-rule", &self.hard_rule)?,
        })
    }

    fn print_json(
        &self,
        out: &mut dyn Write,
        grouping: &Grouping,
        options: &RneOptions,
    ) -> Result<(), Failure> {
        let output = Output {
            schema_version: SCHEMA_VERSION,
            policy: &self.policy,
            easy: &grouping.easy,
            hard: &grouping.hard,
            score: grouping.score.and_then(rne_core::RelativeNeedsEntropy::nats),
            score_in_base: grouping.score.and_then(|score| score.in_base(options.log_base)),
            score_is_infinite: grouping.score.is_some_and(rne_core::RelativeNeedsEntropy::is_infinite),
            proven_optimal: grouping.proven_optimal,
            options,
        };
        Ok(writeln!(out, "{}", serde_json::to_string(&output).map_err(Failure::run)?)?)
    }
}

fn print_text(
    out: &mut dyn Write,
    grouping: &Grouping,
    options: &RneOptions,
    team: &Team,
) -> Result<(), Failure> {
    for (task, ids) in [("hard", &grouping.hard), ("easy", &grouping.easy)] {
        let of_role = |role| -> Vec<String> {
            let members = team.of_role(role).filter(|member| ids.contains(&member.id));
            members.map(|member| member.id.to_string()).collect()
        };
        let roles =
            Role::ALL.map(|role| format!("{}s {}", role.name().to_lowercase(), of_role(role).join(" ")));
        writeln!(out, "{task}:  {}", roles.join(" | "))?;
    }
    if let Some(score) = grouping.score {
        let value =
            score.in_base(options.log_base).map_or("infinite".to_owned(), |value| format!("{value:.9}"));
        writeln!(
            out,
            "RNE between the groups: {value} ({:?}, log base {:?})",
            options.score, options.log_base
        )?;
        writeln!(
            out,
            "options: scale {}, sort {}, merge {:?}, hard rule {:?}, weights {}",
            options.scale,
            options.sort,
            options.merge,
            options.hard_rule,
            options.weights.as_ref().map_or("all 1".to_owned(), |weights| format!("{weights:?}"))
        )?;
    }
    if !grouping.proven_optimal {
        writeln!(
            out,
            "note: a role has more than {} robots; the split was found by local search and is not proven optimal",
            rne_core::grouping::EXACT_ROLE_SIZE
        )?;
    }
    Ok(())
}

/// A variant of an enum by its name, as in a scenario.
fn variant<T: DeserializeOwned>(flag: &str, name: &str) -> Result<T, Failure> {
    ron::from_str(name).map_err(|error| Failure::input(format!("{flag}: {}", error.code)))
}

fn point(flag: &str, text: &str) -> Result<[f64; 2], Failure> {
    let numbers = numbers(flag, text)?;
    <[f64; 2]>::try_from(numbers.as_slice())
        .ok()
        .filter(|point| point.iter().all(|x| x.is_finite()))
        .ok_or_else(|| Failure::input(format!("{flag} must be two finite numbers `x,y`, found {text:?}")))
}

/// Reads the table; says all that is wrong with it at once.
fn read_team(path: &Path) -> Result<Vec<Member>, Failure> {
    let shown = path.display();
    let table = InputTable::read(path)?;
    let column = |name: &str| table.column(name);
    let missing: Vec<&str> = ["id", "role", "x", "y"]
        .into_iter()
        .chain(NEED_NAMES)
        .filter(|name| column(name).is_none())
        .collect();
    if !missing.is_empty() {
        return Err(Failure::input(format!("{shown}:1: the header lacks {}", missing.join(", "))));
    }
    let (mut members, mut problems) = (Vec::new(), Vec::new());
    for (line, row) in &table.rows {
        match member(row, &column) {
            Ok(member) => members.push(member),
            Err(problem) => problems.push(format!("{shown}:{line}: {problem}")),
        }
    }
    if members.is_empty() && problems.is_empty() {
        problems.push(format!("{shown}: has no robots"));
    }
    if problems.is_empty() { Ok(members) } else { Err(Failure::Input(problems.join("\n"))) }
}

fn member(row: &StringRecord, column: &dyn Fn(&str) -> Option<usize>) -> Result<Member, String> {
    let cell = |name: &str| column(name).and_then(|i| row.get(i)).unwrap_or_default();
    let number = |name: &str| {
        let found = cell(name);
        let value = found.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{name} must be a finite number, found {found:?}"))
    };
    let level = |name: &str| match cell(name) {
        "" => Ok(None),
        found => match number(name)? {
            level if (0.0..=100.0).contains(&level) => Ok(Some(level)),
            _ => Err(format!("{name} must be a percentage from 0 to 100, found {found}")),
        },
    };
    let role = cell("role");
    let needs = NEED_NAMES.iter().map(|name| match number(name)? {
        need if need >= 0.0 => Ok(need),
        need => Err(format!("{name} must be a number >= 0, found {need}")),
    });
    Ok(Member {
        id: cell("id")
            .parse()
            .map_err(|_| format!("id must be a whole number >= 0, found {:?}", cell("id")))?,
        role: Role::ALL
            .into_iter()
            .find(|known| known.name().eq_ignore_ascii_case(role))
            .ok_or_else(|| format!("role must be Carrier, Supplier or Observer, found {role:?}"))?,
        position: [number("x")?, number("y")?],
        needs: NeedVector::new(needs.collect::<Result<_, _>>()?).map_err(|error| error.to_string())?,
        energy_level: level("energy_level")?,
        hp_level: level("hp_level")?,
    })
}
