//! Robots with own starts and ends, seen by methods and policies.

use mrta::{Problem, Robot, Task, cbba, dispatch, earliest, optimum};
use teaming::question::Task as Asked;
use teaming::{Decision, PolicyError, Session, TrialStart};

/// Tasks of 1 at 1 and 3 on a line. Each robot begins at 0 and ends at one of these places. Location 0, which
/// no robot uses, is at 4.
fn on_a_line(ends: &[f64]) -> Problem {
    let places: Vec<[f64; 2]> = [4.0, 1.0, 3.0, 0.0].iter().chain(ends).map(|x| [*x, 0.0]).collect();
    let robots = (0..ends.len()).map(|end| Robot { skills: 1, start: 3, end: 4 + end }).collect();
    let task = Task { requires: 1, duration: 1.0, after: Vec::new() };
    let travel = Problem::distances(&places);
    Problem { name: "line".to_owned(), skills: 1, robots, tasks: vec![task; 2], places, travel }
}

/// A policy that is watched.
struct Watched {
    session: Box<dyn Session>,
    /// The last task of the first question.
    last: Option<Asked>,
}

impl Session for Watched {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.session.reset(trial)
    }

    fn decide(&mut self, asked: &teaming::Asked<'_>) -> Result<Decision, PolicyError> {
        self.last = self.last.take().or(asked.question.tasks.last().cloned());
        self.session.decide(asked)
    }
}

fn watched(problem: &Problem, policy: &str) -> (f64, Option<Asked>) {
    let session = policies::standard().parse(policy).unwrap().open().unwrap();
    let mut watched = Watched { session, last: None };
    (dispatch(problem, &mut watched).unwrap(), watched.last)
}

#[test]
fn a_robot_sets_out_from_its_own_start_and_goes_to_its_own_end() {
    let problem = on_a_line(&[4.0]);
    let dis = watched(&problem, "DIS").0;
    for found in [optimum(&problem).unwrap(), earliest(&problem), cbba(&problem), dis] {
        assert!((found - 6.0).abs() < 1e-9, "{found}");
    }
}

#[test]
fn the_task_end_is_at_the_centre_of_the_ends() {
    let last = watched(&on_a_line(&[2.0, 4.0, 9.0]), "DIS").1.unwrap();
    assert_eq!((last.name.as_str(), last.place), ("end", Some([5.0, 0.0])));
}
