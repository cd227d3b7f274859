//! Makespans that others have published, of problems of MRTA-Benchmark.

use mrta::{Problem, cbba, earliest, optimum, read, write};

/// The problems `1p_000000` to `1p_000002` of MRTA-Benchmark as they are published there, the published least
/// makespan of each, and that of the rule of the earliest start by an independent program.
const PUBLISHED: [(&str, [f64; 2]); 3] = [
    (
        r#"{"Q": [[0,0,1],[0,1,0],[1,0,0]],
            "R": [[0,0,0],[0,0,1],[1,0,1],[0,1,0],[0,0,1],[1,0,0],[0,0,1],[0,1,0],[1,1,0],[0,0,0]],
            "T_e": [0,93,95,68,89,70,89,61,62,0],
            "task_locations":
                [[34,17],[38,43],[4,70],[23,77],[96,13],[44,95],[13,11],[18,31],[12,8],[91,26]],
            "precedence_constraints": [[7,3]]}"#,
        [570.167_11, 699.467_73],
    ),
    (
        r#"{"Q": [[0,0,1],[1,1,0],[0,1,0]],
            "R": [[0,0,0],[0,1,1],[0,1,0],[0,0,1],[1,0,0],[1,0,0],[0,0,1],[1,0,0],[0,0,1],[0,0,0]],
            "T_e": [0,52,97,59,69,67,77,82,54,0],
            "task_locations":
                [[2,96],[26,2],[27,9],[63,7],[92,41],[44,13],[98,94],[28,52],[80,26],[46,40]],
            "precedence_constraints": [[1,7]]}"#,
        [541.913_73, 574.827_57],
    ),
    (
        r#"{"Q": [[1,0,1],[0,1,0],[0,0,1]],
            "R": [[0,0,0],[1,0,1],[0,1,0],[0,1,0],[0,0,1],[0,0,1],[1,0,0],[0,1,0],[1,1,0],[0,0,0]],
            "T_e": [0,72,94,94,67,90,70,95,93,0],
            "task_locations":
                [[15,10],[24,47],[40,77],[38,27],[93,82],[57,36],[87,19],[56,83],[39,28],[11,50]],
            "precedence_constraints": [[4,5]]}"#,
        [520.2935, 538.187_74],
    ),
];

fn problem(text: &str) -> Problem {
    read("published", text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_least_makespans_and_those_of_the_earliest_start_are_the_published_ones() {
    for (text, expected) in PUBLISHED {
        let problem = problem(text);
        let found = [optimum(&problem).unwrap(), earliest(&problem)];
        println!("{found:?} {expected:?} cbba {}", cbba(&problem));
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-5));
    }
}

#[test]
fn what_is_written_is_read_as_the_same_problem() {
    for (text, _) in PUBLISHED {
        assert_eq!(problem(&write(&problem(text)).unwrap()), problem(text));
    }
}
