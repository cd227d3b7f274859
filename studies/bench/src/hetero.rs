//! Problems as JSON, in the form of HeteroMRTA's `config.json`.
//!
//! `setup` counts `robots`, `tasks` and skills (`num_skills`). For each of the keys 0, 1, ... `tasks` has
//! where a task is (`pos`), how long it takes (`duration`) and which skills it requires (`skillset`, 0 or 1),
//! and `robots` has where a robot begins and ends (`pose`) and its `skillset`. Robots move at a speed of 0.2,
//! and there is no order.

use serde_json::Value;

use crate::fields::{Reader, found};
use crate::problem::{Problem, Robot, Skills, Task};

/// The speed of all robots.
const SPEED: f64 = 0.2;

impl<'j> Reader<'j> {
    /// A problem in the form of HeteroMRTA.
    pub(crate) fn hetero(&mut self, name: &str) -> Option<Problem> {
        let skills = self.count("num_skills", Skills::BITS as usize);
        let [robots, tasks] = ["robots", "tasks"].map(|field| self.rows(field));
        let skills = skills?;
        let mut robot = |(at, robot): (usize, &'j Value)| {
            let pose = self.place(&format!("robots.{at}.pose"), robot.get("pose"));
            (pose, self.skillset(&format!("robots.{at}.skillset"), robot.get("skillset"), skills))
        };
        let (starts, robots): (Vec<[f64; 2]>, Vec<Skills>) =
            robots.into_iter().enumerate().map(&mut robot).unzip();
        let none =
            robots.iter().fold(if self.bad.is_empty() { Skills::MAX } else { 0 }, |none, of| none & !of);
        let mut task = |(at, task): (usize, &'j Value)| {
            let pos = self.place(&format!("tasks.{at}.pos"), task.get("pos"));
            (pos, self.task(&format!("tasks.{at}"), task, skills, none))
        };
        let (places, tasks): (Vec<[f64; 2]>, Vec<Task>) =
            tasks.into_iter().enumerate().map(&mut task).unzip();
        // Location 0 is the start of the first robot; those of the others come after the tasks.
        let (first, others) = starts.split_first()?;
        let places = [&[*first], places.as_slice(), others].concat();
        let start = |robot: usize| if robot == 0 { 0 } else { tasks.len() + robot };
        let robot = |(at, skills): (usize, Skills)| Robot { skills, start: start(at), end: start(at) };
        let robots = robots.into_iter().enumerate().map(robot).collect();
        let mut travel = Problem::distances(&places);
        travel.iter_mut().flatten().for_each(|time| *time /= SPEED);
        Some(Problem { name: name.to_owned(), skills, robots, tasks, places, travel })
    }

    /// A number of the setup, from 1 on.
    fn count(&mut self, key: &str, most: usize) -> Option<usize> {
        let value = self.json.get("setup").and_then(|setup| setup.get(key));
        let count = value.and_then(Value::as_u64).and_then(|count| usize::try_from(count).ok());
        let count = count.filter(|count| (1..=most).contains(count));
        if count.is_none() {
            let rule = if most == usize::MAX { "at least 1".to_owned() } else { format!("1 to {most}") };
            self.refuse(format!("setup.{key}"), format!("be a whole number, {rule}"), found(value));
        }
        count
    }

    /// The robots or tasks, as many as the setup says.
    fn rows(&mut self, field: &str) -> Vec<&'j Value> {
        let count = self.count(field, usize::MAX);
        count.map_or(Vec::new(), |count| self.keyed(field, self.json.get(field), count))
    }

    /// The values of an object with the keys 0, 1, ...; none if it has others.
    fn keyed(&mut self, field: &str, value: Option<&'j Value>, count: usize) -> Vec<&'j Value> {
        let map = value.and_then(Value::as_object);
        let with_count = map.filter(|map| map.len() == count);
        let rows = with_count.and_then(|map| (0..count).map(|key| map.get(&key.to_string())).collect());
        if rows.is_none() {
            let is_known = |key: &str| key.parse().is_ok_and(|at: usize| at < count && at.to_string() == key);
            let shown = map.map_or(found(value), |map| {
                let other = map.keys().find(|key| !is_known(key));
                let other = other.map_or(String::new(), |key| format!(", one of them {key:?}"));
                format!("{} in all{other}", map.len())
            });
            self.refuse(field, format!("have the keys 0 to {} (see setup)", count - 1), shown);
        }
        rows.unwrap_or_default()
    }

    fn place(&mut self, field: &str, value: Option<&Value>) -> [f64; 2] {
        let mut axis =
            |axis: &str| self.number(format!("{field}.{axis}"), value.and_then(|place| place.get(axis)));
        [axis("x"), axis("y")]
    }

    fn skillset(&mut self, field: &str, value: Option<&'j Value>, count: usize) -> Skills {
        let mut skills = 0;
        for (skill, has) in self.keyed(field, value, count).into_iter().enumerate() {
            match has.as_f64() {
                Some(0.0) => {}
                Some(1.0) => skills |= 1 << skill,
                _ => self.refuse(format!("{field}.{skill}"), "be 0 or 1", has),
            }
        }
        skills
    }

    /// A task. No robot has the skills of `none`.
    fn task(&mut self, field: &str, value: &'j Value, skills: usize, none: Skills) -> Task {
        let duration = self.number(format!("{field}.duration"), value.get("duration"));
        if duration < 0.0 {
            self.refuse(format!("{field}.duration"), "be at least 0", duration);
        }
        let before = self.bad.len();
        let skillset = format!("{field}.skillset");
        let requires = self.skillset(&skillset, value.get("skillset"), skills);
        if requires == 0 && self.bad.len() == before {
            self.refuse(&skillset, "require a skill", "only 0");
        }
        for skill in (0..skills).filter(|skill| (requires & none) >> skill & 1 == 1) {
            self.refuse(format!("{skillset}.{skill}"), "be 0, because no robot has this skill", 1);
        }
        Task { requires, duration, after: Vec::new() }
    }
}
