//! The hash chain over the whole state of a trial: equal chains, equal trials, step by step. What only
//! listens, metrics and decisions, is no part of it: a new counter changes no hash.
//!
//! Every [`PERIOD_S`] seconds and at the end, each part of the state is written as bytes (postcard, or words)
//! and hashed (XXH3, 128 bits). The digests of all parts, the step and the previous link make the next link.
//! Each link also keeps shortened digests of the parts, which show in which part two chains differ.

use std::cell::Cell;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_128;

/// A link is added once in this time, in seconds.
pub const PERIOD_S: f64 = 10.0;

/// The parts of the state, in the order of [`Link::parts`].
pub const PARTS: [&str; 10] = [
    "bodies", "robots", "debris", "rescuees", "beliefs", "mission", "routes", "resolver", "events",
    "evidence",
];

/// The hash of a part that a trial does not have. It is not in the digest.
pub const ABSENT: u128 = 0;

/// One link of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Link {
    /// Steps done.
    pub step: u64,
    /// The low 16 bits of each part's hash.
    pub parts: [u16; PARTS.len()],
    /// Hash over the previous link's digest, the step and all parts.
    pub digest: u128,
}

impl Link {
    /// Names of the parts in which two links of the same step differ.
    pub fn differing_parts(&self, other: &Self) -> Vec<&'static str> {
        let pairs = PARTS.into_iter().zip(self.parts.iter().zip(&other.parts));
        pairs.filter(|(_, (a, b))| a != b).map(|(name, _)| name).collect()
    }
}

/// The chain of one trial so far.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HashChain {
    links: Vec<Link>,
}

impl HashChain {
    /// Adds a link from the hashes of the parts after `step` steps.
    pub fn add(&mut self, step: u64, parts: [u128; PARTS.len()]) {
        let before = self.links.last().map_or(0, |link| link.digest);
        let mut bytes = Vec::with_capacity(16 * (PARTS.len() + 2));
        bytes.extend(before.to_le_bytes());
        bytes.extend(step.to_le_bytes());
        let there = parts.iter().filter(|part| **part != ABSENT);
        there.for_each(|part| bytes.extend(part.to_le_bytes()));
        self.links.push(Link { step, parts: parts.map(|part| part as u16), digest: xxh3_128(&bytes) });
    }

    /// A chain of these links, as it was recorded.
    pub fn of(links: Vec<Link>) -> Self {
        Self { links }
    }

    /// The links, in order of their steps.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The last digest, 32 hexadecimal digits.
    pub fn digest(&self) -> String {
        format!("{:032x}", self.links.last().map_or(0, |link| link.digest))
    }
}

thread_local! {
    /// Where parts are written: the same memory each time.
    static BYTES: Cell<Vec<u8>> = const { Cell::new(Vec::new()) };
}

/// Least length of that memory, in bytes.
const LEAST_BYTES: usize = 1 << 14;

/// Hash of the bytes of one part of the state.
///
/// # Panics
/// Never: all parts are of types that postcard can write to memory.
pub fn part(value: &impl Serialize) -> u128 {
    let mut bytes = BYTES.take();
    let hash = loop {
        match postcard::to_slice(value, &mut bytes) {
            Ok(written) => break xxh3_128(written),
            Err(postcard::Error::SerializeBufferFull) => bytes.resize(LEAST_BYTES.max(2 * bytes.len()), 0),
            Err(error) => panic!("the state can be written to memory: {error}"),
        }
    };
    BYTES.set(bytes);
    hash
}

/// Hash of many small things, each as a few words of fixed width: less work than [`part`].
pub fn part_of_many<const WORDS: usize>(things: impl Iterator<Item = [u32; WORDS]>) -> u128 {
    let things: Vec<_> = things.map(|words| words.map(u32::to_le_bytes)).collect();
    xxh3_128(things.as_flattened().as_flattened())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_any_length_is_hashed_whole() {
        for length in [0, LEAST_BYTES - 2, LEAST_BYTES - 1, 5 * LEAST_BYTES, 10] {
            let value: Vec<u8> = (0..length).map(|at| at as u8).collect();
            assert_eq!(part(&value), xxh3_128(&postcard::to_stdvec(&value).unwrap()), "{length} bytes");
        }
    }
}
