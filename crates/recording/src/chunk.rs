//! The container: a magic number, then chunks. Each chunk is compressed and has its own checksums.

use std::io::{self, Read, Write};

use flate2::read::DeflateDecoder;
use flate2::{Compress, Compression, Crc, FlushCompress, Status};

use crate::error::ReadError;

/// The first bytes of a recording.
pub(crate) const MAGIC: [u8; 8] = *b"USREC\r\n\x1a";

/// Bytes before the content of a chunk: kind, stored length, inflated length, checksum of the content,
/// checksum of all these.
const HEAD: usize = 20;

/// Largest inflated size of a chunk.
const MAX_INFLATED: u32 = 1 << 30;

/// The content of a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The header, in JSON. It is the first chunk, and occurs only once.
    Header,
    /// The events in the time of the next segment, in JSON.
    Events,
    /// A decision, in JSON.
    Decision,
    /// Frames.
    Segment,
    /// The record of the trial, in JSON. It is the last chunk of a complete recording.
    Summary,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Header, Self::Events, Self::Decision, Self::Segment, Self::Summary];

    fn name(self) -> [u8; 4] {
        match self {
            Self::Header => *b"HEAD",
            Self::Events => *b"EVNT",
            Self::Decision => *b"DECI",
            Self::Segment => *b"SEGM",
            Self::Summary => *b"DONE",
        }
    }
}

fn checksum(bytes: &[u8]) -> [u8; 4] {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum().to_le_bytes()
}

/// Writes chunks. The compressor is created once, because creating it takes as long as compressing a chunk.
pub(crate) struct ChunkWriter<W> {
    out: W,
    deflate: Compress,
    stored: Vec<u8>,
}

impl<W: Write> ChunkWriter<W> {
    /// Begins a file with the magic number.
    pub(crate) fn new(mut out: W, level: u32) -> io::Result<Self> {
        out.write_all(&MAGIC)?;
        Ok(Self { out, deflate: Compress::new(Compression::new(level), false), stored: Vec::new() })
    }

    /// Writes a chunk.
    pub(crate) fn write(&mut self, kind: Kind, content: &[u8]) -> io::Result<()> {
        self.deflate(content)?;
        let length = |length: usize| {
            let fits = u32::try_from(length).ok().filter(|length| *length <= MAX_INFLATED);
            fits.map(u32::to_le_bytes)
                .ok_or_else(|| io::Error::other("a chunk of the recording is too large"))
        };
        let sizes = [length(self.stored.len())?, length(content.len())?];
        let head = [kind.name(), sizes[0], sizes[1], checksum(&self.stored)].concat();
        self.out.write_all(&head)?;
        self.out.write_all(&checksum(&head))?;
        self.out.write_all(&self.stored)
    }

    fn deflate(&mut self, content: &[u8]) -> io::Result<()> {
        self.deflate.reset();
        self.stored.clear();
        loop {
            // Enough for everything except incompressible content.
            self.stored.reserve(content.len() / 2 + 256);
            let done = self.deflate.total_in() as usize;
            let rest = content.get(done..).unwrap_or_default();
            match self.deflate.compress_vec(rest, &mut self.stored, FlushCompress::Finish)? {
                Status::StreamEnd => return Ok(()),
                Status::Ok | Status::BufError => {}
            }
        }
    }

    pub(crate) fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }

    /// The destination of the chunks.
    pub(crate) fn into_inner(self) -> W {
        self.out
    }
}

/// A chunk in a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chunk<'b> {
    pub(crate) kind: Kind,
    /// Number of the chunk, from 0.
    pub(crate) number: usize,
    /// Byte at which it begins in the file.
    pub(crate) at: usize,
    stored: &'b [u8],
    inflated: usize,
}

impl Chunk<'_> {
    /// Bytes of the inflated content.
    pub(crate) fn inflated_bytes(&self) -> u64 {
        self.inflated as u64
    }

    /// The inflated content.
    pub(crate) fn content(&self) -> Result<Vec<u8>, ReadError> {
        let mut content = Vec::new();
        let mut inflater = DeflateDecoder::new(self.stored).take(self.inflated as u64 + 1);
        inflater
            .read_to_end(&mut content)
            .map_err(|error| self.damaged(format!("cannot be inflated: {error}")))?;
        if content.len() == self.inflated {
            Ok(content)
        } else {
            Err(self.damaged(format!("{} bytes expected, found another number", self.inflated)))
        }
    }

    pub(crate) fn damaged(&self, reason: impl Into<String>) -> ReadError {
        damaged(self.number, &self.kind.name(), self.at, reason.into())
    }
}

fn damaged(chunk: usize, kind: &[u8], at: usize, reason: String) -> ReadError {
    ReadError::Damaged { chunk, kind: kind.escape_ascii().to_string(), at, reason }
}

/// The chunks of a file.
pub(crate) struct Chunks<'b> {
    bytes: &'b [u8],
    at: usize,
    number: usize,
}

impl<'b> Chunks<'b> {
    /// Checks the magic number.
    pub(crate) fn new(bytes: &'b [u8]) -> Result<Self, ReadError> {
        let start = &bytes[..bytes.len().min(MAGIC.len())];
        if start.is_empty() || start != &MAGIC[..start.len()] {
            return Err(ReadError::NotARecording);
        }
        Ok(Self { bytes, at: MAGIC.len(), number: 0 })
    }

    /// The byte at which the next chunk begins or would begin.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// The next chunk; `None` at the end of the file, or if the file is cut off within a chunk.
    pub(crate) fn next(&mut self) -> Result<Option<Chunk<'b>>, ReadError> {
        let Some(head) = self.bytes.get(self.at..self.at + HEAD) else { return Ok(None) };
        let (kind, at, number) = (&head[..4], self.at, self.number);
        let field = |from: usize| head[from..from + 4].try_into().map(u32::from_le_bytes).unwrap_or_default();
        if checksum(&head[..16]) != head[16..] {
            return Err(damaged(number, kind, at, "its head does not have its checksum".into()));
        }
        let known = Kind::ALL.into_iter().find(|known| known.name() == *kind);
        let known = known.ok_or_else(|| damaged(number, kind, at, "its kind is not known".into()))?;
        if field(8) > MAX_INFLATED {
            return Err(damaged(number, kind, at, format!("is too large: {} bytes", field(8))));
        }
        let begin = at + HEAD;
        let Some(stored) = self.bytes.get(begin..begin + field(4) as usize) else { return Ok(None) };
        if checksum(stored) != head[12..16] {
            return Err(damaged(number, kind, at, "its content does not have its checksum".into()));
        }
        self.at = begin + stored.len();
        self.number += 1;
        Ok(Some(Chunk { kind: known, number, at, stored, inflated: field(8) as usize }))
    }
}
