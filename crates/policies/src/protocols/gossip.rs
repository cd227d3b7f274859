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
        Gossip { exchanges: 1..=MOST, every_s } if (0.0..=3600.0).contains(&every_s) => {
            Ok(Talk::shared(options))
        }
        _ => Err(format!("exchanges must be 1 to {MOST}, and every_s 0 to 3600")),
    });
    kind.from_sources(env!("SOURCES_PROTOCOL_GOSSIP"))
}

impl Protocol for Gossip {
    fn turn(&self, turn: &Turn) -> Result<Act, PolicyError> {
        if let Some(groups) = &turn.rule {
            return Ok(Act::joins(groups.clone()));
        }
        let done = turn.state.as_u64().unwrap_or(0);
        if done < u64::from(self.exchanges) {
            let (wake_in_s, state) = (Some(self.every_s), (done + 1).into());
            return Ok(Act { shares: true, wake_in_s, state, ..Act::default() });
        }
        Ok(Act { asks: true, state: turn.state.clone(), ..Act::default() })
    }
}
