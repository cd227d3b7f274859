//! Random valid scenarios of all kinds: one to four tasks or errands, walls and doors, radiation, scattered
//! objects, distributions instead of values, timelines. Each is run for a minute with every invariant
//! checked.

use std::fmt::Write;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::Scenario;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;

/// Simulated time of a trial, in seconds.
const DURATION_S: f64 = 60.0;

/// Number of texts that are tried before giving up. Random values need not be consistent.
const TRIES: u64 = 200;

const POLICIES: [&str; 5] = ["RNE", "DIS", "ENG", "HP_DIS", "RANDOM"];

const ROLES: &str = r#"
    roles: [
        (name: "carrier", observing_m: 3.0, capacity: 4),
        (name: "supplier", capacity: 1, resources: 10, radius_m: 0.3),
        (name: "observer", kind: Aerial, guides: true, mass_kg: 5.0, sensing_m: 18.0, observing_m: 6.0,
         capacity: 0, resources: 0),
    ],"#;

/// The result of a random scenario.
pub struct Ran {
    /// Text of the scenario.
    pub text: String,
    /// Number of earlier texts that were refused because their values were inconsistent.
    pub refused: u64,
    /// Number of events of its timeline.
    pub events: usize,
    /// Number of its distributions.
    pub draws: usize,
    /// Number of its tasks.
    pub tasks: usize,
    /// Number of objects that it scatters.
    pub scattered: usize,
    /// The violated invariant or other failure.
    pub violation: Option<String>,
}

/// Writes the scenario of a seed and runs a trial of it.
pub fn run(seed: u64) -> Ran {
    let (text, scenario, mut trial, refused) = start(seed);
    let policies = policies::standard();
    let named = policies.open(POLICIES[(seed % 5) as usize]).or_else(|_| policies.open("RNE"));
    let mut policy = named.expect("a policy of the paper");
    let status = loop {
        if let Some(status) = trial.step(&mut *policy) {
            break status;
        }
    };
    let violation = if let Status::Failed(reason) = status { Some(reason) } else { None };
    let (events, draws, tasks) = (scenario.timeline.len(), scenario.draws.len(), scenario.tasks.len());
    Ran { text, refused, events, draws, tasks, scattered: scenario.scatter.len(), violation }
}

/// The scenario of a seed.
pub fn scenario(seed: u64) -> Scenario {
    start(seed).1
}

/// The first text of a seed that is a valid scenario whose trial can begin.
fn start(seed: u64) -> (String, Scenario, Simulation, u64) {
    for attempt in 0..TRIES {
        let text = text(seed.wrapping_mul(1_000).wrapping_add(attempt));
        let Ok(scenario) = Scenario::parse(&text, "random.ron".as_ref()) else { continue };
        if let Ok(trial) = Simulation::new(&scenario, seed) {
            return (text, scenario, trial.checked(), attempt);
        }
    }
    panic!(
        "seed {seed}: no scenario in {TRIES} goes together, the last is\n{}",
        text(seed * 1_000 + TRIES - 1)
    );
}

/// A random text of a scenario; its values need not be consistent.
pub fn text(seed: u64) -> String {
    let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
    let arena = [random.number(40.0, 80.0), random.number(40.0, 70.0)];
    let mut text = format!(
        "(\n    format: 2,\n    name: \"random-{seed}\",\n    duration_s: {DURATION_S:?},\n    dt_s: \
         0.02,\n    arena_m: ({:?}, {:?}),\n{ROLES}\n",
        arena[0], arena[1]
    );
    let robots = team(&mut random, arena, &mut text);
    let tasks = if random.one_in(5) { 0 } else { random.count(1, 4) };
    if tasks == 0 {
        errands(&mut random, arena, robots, &mut text);
    } else {
        self::tasks(&mut random, arena, tasks, &mut text);
    }
    walls(&mut random, arena, &mut text);
    things(&mut random, arena, &mut text);
    timeline(&mut random, arena, robots, tasks, &mut text);
    if random.one_in(3) {
        text.push_str("    conflicts: (resolver: Rotation),\n");
    }
    if random.one_in(2) {
        let _ = writeln!(
            text,
            "    costs: (energy: (per_second: {:?}), hp: (per_second: 2.0)),",
            random.number(0.0, 1.5)
        );
    }
    text + ")\n"
}

struct Random(ChaCha8Rng);

