//! Protocols: how robots that decide for themselves talk first. One file each.

mod gossip;

use teaming::ProtocolKind;

/// All protocols.
pub(crate) fn kinds() -> Vec<ProtocolKind> {
    vec![gossip::kind()]
}
