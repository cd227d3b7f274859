//! A trial as bytes, to resume later: in another process, or on another machine of the same kind, with the
//! same result bit for bit.
//!
//! Layout, with numbers in little-endian order: eight bytes `USARSNAP`; the version of the format (u32);
//! length (u64) and XXH3-128 (u128) of the payload; the payload in postcard's format: the identity of the
//! trial, then its whole state.

use scenario::Scenario;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_128;

use crate::simulation::{Simulation, State};

/// The first bytes of every snapshot.
const MAGIC: &[u8; 8] = b"USARSNAP";

/// Version of the format. It increases whenever the layout of the state changes.
pub const VERSION: u32 = 20;

const HEADER_BYTES: usize = 8 + 4 + 8 + 16;

/// An error that keeps a trial from resuming from a snapshot.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotError {
    /// The bytes do not begin like a snapshot.
    #[error("is not a snapshot of a trial")]
    Foreign,
    /// Another version of the format.
    #[error("is a snapshot of format {found}; this program reads format {VERSION}")]
    Version {
        /// The version that was found.
        found: u32,
    },
    /// Bytes are missing, or too many.
    #[error("should have {expected} bytes and has {found}: it was cut short or written over")]
    Length {
        /// Length by the header.
        expected: u64,
        /// Length that was found.
        found: u64,
    },
    /// The checksum is wrong.
    #[error("is damaged: its checksum is wrong")]
    Damaged,
    /// A snapshot of another scenario.
    #[error("is of another {what}: {found} instead of {expected}")]
    Mismatch {
        /// What differs.
        what: &'static str,
        /// The value of the snapshot.
        found: String,
        /// The value of the requested trial.
        expected: String,
    },
}

/// The identity of the trial in a snapshot.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Name of the scenario.
    pub scenario: String,
    /// XXH3-128 of the whole scenario as text.
    pub scenario_hash: u128,
    /// The policy that decided so far, as it was requested. Another policy may decide from here on.
    pub policy: String,
    /// Seed of the trial.
    pub seed: u64,
}

impl Identity {
    fn new(scenario: &Scenario, policy: &str, seed: u64) -> Self {
        Self {
            scenario: scenario.name.clone(),
            scenario_hash: xxh3_128(scenario.resolved().as_bytes()),
            policy: policy.to_owned(),
            seed,
        }
    }

    /// Reads the identity from a snapshot. Makes all checks except the comparison with a scenario.
    ///
    /// # Errors
    /// The bytes are not a sound snapshot.
    pub fn of(bytes: &[u8]) -> Result<Self, SnapshotError> {
        let (identity, _) = postcard::take_from_bytes(payload(bytes)?).map_err(|_| SnapshotError::Damaged)?;
        Ok(identity)
    }

    fn check(&self, expected: &Self) -> Result<(), SnapshotError> {
        let mismatch = |what, found: String, expected: String| {
            if found == expected { Ok(()) } else { Err(SnapshotError::Mismatch { what, found, expected }) }
        };
        mismatch("scenario", self.scenario.clone(), expected.scenario.clone())?;
        let hash = |identity: &Self| format!("one with hash {:032x}", identity.scenario_hash);
        mismatch("version of the scenario", hash(self), hash(expected))
    }
}

/// Number of bytes that [`check_start`] needs.
pub const START_BYTES: u64 = HEADER_BYTES as u64;

/// Checks the beginning of a snapshot of `length` bytes, so that a file that is not a snapshot need not be
/// read.
///
/// # Errors
/// The bytes are not a snapshot, or one of another version or length.
pub fn check_start(start: &[u8], length: u64) -> Result<(), SnapshotError> {
    let (count, _) = header(start)?;
    let expected = count.saturating_add(START_BYTES);
    if expected == length { Ok(()) } else { Err(SnapshotError::Length { expected, found: length }) }
}

