//! How the discs of the default right of way move, beside people in experiments and beside the problems of
//! CADRL (docs/movement.md).

pub mod crowd;
pub mod literature;

use std::process::ExitCode;
use crowd::Crowd;

pub fn main() -> ExitCode {
    for length in [1.0, 2.8] {
        for width in [0.7, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.4, 3.0] {
            let start = std::time::Instant::now();
            for seed in 1..=2 {
                let p = Crowd::at_door(120, width, length).pass(seed, 400.0).unwrap();
                println!("{length} {width} {seed}: {:?} through {} given up {} {:.1} s", p.flow_per_s, p.through, p.given_up, start.elapsed().as_secs_f64());
            }
        }
    }
    for [a, b] in [[0.7, 1.8], [1.0, 1.8], [1.45, 1.8], [1.8, 1.8], [1.8, 1.2], [1.8, 0.95], [1.8, 0.7]] {
        let start = std::time::Instant::now();
        let p = Crowd::at_corridor(120, a, b).pass(1, 400.0).unwrap();
        let n = p.samples.len() as f64;
        println!("{a} {b}: {:?} through {} given up {} rho {:.2} v {:.2}, {:.1} s", p.flow_per_s, p.through, p.given_up, p.samples.iter().map(|s| s.per_m2).sum::<f64>() / n, p.samples.iter().map(|s| s.speed_mps).sum::<f64>() / n, start.elapsed().as_secs_f64());
    }
    ExitCode::SUCCESS
}
