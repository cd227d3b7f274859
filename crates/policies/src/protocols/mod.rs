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

/// Whether a protocol may wait so long.
fn is_fit(wait_s: f64) -> Result<(), String> {
    let is_fit = (0.0..=LONGEST_S).contains(&wait_s);
    is_fit.then_some(()).ok_or_else(|| format!("wait_s must be 0 to {LONGEST_S}"))
}
