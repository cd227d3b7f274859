//! Shows a running trial on one screen of a terminal, drawn in place.

use std::fmt::Write;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use usar_sim::mission::Activity;
use usar_sim::simulation::Simulation;
use usar_sim::world::RescueeState;

use ron_tree::visible;

/// Time between two drawings.
const PERIOD: Duration = Duration::from_millis(100);

/// The clock is checked once in this many steps.
const CLOCK_STEPS: u64 = 8;

/// Limits of the screen: robots that have a line, and columns of a line.
const MOST_ROBOTS: usize = 16;
const COLUMNS: usize = 79;

/// The screen. Nothing is drawn if stderr is not a terminal.
pub(super) struct Live {
    bar: ProgressBar,
    policy: String,
    begun: Instant,
    drawn: Option<Instant>,
}

impl Live {
    pub(super) fn begin(policy: &str) -> Self {
        let bar = ProgressBar::new_spinner();
        let plain =
            ProgressStyle::with_template("{msg}").unwrap_or_else(|_| ProgressStyle::default_spinner());
        bar.set_style(plain);
        Self { bar, policy: policy.to_owned(), begun: Instant::now(), drawn: None }
    }

    /// Draws the screen if enough time has passed. Call it after each step.
    pub(super) fn listen(&mut self, simulation: &Simulation) {
        if self.bar.is_hidden() || !simulation.steps().is_multiple_of(CLOCK_STEPS) {
            return;
        }
        if self.drawn.is_none_or(|drawn| drawn.elapsed() > PERIOD) {
            let speed = simulation.time_s() / self.begun.elapsed().as_secs_f64().max(1e-6);
            self.bar.set_message(screen(simulation, &self.policy, speed));
            self.bar.tick();
            self.drawn = Some(Instant::now());
        }
    }

    /// Clears the screen.
    pub(super) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

/// The text of the screen: the time, the groups, the robots.
fn screen(simulation: &Simulation, policy: &str, speed: f64) -> String {
    let (scenario, mission) = (simulation.scenario(), simulation.mission());
    let clock = |seconds: f64| format!("{}:{:02}", seconds as u64 / 60, seconds as u64 % 60);
    let rounds = simulation.decisions().len();
    let mut lines = vec![format!(
        "{}, {policy}, seed {}   {} of {}   {speed:.0} times as fast   round {rounds}",
        scenario.name,
        simulation.seed(),
        clock(simulation.time_s()),
        clock(scenario.duration_s),
    )];
    let rescuees: Vec<_> = simulation.world().rescuees.iter().collect();
    for (task, model) in scenario.tasks.iter().zip(&simulation.model().tasks) {
        let own = &rescuees[model.rescuees.clone()];
        let on_board = own.iter().filter(|one| matches!(one.state, RescueeState::OnBoard(_))).count();
        let rescued = own.iter().filter(|one| one.state == RescueeState::Rescued).count();
        let share = if own.is_empty() { 0.0 } else { rescued as f64 / own.len() as f64 };
        lines.push(format!(
            "{:12} {} {rescued} of {} {}, {on_board} on board",
            short(&task.name, 12),
            bar(share, 20),
            own.len(),
            scenario.words.text("rescued")
        ));
    }
    for (robot, agent) in simulation.world().robots.iter().zip(&mission.crew.agents).take(MOST_ROBOTS) {
        let role = &scenario.roles[simulation.model().robots[robot.id.index()].role.index()];
        let task = agent.task.map_or("", |task| scenario.tasks[task.index()].name.as_str());
        let [energy, hp] = [robot.energy, robot.hp].map(|level| bar(level / 100.0, 10));
        let mut line = format!(
            "{:>4} {:10} {:10} energy {energy} {} {hp} ",
            robot.id.0,
            short(&role.name, 10),
            short(task, 10),
            scenario.words.text("HP")
        );
        let _ = write!(line, "{}", doing(agent.activity));
        lines.push(line);
    }
    let more = simulation.world().robots.len().saturating_sub(MOST_ROBOTS);
    if more > 0 {
        lines.push(format!("     and {more} robots more"));
    }
    let lines: Vec<String> = lines.iter().map(|line| short(&visible(line), COLUMNS)).collect();
    lines.join("\n")
}

fn doing(activity: Activity) -> &'static str {
    match activity {
        Activity::Home => "home",
        Activity::Searching => "searching",
        Activity::Approaching(_) => "approaching",
        Activity::Loading(..) => "loading",
        Activity::Standby => "standby",
        Activity::OnErrand => "on errand",
        Activity::Returning => "returning",
        Activity::ToRest => "to rest",
        Activity::Resting(_) => "resting",
    }
}

/// The first characters of a text.
fn short(text: &str, most: usize) -> String {
    text.chars().take(most).collect()
}

/// A share as a bar with this many characters.
fn bar(share: f64, width: usize) -> String {
    let full = (share.clamp(0.0, 1.0) * width as f64).round() as usize;
    "█".repeat(full) + &"░".repeat(width - full)
}

#[cfg(test)]
mod tests {

    use scenario::Scenario;

    use super::*;

    #[test]
    fn a_screen_has_the_time_the_tasks_and_the_robots_in_80_columns() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let mut simulation = Simulation::new(&Scenario::load(&path).unwrap().0, 1).unwrap();
        let mut policy = policies::standard().open("RNE").unwrap();
        (0..500).for_each(|_| drop(simulation.step(&mut *policy)));
        let screen = screen(&simulation, "RNE", 12.0);
        let lines: Vec<&str> = screen.lines().collect();
        assert_eq!(lines.len(), 1 + 2 + 12);
        assert!(
            lines[0].starts_with("paper, RNE, seed 1   0:10 of 10:00   12 times as fast   round 1"),
            "{screen}"
        );
        assert!(lines.iter().all(|line| line.chars().count() < 80), "{screen}");
        assert_eq!((bar(0.5, 4), bar(7.0, 2), bar(-1.0, 2)), ("██░░".into(), "██".into(), "░░".into()));
    }
}
