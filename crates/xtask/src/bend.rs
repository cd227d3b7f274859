//! Bent results: journals, manifests and recordings whose JSON is sound and whose checksums match, but in which
//! a value is another one. A reader must refuse them or read them; it may not panic.

use std::io::Read;

use flate2::Compression;
use flate2::read::{DeflateDecoder, DeflateEncoder};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};

/// Bytes before the first chunk of a recording, and of the head of each chunk.
const MAGIC: usize = 8;
const HEAD: usize = 20;

/// Puts something else in the place of one value: another type, an extreme number, a longer, shorter or empty
/// list, or nothing. The number decides which.
pub fn bend(value: &mut Value, number: u64) {
    bend_by(value, &mut ChaCha8Rng::seed_from_u64(number));
}

fn bend_by(value: &mut Value, draws: &mut ChaCha8Rng) {
    let is_here = draws.random_range(0..8) == 0;
    match value {
        Value::Object(fields) if !fields.is_empty() && !is_here => {
            let number = draws.random_range(0..fields.len());
            let key = fields.keys().nth(number).cloned().unwrap_or_default();
            if draws.random_range(0..40) == 0 {
                fields.remove(&key);
            } else {
                bend_by(&mut fields[&key], draws);
            }
        }
        Value::Array(entries) if !entries.is_empty() && !is_here => {
            let at = draws.random_range(0..entries.len());
            match draws.random_range(0..12) {
                0 => entries.clear(),
                1 => drop(entries.remove(at)),
                2 => entries.push(entries[at].clone()),
                3 => entries.truncate(at),
                4 => entries.reverse(),
                _ => bend_by(&mut entries[at], draws),
            }
        }
        value => *value = odd(value, draws),
    }
}

/// A value for the place of another one, mostly of its type.
fn odd(value: &Value, draws: &mut ChaCha8Rng) -> Value {
    let number = [
        json!(0),
        json!(1),
        json!(2),
        json!(7),
        json!(-1),
        json!(65_535),
        json!(4_294_967_295_u32),
        json!(1_u64 << 32),
        json!(u64::MAX),
        json!(1e308),
        json!(-1e308),
        json!(0.5),
        json!(1e-320),
    ];
    let any =
        [json!(null), json!([]), json!({}), json!(""), json!("?"), json!(true), json!([[]]), json!("1")];
    let pick = |from: &[Value], draws: &mut ChaCha8Rng| from[draws.random_range(0..from.len())].clone();
    match value {
        _ if draws.random_range(0..4) == 0 => pick(&any, draws),
        Value::Number(_) | Value::Null => pick(&number, draws),
        Value::Bool(is_true) => json!(!is_true),
        Value::String(text) => json!(format!("{text}{text}")),
        Value::Array(_) | Value::Object(_) => pick(&any, draws),
    }
}

/// A recording in which one value of one chunk in JSON is bent, or, in one of eight, a byte of its frames.
pub fn bent_recording(sound: &[u8], number: u64) -> Vec<u8> {
    let mut draws = ChaCha8Rng::seed_from_u64(number);
    let mut chunks = chunks_of(sound);
    let frames = |kind: &[u8]| kind == b"SEGM";
    let wants_frames = draws.random_range(0..8) == 0;
    let those: Vec<usize> =
        (0..chunks.len()).filter(|number| frames(&chunks[*number].0) == wants_frames).collect();
    // The header as often as all others together.
    let pick = if wants_frames || draws.random() { draws.random_range(0..those.len()) } else { 0 };
    let content = &mut chunks[those[pick]].1;
    if wants_frames {
        let at = draws.random_range(0..content.len());
        content[at] = draws.random();
    } else {
        let mut value: Value = serde_json::from_slice(content).expect("a chunk in JSON");
        bend_by(&mut value, &mut draws);
        *content = value.to_string().into_bytes();
    }
    let mut bytes = sound[..MAGIC].to_vec();
    chunks.iter().for_each(|(kind, content)| add_chunk(&mut bytes, kind, content));
    bytes
}

/// The kinds and the inflated contents of the chunks.
fn chunks_of(recording: &[u8]) -> Vec<(Vec<u8>, Vec<u8>)> {
    let (mut rest, mut chunks) = (&recording[MAGIC..], Vec::new());
    while !rest.is_empty() {
        let (head, after) = rest.split_at(HEAD);
        let size = u32::from_le_bytes(head[4..8].try_into().expect("four bytes")) as usize;
        let (stored, after) = after.split_at(size);
        let mut content = Vec::new();
        DeflateDecoder::new(stored).read_to_end(&mut content).expect("a sound chunk");
        chunks.push((head[..4].to_vec(), content));
        rest = after;
    }
    chunks
}

fn add_chunk(bytes: &mut Vec<u8>, kind: &[u8], content: &[u8]) {
    let mut stored = Vec::new();
    DeflateEncoder::new(content, Compression::fast()).read_to_end(&mut stored).expect("memory takes it");
    let checksum = |bytes: &[u8]| {
        let mut crc = flate2::Crc::new();
        crc.update(bytes);
        crc.sum().to_le_bytes()
    };
    let sizes = [stored.len() as u32, content.len() as u32].map(u32::to_le_bytes);
    let head = [kind, &sizes[0], &sizes[1], &checksum(&stored)].concat();
    bytes.extend(&head);
    bytes.extend(checksum(&head));
    bytes.extend(stored);
}
