//! `usar group`: groups a team from a table, or answers a question in JSON, with any policy.

use csv::StringRecord;
use experiments::experiment::PolicySpec;
use experiments::input_table::InputTable;
use rne_core::question::hardest_first;
use rne_core::{
    Decision, LogBase, Member, Need, NeedVector, Question, Quota, RandomSeed, RoleId, SCHEMA_VERSION, Task,
};

use crate::arguments::{JsonArgument, numbers, parse_policy};
use crate::output::print_plain_json;
use crate::prelude::*;

/// Group a team from a table, or answer a question in JSON
#[derive(Debug, Args)]
#[command(after_help = "\
The table (CSV with a header) has the columns id, role, x, y (metres), and optionally energy_level and \
hp_level (percent), which ENG and HP_DIS need. Every other column is a need. Roles are merged in the order \
in which the table names them first.

A file that ends with .json is a question (docs/decisions.md). --json prints the decision in its JSON form.

Examples:
  usar group robots.csv --policy RNE
  usar group robots.csv --policy 'RNE(score: JensenShannon, hard_rule: Capability)' --weights 6,4,2
  usar group robots.csv --policy DIS --task far,2,15.6,64.2 --task near,1,73.4,51.6 --json
  usar group robots.csv --task a,3 --task b,2 --task c,1           three tasks by difficulty
  usar group question.json --policy ENG --json")]
pub(crate) struct Arguments {
    /// The team (CSV), or a question (JSON)
    file: PathBuf,
    /// Policy that decides, with its options in brackets
    #[arg(long, default_value = "RNE")]
    policy: String,
    /// A task: name, difficulty and, for policies that need it, its place `x,y` in metres [default: first,2
    /// and second,1]
    #[arg(long = "task", value_name = "NAME,DIFFICULTY[,X,Y]", allow_hyphen_values = true)]
    tasks: Vec<String>,
    /// Weight of each need, separated by commas; only their ratios matter [default: all 1]
    #[arg(long, allow_hyphen_values = true)]
    weights: Option<String>,
    /// Seed of all that the command itself draws
    #[arg(long, default_value_t = 1, hide_short_help = true)]
    draw_seed: u64,
    #[command(flatten)]
    json: JsonArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let spec = parse_policy("--policy", &self.policy, registry)?;
        let question = self.question()?;
        let decision = spec.made().decide(&question).map_err(Failure::input_at(self.file.display()))?;
        decision.assignment.check(&question).map_err(Failure::input_at(self.file.display()))?;
        if self.json.json {
            return print_plain_json(&decision);
        }
        print_text(out, &question, &decision, &spec)
    }

    fn question(&self) -> Result<Question, Failure> {
        if self.file.extension().is_some_and(|kind| kind == "json") {
            if !self.tasks.is_empty() || self.weights.is_some() {
                refuse!("--task and --weights are for tables: a question has its own");
            }
            let text =
                ron_tree::file::read_text(&self.file).map_err(Failure::input_at(self.file.display()))?;
            return Question::from_json(&text).map_err(Failure::input_at(self.file.display()));
        }
        let Team { roles, needs, members } = read_team(&self.file)?;
        let weights = match &self.weights {
            Some(text) => numbers("--weights", text)?,
            None => vec![1.0; needs.len()],
        };
        if weights.len() != needs.len() {
            let (found, names) = (weights.len(), needs.join(", "));
            refuse!("--weights: must have one entry for each need ({names}), found {found}");
        }
        let tasks = self.tasks()?;
        let order = hardest_first(tasks.iter().map(|task| task.difficulty));
        let count = |role: usize| members.iter().filter(|member| member.role.index() == role).count();
        let counts: Vec<usize> = (0..roles.len()).map(count).collect();
        let question = Question {
            schema_version: SCHEMA_VERSION,
            round: 1,
            roles,
            needs: needs.into_iter().zip(weights).map(|(name, weight)| Need { name, weight }).collect(),
            quotas: Quota::equal(&counts, &order),
            tasks,
            members,
            may_idle: false,
            history: Vec::new(),
            random_seed: RandomSeed::from(self.draw_seed),
        };
        question.checked().map_err(Failure::input_at(self.file.display()))
    }

    fn tasks(&self) -> Result<Vec<Task>, Failure> {
        if self.tasks.is_empty() {
            return Ok(vec![Task::new("first", 2), Task::new("second", 1)]);
        }
        self.tasks.iter().map(|text| task(text)).collect()
    }
}