impl Random {
    /// A number of two decimals.
    fn number(&mut self, least: f64, most: f64) -> f64 {
        (self.0.random_range(least..most) * 100.0).round() / 100.0
    }

    fn count(&mut self, least: u32, most: u32) -> u32 {
        self.0.random_range(least..=most)
    }

    fn one_in(&mut self, many: u32) -> bool {
        self.0.random_range(0..many) == 0
    }

    /// A number, or sometimes a distribution within the same bounds.
    fn value(&mut self, least: f64, most: f64) -> String {
        let middle = f64::midpoint(least, most);
        match self.count(0, 7) {
            0 => format!("Uniform({least:?}, {most:?})"),
            1 => format!("Truncated(Normal({middle:?}, {:?}), {least:?}, {most:?})", most - least),
            2 => format!("Choice([{least:?}, {most:?}])"),
            3 => format!("Clamped(Normal({middle:?}, {:?}), {least:?}, {most:?})", most - least),
            _ => format!("{:?}", self.number(least, most.max(least + 0.01))),
        }
    }

    /// A count, or sometimes a distribution of one.
    fn whole(&mut self, least: u32, most: u32) -> String {
        if self.one_in(3) { format!("Uniform({least}, {most})") } else { self.count(least, most).to_string() }
    }

    fn point(&mut self, low: [f64; 2], high: [f64; 2]) -> String {
        format!("({}, {})", self.value(low[0], high[0]), self.value(low[1], high[1]))
    }
}

/// Writes rows of robots near the lower wall; returns the least number of robots.
fn team(random: &mut Random, arena: [f64; 2], text: &mut String) -> u32 {
    let mut least = 0;
    text.push_str("    team: [\n");
    for (row, (role, most)) in [("carrier", 6), ("supplier", 3), ("observer", 2)].into_iter().enumerate() {
        let count = random.count(1, most);
        let drawn = random.one_in(4);
        least += if drawn { 1 } else { count };
        let count = if drawn { format!("Uniform(1, {count})") } else { count.to_string() };
        let levels = if random.one_in(3) {
            format!(", levels: (energy: {}, hp: {})", random.value(20.0, 100.0), random.value(40.0, 100.0))
        } else {
            String::new()
        };
        let body = if random.one_in(4) {
            format!(", body: (speed_mps: {})", random.value(1.0, 3.0))
        } else {
            String::new()
        };
        let (x, y) = (arena[0] / 2.0, 2.0 + 2.0 * row as f64);
        let _ = writeln!(
            text,
            "        (role: {role:?}, count: {count}, center: ({x:?}, {y:?}), width_m: 10.0{levels}{body}),"
        );
    }
    text.push_str("    ],\n");
    least
}

fn errands(random: &mut Random, arena: [f64; 2], robots: u32, text: &mut String) {
    text.push_str("    errands: [\n");
    for robot in 0..robots {
        let places: Vec<String> = (0..random.count(1, 3))
            .map(|_| random.point([2.0, 2.0], [arena[0] - 2.0, arena[1] - 2.0]))
            .collect();
        let _ = writeln!(text, "        (robot: {robot}, to: [{}]),", places.join(", "));
    }
    text.push_str("    ],\n");
}

fn tasks(random: &mut Random, arena: [f64; 2], tasks: u32, text: &mut String) {
    text.push_str("    tasks: [\n");
    let part = arena[0] / f64::from(tasks);
    for task in 0..tasks {
        let middle = part * (f64::from(task) + 0.5);
        let center = random.point([middle - 1.0, arena[1] - 6.0], [middle + 1.0, arena[1] - 4.0]);
        let (columns, rows) = (random.whole(1, 5), random.whole(0, 4));
        let quota = if random.one_in(4) {
            format!(", quota: {{\"carrier\": {}}}", random.count(0, 3))
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "        (name: \"t{task}\", difficulty: {task}, center: {center}, size_m: (6.0, 4.0), grid: \
             ({columns}, {rows}), rest: ({middle:?}, 14.0){quota}),",
        );
    }
    text.push_str("    ],\n");
}

