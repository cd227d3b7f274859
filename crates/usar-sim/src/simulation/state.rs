//! Everything that changes in a trial, and the stages of a step that change it.

use std::sync::Arc;

use parry2d::math::Vector;
use scenario::{LevelSource, MissionEnd};
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::charge::{bearable, last_event, spend};
use super::faults::Faults;
use super::moments::Moments;
use crate::belief::{Beliefs, Holder, KnownRobot};
use crate::conflict::{self, Delay, Mover, PriorityKey, Resolver};
use crate::event::{Event, EventLog};
use crate::executor::Executor;
use crate::hash::{ABSENT, HashChain, PARTS, part};
use crate::metrics::Metrics;
use crate::mission::{Activity, Agent, Mission, Scene};
use crate::model::Model;
use crate::navigation::{Navigator, Outlook};
use crate::record::DecisionRecord;
use crate::report::{Report, Track};
use crate::robot::STANDING_MPS;
use crate::sensors::{base, look_around, oneself, team_mates};
use crate::tally::{Tally, delay_cause};
use crate::telemetry::Telemetry;
use crate::world::{Rescuee, RescueeState, Robot, World};

/// Difference between two sums of the same costs that counts as rounding, as a share.
const COSTS_ROUNDING: f64 = 1e-9;

/// A robot beside a way has seen after this time that it is open, in seconds.
const SEEN_AFTER_S: f64 = 4.0;

/// Everything that changes in a trial. Snapshots hold it, and the hash chain covers it.
#[derive(Serialize, Deserialize)]
pub(crate) struct State {
    pub(super) step: u64,
    pub(super) world: World,
    /// Reports that are under way.
    pub(super) sent: Vec<Report>,
    pub(super) beliefs: Beliefs,
    pub(super) mission: Mission,
    pub(super) navigator: Navigator,
    pub(super) resolver: Resolver,
    /// Whether a step has begun but is not finished, because a question waits.
    pub(super) is_midway: bool,
    pub(super) log: EventLog,
    pub(super) timeline: Moments,
    /// What is wrong with robots by events of the timeline.
    pub(super) faults: Faults,
    /// What robots say of themselves, where the base does not know how they are.
    pub(super) telemetry: Option<Box<Telemetry>>,
    pub(super) chain: HashChain,
    pub(super) listeners: Listeners,
}

/// What steps work with. It is empty between steps, apart from what only saves time.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) heard: Vec<Report>,
    movers: Vec<Mover<'static>>,
    conflict: conflict::Scratch,
    tracks: Vec<Track>,
    /// See [`Simulation::steer`](super::Simulation::steer).
    pub(super) steering: Option<Vec<Vector>>,
}

impl Scratch {
    /// Has the steps of a large team done on all threads.
    pub(super) fn use_all_threads(&mut self) {
        self.conflict.executor = Executor::Threads;
    }
}

/// What listens to a trial and acts on nothing: the hash chain leaves it out, so that a new counter changes
/// no hash.
#[derive(Serialize, Deserialize)]
pub(crate) struct Listeners {
    pub(super) metrics: Metrics,
    /// The groupings so far, with the accounts of the policies.
    pub(super) decisions: Vec<DecisionRecord>,
}

#[cfg(test)]
impl State {
    pub(crate) fn step(&self) -> u64 {
        self.step
    }

    pub(crate) fn listeners(&self) -> &Listeners {
        &self.listeners
    }

    pub(crate) fn chain_mut(&mut self) -> &mut HashChain {
        &mut self.chain
    }
}

impl State {
    /// The state before the first step: all robots at home.
    pub(super) fn new(model: &Model) -> Self {
        let world = World::build(model);
        let holders = Holder::count(model.mission.belief_sharing, model.tasks.len(), model.robots.len());
        let tallies = model.robots.iter().map(|robot| Tally::new(robot.initial_levels)).collect();
        Self {
            step: 0,
            sent: model.task_ids().map(|task| base::report(&world, model, task, 0)).collect(),
            beliefs: Beliefs::nothing(holders, &model.inflation, &model.robots),
            mission: Mission::new(model),
            navigator: Navigator::new(world.robots.len()),
            resolver: Resolver::new(&model.right_of_way),
            is_midway: false,
            log: EventLog::default(),
            timeline: Moments::of(model),
            faults: Faults::default(),
            telemetry: Telemetry::of(model),
            chain: HashChain::default(),
            listeners: Listeners { metrics: Metrics::new(model.tasks.len(), tallies), decisions: Vec::new() },
            world,
        }
    }

