//! Protocols: how robots that decide for themselves talk first. One file each.

mod gossip;
mod leader;
mod majority;

use teaming::ProtocolKind;

/// Longest wait of a protocol, in seconds.
const LONGEST_S: f64 = 3600.0;

/// All protocols.
pub(crate) fn kinds() -> Vec<ProtocolKind> {
    vec![gossip::kind(), majority::kind(), leader::kind()]
}
