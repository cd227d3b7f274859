//! Shapes that would silently become others are refused.

use scenario::Scenario;

/// The problem with a piece of debris of this shape in an arena of this size.
fn refused(shape: &str, arena: &str) -> String {
    let text = format!(
        r#"(name: "shapes", duration_s: 10.0, dt_s: 0.02, arena_m: {arena},
        team: [(role: "robot", count: 1, center: (2.0, 2.0), width_m: 0.0)],
        errands: [(robot: 0, to: [(30.0, 30.0)])],
        debris: [(shape: {shape}, at: (20.0, 16.0))])"#
    );
    Scenario::parse(&text, "shapes.ron".as_ref()).map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn a_polygon_that_is_flat_in_single_precision_is_refused_and_does_not_become_a_disc() {
    let flat = refused("Polygon([(-20.0, 0.0), (20.0, 0.0), (20.0, 0.0000051)])", "(40.0, 40.0)");
    let said = "debris[0].shape must be at least 0.01 m wide in every direction, found 0.0000050";
    assert!(flat.contains(said), "{flat}");
    assert_eq!(refused("Polygon([(-10.0, 0.0), (10.0, 0.0), (10.0, 0.02)])", "(40.0, 40.0)"), "");
}

#[test]
fn a_star_that_winds_twice_is_refused_and_does_not_become_its_hull() {
    let star = "Polygon([(3.0, 0.0), (-2.427, 1.764), (0.927, -2.853), (0.927, 2.853), (-2.427, -1.764)])";
    let star = refused(star, "(40.0, 40.0)");
    let said =
        "debris[0].shape must go round once: no corner may lie to the right of an edge, found a corner";
    assert!(star.contains(said), "{star}");
    let pentagon =
        "Polygon([(3.0, 0.0), (0.927, 2.853), (-2.427, 1.764), (-2.427, -1.764), (0.927, -2.853)])";
    assert_eq!(refused(pentagon, "(40.0, 40.0)"), "");
}

#[test]
fn an_arena_beyond_single_precision_is_refused() {
    let wide = refused("Disc(1.0)", "(8001.0, 40.0)");
    assert!(wide.contains("arena_m[0] must be a number from 2 to 8000, found 8001"), "{wide}");
    assert_eq!(refused("Disc(1.0)", "(8000.0, 40.0)"), "");
}