    /// Restores everything that a snapshot leaves out because it is fixed or follows from the rest. This is
    /// the only place that does so.
    pub(super) fn restore(&mut self, model: &Model) {
        let World { robots, debris, rescuees, .. } = &mut self.world;
        for ((robot, known), model) in robots.iter_mut().zip(&mut self.beliefs.team).zip(&model.robots) {
            robot.model = Arc::clone(model);
            known.restore(model);
        }
        debris.iter_mut().zip(&model.debris).for_each(|(piece, model)| piece.model = Arc::clone(model));
        rescuees.iter_mut().zip(&model.rescuees).for_each(|(rescuee, model)| rescuee.model = *model);
        self.world.restore(model);
        self.beliefs.draw_maps(&model.inflation);
        self.mission.crew.look_for_guides(&model.mission, &self.beliefs.team);
    }

    /// The mission, and the scene in which it decides.
    pub(super) fn scene<'s>(&'s mut self, model: &'s Model) -> (&'s mut Mission, Scene<'s>) {
        let (mission, scene, _) = self.scene_in_world(model);
        (mission, scene)
    }

    /// The same, and the world around them for their sensors.
    fn scene_in_world<'s>(&'s mut self, model: &'s Model) -> (&'s mut Mission, Scene<'s>, &'s World) {
        let Self {
            mission, beliefs, sent, navigator, resolver, log, step, timeline, telemetry, world, ..
        } = self;
        let telemetry = telemetry.as_deref_mut();
        let awaits_event = timeline.is_to_come(model);
        let seen = || step.saturating_sub(model.steps_in(SEEN_AFTER_S));
        let awaits_opening = !timeline.is_empty() && timeline.opens_after(seen(), model);
        let (step, directives) = (*step, resolver.directives());
        let scene = Scene {
            model,
            beliefs,
            sent,
            navigator,
            directives,
            log,
            telemetry,
            step,
            awaits_event,
            awaits_opening,
        };
        (mission, scene, world)
    }

    /// Passes the events of this step from the `from`-th on to the metrics. Returns the number of all events.
    pub(super) fn listen(&mut self, from: usize, dt_s: f64) -> usize {
        let events = self.log.events();
        self.listeners.metrics.listen(&events[from..], &self.world, self.step as f64 * dt_s);
        events.len()
    }

    /// Robots look around and report; the groups and the team at home hear.
    pub(super) fn sense(&mut self, model: &Model, heard: &mut Vec<Report>) {
        let Self { world, mission, beliefs, sent, step, .. } = self;
        look_around(world, model, |robot| beliefs.of(mission.crew.holder_of(robot.id, model)), *step, sent);
        self.hear(model, heard);
    }

    /// Robots notice their own state, and say so to the whole team.
    pub(super) fn feel(&mut self, model: &Model, heard: &mut Vec<Report>) {
        self.notice_selves();
        self.hear(model, heard);
    }

    /// Robots notice their own state, and the whole team hears at once what is new of it.
    pub(super) fn notice_selves(&mut self) {
        for robot in &self.world.robots {
            if let Some(state) = oneself::sense(robot, &self.beliefs.team[robot.id.index()]) {
                self.beliefs.hear_of_self(state, self.step);
            }
        }
    }

    /// The reports that were sent are heard: by those who share the belief of their sender, and by its mates
    /// when the radio brings them.
    pub(super) fn hear(&mut self, model: &Model, heard: &mut Vec<Report>) {
        heard.append(&mut self.sent);
        self.say(heard, model);
        self.hear_mates(model);
        self.believe(heard, model);
    }

    /// Those who share the belief of a sender take its reports into account.
    fn believe(&mut self, heard: &mut Vec<Report>, model: &Model) {
        let Self { mission, beliefs, log, .. } = self;
        for report in heard.drain(..) {
            let is_news = beliefs.hear(&report, |robot| mission.crew.holder_of(robot, model));
            log.extend(Event::of_report(&report).filter(|_| is_news));
        }
    }

    /// Robots look at their mates and say how they are; the base hears them.
    pub(super) fn report(&mut self, model: &Model) {
        let (mission, mut scene, world) = self.scene_in_world(model);
        let sighted_mps = |by, of| team_mates::sighted_mps(world, by, of);
        mission.with_telemetry(&mut scene, |telemetry, now, log| telemetry.step(sighted_mps, now, log));
    }

    /// Whether nobody is left to bring home and no event is to come. Who is on board of a robot that can no
    /// longer act cannot be brought home.
    fn is_done(&self, model: &Model) -> bool {
        let Self { world, timeline, .. } = self;
        let is_left = |rescuee: &Rescuee| match rescuee.state {
            RescueeState::Waiting => true,
            RescueeState::OnBoard(robot) => world.robots[robot.index()].is_able(),
            RescueeState::Rescued | RescueeState::Absent => false,
        };
        let ends_when_done = model.mission.ends == MissionEnd::WhenDone;
        ends_when_done && !timeline.is_to_come(model) && !world.rescuees.iter().any(is_left)
    }

    /// Rounds end and begin; the base restocks robots.
    pub(super) fn prepare(&mut self, model: &Model) {
        let is_done = self.is_done(model);
        let (mission, mut scene) = self.scene(model);
        for robot in mission.prepare(is_done, &mut scene) {
            self.world.restock(robot);
        }
    }

    pub(super) fn plan(&mut self, model: &Model, scratch: &mut Scratch) {
        let (mission, beliefs, faults) = (&self.mission, &self.beliefs, &self.faults);
        let outlook = Outlook {
            model,
            team: &beliefs.team,
            step: self.step,
            belief_of: |robot| beliefs.of(mission.crew.holder_of(robot, model)),
            speed_of: |robot: &KnownRobot| faults.speed_of(robot.id, mission.crew.speed_of(model, robot)),
        };
        self.navigator.plan(&outlook, scratch.conflict.executor);
    }

    /// Decides which robots go and which wait, and notes why robots stop.
    pub(super) fn resolve(&mut self, model: &Model, scratch: &mut Scratch) {
        let (mission, beliefs, navigator) = (&self.mission, &self.beliefs, &self.navigator);
        let mut movers: Vec<Mover> = std::mem::take(&mut scratch.movers);
        let of = |robot: &KnownRobot| mover(robot, model, mission, beliefs, navigator);
        scratch.conflict.executor.for_team(beliefs.team.len()).extend(&mut movers, &beliefs.team, of);
        if !self.faults.is_empty() {
            self.faults.slow(&mut movers);
        }
        if self.telemetry.is_some() {
            self.say_levels(model, &mut movers);
        }
        for (mover, track) in movers.iter_mut().zip(team_mates::tracks(&self.world)) {
            (mover.position, mover.velocity) = (track.position, track.velocity);
        }
        for (mover, wish) in movers.iter_mut().zip(scratch.steering.iter().flatten()) {
            let is_able = self.world.robots[mover.robot.index()].is_able();
            mover.preferred = if is_able { wish.clamp_length_max(mover.speed) } else { Vector::ZERO };
        }
        let rules = &model.right_of_way;
        let directives = self.resolver.resolve(rules, &mut movers, &mut scratch.conflict, &mut self.log);
        for ((robot, directive), tally) in
            self.world.robots.iter().zip(directives).zip(&mut self.listeners.metrics.robots)
        {
            let traveller = navigator.traveller(robot.id);
            let activity = mission.crew.agents[robot.id.index()].activity;
            let cause = delay_cause(robot, activity, traveller, *directive);
            tally.note_delay(Delay { cause, waits_for: directive.waits_for() }, traveller.stalled_steps());
        }
        scratch.movers = movers.into_iter().map_while(|_| None).collect(); // empty, in the same memory
    }

    /// Where robots go first by their levels, they may go by what they said of them.
    fn say_levels(&self, model: &Model, movers: &mut [Mover<'_>]) {
        let (Some(telemetry), Some(rules)) = (&self.telemetry, &model.telemetry) else { return };
        if rules.priority == LevelSource::Truth {
            return;
        }
        for mover in movers {
            let class = class_of(self.mission.crew.agents[mover.robot.index()].task, model);
            let levels = telemetry.levels(rules, mover.robot);
            mover.priority = PriorityKey::new(model.right_of_way.priority, mover.robot, class, levels);
        }
    }

    /// Robots adapt their velocities to how the others move now.
    pub(super) fn adapt(&mut self, scratch: &mut Scratch) {
        scratch.tracks.clear();
        scratch.tracks.extend(team_mates::tracks(&self.world));
        self.resolver.adapt(&scratch.tracks, &mut scratch.conflict);
    }

    /// Changes each robot's velocity towards that of its directive, as far as its acceleration allows.
    pub(super) fn drive(&mut self) {
        for (robot, directive) in self.world.robots.iter().zip(self.resolver.directives()) {
            let wished = if robot.is_able() { directive.velocity() } else { Vector::ZERO };
            let change = wished - robot.velocity;
            let change = change.clamp_length_max(robot.spec.greatest_change);
            self.world.physics.drive(robot.id, change);
        }
    }

    /// Charges energy for moving and loading and HP for radiation and work. Robots whose energy or HP is 0
    /// can no longer act.
    pub(super) fn expose(&mut self, model: &Model) {
        let unit = model.costs.unit;
        let (metrics, faults) = (&mut self.listeners.metrics, &self.faults);
        let messages = self.telemetry.as_mut().map(|telemetry| telemetry.take_unpaid()).unwrap_or_default();
        let medium = model.telemetry.as_ref().and_then(|rules| rules.medium.as_ref());
        let message_energy = medium.map_or(0.0, |medium| medium.energy_per_message);
        for (robot, zones) in self.world.robots_in_zones(model) {
            let speed = robot.velocity.length();
            metrics.robots[robot.id.index()].note_step(f64::from(speed) * model.dt_s());
            let agent = &self.mission.crew.agents[robot.id.index()];
            if !robot.is_able() || matches!(agent.activity, Activity::Resting(_)) {
                continue;
            }
            let [energy, hp] = step_costs(model, agent, robot, speed, zones);
            let messages = messages.get(&robot.id).map_or(0.0, |count| f64::from(*count) * message_energy);
            let energy = faults.energy_of(robot.id, energy + messages);
            let percent = [unit.to_percent(energy, robot.spec.energy), unit.to_percent(hp, robot.spec.hp)];
            let [energy, hp] = bearable(robot, percent, &model.mission);
            if energy > 0.0 || hp > 0.0 {
                spend(robot, [energy, hp], unit, metrics);
            }
            self.log.extend(last_event(robot, &model.mission));
        }
    }

    /// Checks that what the robots spent is what the trial was charged.
    pub(super) fn check_costs(&self) -> Result<(), String> {
        let metrics = &self.listeners.metrics;
        let spent = metrics.robots.iter().map(|robot| robot.spent);
        let spent = spent.fold([0.0; 2], |[energy, hp], own| [energy + own[0], hp + own[1]]);
        for ((what, robots), trial) in ["energy", "HP"].into_iter().zip(spent).zip(metrics.spent()) {
            if (robots - trial).abs() > COSTS_ROUNDING * (1.0 + trial) {
                return Err(format!("the robots spent {robots} {what}, the trial was charged {trial}"));
            }
        }
        Ok(())
    }

    /// The hash of the events and, if there is a timeline, of the timeline and what it changed.
    fn part_of_events(&self) -> u128 {
        let (world, timeline) = (&self.world, &self.timeline);
        if timeline.is_empty() {
            return part(&self.log);
        }
        if self.faults.is_empty() {
            return part(&(&self.log, timeline, world.changed_by_events()));
        }
        part(&(&self.log, timeline, world.changed_by_events(), &self.faults))
    }

    fn part_of_mission(&self) -> u128 {
        let (mission, is_midway) = (&self.mission, self.is_midway);
        match mission.talks() {
            None => part(&(mission.course(), is_midway)),
            Some(talks) => part(&(mission.course(), is_midway, talks)),
        }
    }

    /// Adds a link to the hash chain.
    pub(super) fn add_link(&mut self) {
        if self.chain.links().last().is_some_and(|link| link.step == self.step) {
            return;
        }
        let parts = self.parts();
        self.chain.add(self.step, parts);
    }

    /// The hash of each part of the state, in the order of [`PARTS`].
    pub(crate) fn parts(&self) -> [u128; PARTS.len()] {
        [
            part(&self.world.physics.motions()),
            part(&self.world.robots),
            part(&self.world.lying_debris()),
            part(&(self.world.rescuees.digest(), self.mission.claims.held(), &self.world.loading)),
            part(&(self.beliefs.to_hash(), &self.sent, self.world.changes())),
            self.part_of_mission(),
            part(&self.navigator.to_hash()),
            part(&self.resolver),
            self.part_of_events(),
            self.telemetry.as_ref().map_or(ABSENT, |telemetry| telemetry.digest()),
        ]
    }
}

