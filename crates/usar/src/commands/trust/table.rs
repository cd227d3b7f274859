//! Reads the table of a team: a row for each robot.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::str::FromStr;

use experiments::input_table::{CellProblem, InputRow, InputTable, Problem};
use experiments::limits::TEAM_ROBOTS;
use rne_core::NeedVector;
use teaming::{Member, RoleId};

use crate::bad_value::BadValue;
use crate::prelude::*;

/// A need of which less is better, and its worst value.
#[derive(Debug, Clone)]
pub(super) struct LessIsBetter {
    need: String,
    worst: f64,
}

impl FromStr for LessIsBetter {
    type Err = BadValue;

    fn from_str(text: &str) -> Result<Self, BadValue> {
        let parts = text.rsplit_once('=').and_then(|(need, worst)| Some((need, worst.trim().parse().ok()?)));
        match parts {
            Some((need, worst)) if worst > 0.0 && worst <= f64::MAX => {
                Ok(Self { need: need.trim().to_owned(), worst })
            }
            _ => Err(BadValue::new("NEED=WORST with a number above 0, as in damage=100", text)),
        }
    }
}

/// A need of a table.
pub(super) struct NeedColumn {
    pub(super) name: String,
    /// The worst value of a need of which less is better. It counts as what is left until there.
    pub(super) worst: Option<f64>,
}

/// A team, as read from a table.
pub(super) struct TeamTable {
    /// The table itself.
    pub(super) table: InputTable,
    /// Names of the roles, in the order of their first rows in the table.
    pub(super) roles: Vec<String>,
    /// Its needs.
    pub(super) needs: Vec<NeedColumn>,
    /// The robots, in the order of the rows.
    pub(super) members: Vec<Member>,
    /// Whether the table has the places of robots. Without, they are all at the origin.
    pub(super) has_places: bool,
}

/// Columns other than needs.
const OTHER_COLUMNS: [&str; 6] = ["id", "role", "x", "y", LEVELS[0], LEVELS[1]];

/// The columns of [`Level::energy_and_hp`](teaming::Level::energy_and_hp).
const LEVELS: [&str; 2] = ["energy_level", "hp_level"];

impl TeamTable {
    /// Reads the table.
    ///
    /// # Errors
    /// All problems of the header, or else of the rows, each with its line.
    pub(super) fn read(path: &Path, less_is_better: &[LessIsBetter]) -> Result<Self, Failure> {
        let table = InputTable::read(path)?;
        let needs = needs(&table, less_is_better)?;
        let has_places = table.column("x").is_some();
        let robots = table.rows().len();
        if robots == 0 || robots > TEAM_ROBOTS.count() {
            refuse!("{}: must have 1 to {} robots, found {robots}", path.display(), TEAM_ROBOTS.most);
        }
        let mut rows = Rows { roles: Vec::new(), problems: repeated_ids(&table) };
        let members: Vec<Member> =
            table.rows().zip(ids(&table)).filter_map(|(row, id)| rows.member(row, id, &needs)).collect();
        let Rows { roles, problems } = rows;
        if !problems.is_empty() {
            return Err(table.refused(problems));
        }
        Ok(Self { table, roles, needs, members, has_places })
    }
}

