//! Teams of any size with needs drawn at random, for measurements of grouping alone.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::{Member, NeedVector, Role, TaskPositions, Team};

/// A team with needs as in the paper's scenario, drawn at random.
pub fn team(counts: [u32; 3]) -> Team {
    let mut draws = ChaCha8Rng::seed_from_u64(7);
    let roles = [Role::Carrier, Role::Supplier, Role::Observer];
    let of_role = roles.into_iter().zip(counts).flat_map(|(role, count)| (0..count).map(move |_| role));
    let members = of_role.zip(0..).map(|(role, id)| {
        let level =
            |mean: f64, draws: &mut ChaCha8Rng| (mean + draws.random_range(-20.0..20.0_f64)).min(100.0);
        let (energy, hp) = (level(80.0, &mut draws), level(90.0, &mut draws));
        let [capacity, resources, observing] = match role {
            Role::Carrier => [10.0, 0.0, 5.0],
            Role::Supplier => [0.0, 20.0, 5.0],
            Role::Observer => [0.0, 0.0, 30.0],
        };
        let needs = [hp, 2.0 * hp / 100.0, 5.0 * hp / 100.0, energy, resources, capacity, observing];
        Member {
            id,
            role,
            position: [draws.random_range(0.0..100.0), 5.0],
            needs: NeedVector::new(needs.to_vec()).expect("valid needs"),
            energy_level: Some(energy),
            hp_level: Some(hp),
        }
    });
    let tasks = TaskPositions { easy: [80.0, 80.0], hard: [20.0, 80.0] };
    Team::new(members.collect(), Some(tasks)).expect("a team")
}
