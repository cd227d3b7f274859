//! Events in words, and as lines of JSON.

use scenario::{DebrisFile, ZoneFile};
use serde::Serialize;
use serde_json::{Map, Value};
use usar_sim::event::{CutOffCause, Event, Place, ReturnCause, TurnBackCause};
use usar_sim::ids::RobotId;
use usar_sim::simulation::Simulation;

/// An event with its time, its name and a sentence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ToldEvent {
    /// Simulated time at which the event had happened, in seconds.
    pub time_s: f64,
    /// The step at whose end it had happened.
    pub step: u64,
    /// Its kind in snake case, for example `made_room`.
    pub event: String,
    /// The event in a sentence.
    pub says: String,
    /// The other data of the event, by the names of the fields of [`Event`].
    #[serde(flatten)]
    pub fields: Map<String, Value>,
}

/// What events in words call by its name, each kind in the order of its numbers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Names<'a> {
    /// Names of the tasks.
    pub tasks: &'a [&'a str],
    /// The debris, of which some has a name.
    pub debris: &'a [DebrisFile],
    /// The radiation zones, of which some have names.
    pub zones: &'a [ZoneFile],
}

impl Names<'_> {
    fn task(&self, number: usize) -> &str {
        self.tasks.get(number).copied().unwrap_or("?")
    }

    fn debris(&self, number: u32) -> String {
        let name = self.debris.get(number as usize).and_then(|debris| debris.name.clone());
        name.unwrap_or_else(|| format!("debris {number}"))
    }

    fn zone(&self, number: u32) -> String {
        let name = self.zones.get(number as usize).and_then(|zone| zone.name.clone());
        name.unwrap_or_else(|| format!("radiation {number}"))
    }
}

impl ToldEvent {
    /// An event that had happened at the end of a step.
    pub fn new(step: u64, dt_s: f64, event: &Event, names: Names) -> Self {
        let (name, fields) = match serde_json::to_value(event) {
            Ok(Value::Object(kinds)) => kinds.into_iter().next().unwrap_or_default(),
            Ok(Value::String(name)) => (name, Value::Null),
            _ => Default::default(),
        };
        let fields = if let Value::Object(fields) = fields { fields } else { Map::new() };
        let time_s = (step as f64 * dt_s * 1e6).round() / 1e6;
        Self { time_s, step, event: snake(&name), says: sentence(event, names), fields }
    }

    /// The ids of the robots that the event concerns.
    pub fn robots(&self) -> Vec<u64> {
        let one = ["robot", "room_for", "resource_of"]
            .into_iter()
            .filter_map(|name| self.fields.get(name)?.as_u64());
        let many = self.fields.get("robots").and_then(Value::as_array).into_iter().flatten();
        let mut robots: Vec<u64> = one.chain(many.filter_map(Value::as_u64)).collect();
        robots.dedup();
        robots
    }

    /// The value of a numeric field.
    pub fn number(&self, field: &str) -> Option<u64> {
        self.fields.get(field)?.as_u64()
    }
}

