//! Why a file cannot be read as a recording.

use thiserror::Error;

/// Why a file cannot be read as a recording. A truncated file gives none of these errors, unless it ends
/// within its header: its complete chunks are read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The first bytes are not those of a recording.
    #[error("is not a recording: its first bytes are not \"USREC\"")]
    NotARecording,
    /// It was written in another version of the format.
    #[error("has version {found} of the format; this program reads version {expected}")]
    Version {
        /// The version of the file.
        found: u32,
        /// The version that this program reads.
        expected: u32,
    },
    /// Its chunks are larger than any recording's.
    #[error("has more than {} MiB when it is inflated, which no recording has", .most >> 20)]
    TooLarge {
        /// The most bytes that are inflated.
        most: u64,
    },
    /// It ends before its header does.
    #[error("ends within its header, after {bytes} bytes: there is nothing to show")]
    NoHeader {
        /// Length of the file.
        bytes: usize,
    },
    /// A chunk does not match its checksum, or has invalid content.
    #[error("is damaged: chunk {chunk} ({kind}), at byte {at}: {reason}")]
    Damaged {
        /// Number of the chunk, from 0.
        chunk: usize,
        /// Kind of the chunk.
        kind: String,
        /// Byte at which it begins in the file.
        at: usize,
        /// Description of the damage.
        reason: String,
    },
    /// A requested frame does not exist.
    #[error("has {frames} frames; there is no frame {asked}")]
    NoFrame {
        /// The requested number, from 0.
        asked: usize,
        /// Number of frames.
        frames: usize,
    },
}
