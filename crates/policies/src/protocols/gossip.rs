//! `Gossip`: each robot says several times what it has heard of all, and then decides by itself. The newest
//! report of each robot counts.
//!
//! Rumours that are passed on reach all of `n` robots after `log2 n + ln n` exchanges in which each tells one
//! other at random (Karp, Schindelhauer, Shenker, Voecking, FOCS 2000). Here each tells all in reach, so that
//! without loss one exchange is enough, and with loss two or three.
//!
//! By hand: of three robots in a row, where only neighbours hear each other, the first knows the third after
//! one exchange, for the second has heard both.

use serde::{Deserialize, Serialize};
use teaming::{Act, PolicyError, Protocol, ProtocolKind, Talk, Turn};

use super::LONGEST_S;

/// Its options.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Gossip {
    /// How often each says what it has heard.
    exchanges: u32,
    /// Time from one exchange to the next, and to the decision, in seconds.
    every_s: f64,
}

impl Default for Gossip {
    fn default() -> Self {
        Self { exchanges: 2, every_s: 1.0 }
    }
}

/// Most exchanges before a decision.
const MOST: u32 = 100;

/// The kind.
pub fn kind() -> ProtocolKind {
    let about = "each says what it has heard of all, and decides by the newest";
    let kind = ProtocolKind::made("Gossip", about, |options: Gossip, _| match options {
        Gossip { exchanges: 1..=MOST, every_s } if (0.0..=LONGEST_S).contains(&every_s) => {
            Ok(Talk::shared(options))
        }
        _ => Err(format!("exchanges must be 1 to {MOST}, and every_s 0 to {LONGEST_S}")),
    });
    kind.from_sources(env!("SOURCES_PROTOCOL_GOSSIP"))
}

impl Protocol for Gossip {
    fn turn(&self, turn: &Turn) -> Result<Act, PolicyError> {
        if let Some(groups) = &turn.rule {
            return Ok(Act::joins(groups.clone()));
        }
        let done: u32 = turn.mind();
        if done < self.exchanges {
            return Ok(Act { shares: true, ..Act::waits(self.every_s) }.keeping(&(done + 1)));
        }
        Ok(Act::asks().keeping(&done))
    }
}
