//! Movement beside the literature: its figures are read with their sources, Weidmann's relation has its
//! values, and small crowds are measured.

use xtask::movement::crowd::{Crowd, steady_flow};
use xtask::movement::literature::{Quantity, powers, published, weidmann};
use xtask::movement::square;

use crate::support::root;

#[test]
fn every_figure_of_the_literature_has_a_source_and_is_on_the_page() {
    let figures = published().unwrap();
    let page = std::fs::read_to_string(root().join("docs/movement.md")).unwrap();
    let flows = figures.iter().filter(|one| one.quantity == Quantity::SpecificFlow);
    assert_eq!((flows.clone().count(), figures.len()), (9, 32));
    for one in &figures {
        assert!(["arXiv", "doi"].iter().any(|sign| one.source.contains(sign)), "{one:?}");
        assert!((0.0..=5.0).contains(&one.y) && one.x > 0.0, "{one:?}");
    }
    for one in flows {
        let told = format!("{:.2} ({})", one.x * one.y, one.series);
        assert!(page.contains(&told), "docs/movement.md lacks {told}: `just movement --out docs`");
    }
}

/// The values come from another program.
#[test]
fn weidmanns_relation_has_its_values() {
    for (per_m2, speed) in [(1.0, 1.058_063), (2.0, 0.606_238), (5.4, 0.0), (8.0, 0.0), (0.0, 1.34)] {
        assert!((weidmann(per_m2) - speed).abs() < 1e-6, "{per_m2}: {}", weidmann(per_m2));
    }
}

#[test]
fn a_flow_leaves_out_the_first_and_the_last_tenth() {
    // One every two seconds, but for the first and the last two of twenty.
    let steady: Vec<f64> = (0..16).map(|i| 100.0 + 2.0 * f64::from(i)).collect();
    let times: Vec<f64> = [0.0, 1.0].into_iter().chain(steady).chain([500.0, 900.0]).collect();
    assert_eq!(steady_flow(&times), Some(0.5));
    assert_eq!(steady_flow(&[]), None);
    assert_eq!(steady_flow(&[1.0]), None);
    assert_eq!(steady_flow(&[1.0, 1.0]), None);
}

#[test]
fn a_small_crowd_gets_through_a_door_and_a_wider_one_sooner() {
    let flow = |width_m: f64| {
        let passage = Crowd::at_door(24, width_m, 1.0).pass(1, 120.0).unwrap();
        assert!(!passage.jammed && passage.through == 24, "{passage:?}");
        passage.flow_per_s.unwrap()
    };
    let [narrow, wide] = [1.0, 3.0].map(flow);
    assert!((0.8..3.0).contains(&narrow) && wide > 1.5 * narrow, "{narrow} and {wide} a second");
}

#[test]
fn a_lone_robot_in_a_corridor_goes_at_the_free_speed() {
    let passage = Crowd::at_corridor(1, 1.8, 1.8).pass(1, 60.0).unwrap();
    assert!(!passage.samples.is_empty());
    for sample in &passage.samples {
        assert!((sample.speed_mps - 1.34).abs() < 0.02, "{sample:?}");
        assert!((sample.per_m2 - 1.0 / 3.6).abs() < 1e-9 && sample.standing == 0.0, "{sample:?}");
    }
}

#[test]
fn agents_in_a_square_are_drawn_as_told_and_arrive() {
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for seed in 1..=20 {
        let agents = square::case(6, seed);
        for (i, a) in agents.iter().enumerate() {
            assert!((0.3..0.5).contains(&a.radius_m) && (0.5..1.2).contains(&a.speed_mps), "{a:?}");
            for b in &agents[..i] {
                let least = a.radius_m + b.radius_m + 0.2;
                assert!(apart(a.start, b.start) >= least && apart(a.goal, b.goal) >= least, "{a:?} {b:?}");
            }
        }
    }
    let outcome = square::run(2, 1).unwrap();
    assert!(!outcome.stuck && !outcome.collided, "{outcome:?}");
    assert!(outcome.extra_s >= outcome.extra_alone_s && outcome.extra_alone_s > 0.0, "{outcome:?}");
}

#[test]
fn measured_power_is_a_share_of_the_battery() {
    let page = std::fs::read_to_string(root().join("docs/scenarios.md")).unwrap();
    let all = powers().unwrap();
    // 3.8 W for an hour are 3.8 of 27 watt-hours.
    assert!((3600.0 * all[0].per_second() - 100.0 * 3.8 / 27.0).abs() < 1e-9);
    // A watt more at 0.175 m/s: 1 / 0.175 J a metre, of 97,200.
    assert!((all[2].per_metre(&all[0]).unwrap() - 100.0 / 0.175 / 97_200.0).abs() < 1e-9);
    assert_eq!(all[0].per_metre(&all[0]), None);
    for power in all {
        let told = format!("| {:.5} |", power.per_second());
        assert!(page.contains(&told), "docs/scenarios.md lacks {told}: `just movement --out docs`");
    }
}
