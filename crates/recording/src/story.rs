//! The story of a small scenario with errands, in a few sentences: which robots met, waited, made room and
//! arrived.

use std::collections::BTreeMap;

use usar_sim::conflict::DelayCause;
use usar_sim::event::Event;
use usar_sim::simulation::Simulation;

use crate::words::{robots_in_words, told};

/// A larger team has no story.
const LARGEST_TEAM: usize = 12;

/// Robots meet if the distance between them is less than the first, in metres, and part if it is more than
/// the second.
const MEET_M: f32 = 0.5;
const PART_M: f32 = 1.5;

/// Delays with a shorter break than this between them count as one, in seconds. Waits shorter than the second
/// limit are left out.
const BREAK_S: f64 = 1.0;
const SHORTEST_WAIT_S: f64 = 0.2;

/// Largest number of sentences.
const MOST: usize = 16;

/// Width of a line in columns.
const COLUMNS: usize = 80;

/// Events that the story mentions.
const TOLD: [&str; 14] = [
    "deadlocked",
    "turn_passed",
    "backed_off",
    "errand_done",
    "unreachable",
    "cut_off",
    "stranded",
    "debris_fell",
    "way_closed",
    "way_opened",
    "source_appeared",
    "source_died",
    "damaged",
    "standstill",
];

/// Two robots that come near each other.
#[derive(Debug)]
struct Meeting {
    begun_s: f64,
    nearest_m: f32,
    is_over: bool,
}

/// A robot that waits, or makes room, for another robot: start, end, and time without its breaks, in seconds.
#[derive(Debug)]
struct Spell {
    begun_s: f64,
    last_s: f64,
    total_s: f64,
}

/// The spells of each robot, by the robot for which it waits or makes room.
#[derive(Debug, Default)]
struct Spells(BTreeMap<(u32, u32), Vec<Spell>>);

impl Spells {
    fn add(&mut self, robot: u32, other: u32, time_s: f64, dt_s: f64) {
        let spells = self.0.entry((robot, other)).or_default();
        match spells.last_mut().filter(|spell| time_s - spell.last_s < BREAK_S) {
            Some(spell) => (spell.last_s, spell.total_s) = (time_s, spell.total_s + dt_s),
            None => spells.push(Spell { begun_s: time_s - dt_s, last_s: time_s, total_s: dt_s }),
        }
    }

    fn iter(&self) -> impl Iterator<Item = (&(u32, u32), &Spell)> {
        self.0.iter().flat_map(|(pair, spells)| spells.iter().map(move |spell| (pair, spell)))
    }
}

/// An event, and how often it happened.
#[derive(Debug)]
struct Happening {
    first_s: f64,
    times: u32,
}

/// The meetings, delays and events of a trial.
#[derive(Debug, Default)]
pub struct Story {
    meetings: BTreeMap<(u32, u32), Vec<Meeting>>,
    waits: Spells,
    making_room: Spells,
    /// For each robot that made room, the robot for which it last did.
    room_for: BTreeMap<u32, u32>,
    happenings: BTreeMap<String, Happening>,
}

impl Story {
    /// The story of a trial, if its team is small and it has errands.
    pub fn of(simulation: &Simulation) -> Option<Self> {
        let is_small = simulation.world().robots.len() <= LARGEST_TEAM;
        (is_small && !simulation.scenario().errands.is_empty()).then(Self::default)
    }

    /// Records a step. Call it after each step.
    pub fn listen(&mut self, simulation: &Simulation) {
        let time_s = simulation.time_s();
        self.listen_for_meetings(simulation, time_s);
        for event in simulation.events() {
            if let Event::MadeRoom { robot, room_for } = event {
                self.room_for.insert(robot.0, room_for.0);
            }
        }
        for (robot, delay) in (0..).zip(simulation.delays()) {
            let dt_s = simulation.scenario().dt_s;
            if delay.cause == DelayCause::MakingRoom {
                let head = self.room_for.get(&robot);
                head.into_iter().for_each(|head| self.making_room.add(robot, *head, time_s, dt_s));
            } else if let Some(other) = delay.waits_for {
                self.waits.add(robot, other.0, time_s, dt_s);
            }
        }
        for event in told(simulation).filter(|event| TOLD.contains(&event.event.as_str())) {
            let happening = Happening { first_s: event.time_s, times: 0 };
            self.happenings.entry(event.says).or_insert(happening).times += 1;
        }
    }

