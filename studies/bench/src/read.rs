//! Problems as JSON, in the form of MRTA-Benchmark. A text in the form of HeteroMRTA is told by its fields.
//!
//! `Q` has a row for each robot and a 0 or 1 for each skill. `R` has a row for each task, in the same way,
//! and `T_e` how long each takes; the first and the last row are no tasks, but the first and the last
//! location, and are 0. `task_locations` has a place for each row of `R`. `precedence_constraints` has
//! pairs of rows: the first must be over before the second. `T_t` has the time of travel between all rows;
//! without it, distance is time.

use serde_json::{Value, json};

use crate::fields::{BadProblem, Reader, found};
use crate::problem::{Problem, Robot, Skills, Task};

/// Reads a problem in the form of MRTA-Benchmark, or in that of HeteroMRTA's `config.json`: that has `robots`
/// or `tasks` and no `Q`.
///
/// # Errors
/// A text that is not JSON, or all fields that break a rule.
pub fn read(name: &str, text: &str) -> Result<Problem, BadProblem> {
    let json: Value = serde_json::from_str(text).or_else(|error| {
        // Python writes such numbers; as words they are found at their field.
        let quoted = text.replace("-Infinity", "\"-infinite\"");
        let quoted = quoted.replace("NaN", "\"NaN\"").replace("Infinity", "\"Infinity\"");
        serde_json::from_str(&quoted).map_err(|_| error)
    })?;
    let mut reader = Reader { json: &json, bad: Vec::new() };
    let is_there = |field: &str| json.get(field).is_some();
    let is_hetero = !is_there("Q") && (is_there("robots") || is_there("tasks"));
    let problem = if is_hetero { reader.hetero(name) } else { reader.benchmark(name) };
    match problem {
        Some(problem) if reader.bad.is_empty() => Ok(problem),
        _ => Err(BadProblem::Fields(reader.bad)),
    }
}

/// Writes a problem in the form of MRTA-Benchmark; `None` if not all robots begin at location 0 and end at
/// the last one, because that form has no other places for them.
#[must_use]
pub fn write(problem: &Problem) -> Option<String> {
    let ends = [0, problem.last()];
    if problem.robots.iter().any(|robot| [robot.start, robot.end] != ends) {
        return None;
    }
    let row =
        |skills: &Skills| (0..problem.skills).map(|skill| (skills >> skill) & 1).collect::<Vec<Skills>>();
    let with_ends = |first: Value, tasks: Vec<Value>| -> Vec<Value> {
        std::iter::once(first.clone()).chain(tasks).chain([first]).collect()
    };
    let required = problem.tasks.iter().map(|task| json!(row(&task.requires))).collect();
    let durations = problem.tasks.iter().map(|task| json!(task.duration)).collect();
    let pairs = problem.tasks.iter().enumerate();
    let pairs = pairs.flat_map(|(task, of)| of.after.iter().map(move |first| [first + 1, task + 1]));
    let json = json!({
        "Q": problem.robots.iter().map(|robot| row(&robot.skills)).collect::<Vec<_>>(),
        "R": with_ends(json!(row(&0)), required),
        "T_e": with_ends(json!(0), durations),
        "T_t": problem.travel,
        "task_locations": problem.places,
        "precedence_constraints": pairs.collect::<Vec<_>>(),
    });
    Some(format!("{json}\n"))
}

