//! `hashes.csv`: the hash chains of all trials. A sweep writes them, and its verification compares them.

use usar_sim::hash::{HashChain, Link, PARTS};

fn link_of(step: u64, digest: &str, digits: &str) -> Option<Link> {
    let digest = u128::from_str_radix(digest, 16).ok()?;
    let mut parts = [0; PARTS.len()];
    for (i, part) in parts.iter_mut().enumerate() {
        *part = u16::from_str_radix(digits.get(4 * i..4 * i + 4)?, 16).ok()?;
    }
    Some(Link { step, parts, digest })
}

/// Encodes a chain as one text.
pub(super) fn encode(links: &[Link]) -> String {
    let link = |link: &Link| {
        let parts = link.parts.map(|part| format!("{part:04x}")).concat();
        format!("{}:{:032x}:{parts}", link.step, link.digest)
    };
    links.iter().map(link).collect::<Vec<_>>().join(" ")
}

/// Decodes the chain in a text.
pub(super) fn decode(text: &str) -> Option<HashChain> {
    let link = |text: &str| {
        let mut pieces = text.split(':');
        let (step, digest, parts) = (pieces.next()?, pieces.next()?, pieces.next()?);
        link_of(step.parse().ok()?, digest, parts)
    };
    Some(HashChain::of(text.split_whitespace().map(link).collect::<Option<Vec<Link>>>()?))
}
