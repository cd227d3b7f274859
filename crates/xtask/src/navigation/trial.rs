//! One trial of a problem: the robots together, compared with each robot alone.

use std::path::Path;
use std::time::{Duration, Instant};

use experiments::Failure;
use scenario::{Row, Scenario, ScenarioFile};
use usar_sim::event::Event;
use usar_sim::invariant::RARE_OVERLAP_M;
use usar_sim::record::Status;
use usar_sim::simulation::{Advance, Simulation};
use usar_sim::stage::Stage;
use usar_sim::world::World;

use super::problems::Problem;

/// Distances between bodies, in metres: robots touch below the first, and a new touch counts only after
/// they were farther apart than the second.
const TOUCH_M: [f32; 2] = [0.002, 0.02];

/// The outcome of a trial.
pub struct Outcome {
    /// Number of robots with a goal.
    pub robots: usize,
    /// Number of robots that arrived.
    pub arrived: usize,
    /// Flow: the sum of the arrival times by the sum of the times that each robot needs alone. A robot that
    /// does not arrive counts with the limit.
    pub flow: f64,
    /// The limit, in seconds: five times the longest time alone, and half a minute.
    pub limit_s: f64,
    /// Time when the last robot arrived or gave up, or the limit, in seconds.
    pub time_s: f64,
    /// Number of goals given up, as unreachable or because their robots came no nearer.
    pub given_up: u32,
    /// Number of new touches, for each robot.
    pub touches: f64,
    /// The deepest overlap of bodies, in metres.
    pub deepest_m: f32,
    /// Whether bodies overlapped by more than a centimetre.
    pub overlapped: bool,
    /// Wall-clock time of a step for one robot, without checks, in microseconds.
    pub step_us: f64,
    /// Whether the trial was interrupted.
    pub failed: bool,
}

impl Outcome {
    /// Whether all robots arrived, and no bodies overlapped by more than a centimetre.
    pub fn is_ok(&self) -> bool {
        !self.failed && self.arrived == self.robots && !self.overlapped
    }
}

/// Fields of the scenario to set, with their values.
pub type Changes = [(String, String)];

/// Runs the instance of a seed, with these fields of its scenario set.
///
/// # Errors
/// A change that cannot be set, or a world in which a robot does not arrive even alone.
pub fn run(problem: &Problem, seed: u64, changes: &Changes) -> Result<Outcome, Failure> {
    let path = format!("{}.ron", problem.name);
    let text = problem.text(seed);
    let scenario = Scenario::parse(&text, Path::new(&path)).map_err(Failure::run)?;
    let mut file = (*scenario).clone();
    for (field, value) in changes {
        file.set(field, value).map_err(Failure::run)?;
    }
    let alone = |errand: usize| {
        let failed = |error| Failure::run(format!("{}, seed {seed}: {error}", problem.name));
        alone(&file, errand, seed).map_err(failed)
    };
    let free: Vec<f64> = (0..file.errands.len()).map(alone).collect::<Result<_, Failure>>()?;
    let limit_s = 5.0 * free.iter().copied().fold(0.0, f64::max) + 30.0;
    file.duration_s = limit_s;
    together(file, seed, free.iter().sum())
}

fn simulation(file: ScenarioFile, seed: u64) -> Result<Simulation, Failure> {
    let scenario = Scenario::try_from(file).map_err(|broken| Failure::run(format!("{broken:?}")))?;
    Simulation::new(&scenario, seed).map_err(Failure::run)
}

/// Time that a robot needs for its errand alone, in seconds.
fn alone(file: &ScenarioFile, errand: usize, seed: u64) -> Result<f64, Failure> {
    let mut file = file.clone();
    let mut errand = file.errands.swap_remove(errand);
    let robot: Row = file.team.swap_remove(errand.robot as usize);
    let id = std::mem::take(&mut errand.robot);
    (file.team, file.errands) = (vec![robot], vec![errand]);
    let mut simulation = simulation(file, seed)?;
    while let Advance::Running = simulation.advance() {
        if simulation.events().iter().any(|event| matches!(event, Event::ErrandDone { .. })) {
            return Ok(simulation.time_s());
        }
    }
    Err(Failure::run(format!("robot {id} does not arrive although it is alone")))
}

/// Runs all robots together, until the last one has arrived or given up.
fn together(file: ScenarioFile, seed: u64, free_s: f64) -> Result<Outcome, Failure> {
    let limit_s = file.duration_s;
    let goals: Vec<u32> = file.errands.iter().map(|errand| errand.robot).collect();
    let mut simulation = simulation(file, seed)?.checked();
    let mut nobody = policies::standard().open("RANDOM").map_err(Failure::run)?; // errands ask nothing
    let all = simulation.world().robots.len();
    let (mut arrivals, mut given_up) = (vec![None; all], vec![None; all]);
    let (mut touches, mut clock) = (Touches::new(all), Duration::ZERO);
    let failed = loop {
        let (start, mut end) = (Instant::now(), Duration::ZERO);
        let over = simulation.watch(&mut *nobody, |stage| {
            if stage != Stage::Record {
                end = start.elapsed();
            }
        });
        clock += end;
        if let Some(status) = over {
            break matches!(status, Status::Failed(_));
        }
        for event in simulation.events() {
            match event {
                Event::ErrandDone { robot } => arrivals[robot.index()] = Some(simulation.time_s()),
                Event::Unreachable { robot, .. } | Event::CutOff { robot, .. } => {
                    given_up[robot.index()] = Some(simulation.time_s());
                }
                _ => {}
            }
        }
        touches.note(simulation.world());
    };
    let times = goals.iter().map(|robot| arrivals[*robot as usize].unwrap_or(limit_s));
    let overlaps = simulation.overlaps().unwrap_or_default();
    Ok(Outcome {
        robots: goals.len(),
        arrived: arrivals.iter().flatten().count(),
        flow: times.sum::<f64>() / free_s,
        limit_s,
        time_s: simulation.time_s(),
        given_up: given_up.iter().flatten().count() as u32,
        touches: touches.count as f64 / all as f64,
        deepest_m: overlaps.deepest_m,
        overlapped: overlaps.deepest_m > RARE_OVERLAP_M,
        step_us: clock.as_secs_f64() * 1e6 / (simulation.steps() * all as u64) as f64,
        failed,
    })
}

/// Counts how often robots begin to touch one another.
struct Touches {
    /// For each pair, whether they touch.
    touching: Vec<bool>,
    /// Number of robots that began to touch another: each pair counts twice.
    count: u64,
}

impl Touches {
    fn new(robots: usize) -> Self {
        Self { touching: vec![false; robots * robots], count: 0 }
    }

    fn note(&mut self, world: &World) {
        let robots = &world.robots;
        for (i, a) in robots.iter().enumerate() {
            for (j, b) in robots.iter().enumerate().skip(i + 1) {
                let touching = &mut self.touching[i * robots.len() + j];
                let apart = (a.position - b.position).length() - a.radius() - b.radius();
                if !*touching && apart < TOUCH_M[0] {
                    self.count += 2;
                    *touching = true;
                } else if apart > TOUCH_M[1] {
                    *touching = false;
                }
            }
        }
    }
}
