//! RNE as a trust measure: between the groups of an assignment, and need by need.

use policies::RneOptions;
use policies::rne::Rne;
use teaming::{Policy, TrustMeasure};

use crate::oracle::nats;
use crate::support::{all_options, drawn_team, question};

#[test]
fn the_score_of_an_assignment_is_that_of_the_decision() {
    for options in all_options() {
        let rne = Rne::new(options).unwrap();
        for seed in 0..4 {
            let question = question(drawn_team(&[4, 3], seed), &[1, 2]);
            let decision = rne.decide(&question).unwrap();
            let score = rne.score(&question, &decision.assignment).unwrap();
            // The decision has them added up in another order.
            assert!((nats(score) - nats(decision.score)).abs() < 1e-12, "{rne:?}");
        }
    }
}

#[test]
fn the_needs_add_up_to_the_rne_between_groups_worked_out_by_hand() {
    let question = question(drawn_team(&[4], 1), &[1, 2]);
    let rne = Rne::new(RneOptions { scale: false, ..RneOptions::default() }).unwrap();
    let assignment = rne.decide(&question).unwrap().assignment;
    let trust = rne.of_team(&question).unwrap();
    for [from, to] in [[0, 1], [1, 0]].map(|pair| pair.map(|task: usize| &assignment.groups[task])) {
        // The members' needs (weights are 1 and not scaled), summed and divided by their sum.
        let shares = [from, to].map(|group| {
            let members = || question.members.iter().filter(|member| group.contains(&member.id));
            let sum = |k: usize| members().map(|member| member.needs.values()[k]).sum::<f64>();
            let all: f64 = (0..5).map(sum).sum();
            (0..5).map(|k| sum(k) / all).collect::<Vec<f64>>()
        });
        let mut total = 0.0;
        for (k, found) in trust.by_need(from, to).unwrap().unwrap().iter().enumerate() {
            let by_hand = shares[0][k] * libm::log(shares[0][k] / shares[1][k]);
            assert!((found.adds - by_hand).abs() < 1e-12, "need {k}: {found:?}, by hand {by_hand}");
            total += by_hand;
        }
        assert!((trust.towards(from, to).unwrap() - total).abs() < 1e-12);
    }
    let larger = trust.towards(&assignment.groups[0], &assignment.groups[1]).unwrap();
    let larger = larger.max(trust.towards(&assignment.groups[1], &assignment.groups[0]).unwrap());
    assert!((trust.between(&assignment).unwrap().unwrap() - larger).abs() < 1e-12);
}