/// Number of bytes of the payload, and the checksum followed by the payload.
fn header(bytes: &[u8]) -> Result<(u64, &[u8]), SnapshotError> {
    let Some(rest) = bytes.strip_prefix(MAGIC) else { return Err(SnapshotError::Foreign) };
    let length = |expected: u64| SnapshotError::Length { expected, found: bytes.len() as u64 };
    let (version, rest) = rest.split_first_chunk().ok_or_else(|| length(HEADER_BYTES as u64))?;
    let found = u32::from_le_bytes(*version);
    if found != VERSION {
        return Err(SnapshotError::Version { found });
    }
    let (count, rest) = rest.split_first_chunk().ok_or_else(|| length(HEADER_BYTES as u64))?;
    Ok((u64::from_le_bytes(*count), rest))
}

/// The checked payload of a snapshot.
fn payload(bytes: &[u8]) -> Result<&[u8], SnapshotError> {
    let length = |expected: u64| SnapshotError::Length { expected, found: bytes.len() as u64 };
    let (count, rest) = header(bytes)?;
    let (checksum, payload) = rest.split_first_chunk().ok_or_else(|| length(HEADER_BYTES as u64))?;
    if count != payload.len() as u64 {
        return Err(length(count.saturating_add(HEADER_BYTES as u64)));
    }
    if u128::from_le_bytes(*checksum) != xxh3_128(payload) {
        return Err(SnapshotError::Damaged);
    }
    Ok(payload)
}

impl Simulation {
    /// The whole present trial, with the name of the policy that decided so far.
    ///
    /// # Panics
    /// Never: the state is of types that postcard can write to memory.
    pub fn snapshot(&self, policy: &str) -> Vec<u8> {
        let identity = Identity::new(self.given(), policy, self.seed());
        let payload =
            postcard::to_stdvec(&(identity, self.state())).expect("the state can be written to memory");
        let mut bytes = Vec::with_capacity(HEADER_BYTES + payload.len());
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((payload.len() as u64).to_le_bytes());
        bytes.extend(xxh3_128(&payload).to_le_bytes());
        bytes.extend(payload);
        bytes
    }