/// Sometimes writes a wall across the arena, with doors that have names.
fn walls(random: &mut Random, arena: [f64; 2], text: &mut String) {
    if random.one_in(2) {
        return;
    }
    let doors = random.count(2, 4);
    let part = arena[0] / f64::from(doors);
    let door = |random: &mut Random, i: u32| {
        let closed = if i > 0 && random.one_in(4) { ", closed: true" } else { "" };
        format!(
            "(at_m: {:?}, width_m: {:?}, name: \"d{i}\"{closed})",
            part * (f64::from(i) + 0.5),
            random.number(1.5, 4.0)
        )
    };
    let all: Vec<String> = (0..doors).map(|i| door(random, i)).collect();
    let y = arena[1] * 0.6;
    // One door that no event closes.
    let _ = writeln!(
        text,
        "    walls: [(from: (3.0, {y:?}), to: ({:?}, {y:?}), doors: [{}])],",
        arena[0],
        all.join(", ")
    );
}

fn things(random: &mut Random, arena: [f64; 2], text: &mut String) {
    let within = format!("((2.0, 18.0), ({:?}, {:?}))", arena[0] - 2.0, arena[1] * 0.75);
    text.push_str("    scatter: [\n");
    for _ in 0..random.count(0, 3) {
        let what = if random.one_in(3) { "Radiation" } else { "Debris" };
        let place = ["Anywhere", "Grid", "Poisson(1.5)"][random.count(0, 2) as usize];
        let movable = if what == "Debris" && random.one_in(4) { ", movable: (mass_kg: 20.0)" } else { "" };
        let _ = writeln!(
            text,
            "        (what: {what}, count: {}, radius_m: {}, within: {within}, place: {place}{movable}),",
            random.whole(0, 8),
            random.value(0.4, 1.2)
        );
    }
    text.push_str("    ],\n    radiation: [\n");
    for i in 0..random.count(0, 3) {
        let at = random.point([0.0, 10.0], arena);
        let _ = writeln!(text, "        (at: {at}, radius_m: {}, name: \"z{i}\"),", random.value(1.0, 5.0));
    }
    text.push_str("    ],\n    debris: [\n");
    for i in 0..random.count(0, 3) {
        let at = random.point([4.0, 20.0], [arena[0] - 4.0, arena[1] * 0.7]);
        let shape = ["Disc(0.7)", "Box(2.0, 0.6)", "Polygon([(1.0, 0.0), (-0.5, 1.0), (-0.5, -1.0)])"]
            [random.count(0, 2) as usize];
        let _ = writeln!(
            text,
            "        (shape: {shape}, at: {at}, rotation_deg: {}, name: \"p{i}\"),",
            random.value(0.0, 180.0)
        );
    }
    text.push_str("    ],\n");
}

fn timeline(random: &mut Random, arena: [f64; 2], robots: u32, tasks: u32, text: &mut String) {
    text.push_str("    timeline: [\n");
    let [doors, zones, pieces] =
        ["d", "z", "p"].map(|letter| text.matches(&format!("name: \"{letter}")).count() as u32);
    for i in 0..random.count(0, 8) {
        let at = random.point([4.0, 16.0], [arena[0] - 4.0, arena[1] * 0.75]);
        let any = random.count(0, 20);
        let event = match random.count(0, 8) {
            0 => format!("DebrisFalls(shape: Disc({}), at: {at}, name: \"f{i}\")", random.value(0.3, 1.5)),
            1 if doors > 1 => format!("Closes(\"d{}\")", 1 + any % (doors - 1)),
            2 if doors > 1 => format!("Opens(\"d{}\")", 1 + any % (doors - 1)),
            3 => format!("SourceAppears(at: {at}, radius_m: {})", random.value(1.0, 5.0)),
            4 if zones > 0 => format!("SourceDies(\"z{}\")", any % zones),
            5 => format!("RobotFails({})", any % robots),
            6 if pieces > 0 => format!("Opens(\"p{}\")", any % pieces),
            7 if tasks > 1 => format!(
                "{}(\"t{}\")",
                if random.one_in(2) { "TaskBegins" } else { "TaskEnds" },
                1 + any % (tasks - 1)
            ),
            8 if tasks > 0 => {
                format!("RescueesAppear(task: \"t{}\", grid: (2, {}))", any % tasks, random.count(1, 3))
            }
            _ => format!(
                "RobotLoses(robot: {}, energy: {}, hp: {})",
                any % robots,
                random.value(0.0, 100.0),
                random.value(0.0, 60.0)
            ),
        };
        let _ = writeln!(text, "        (at_s: {}, event: {event}),", random.value(0.0, DURATION_S));
    }
    text.push_str("    ],\n");
}