impl Reader<'_> {
    /// A problem in the form of MRTA-Benchmark.
    fn benchmark(&mut self, name: &str) -> Option<Problem> {
        let robots = self.table("Q")?;
        let (rows, durations) = (self.table("R")?, self.row("T_e")?);
        let skills = robots.first().map_or(0, Vec::len);
        if robots.is_empty() || !(1..=Skills::BITS as usize).contains(&skills) {
            self.refuse("Q", "have a row for each robot with 1 to 64 skills", format!("{robots:?}"));
        }
        let count = rows.len();
        if count < 3 {
            let rule = "have a first and a last row of zeros, and a row for each task between them";
            self.refuse("R", rule, format!("{count} rows"));
            return None;
        }
        if durations.len() != count {
            self.refuse("T_e", format!("have a number for each of the {count} rows of R"), durations.len());
            return None;
        }
        let places = self.table("task_locations")?;
        if places.len() != count {
            let rule = format!("have a place for each of the {count} rows of R");
            self.refuse("task_locations", rule, places.len());
        }
        let robots = self.skills("Q", &robots, skills);
        let requires = self.skills("R", &rows, skills);
        for (at, end) in [0, count - 1].into_iter().flat_map(|at| [(at, "R"), (at, "T_e")]) {
            let found = if end == "R" { requires[at] as f64 } else { durations[at] };
            if found != 0.0 {
                let found = if end == "R" { format!("{:?}", rows[at]) } else { found.to_string() };
                self.refuse(format!("{end}[{at}]"), "be 0: the first and the last row are no tasks", found);
            }
        }
        self.tasks_can_be_done(&requires, &rows, robots.iter().fold(0, |all, robot| all | robot));
        for (at, duration) in durations.iter().enumerate().filter(|(_, duration)| **duration < 0.0) {
            self.refuse(format!("T_e[{at}]"), "be at least 0", duration);
        }
        let places: Vec<[f64; 2]> = self.places(&places);
        let after = self.order(count)?;
        let travel = if self.json.get("T_t").is_some() { self.travel(count)? } else { Vec::new() };
        let task = |row: usize| Task {
            requires: requires[row],
            duration: durations[row],
            after: after[row].iter().map(|first| first - 1).collect(),
        };
        let tasks = (1..count - 1).map(task).collect();
        let robots = robots.into_iter().map(|skills| Robot { skills, start: 0, end: count - 1 }).collect();
        let travel = if travel.is_empty() { Problem::distances(&places) } else { travel };
        Some(Problem { name: name.to_owned(), skills, robots, tasks, places, travel })
    }

    /// A field that is a list of lists of numbers.
    fn table(&mut self, field: &str) -> Option<Vec<Vec<f64>>> {
        let Some(rows) = self.json.get(field).and_then(Value::as_array) else {
            self.refuse(field, "be a list of lists of numbers", found(self.json.get(field)));
            return None;
        };
        let before = self.bad.len();
        let rows = rows.iter().enumerate().map(|(at, row)| self.numbers(&format!("{field}[{at}]"), row));
        let rows = rows.collect();
        (self.bad.len() == before).then_some(rows)
    }

    /// A field that is a list of numbers.
    fn row(&mut self, field: &str) -> Option<Vec<f64>> {
        let before = self.bad.len();
        let row = self.numbers(field, self.json.get(field).unwrap_or(&Value::Null));
        (self.bad.len() == before).then_some(row)
    }

    fn numbers(&mut self, field: &str, row: &Value) -> Vec<f64> {
        let Some(row) = row.as_array() else {
            self.refuse(field, "be a list of numbers", row);
            return Vec::new();
        };
        let mut number = |(at, value): (usize, &Value)| self.number(format!("{field}[{at}]"), Some(value));
        row.iter().enumerate().map(&mut number).collect()
    }

    fn skills(&mut self, field: &str, rows: &[Vec<f64>], count: usize) -> Vec<Skills> {
        for (at, row) in rows.iter().enumerate() {
            if row.len() != count {
                let rule = format!("have a number for each of the {count} skills of Q[0]");
                self.refuse(format!("{field}[{at}]"), rule, row.len());
            }
            if let Some(other) = row.iter().find(|skill| ![0.0, 1.0].contains(skill)) {
                self.refuse(format!("{field}[{at}]"), "have 0 or 1 for each skill", other);
            }
        }
        let bit = |(skill, has): (usize, &f64)| if *has > 0.5 { 1 << skill } else { 0 };
        rows.iter().map(|row| row.iter().take(64).enumerate().map(bit).sum()).collect()
    }

    fn tasks_can_be_done(&mut self, requires: &[Skills], rows: &[Vec<f64>], there: Skills) {
        for (at, required) in requires.iter().enumerate().skip(1).take(requires.len() - 2) {
            if *required == 0 {
                self.refuse(format!("R[{at}]"), "require a skill", format!("{:?}", rows[at]));
            } else if required & !there != 0 {
                let skill = (required & !there).trailing_zeros() + 1;
                let rule = "require only skills that a robot has";
                self.refuse(format!("R[{at}]"), rule, format!("skill {skill}, which nobody has"));
            }
        }
    }

    fn places(&mut self, rows: &[Vec<f64>]) -> Vec<[f64; 2]> {
        for (at, row) in rows.iter().enumerate().filter(|(_, row)| row.len() != 2) {
            self.refuse(format!("task_locations[{at}]"), "be two numbers", row.len());
        }
        rows.iter().filter_map(|row| <[f64; 2]>::try_from(row.as_slice()).ok()).collect()
    }

    /// For each row of `R`, the rows before it.
    fn order(&mut self, count: usize) -> Option<Vec<Vec<usize>>> {
        let mut after = vec![Vec::new(); count];
        for (at, pair) in self.table("precedence_constraints")?.iter().enumerate() {
            let is_task = |row: &f64| row.fract() == 0.0 && (1.0..(count - 1) as f64).contains(row);
            match pair.as_slice() {
                [first, second] if is_task(first) && is_task(second) => {
                    after[*second as usize].push(*first as usize);
                }
                other => {
                    let rule = format!("be two rows of tasks, from 1 to {}", count - 2);
                    self.refuse(format!("precedence_constraints[{at}]"), rule, format!("{other:?}"));
                }
            }
        }
        let mut left: Vec<usize> = (0..count).collect();
        while let Some(at) = left.iter().position(|row| !after[*row].iter().any(|first| left.contains(first)))
        {
            left.remove(at);
        }
        if !left.is_empty() {
            let found = format!("a circle in or before the rows {left:?}");
            self.refuse("precedence_constraints", "have no circle", found);
        }
        Some(after)
    }

    fn travel(&mut self, count: usize) -> Option<Vec<Vec<f64>>> {
        let travel = self.table("T_t")?;
        if travel.len() != count {
            self.refuse("T_t", format!("have a row for each of the {count} rows of R"), travel.len());
        }
        for (at, row) in travel.iter().enumerate() {
            if row.len() != count {
                self.refuse(format!("T_t[{at}]"), format!("have {count} numbers"), row.len());
            }
            if let Some(time) = row.iter().find(|time| **time < 0.0) {
                self.refuse(format!("T_t[{at}]"), "have no time below 0", time);
            }
        }
        Some(travel)
    }
}