fn snake(name: &str) -> String {
    let mut out = String::new();
    for (at, c) in name.char_indices() {
        if c.is_uppercase() && at > 0 {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// Robots by their ids, as in `robots 0, 1 and 4`.
fn robots_in_words(robots: &[u32]) -> String {
    match robots {
        [] => "no robot".to_owned(),
        [one] => format!("robot {one}"),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(u32::to_string).collect();
            format!("robots {} and {last}", first.join(", "))
        }
    }
}

fn set(robots: &[RobotId]) -> String {
    robots_in_words(&robots.iter().map(|robot| robot.0).collect::<Vec<_>>())
}

fn listener(to: Option<RobotId>) -> String {
    to.map_or_else(|| "the base".to_owned(), |robot| format!("robot {robot}"))
}

/// An event in a sentence without its time and without a full stop.
fn sentence(event: &Event, names: Names) -> String {
    let task = |task: usize| names.task(task);
    let at = |[x, y]: [f32; 2]| format!("({x:.1}, {y:.1})");
    match event {
        Event::RoundStarted { round, groups } => {
            let groups = groups.iter().enumerate().map(|(i, group)| format!("{}: {}", task(i), set(group)));
            format!("round {round} begins; {}", groups.collect::<Vec<_>>().join("; "))
        }
        Event::RoundEnded { round } => format!("round {round} is over"),
        Event::GroupReturned { task: number, cause } => {
            let cause: &ReturnCause = cause;
            format!("the group of {} goes home: {}", task(number.index()), cause.name())
        }
        Event::Restocked { robot, resources } => format!("robot {robot} takes resources: {resources}"),
        Event::DebrisDiscovered { robot, debris } => {
            format!("robot {robot} notices {}", names.debris(*debris))
        }
        Event::ZoneDiscovered { robot, zone } => format!("robot {robot} notices {}", names.zone(*zone)),
        Event::Sighted { robot, rescuee } => format!("robot {robot} sees rescuee {}", rescuee.0),
        Event::Loaded { robot, rescuee, .. } => format!("robot {robot} has rescuee {} on board", rescuee.0),
        Event::Delivered { robot, rescuee, place } => {
            let place = match place {
                Place::Home => "home",
                Place::Rest => "to a rest place",
            };
            format!("robot {robot} has brought rescuee {} {place}", rescuee.0)
        }
        Event::TurnedBack { robot, cause } => match cause {
            TurnBackCause::Energy => format!("robot {robot} turns back: energy"),
            TurnBackCause::Hp => format!("robot {robot} turns back: HP"),
        },
        Event::RestStarted { robot } => format!("robot {robot} begins to rest"),
        Event::RestEnded { robot } => format!("robot {robot} has rested"),
        Event::Stranded { robot } => format!("robot {robot} has no energy left"),
        Event::Disabled { robot } => format!("robot {robot} has no HP left"),
        Event::ConflictStarted { robots } => format!("{} come into conflict", set(robots)),
        Event::Deadlocked { robots } => format!("{} are deadlocked", set(robots)),
        Event::MadeRoom { robot, room_for } => format!("robot {robot} makes room for robot {room_for}"),
        Event::TurnPassed { robots } => format!("the turn passes among {}", set(robots)),
        Event::BackedOff { robots } => format!("{} back off", set(robots)),
        Event::ErrandDone { robot } => format!("robot {robot} has arrived"),
        Event::Unreachable { robot, place } => format!("robot {robot} gives up on the place {}", at(*place)),
        Event::CutOff { robot, place, cause } => {
            let cause: &CutOffCause = cause;
            format!("the team no longer waits for robot {robot}, which {} to {}", cause.name(), at(*place))
        }
        Event::Finished => "all is done".to_owned(),
        Event::MissionOver => "no robot that can carry is left".to_owned(),
        Event::Standstill => "no round can begin, and no robot gets anywhere: the trial ends".to_owned(),
        Event::DebrisFell { debris } => format!("{} falls", names.debris(*debris)),
        Event::WayClosed { debris } => format!("a way closes: {}", names.debris(*debris)),
        Event::WayOpened { debris } => format!("a way opens: {} is gone", names.debris(*debris)),
        Event::CalledOff { debris } => format!("{} stays away: its way is to be open", names.debris(*debris)),
        Event::SourceAppeared { zone } => format!("{} appears", names.zone(*zone)),
        Event::SourceDied { zone } => format!("{} dies", names.zone(*zone)),
        Event::Damaged { robot, energy, hp } => {
            format!("robot {robot} is damaged: it loses {energy:.1} % energy and {hp:.1} % HP")
        }
        Event::RescueesAppeared { task: number, first, count } => {
            format!("{count} rescuees appear in {}, from rescuee {first} on", task(number.index()))
        }
        Event::TaskBegan { task: number } => format!("task {} begins", task(number.index())),
        Event::TaskEnded { task: number } => format!("task {} ends", task(number.index())),
        Event::Heard { robot, to, sent_s } => {
            format!("{} hears what robot {robot} sent at {sent_s:.2} s", listener(*to))
        }
        Event::Lost { robot, to } => format!("a message of robot {robot} to {} is lost", listener(*to)),
        Event::BeganToLie { robot } => format!("robot {robot} begins to lie"),
        Event::BecameHonest { robot } => format!("robot {robot} tells no more lies"),
        Event::Slowed { robot, factor } => {
            format!("robot {robot} has {:.0} % of its speed left", 100.0 * factor)
        }
        Event::Faded { robot, factor } => format!("robot {robot} spends {factor} times the energy"),
        Event::Muted { robot } => format!("the radio of robot {robot} breaks"),
    }
}

/// The events of the last step of a simulation, in words.
pub fn told(simulation: &Simulation) -> impl Iterator<Item = ToldEvent> + '_ {
    let scenario = simulation.scenario();
    let tasks: Vec<&str> = scenario.tasks.iter().map(|task| task.name.as_str()).collect();
    let (step, dt_s) = (simulation.steps(), scenario.dt_s);
    let layout = simulation.layout();
    simulation.events().iter().map(move |event| {
        let names = Names { tasks: &tasks, debris: &layout.debris, zones: &layout.zones };
        ToldEvent::new(step, dt_s, event, names)
    })
}

#[cfg(test)]
mod tests {
    use scenario::DebrisShape;
    use teaming::TaskId;

    use super::*;

    #[test]
    fn an_event_is_told_with_its_fields() {
        let event = Event::MadeRoom { robot: RobotId(3), room_for: RobotId(1) };
        let told = ToldEvent::new(125, 0.02, &event, Names::default());
        assert_eq!((told.time_s, told.event.as_str(), told.robots()), (2.5, "made_room", vec![3, 1]));
        let line = serde_json::to_string(&told).unwrap();
        let expected = concat!(
            r#"{"time_s":2.5,"step":125,"event":"made_room","says":"robot 3 makes room for robot 1","#,
            r#""robot":3,"room_for":1}"#
        );
        assert_eq!(line, expected);
        let returned = Event::GroupReturned { task: TaskId(0), cause: ReturnCause::NothingLeft };
        let told = ToldEvent::new(1, 1.0, &returned, Names { tasks: &["north"], ..Names::default() });
        assert_eq!(told.says, "the group of north goes home: nothing left");
        assert_eq!(ToldEvent::new(1, 1.0, &Event::Finished, Names::default()).event, "finished");
        let slab = DebrisFile {
            shape: DebrisShape::Disc(1.0),
            at: [0.0; 2],
            rotation_deg: 0.0,
            movable: None,
            name: Some("slab".to_owned()),
        };
        let names = Names { debris: &[slab], ..Names::default() };
        let says = |debris| ToldEvent::new(1, 1.0, &Event::DebrisFell { debris }, names).says;
        assert_eq!([says(0), says(1)], ["slab falls", "debris 1 falls"]);
        assert_eq!(robots_in_words(&[0, 2, 5]), "robots 0, 2 and 5");
    }
}
