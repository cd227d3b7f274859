//! A trial step by step.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use experiments::metric::task_names;
use experiments::oracle::{BranchError, LIMITS, Objective, play, survey};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use teaming::{Assignment, Deadline, Decision, Session};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{Advance, Simulation as Trial};
use usar_sim::world::Robot;

use crate::answer::asked;
use crate::arrays::{array, points, vectors};
use crate::scenario::Scenario;
use crate::trial::{recorded, to_its_end};
use crate::waiting::{Call, on_threads};

/// How long steps are done before signals are looked at.
const PERIOD: Duration = Duration::from_millis(50);

/// The policy's name in a record of a trial that Python drives.
const BY_HAND: &str = "by hand";

/// An assignment that the oracle played: its groups, and its value.
type Played = (Vec<Vec<u32>>, Option<f64>);

/// A trial step by step.
///
/// >>> import usar
/// >>> trial = usar.Simulation(usar.Scenario.builtin("paper").set(duration_s=120), seed=1)
/// >>> while question := trial.until_asked():
/// ...     trial.assign(usar.group(question, "ENG"))
/// >>> trial.record()
/// <usar.Record of by hand, seed 1: 40 rescued, completed>
#[pyclass(module = "usar._usar")]
pub struct Simulation {
    pub(crate) it: Trial,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scenario, seed=1))]
    fn new(scenario: &Scenario, seed: u64) -> PyResult<Self> {
        let it = Trial::new(&scenario.it, seed).map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Self { it })
    }

    /// Do steps until the team is to be grouped, and return the question; None once the trial is over.
    fn until_asked<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.advance(py, u64::MAX)?;
        self.question(py)
    }

    /// The question that waits, if there is one.
    #[getter]
    fn question<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.it.question().map(|question| asked(py, question)).transpose()
    }

    /// Answer the question that waits: the ids of each task's group.
    fn assign(&mut self, groups: &Bound<'_, PyAny>) -> PyResult<()> {
        let decision = Decision::of(crate::answer::groups(groups)?);
        self.it.assign(decision).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Do so many steps, fewer where a question waits or the trial is over; return how many were done.
    #[pyo3(signature = (n=1))]
    fn step(&mut self, py: Python<'_>, n: u64) -> PyResult<u64> {
        let begun = self.it.steps();
        self.advance(py, begun.saturating_add(n))?;
        Ok(self.it.steps() - begun)
    }

    /// From now on, robots wish these velocities in metres a second (a row each), up to their top speeds, and
    /// the right of way applies to them as the scenario says; with None, they go along their routes again. A
    /// fork goes along routes.
    #[pyo3(signature = (velocities))]
    fn steer(&mut self, velocities: Option<Bound<'_, PyAny>>) -> PyResult<()> {
        let robots = self.it.world().robots.len();
        self.it.steer(velocities.map(|given| vectors(&given, robots)).transpose()?);
        Ok(())
    }

    /// The same trial once more, which goes on by itself.
    fn fork(&self) -> Self {
        Self { it: self.it.checkpoint().resume() }
    }

    /// The record of this trial if a policy decides from here on. The trial itself stays where it is.
    #[pyo3(signature = (policy=None), text_signature = "(self, policy='RNE')")]
    fn finish<'py>(&self, py: Python<'py>, policy: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        to_its_end(py, self.it.checkpoint().resume(), policy)
    }

    /// Play every assignment of the question that waits to the end of its round, on all cores, and return
    /// each with its value, the best first. Of more than `limit` assignments, a sample is played and the best
    /// of it improved.
    #[pyo3(signature = (metric="rescuees.total", limit=1000))]
    fn oracle(&self, py: Python<'_>, metric: &str, limit: u64) -> PyResult<Vec<Played>> {
        let Some(question) = self.it.question() else {
            return Err(PyValueError::new_err("no question waits for an answer"));
        };
        let objective = Objective::parse(metric, &task_names(self.it.scenario()));
        let objective = objective.map_err(|error| PyValueError::new_err(error.to_string()))?;
        if !LIMITS.contains(&limit) {
            let [least, most] = [LIMITS.start(), LIMITS.end()];
            let message = format!("limit must be from {least} to {most}, found {limit}");
            return Err(PyValueError::new_err(message));
        }
        let call = Call::new();
        let (start, stop) = (self.it.checkpoint(), Arc::clone(&call.stop));
        let one = |assignment: &Assignment| {
            let onwards = None::<&mut Box<dyn Session>>;
            play(&start, Decision::of(assignment.clone()), onwards, Deadline::when(&stop))
        };
        let played = |batch: &[Assignment]| batch.par_iter().map(one).collect::<Result<_, BranchError>>();
        let work = || on_threads(usize::MAX, || survey(question, &objective, limit, &[], played));
        let played = call.wait_for(py, |_| Ok(()), work)??;
        let played = played.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let ranked = played.ranked(&objective).into_iter();
        Ok(ranked.map(|one| (one.assignment.groups.clone(), objective.value(&one.outcome))).collect())
    }

    /// The record of the trial, once it is over.
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Some(status) = self.it.ending() else {
            return Err(PyValueError::new_err("the trial is not over; finish(policy) goes on to its end"));
        };
        let record = TrialRecord { status, ..self.it.checkpoint().resume().finish() };
        recorded(py, &record, &self.it.given().name, BY_HAND)
    }

    /// Hash of every state up to now: equal for equal trials, bit for bit.
    #[getter]
    fn state_hash(&self) -> String {
        self.it.checkpoint().resume().finish().state_hash
    }

    /// Seed of the trial.
    #[getter]
    fn seed(&self) -> u64 {
        self.it.seed()
    }

    /// Simulated time, in seconds.
    #[getter]
    fn time_s(&self) -> f64 {
        self.it.time_s()
    }

    /// Steps done.
    #[getter]
    fn steps(&self) -> u64 {
        self.it.steps()
    }

    /// How the trial ended; None while it goes on.
    #[getter]
    fn status(&self) -> Option<&'static str> {
        self.it.ending().map(|status| status.name())
    }

    /// Rescuees delivered, and energy and HP spent, by the whole team up to now.
    #[getter]
    fn totals(&self) -> (u32, f64, f64) {
        let metrics = self.it.metrics();
        let [energy, hp] = metrics.ungrouped;
        metrics.tasks.iter().fold((0, energy, hp), |(rescued, energy, hp), task| {
            (rescued + task.rescued, energy + task.energy, hp + task.hp)
        })
    }

    /// Time from one decision of robots on their velocities to the next, in seconds.
    #[getter]
    fn control_period_s(&self) -> f64 {
        self.it.model().control_period_s()
    }

    /// For each robot, the next point of its route, in metres; where it is for a robot without one.
    #[getter]
    fn waypoints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let next = |robot: &Robot| {
            let route = self.it.navigator().traveller(robot.id).route();
            route.and_then(|route| route.ahead().first()).unwrap_or(&robot.position).to_array()
        };
        points(py, self.it.world().robots.iter().map(next))
    }

    /// For each robot, its present top speed in metres a second, if no fault slows it.
    #[getter]
    fn top_speeds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (crew, model) = (&self.it.mission().crew, self.it.model());
        let speeds = self.it.world().robots.iter().map(|robot| crew.speed_of(model, robot) as f32);
        array(py, "float32", 1, speeds.flat_map(f32::to_ne_bytes).collect())
    }

    /// For each robot, x and y in metres.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.it.world().robots.iter().map(|robot| robot.position.to_array()))
    }

    /// For each robot, its velocity in metres a second.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        points(py, self.it.world().robots.iter().map(|robot| robot.velocity.to_array()))
    }

    /// For each robot, energy and HP in percent.
    #[getter]
    fn levels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let levels =
            self.it.world().robots.iter().map(|robot| [robot.energy, robot.hp].map(f64::to_ne_bytes));
        array(py, "float64", 2, levels.flatten().flatten().collect())
    }

    /// For each robot, the rescuees on board.
    #[getter]
    fn carried<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let carried = self.it.world().robots.iter().map(|robot| (robot.load.len() as u32).to_ne_bytes());
        array(py, "uint32", 1, carried.flatten().collect())
    }

    /// For each robot, whether it can act.
    #[getter]
    fn able<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, "bool", 1, self.it.world().robots.iter().map(|robot| u8::from(robot.is_able())).collect())
    }

    /// What the team at home holds true: a dict with the places in metres of `rescuees` that are held to
    /// wait, of `debris`, and of `radiation` with its radius.
    #[getter]
    fn beliefs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let belief = self.it.beliefs().of(None);
        let rescuees = belief.rescuees.iter().filter_map(|(_, known)| known.waits_at);
        let debris = belief.debris.iter().map(|(_, known)| known.pose.translation.to_array());
        let zones = belief.zones_on().iter().map(|(_, zone)| [zone.center.x, zone.center.y, zone.radius]);
        let beliefs = PyDict::new(py);
        beliefs.set_item("rescuees", points(py, rescuees.map(|place| place.to_array()))?)?;
        beliefs.set_item("debris", points(py, debris)?)?;
        beliefs.set_item("radiation", points(py, zones)?)?;
        Ok(beliefs)
    }
}

