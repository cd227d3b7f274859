//! A problem: robots, tasks, and the ways between their locations.

/// A set of skills, a bit for each.
pub type Skills = u64;

/// A robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Robot {
    /// Its skills.
    pub skills: Skills,
    /// The location where it begins; that of no task.
    pub start: usize,
    /// The location to which it goes after its last task.
    pub end: usize,
}

/// A task.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// The skills that its group must have together; at least one.
    pub requires: Skills,
    /// How long it takes.
    pub duration: f64,
    /// The tasks that must be over before it starts.
    pub after: Vec<usize>,
}

/// A problem of task allocation. Locations are numbered: task j is at j + 1, and the others are those where
/// robots begin and end.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Its name.
    pub name: String,
    /// How many skills there are.
    pub skills: usize,
    /// The robots.
    pub robots: Vec<Robot>,
    /// The tasks.
    pub tasks: Vec<Task>,
    /// The place of each location.
    pub places: Vec<[f64; 2]>,
    /// The time of travel from each location to each location.
    pub travel: Vec<Vec<f64>>,
}

impl Problem {
    /// The location after those of all tasks.
    #[must_use]
    pub fn last(&self) -> usize {
        self.tasks.len() + 1
    }

    /// The skills of some robots together.
    pub(crate) fn skills_of<'r>(&self, robots: impl IntoIterator<Item = &'r usize>) -> Skills {
        robots.into_iter().fold(0, |skills, robot| skills | self.robots[*robot].skills)
    }

    /// For each task, how long it and the longest chain of tasks after it take, with the way from there to
    /// the nearest end of a robot that has a skill for the last one.
    #[must_use]
    pub fn tails(&self) -> Vec<f64> {
        let way = |(task, of): (usize, &Task)| {
            let able = self.robots.iter().filter(|robot| robot.skills & of.requires != 0);
            able.map(|robot| self.travel[task + 1][robot.end]).fold(f64::INFINITY, f64::min)
        };
        let mut tails: Vec<f64> = self.tasks.iter().enumerate().map(way).collect();
        // As many rounds as the longest chain has tasks.
        for _ in 0..self.tasks.len() {
            let before = tails.clone();
            for (task, of) in self.tasks.iter().enumerate() {
                let own = of.duration + before[task];
                of.after.iter().for_each(|first| tails[*first] = tails[*first].max(own));
            }
            if tails == before {
                break;
            }
        }
        tails.iter().zip(&self.tasks).map(|(tail, task)| tail + task.duration).collect()
    }

    /// The distance of each pair of places.
    #[must_use]
    pub fn distances(places: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let distance = |a: &[f64; 2], b: &[f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        places.iter().map(|from| places.iter().map(|to| distance(from, to)).collect()).collect()
    }
}