    /// The trial of a snapshot, at the step where the snapshot was taken. Invariants are not checked until
    /// [`Simulation::checked`] is called.
    ///
    /// # Errors
    /// The bytes are not a sound snapshot, or a snapshot of another scenario.
    pub fn restore(scenario: &Scenario, bytes: &[u8]) -> Result<Self, SnapshotError> {
        let found = Identity::of(bytes)?;
        found.check(&Identity::new(scenario, &found.policy, found.seed))?;
        let (identity, state): (Identity, State) =
            postcard::from_bytes(payload(bytes)?).map_err(|_| SnapshotError::Damaged)?;
        Self::resume(scenario, identity.seed, state).map_err(|_| SnapshotError::Damaged)
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::hash::HashChain;

    /// Ground and aerial robots in conflict on a mission, debris that is pushed, radiation, rescuees.
    fn scenario() -> Scenario {
        let text = r#"(
            name: "fields", description: "", duration_s: 60.0, dt_s: 0.02, arena_m: (24.0, 16.0),
            roles: [
                (name: "walker"),
                (name: "flyer", kind: Aerial, mass_kg: 5.0, sensing_m: 18.0, observing_m: 6.0, capacity: 0,
                 guides: true),
            ],
            team: [
                (role: "walker", count: 2, center: (12.0, 2.0), width_m: 1.5),
                (role: "walker", count: 2, center: (12.0, 4.0), width_m: 1.5),
                (role: "flyer", count: 2, center: (12.0, 6.0), width_m: 1.5),
            ],
            tasks: [
                (name: "far", difficulty: 2, center: (5.0, 12.0), size_m: (2.0, 1.0), grid: (3, 2),
                 rest: (5.0, 5.0)),
                (name: "near", difficulty: 1, center: (19.0, 12.0), size_m: (2.0, 1.0), grid: (3, 2),
                 rest: (19.0, 5.0)),
            ],
            debris: [
                (shape: Box(1.0, 0.6), at: (9.0, 7.0), rotation_deg: 20.0,
                 movable: (mass_kg: 5.0, friction: 0.3)),
                (shape: Disc(0.5), at: (16.0, 8.0)),
            ],
            radiation: [(at: (8.0, 9.0), radius_m: 2.0, name: "leak")],
            walls: [(from: (20, 0), to: (20, 8), doors: [(at_m: 4, width_m: 1.5, name: "gate")])],
            timeline: [
                (at_s: 2, event: DebrisFalls(shape: Disc(0.6), at: (12, 9))),
                (at_s: 3, event: Closes("gate")),
                (at_s: 4, event: SourceDies("leak")), (at_s: 5, event: TaskEnds("near")),
                (at_s: 30, event: Opens("gate")),
                (at_s: 6, event: SourceAppears(at: (14, 12), radius_m: 2)),
                (at_s: 1, event: RobotLoses(robot: 1, hp: 20)),
                (at_s: 2.5, event: RescueesAppear(task: "far", grid: (2, 1))),
            ],
        )"#;
        Scenario::parse(text, "fields.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
    }

    fn after(scenario: &Scenario, steps: u64) -> Simulation {
        let mut rne = policies::standard().open("RNE").unwrap();
        let mut trial = Simulation::new(scenario, 1).unwrap();
        (0..steps).for_each(|_| assert_eq!(trial.step(&mut *rne), None));
        trial
    }

    #[test]
    fn every_field_of_the_state_counts_in_the_hash() {
        let scenario = scenario();
        let mut trial = after(&scenario, 340);
        *trial.state_mut().chain_mut() = HashChain::default();
        let digest = |state: &State| {
            let mut chain = HashChain::default();
            chain.add(state.step(), state.parts());
            chain.digest()
        };
        let bytes = postcard::to_stdvec(trial.state()).unwrap();
        let original = digest(trial.state());
        let step_bytes = postcard::to_stdvec(&trial.steps()).unwrap().len();
        let physics_bytes = postcard::to_stdvec(&trial.world().physics).unwrap().len();
        let listeners = postcard::to_stdvec(trial.state().listeners()).unwrap().len();
        let hashed = bytes.len() - listeners; // what listens acts on nothing
        let mut tried = 0;
        for at in (0..step_bytes).chain(step_bytes + physics_bytes..hashed - 1) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 1;
            let Ok(state) = postcard::from_bytes::<State>(&flipped) else { continue };
            if postcard::to_stdvec(&state).unwrap() != flipped {
                continue; // read as something else: a length, or a number written in another way
            }
            tried += 1;
            assert_ne!(digest(&state), original, "byte {at} of {} does not count", bytes.len());
        }
        assert!(tried > (hashed - physics_bytes) / 2, "{tried} of {hashed} bytes tried");
    }

    #[test]
    fn a_cut_or_flipped_snapshot_is_refused_by_name() {
        let scenario = scenario();
        let bytes = after(&scenario, 40).snapshot("RNE");
        let refuse = |bytes: &[u8]| Simulation::restore(&scenario, bytes).err().unwrap();
        for length in [0, 7, 8, 11, 20, 35, 36, bytes.len() / 2, bytes.len() - 1] {
            let error = refuse(&bytes[..length]);
            let expected = matches!(error, SnapshotError::Length { .. })
                || length < 8 && error == SnapshotError::Foreign;
            assert!(expected, "{length} bytes: {error}");
        }
        for at in (0..bytes.len()).step_by(97).chain(0..HEADER_BYTES) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 0x40;
            let error = refuse(&flipped);
            let expected = match at {
                0..8 => error == SnapshotError::Foreign,
                8..12 => matches!(error, SnapshotError::Version { .. }),
                12..20 => matches!(error, SnapshotError::Length { .. }),
                _ => error == SnapshotError::Damaged,
            };
            assert!(expected, "byte {at}: {error}");
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(matches!(refuse(&longer), SnapshotError::Length { .. }));
    }

    #[test]
    fn a_snapshot_of_another_scenario_is_refused_by_name() {
        let scenario = scenario();
        let bytes = after(&scenario, 3).snapshot("RNE");
        let mut file = (*scenario).clone();
        file.debris[1].at[0] += 0.01;
        let moved = Scenario::try_from(file).unwrap();
        let error = Simulation::restore(&moved, &bytes).err().unwrap().to_string();
        assert!(error.starts_with("is of another version of the scenario: one with hash "), "{error}");
    }
}