/// Energy and HP that a step at this speed costs a robot in `zones` overlapping radiation zones, in the unit
/// of the scenario's costs.
fn step_costs(model: &Model, agent: &Agent, robot: &Robot, speed: f32, zones: usize) -> [f64; 2] {
    let mut costs = model.costs.of_step(speed, speed > STANDING_MPS, zones);
    if matches!(agent.activity, Activity::Loading(..)) {
        costs[0] += model.costs.loading_energy;
    }
    let is_at_work =
        || agent.task.is_some_and(|task| model.tasks[task.index()].area.contains(robot.position));
    if model.costs.work_hp > 0.0 && is_at_work() {
        costs[1] += model.costs.work_hp;
    }
    costs
}

/// The rank of a robot's task; after all tasks if it has none.
fn class_of(task: Option<TaskId>, model: &Model) -> u8 {
    task.map_or(model.tasks.len() as u8, |task| model.tasks[task.index()].rank)
}

/// A robot as the resolver sees it.
fn mover<'s>(
    robot: &KnownRobot,
    model: &Model,
    mission: &'s Mission,
    beliefs: &'s Beliefs,
    navigator: &'s Navigator,
) -> Mover<'s> {
    let speed = mission.crew.speed_of(model, robot) as f32;
    let preferred = if robot.is_able() { navigator.preferred_velocity(robot, speed) } else { Vector::ZERO };
    let route = navigator.traveller(robot.id).route();
    let agent = &mission.crew.agents[robot.id.index()];
    let class = class_of(agent.task, model);
    let rule = model.right_of_way.priority;
    let is_busy = matches!(agent.activity, Activity::Loading(..) | Activity::Resting(_));
    Mover {
        robot: robot.id,
        aerial: robot.is_aerial(),
        position: robot.position,
        velocity: robot.velocity,
        preferred,
        retreat_left: None,
        stalled_steps: navigator.traveller(robot.id).stalled_steps() as u32,
        leg_left: route.map_or(0.0, |route| (route.ahead()[0] - robot.position).length()),
        route: route.map_or(&[], |route| route.ahead()),
        passages: navigator.traveller(robot.id).passages(),
        trail: navigator.trail(robot.id),
        radius: robot.radius(),
        speed,
        brakes: robot.spec.brakes,
        priority: PriorityKey::new(rule, robot.id, class, [robot.energy, robot.hp]),
        known: (!robot.is_aerial())
            .then(|| beliefs.of(mission.crew.holder_of(robot.id, model)).obstacles(robot.radius())),
        can_make_room: robot.is_able() && !is_busy,
    }
}
