use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use scenario::BeliefSharing;
use teaming::TaskId;

use super::*;
use crate::ids::{RescueeId, RobotId};
use crate::planning::Inflation;
use crate::report::{Report, Speaker, Statement};

fn belief() -> Belief {
    Belief::nothing(&Inflation { radii: vec![0.4], clearance: 0.15 })
}

fn says(says: Statement, at_step: u64) -> Report {
    Report { from: Speaker::Robot(RobotId(3)), says, at_step, sd_m: 0.0 }
}

fn ball(debris: u32, x: f32, at_step: u64) -> Report {
    let (shape, pose) = (SharedShape::ball(1.0), Pose::from_translation(Vector::new(x, 0.0)));
    says(Statement::DebrisLies { debris, shape, pose }, at_step)
}

#[test]
fn the_newest_report_counts_in_whatever_order_reports_are_heard() {
    let heard = |order: [usize; 3]| {
        let reports = [ball(7, 10.0, 5), ball(7, 20.0, 15), ball(7, 30.0, 10)];
        let mut belief = belief();
        let newer = order.map(|at| belief.hear(&reports[at]));
        (belief.debris.get(7).unwrap().pose.translation.x, newer)
    };
    assert_eq!(heard([0, 1, 2]), (20.0, [true, true, false]));
    assert_eq!(heard([2, 0, 1]), (20.0, [true, false, true]));
    assert_eq!(heard([1, 2, 0]), (20.0, [true, false, false]));
}

#[test]
fn a_thing_that_does_not_exist_and_one_at_a_wrong_place_stand_in_the_way_like_any_other() {
    let mut belief = belief();
    belief.hear(&ball(1_000, 10.0, 1)); // no world has a piece of this number here
    let (a, b) = (Vector::new(0.0, 0.0), Vector::new(20.0, 0.0));
    assert!(belief.obstacles(0.4).cuts(a, b));
    let shifted = b + Vector::new(20.0, 0.0);
    belief.hear(&ball(1_000, 30.0, 2));
    assert!(!belief.obstacles(0.4).cuts(a, b) && belief.obstacles(0.4).cuts(b, shifted));
    assert_eq!(belief.debris.iter().count(), 1);
}

#[test]
fn the_same_place_again_is_no_news() {
    let mut belief = belief();
    belief.hear(&ball(0, 10.0, 1));
    let seen = belief.seen();
    assert!(belief.hear(&ball(0, 10.0, 2)) && belief.news_since(seen).is_empty());
    belief.hear(&ball(0, 11.0, 3));
    assert_eq!(belief.news_since(seen).len(), 2, "the old place is free, the new one is not");
}

#[test]
fn a_rescuee_waits_until_a_later_report_says_that_it_is_gone() {
    let (rescuee, at) = (RescueeId(2), Vector::new(1.0, 2.0));
    let mut belief = belief();
    assert!(belief.rescuees.get(2).is_none());
    belief.hear(&says(Statement::RescueeWaits { rescuee, at }, 10));
    belief.hear(&says(Statement::RescueeIsGone { rescuee }, 9));
    assert_eq!(belief.rescuees.get(2).unwrap().waits_at, Some(at));
    belief.hear(&says(Statement::RescueeIsGone { rescuee }, 11));
    assert_eq!(belief.rescuees.get(2).unwrap().waits_at, None);
}

fn waits(number: u32, x: f32, sd_m: f32, at_step: u64) -> Report {
    let at = Vector::new(x, 0.0);
    Report { sd_m, ..says(Statement::RescueeWaits { rescuee: RescueeId(number), at }, at_step) }
}

#[test]
fn exact_reports_give_one_order_in_whatever_order_things_are_found() {
    let found = |order: &[u32]| {
        let mut belief = belief();
        order.iter().for_each(|number| assert!(belief.hear(&waits(*number, 0.1 * *number as f32, 0.0, 1))));
        belief.waiting_among(&(0..9)).to_vec()
    };
    assert_eq!(found(&[0, 1, 2, 3, 4]), found(&[4, 3, 2, 1, 0]));
}

#[test]
fn sightings_within_the_gate_are_one_rescuee_and_the_best_of_them_counts() {
    let mut belief = belief();
    assert!(belief.hear(&waits(20, 10.0, 1.0, 1)));
    assert!(!belief.hear(&waits(30, 11.0, 1.0, 2)), "the same, seen no better");
    assert!(belief.hear(&waits(30, 11.0, 0.5, 3)), "the same, seen better");
    assert_eq!(belief.waiting_among(&(0..99)), [(RescueeId(20), Vector::new(11.0, 0.0))]);
    assert!(belief.hear(&waits(30, 14.0, 0.5, 4)), "3.0 m apart; the gate is 3 sd + 0.3 m = 2.4 m");
    assert_eq!(belief.waiting_among(&(0..99)).len(), 2);
    assert!(belief.hear(&waits(5, 11.2, 0.0, 5)), "an exact sight has the true number");
    let numbers: Vec<u32> = belief.waiting_among(&(0..99)).iter().map(|(id, _)| id.0).collect();
    assert_eq!(numbers, [5, 30]);
}

#[test]
fn pooled_beliefs_hold_the_newest_of_each_and_survive_a_snapshot() {
    let inflation = Inflation { radii: vec![0.4, 0.8], clearance: 0.15 };
    let mut beliefs = Beliefs::nothing(2, &inflation, &[]);
    let sharing = BeliefSharing::WithGroup;
    let group = |robot: RobotId| (robot.0 < 2).then(|| Holder::of(sharing, robot, TaskId(robot.0 as u16)));
    let by = |robot: u32, report: Report| Report { from: Speaker::Robot(RobotId(robot)), ..report };
    beliefs.hear(&by(0, ball(0, 10.0, 1)), group);
    beliefs.hear(&by(1, ball(0, 20.0, 2)), group);
    beliefs.hear(&by(1, ball(1, 40.0, 2)), group);
    assert!(beliefs.of(None).debris.iter().next().is_none(), "nobody has come home yet");
    beliefs.pool();
    let written = postcard::to_stdvec(&beliefs).unwrap();
    let mut again: Beliefs = postcard::from_bytes(&written).unwrap();
    again.draw_maps(&inflation);
    for beliefs in [&beliefs, &again] {
        let home = beliefs.of(None);
        let places: Vec<f32> = home.debris.iter().map(|(_, known)| known.pose.translation.x).collect();
        assert_eq!(places, [20.0, 40.0]);
        assert!(home.obstacles(0.8).cuts(Vector::new(15.0, 0.0), Vector::new(25.0, 0.0)));
        assert!(!home.obstacles(0.8).cuts(Vector::new(5.0, 0.0), Vector::new(15.0, 0.0)));
    }
}