fn task(text: &str) -> Result<Task, Failure> {
    let bad =
        || Failure::input(format!("--task: must be NAME,DIFFICULTY or NAME,DIFFICULTY,X,Y, found {text:?}"));
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let (name, difficulty, place) = match parts[..] {
        [name, difficulty] => (name, difficulty, None),
        [name, difficulty, x, y] => {
            let number = |text: &str| text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(bad);
            (name, difficulty, Some([number(x)?, number(y)?]))
        }
        _ => return Err(bad()),
    };
    let difficulty = difficulty.parse().map_err(|_| bad())?;
    if name.is_empty() { Err(bad()) } else { Ok(Task { place, ..Task::new(name, difficulty) }) }
}

fn print_text(
    out: &mut dyn Write,
    question: &Question,
    decision: &Decision,
    spec: &PolicySpec,
) -> Result<(), Failure> {
    let width = question.tasks.iter().map(|task| task.name.len()).max().unwrap_or(0);
    for task in question.task_ids() {
        let group = decision.assignment.of(task);
        let of_role = |role: RoleId| {
            let members = question.of_role(role).filter(|member| group.contains(&member.id));
            let ids: Vec<String> = members.map(|member| member.id.to_string()).collect();
            format!("{} {}", question.roles[role.index()], ids.join(" "))
        };
        let roles: Vec<String> = question.role_ids().map(of_role).collect();
        writeln!(out, "{:<width$}  {}", question.tasks[task.index()].name, roles.join(" | "))?;
    }
    let made = spec.made();
    if let Some(score) = decision.score {
        let written = spec.options().iter().find(|(name, _)| name == "log_base");
        let base = written.and_then(|(_, base)| serde_json::from_value(base.as_str().into()).ok());
        let base: LogBase = base.unwrap_or_default();
        let value = score.in_base(base).map_or("infinite".to_owned(), |value| format!("{value:.9}"));
        writeln!(out, "score   {value} (log base {base:?})")?;
    }
    if !made.options.is_empty() {
        writeln!(out, "options {}", made.options)?;
    }
    if !decision.proven_optimal {
        writeln!(
            out,
            "note: the team is too large to look at every grouping; this one was found by local search and \
             is not proven optimal"
        )?;
    }
    Ok(())
}

/// A team, as read from a table.
struct Team {
    /// Names of the roles, in the order of their first rows in the table.
    roles: Vec<String>,
    /// Names of the needs.
    needs: Vec<String>,
    members: Vec<Member>,
}

/// Columns other than needs.
const OTHER_COLUMNS: [&str; 6] = ["id", "role", "x", "y", "energy_level", "hp_level"];

/// Reads the table; reports all its problems at once.
fn read_team(path: &Path) -> Result<Team, Failure> {
    let shown = path.display();
    let table = InputTable::read(path)?;
    let missing: Vec<&str> =
        ["id", "role", "x", "y"].into_iter().filter(|name| table.column(name).is_none()).collect();
    if !missing.is_empty() {
        refuse!("{shown}:1: the header lacks {}", missing.join(", "));
    }
    let is_need = |name: &&str| !OTHER_COLUMNS.contains(name);
    let needs: Vec<String> = table.columns().filter(is_need).map(str::to_owned).collect();
    if needs.is_empty() {
        refuse!("{shown}:1: the header lacks needs: columns of any other name");
    }
    let mut team = Team { roles: Vec::new(), needs, members: Vec::new() };
    let mut problems = Vec::new();
    for (line, row) in &table.rows {
        match member(row, &table, &mut team) {
            Ok(member) => team.members.push(member),
            Err(problem) => problems.push(format!("{shown}:{line}: {problem}")),
        }
    }
    if team.members.is_empty() && problems.is_empty() {
        problems.push(format!("{shown}: has no robots"));
    }
    if problems.is_empty() { Ok(team) } else { Err(Failure::Input(problems.join("\n"))) }
}

fn member(row: &StringRecord, table: &InputTable, team: &mut Team) -> Result<Member, String> {
    let cell = |name: &str| table.column(name).and_then(|i| row.get(i)).unwrap_or_default();
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
    let needs = team.needs.iter().map(|name| match number(name)? {
        need if need >= 0.0 => Ok(need),
        need => Err(format!("{name} must be a number >= 0, found {need}")),
    });
    let needs = NeedVector::new(needs.collect::<Result<_, String>>()?).map_err(|error| error.to_string())?;
    let role = match cell("role") {
        "" => return Err("role must be a name, found nothing".to_owned()),
        name => team.roles.iter().position(|known| known == name).unwrap_or_else(|| {
            team.roles.push(name.to_owned());
            team.roles.len() - 1
        }),
    };
    Ok(Member {
        id: cell("id")
            .parse()
            .map_err(|_| format!("id must be a whole number >= 0, found {:?}", cell("id")))?,
        role: RoleId(u16::try_from(role).map_err(|_| "there are too many roles".to_owned())?),
        home: [number("x")?, number("y")?],
        needs,
        energy_level: level("energy_level")?,
        hp_level: level("hp_level")?,
    })
}
