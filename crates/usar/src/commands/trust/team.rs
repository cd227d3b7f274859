//! The team that is looked at: from a table, or from a question in JSON.

use std::collections::BTreeMap;

use experiments::input_table::InputRow;
use rne_core::NeedWeights;
use teaming::error::PolicyError;
use teaming::question::hardest_first;
use teaming::{Level, Need, Question, Quota, RandomSeed, Task};

use super::table::{LessIsBetter, NeedColumn, TeamTable};
use crate::arguments::numbers;
use crate::prelude::*;

/// What a table does not say of the team and its tasks.
#[derive(Debug, Args)]
pub(super) struct TeamArguments {
    /// Needs of which less is better, each with its worst value; they count as WORST minus the value
    #[arg(long, value_name = "NEED=WORST", conflicts_with = "trustor", value_delimiter = ',')]
    less_is_better: Vec<LessIsBetter>,
    /// A task: name, difficulty and, for policies that need it, its place `x,y` in metres [default: first,2
    /// and second,1]
    #[arg(
        long = "task",
        value_name = "NAME,DIFFICULTY[,X,Y]",
        requires = "policy",
        allow_hyphen_values = true
    )]
    tasks: Vec<String>,
    /// Seed of all that the command itself draws
    #[arg(long, default_value_t = 1, hide_short_help = true)]
    draw_seed: u64,
}

/// A team, as a question about its groups.
pub(super) struct Team {
    /// The question. Robots are numbers in it.
    pub(super) question: Question,
    file: String,
    /// What the table says of robots; `None` for a question in JSON.
    rows: Option<Rows>,
}

struct Rows {
    table: TeamTable,
    /// The id in the table and the line of each robot, by its number.
    robots: BTreeMap<u32, (String, usize)>,
}

impl TeamArguments {
    /// Reads the team.
    ///
    /// # Errors
    /// The file or an option cannot be used.
    pub(super) fn read(&self, file: &Path, weights: Option<&str>) -> Result<Team, Failure> {
        let shown = file.display().to_string();
        if file.extension().is_some_and(|kind| kind == "json") {
            if !self.tasks.is_empty() || weights.is_some() || !self.less_is_better.is_empty() {
                refuse!("--task, --weights and --less-is-better are for tables: a question has its own");
            }
            let text = ron_tree::file::read_text(file).map_err(Failure::input_at(&shown))?;
            let question = Question::from_json(&text).map_err(Failure::input_at(&shown))?;
            return Ok(Team { question, file: shown, rows: None });
        }
        let table = TeamTable::read(file, &self.less_is_better)?;
        let tasks = self.tasks()?;
        if !table.has_places && tasks.iter().any(|task| task.place.is_some()) {
            refuse!(
                "{shown}:1: the header lacks x and y: --task has places, for distances from robots to them"
            );
        }
        let question = self.question(&table, tasks, weights)?;
        let question = question.checked().map_err(Failure::input_at(&shown))?;
        let robot = |row: InputRow| (row.text("id").unwrap_or_default().to_owned(), row.line);
        let robots = table.members.iter().zip(table.table.rows());
        let robots = robots.map(|(member, row)| (member.id, robot(row))).collect();
        Ok(Team { question, file: shown, rows: Some(Rows { table, robots }) })
    }

    fn question(
        &self,
        team: &TeamTable,
        tasks: Vec<Task>,
        weights: Option<&str>,
    ) -> Result<Question, Failure> {
        let weights = weights_of(&team.needs, weights)?;
        let need = |(need, weight): (&NeedColumn, f64)| Need { name: need.name.clone(), weight };
        let count = |role: usize| team.members.iter().filter(|member| member.role.index() == role).count();
        let counts: Vec<usize> = (0..team.roles.len()).map(count).collect();
        Ok(Question {
            roles: team.roles.clone(),
            needs: team.needs.iter().zip(weights).map(need).collect(),
            quotas: Quota::equal(&counts, &hardest_first(tasks.iter().map(|task| task.difficulty))),
            tasks,
            members: team.members.clone(),
            levels: Level::energy_and_hp(),
            random_seed: RandomSeed::from(self.draw_seed),
            ..Question::default()
        })
    }

    fn tasks(&self) -> Result<Vec<Task>, Failure> {
        if self.tasks.is_empty() {
            return Ok(vec![Task::new("first", 2), Task::new("second", 1)]);
        }
        self.tasks.iter().map(|text| task(text)).collect()
    }
}

impl Team {
    /// The id of a robot as the file has it.
    pub(super) fn name(&self, robot: u32) -> String {
        let row = self.rows.as_ref().and_then(|rows| rows.robots.get(&robot));
        row.map_or_else(|| robot.to_string(), |(name, _)| name.clone())
    }

    /// Whether it comes from a table.
    pub(super) fn is_table(&self) -> bool {
        self.rows.is_some()
    }

    /// The numbers of its robots, in the order of the file.
    pub(super) fn robots(&self) -> Vec<u32> {
        let members = self.rows.as_ref().map_or(&self.question.members, |rows| &rows.table.members);
        members.iter().map(|member| member.id).collect()
    }

    /// Its needs in a sentence, with what each of them counts as.
    pub(super) fn needs(&self) -> String {
        let turned = self.rows.iter().flat_map(|rows| &rows.table.needs);
        let worst: BTreeMap<&str, f64> =
            turned.filter_map(|need| Some((need.name.as_str(), need.worst?))).collect();
        let told = |need: &Need| {
            let Need { name, weight } = need;
            let counted = worst.get(name.as_str()).map(|worst| format!(", counts as {worst} - {name}"));
            format!("{name} (weight {weight}{})", counted.unwrap_or_default())
        };
        self.question.needs.iter().map(told).collect::<Vec<_>>().join(", ")
    }

    /// The failure of a policy or measure, with what it is about by the names and lines of the table.
    pub(super) fn failure(&self, error: &PolicyError) -> Failure {
        let Some(rows) = &self.rows else { return Failure::input_at(&self.file)(error) };
        match error {
            PolicyError::Needs { id, source } => {
                let line = rows.robots.get(id).map_or(1, |(_, line)| *line);
                rows.table.table.refused_at(line, format_args!("robot {:?}: {source}", self.name(*id)))
            }
            // Cells of a table are not empty, so that all robots lack what one lacks.
            PolicyError::MissingFact { policy, what, .. } => rows.table.table.refused_at(
                1,
                format_args!(
                    "policy {policy} needs {what}, which is missing; it takes levels from the columns \
                     energy_level and hp_level, and distances from x and y to the places of `--task \
                     NAME,DIFFICULTY,X,Y`"
                ),
            ),
            other => Failure::input_at(&self.file)(other),
        }
    }
}

fn weights_of(needs: &[NeedColumn], text: Option<&str>) -> Result<Vec<f64>, Failure> {
    let Some(text) = text else { return Ok(vec![1.0; needs.len()]) };
    let weights = NeedWeights::new(numbers("--weights", text)?).map_err(Failure::input_at("--weights"))?;
    if weights.values().len() != needs.len() {
        let names: Vec<&str> = needs.iter().map(|need| need.name.as_str()).collect();
        let (found, names) = (weights.values().len(), names.join(", "));
        refuse!("--weights: must have one entry for each need ({names}), found {found}");
    }
    Ok(weights.values().to_vec())
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