/// The needs in the header; the failure has all problems of the header.
fn needs(table: &InputTable, less_is_better: &[LessIsBetter]) -> Result<Vec<NeedColumn>, Failure> {
    let names: Vec<&str> = table.columns().filter(|name| !OTHER_COLUMNS.contains(name)).collect();
    let mut problems = Vec::new();
    let mut lacks = |is_lacking: bool, what: &str| {
        if is_lacking {
            problems.push((1, format!("the header lacks {what}")));
        }
    };
    let found = table.columns().collect::<Vec<_>>().join(", ");
    lacks(table.column("id").is_none(), &format!("id, found {found}"));
    lacks(table.column("x").is_none() && table.column("y").is_some(), "x, but has y");
    lacks(table.column("y").is_none() && table.column("x").is_some(), "y, but has x");
    lacks(names.is_empty(), "needs: columns of any other name");
    if !problems.is_empty() {
        return Err(table.refused(problems));
    }
    for (i, LessIsBetter { need, .. }) in less_is_better.iter().enumerate() {
        if !names.contains(&need.as_str()) {
            refuse!("--less-is-better: must name needs ({}), found {need:?}", names.join(", "));
        }
        if less_is_better[..i].iter().any(|other| other.need == *need) {
            refuse!("--less-is-better: {need:?} is named twice");
        }
    }
    let worst =
        |name: &str| less_is_better.iter().find(|turned| turned.need == name).map(|turned| turned.worst);
    Ok(names.into_iter().map(|name| NeedColumn { name: name.to_owned(), worst: worst(name) }).collect())
}

/// The number of each robot: its id, or its place in the table if not all ids are whole numbers.
fn ids(table: &InputTable) -> Vec<u32> {
    let id = |row: InputRow| {
        let text = row.text("id")?;
        text.parse().ok().filter(|id: &u32| id.to_string() == text)
    };
    let by_name: Option<Vec<u32>> = table.rows().map(id).collect();
    by_name.unwrap_or_else(|| (1..).take(table.rows().len()).collect())
}

fn repeated_ids(table: &InputTable) -> Vec<Problem> {
    let (mut lines, mut problems) = (BTreeMap::new(), Vec::new());
    for row in table.rows() {
        let Some(id) = row.text("id").filter(|id| !id.is_empty()) else { continue };
        let first = *lines.entry(id).or_insert(row.line);
        if first != row.line {
            problems.push((row.line, format!("id: must be unique, found {id:?}, as in line {first}")));
        }
    }
    problems
}

/// What is found row by row.
struct Rows {
    roles: Vec<String>,
    problems: Vec<Problem>,
}

impl Rows {
    fn member(&mut self, row: InputRow, id: u32, needs: &[NeedColumn]) -> Option<Member> {
        let before = self.problems.len();
        self.text(row, "id");
        let role = self.role(row);
        let mut number = |column: &str, range| self.number(row, column, range);
        let any = f64::MIN..=f64::MAX;
        let home = ["x", "y"].map(|column| number(column, any.clone()).unwrap_or(0.0));
        let levels = LEVELS.map(|column| number(column, 0.0..=100.0)).to_vec();
        let values = needs.iter().map(|need| {
            let value = number(&need.name, 0.0..=need.worst.unwrap_or(f64::MAX)).unwrap_or(0.0);
            need.worst.map_or(value, |worst| worst - value)
        });
        let values: Vec<f64> = values.collect();
        if before == self.problems.len() && values.iter().all(|value| *value == 0.0) {
            self.problems.push((row.line, "must have a need above 0, found none".to_owned()));
        }
        let needs =
            NeedVector::new(values).map_err(|error| self.problems.push((row.line, error.to_string())));
        Some(Member { id, role, home, needs: needs.ok()?, levels })
    }

    fn text<'t>(&mut self, row: InputRow<'t>, column: &str) -> Option<&'t str> {
        let text = row.text(column)?;
        if text.is_empty() {
            self.problems.push((row.line, CellProblem::Empty { column: column.to_owned() }.to_string()));
        }
        Some(text)
    }

    fn number(&mut self, row: InputRow, column: &str, range: RangeInclusive<f64>) -> Option<f64> {
        row.number(column, range).unwrap_or_else(|problem| {
            self.problems.push((row.line, problem.to_string()));
            None
        })
    }

    /// The role of a robot; `robot` if the table has no roles.
    fn role(&mut self, row: InputRow) -> RoleId {
        let name = self.text(row, "role").unwrap_or("robot");
        let role = self.roles.iter().position(|known| known == name).unwrap_or_else(|| {
            self.roles.push(name.to_owned());
            self.roles.len() - 1
        });
        RoleId(u16::try_from(role).unwrap_or(u16::MAX)) // there are no more roles than robots
    }
}