    fn listen_for_meetings(&mut self, simulation: &Simulation, time_s: f64) {
        let (robots, model) = (&simulation.world().robots, simulation.model());
        let roles = &simulation.scenario().roles;
        let role = |robot: usize| &roles[model.robots[robot].role.index()];
        for a in 0..robots.len() {
            for b in a + 1..robots.len() {
                if role(a).kind != role(b).kind {
                    continue;
                }
                let radii = (role(a).radius_m + role(b).radius_m) as f32;
                let between = (robots[a].position - robots[b].position).length() - radii;
                self.add_distance(a as u32, b as u32, between, time_s);
            }
        }
    }

    fn add_distance(&mut self, a: u32, b: u32, between: f32, time_s: f64) {
        let pair = (a, b);
        let underway =
            self.meetings.get_mut(&pair).and_then(|all| all.last_mut()).filter(|last| !last.is_over);
        if let Some(meeting) = underway {
            meeting.nearest_m = meeting.nearest_m.min(between);
            meeting.is_over = between > PART_M;
        } else if between < MEET_M {
            let meeting = Meeting { begun_s: time_s, nearest_m: between, is_over: false };
            self.meetings.entry(pair).or_default().push(meeting);
        }
    }

    /// The sentences in the order of time, each as lines of at most 80 columns.
    pub fn tell(&self) -> Vec<String> {
        let mut sentences: Vec<(f64, String)> = Vec::new();
        for ((a, b), meetings) in &self.meetings {
            sentences.extend(meetings.iter().map(|meeting| {
                let pair = robots_in_words(&[*a, *b]);
                let nearest = meeting.nearest_m.max(0.0);
                (
                    meeting.begun_s,
                    format!("{pair} meet; at the nearest there are {nearest:.2} m between them"),
                )
            }));
        }
        let waits = self.waits.iter().filter(|(_, wait)| wait.total_s >= SHORTEST_WAIT_S);
        sentences.extend(waits.map(|((robot, other), Spell { begun_s, total_s, .. })| {
            (*begun_s, format!("robot {robot} begins to wait for robot {other}, {total_s:.1} s in all"))
        }));
        sentences.extend(self.making_room.iter().map(|((robot, other), Spell { begun_s, total_s, .. })| {
            (*begun_s, format!("robot {robot} makes room for robot {other}, for {total_s:.1} s"))
        }));
        for (says, Happening { first_s, times }) in &self.happenings {
            let often = if *times > 1 { format!(", for the first of {times} times") } else { String::new() };
            sentences.push((*first_s, format!("{says}{often}")));
        }
        sentences.sort_by(|a, b| a.0.total_cmp(&b.0));
        let more = sentences.len().saturating_sub(MOST);
        let mut lines: Vec<String> = sentences
            .iter()
            .take(MOST)
            .flat_map(|(at, says)| fold(&format!("At {at:.1} s {says}.")))
            .collect();
        if more > 0 {
            lines.push(format!("And {more} things more: --events FILE.jsonl writes all."));
        }
        lines
    }
}

/// Folds a sentence into lines; all lines but the first are indented.
fn fold(sentence: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in sentence.split(' ') {
        let last = lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= COLUMNS);
        match last {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => line.extend([" ", word]),
            None => lines.push(format!("  {word}")),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waits_with_short_breaks_are_one_and_sentences_are_in_order() {
        let mut story = Story::default();
        for step in 0..100 {
            let time_s = 3.0 + f64::from(step) * 0.02;
            if !(40..60).contains(&step) {
                story.waits.add(1, 0, time_s, 0.02);
            }
        }
        story.waits.add(2, 0, 9.0, 0.02);
        story.making_room.add(2, 1, 5.0, 0.5);
        story.making_room.add(2, 1, 5.5, 0.5);
        for (between, time_s) in [(2.0, 0.0), (0.4, 1.0), (0.1, 2.0), (2.0, 3.0), (0.3, 8.0)] {
            story.add_distance(0, 1, between, time_s);
        }
        story.happenings.insert("robot 0 has arrived".into(), Happening { first_s: 4.0, times: 2 });
        assert_eq!(
            story.tell(),
            [
                "At 1.0 s robots 0 and 1 meet; at the nearest there are 0.10 m between them.",
                "At 3.0 s robot 1 begins to wait for robot 0, 1.6 s in all.",
                "At 4.0 s robot 0 has arrived, for the first of 2 times.",
                "At 4.5 s robot 2 makes room for robot 1, for 1.0 s.",
                "At 8.0 s robots 0 and 1 meet; at the nearest there are 0.30 m between them.",
            ]
        );
    }

    #[test]
    fn long_sentences_are_folded() {
        let lines = fold(&"word ".repeat(40));
        assert!(lines.len() == 3 && lines.iter().all(|line| line.chars().count() <= COLUMNS), "{lines:?}");
    }
}
