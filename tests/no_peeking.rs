//! Decisions see reports: the truth is changed and the reports are not, and no decision changes.

use std::collections::BTreeSet;

use scenario::Scenario;
use teaming::{Asked, Decision, PolicyError, Session};
use usar_sim::event::Event;
use usar_sim::ids::{RescueeId, RobotId};
use usar_sim::mission::Activity;
use usar_sim::navigation::Goal;
use usar_sim::robot::ENERGY;
use usar_sim::simulation::{Advance, Simulation};
use usar_sim::world::RescueeState;

use crate::support::{paper, paper_with, policy};

/// Rescuees that their group believes to wait and that no robot claims.
fn believed(trial: &Simulation) -> Vec<RescueeId> {
    let of_task = |task: teaming::TaskId| {
        let known = &trial.beliefs_of(Some(task)).next().unwrap().rescuees;
        let own = trial.model().tasks[task.index()].rescuees.clone();
        own.filter(|id| known.get(*id).is_some_and(|known| known.waits_at.is_some()))
    };
    let ids = trial.model().task_ids().flat_map(of_task).map(|id| RescueeId(id as u32));
    ids.filter(|id| trial.mission().claims.by(*id).is_none()).collect()
}

/// The claim and the goal of each robot, until a robot is where it can touch what it claimed.
fn decisions(trial: &Simulation) -> Vec<(Option<RescueeId>, Option<Goal>)> {
    let agents = (0..).map(RobotId).zip(&trial.mission().crew.agents);
    agents.map(|(id, agent)| (agent.activity.claim(), trial.navigator().traveller(id).goal())).collect()
}

#[test]
fn robots_go_for_rescuees_that_are_gone_until_somebody_says_so() {
    let (scenario, mut rne) = (paper(), policy("RNE"));
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    while believed(&trial).is_empty() {
        assert_eq!(trial.step(&mut *rne), None);
    }
    let mut changed = trial.checkpoint().resume();
    let gone = believed(&changed);
    for id in &gone {
        changed.world_mut().rescuees[id.index()].state = RescueeState::Absent;
    }
    let mut chased = 0;
    loop {
        assert_eq!((trial.step(&mut *rne), changed.step(&mut *rne)), (None, None));
        if trial
            .mission()
            .crew
            .agents
            .iter()
            .any(|agent| matches!(agent.activity, Activity::Loading(id, _) if gone.contains(&id)))
        {
            break; // a robot touches what it claimed: from here on, the truth may tell
        }
        assert_eq!(decisions(&trial), decisions(&changed), "at {} s", trial.time_s());
        chased = gone.iter().filter(|id| changed.mission().claims.by(**id).is_some()).count();
    }
    assert!(chased > 0, "nobody went for a rescuee that is gone: the test shows nothing");
    (0..1_000).for_each(|_| assert_eq!(changed.step(&mut *rne), None));
    let known_gone = |id: &RescueeId| {
        let task = changed.world().rescuees[id.index()].task;
        let known = changed.beliefs_of(Some(task)).next().unwrap().rescuees.get(id.index());
        known.is_some_and(|known| known.waits_at.is_none())
    };
    assert!(gone.iter().any(known_gone), "who finds nobody there says so");
}

#[test]
fn the_question_has_what_robots_said_and_the_record_the_truth_beside_it() {
    let (scenario, mut rne) = (paper(), policy("RNE"));
    let mut asked = |change: &dyn Fn(&mut Simulation)| {
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        change(&mut trial);
        assert!(matches!(trial.advance(), Advance::Asks(_)));
        let question = trial.question().unwrap().clone();
        trial.assign(rne.decide(&Asked::of(&question)).unwrap()).unwrap();
        trial.decisions()[0].clone()
    };
    let honest = asked(&|_| {});
    let changed = asked(&|trial| trial.world_mut().robots[2].energy = 31.0); // it has not felt that yet
    assert_eq!((&honest.question, &honest.decision), (&changed.question, &changed.decision));
    assert_eq!((&honest.truth, honest.team()), (&None, honest.question.members.as_slice()));
    let levels: Vec<_> = changed.team().iter().map(|member| member.level(ENERGY)).collect();
    let said: Vec<_> = changed.question.members.iter().map(|member| member.level(ENERGY)).collect();
    assert_eq!((levels[2], &levels[3..]), (Some(31.0), &said[3..]));
    assert!(said[2] > levels[2]);
}

#[test]
fn robots_learn_of_a_team_mate_what_it_says() {
    let (scenario, mut rne) = (paper(), policy("RNE"));
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    (0..10).for_each(|_| assert_eq!(trial.step(&mut *rne), None));
    trial.world_mut().robots[2].energy = 31.0;
    assert!(trial.beliefs().team[2].energy > 31.0, "nobody can know yet");
    (0..5).for_each(|_| assert_eq!(trial.step(&mut *rne), None)); // to the next control step
    assert!(trial.beliefs().team[2].is_as(&trial.world().robots[2]));
}

/// Claims of 150 s on rescuees that the robot that claims them has not seen itself, nor heard of at the end
/// of a round; and the number of all claims.
fn claims_by_hearsay(scenario: &Scenario) -> [usize; 2] {
    let (mut trial, mut rne) = (Simulation::new(scenario, 1).unwrap().checked(), policy("RNE"));
    let (mut seen, mut pooled) = (BTreeSet::new(), BTreeSet::new());
    let (mut all, mut hearsay) = (BTreeSet::new(), BTreeSet::new());
    while trial.time_s() < 150.0 {
        assert_eq!(trial.step(&mut *rne), None);
        for event in trial.events() {
            if let Event::Sighted { robot, rescuee } = event {
                seen.insert((*robot, *rescuee));
            } else if let Event::RoundEnded { .. } = event {
                pooled.extend(seen.iter().map(|(_, rescuee)| *rescuee));
            }
        }
        let agents = (0..).map(RobotId).zip(&trial.mission().crew.agents);
        let claims: Vec<_> = agents.filter_map(|(id, agent)| Some((id, agent.activity.claim()?))).collect();
        let is_new = |claim: &&(RobotId, RescueeId)| !seen.contains(*claim) && !pooled.contains(&claim.1);
        hearsay.extend(claims.iter().filter(is_new).copied());
        all.extend(claims);
    }
    [hearsay.len(), all.len()]
}

#[test]
fn where_nobody_shares_beliefs_robots_go_only_for_what_they_have_seen_themselves() {
    let alone = paper_with(&[("    mission: (", "    mission: (belief_sharing: WithNobody,")]);
    let [hearsay, all] = claims_by_hearsay(&alone);
    assert!(hearsay == 0 && all > 10, "{hearsay} of {all}");
    let [hearsay, all] = claims_by_hearsay(&paper());
    assert!(hearsay > 0 && all > 10, "in a group, what one has seen all know: {hearsay} of {all}");
}

/// A session of one's own, of no driver, that answers by a rule and notes what it gets beside the question.
struct Looks<'s>(&'s mut dyn Session, &'s mut Vec<bool>);

impl Session for Looks<'_> {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.1.push(asked.truth().is_some() || asked.trial().is_some());
        self.0.decide(asked)
    }
}

#[test]
fn a_session_that_declares_nothing_gets_neither_the_truth_nor_the_trial() {
    let (mut rule, mut seen) = (policy("RANDOM"), Vec::new());
    let record = Simulation::new(&paper_with(&[("duration_s: 600.0", "duration_s: 200.0")]), 1).unwrap();
    let record = record.run(Looks(&mut *rule, &mut seen), |_, _, _| {});
    assert!(!record.decisions.is_empty() && seen == vec![false; record.decisions.len()]);
}