impl Simulation {
    /// Does steps until a question waits or the trial is over.
    fn to_question(trial: &mut Trial, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) && matches!(trial.advance(), Advance::Running) {}
    }

    /// Does steps until so many are done, a question waits, or the trial is over.
    fn advance(&mut self, py: Python<'_>, last: u64) -> PyResult<()> {
        let mut is_there = false;
        while !is_there {
            is_there = py.detach(|| {
                let begun = Instant::now();
                while begun.elapsed() < PERIOD {
                    let goes_on = self.it.steps() < last && matches!(self.it.advance(), Advance::Running);
                    if !goes_on {
                        return true;
                    }
                }
                false
            });
            py.check_signals()?;
        }
        match self.it.ending() {
            Some(Status::Failed(reason)) => Err(PyRuntimeError::new_err(reason)),
            _ => Ok(()),
        }
    }
}

/// Advance several trials, on this number of threads at most, until each asks or is over.
#[pyfunction]
pub fn advance_all(
    py: Python<'_>,
    mut trials: Vec<PyRefMut<'_, Simulation>>,
    threads: usize,
) -> PyResult<()> {
    let call = Call::new();
    let stop = Arc::clone(&call.stop);
    let mut trials: Vec<&mut Trial> = trials.iter_mut().map(|trial| &mut trial.it).collect();
    let threads = threads.min(trials.len());
    let work = || trials.par_iter_mut().for_each(|trial| Simulation::to_question(trial, &stop));
    call.wait_for(py, |_| Ok(()), || on_threads(threads, work))?
}
