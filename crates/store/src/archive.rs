//! The log of a finished job, its lines in order, compressed. It is a gzip file of several members, so that
//! `zcat` prints the lines. The header of each member states its length and its number
//! of lines. A line is therefore found without reading the lines before it.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use flate2::{Compression, GzBuilder};

use crate::failure::Failure;
use crate::files;
use crate::log::LINE_BYTES;

/// A member is full when its lines have this many bytes.
pub const MEMBER_BYTES: usize = 256 << 10;

/// Start of each member: a gzip header of ten bytes with an extra field, the field's length, and our
/// subfield of eight bytes (RFC 1952).
const HEAD: [u8; 16] = [0x1f, 0x8b, 8, 4, 0, 0, 0, 0, 0, 0xff, 12, 0, b'U', b'S', 8, 0];
/// Bytes of a header including its two numbers.
const HEAD_BYTES: usize = HEAD.len() + 8;
/// Compression level: level 3 takes half the time of level 6 for a tenth more bytes.
const LEVEL: Compression = Compression::new(3);

/// Compresses whole lines into a member of the file.
///
/// # Errors
/// The lines take more than 4 GiB.
pub fn member(lines: &[u8], count: usize) -> Result<Vec<u8>, Failure> {
    let extra = [&HEAD[12..], &[0; 8]].concat();
    let mut encoder = GzBuilder::new().extra(extra).operating_system(0xff).write(Vec::new(), LEVEL);
    encoder.write_all(lines)?;
    let mut bytes = encoder.finish()?;
    bytes[..HEAD.len()].copy_from_slice(&HEAD);
    let number = |count: usize| u32::try_from(count).map_err(|_| Failure::storage("a line takes over 4 GiB"));
    let numbers = [number(bytes.len())?.to_le_bytes(), number(count)?.to_le_bytes()].concat();
    bytes[HEAD.len()..HEAD_BYTES].copy_from_slice(&numbers);
    Ok(bytes)
}

/// The place of a member in the file.
#[derive(Debug, Clone, Copy)]
struct Member {
    start: u64,
    size: u32,
    /// Number of its first line, from 0.
    first: usize,
}

/// Reads the lines.
pub struct Archive {
    path: PathBuf,
    members: Vec<Member>,
    lines: usize,
    /// The latest member that was read: its number, its bytes, and where its lines end.
    latest: Option<(usize, Vec<u8>, Vec<usize>)>,
}

impl Archive {
    /// Finds the members.
    ///
    /// # Errors
    /// The file cannot be read, or is not an archive.
    pub fn open(path: &Path) -> io::Result<Self> {
        let (archive, is_whole) = Self::open_damaged(path)?;
        if is_whole { Ok(archive) } else { Err(invalid("it is cut off, or was changed")) }
    }

    /// Finds the members that follow one another without a gap, and returns whether they reach the end of
    /// the file.
    fn open_damaged(path: &Path) -> io::Result<(Self, bool)> {
        let mut file = files::open(path)?;
        let end = file.metadata()?.len();
        let (mut members, mut start, mut lines) = (Vec::new(), 0, 0);
        while start < end {
            let Some((size, count)) = head_at(&mut file, start, end)? else { break };
            members.push(Member { start, size, first: lines });
            start += u64::from(size);
            lines += count as usize;
        }
        Ok((Self { path: path.to_owned(), members, lines, latest: None }, start == end))
    }

    /// The readable lines of a file with any damage, member by member.
    ///
    /// # Errors
    /// The file cannot be read at all.
    pub fn salvage(path: &Path) -> io::Result<Vec<Vec<u8>>> {
        let (archive, _) = Self::open_damaged(path)?;
        archive.members.iter().map(|member| archive.read(*member)).collect()
    }

    /// Number of lines.
    pub fn count(&self) -> usize {
        self.lines
    }

    /// A line, by its number from 0.
    ///
    /// # Errors
    /// The line cannot be read, or does not exist.
    pub fn line(&mut self, number: usize) -> io::Result<&[u8]> {
        let place = self.members.partition_point(|member| member.first <= number).wrapping_sub(1);
        let member = *self.members.get(place).ok_or_else(|| invalid("it has no such line"))?;
        if self.latest.as_ref().is_none_or(|(latest, ..)| *latest != place) {
            let bytes = self.read(member)?;
            let ends = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
            let ends = ends.map(|(at, _)| at + 1).collect();
            self.latest = Some((place, bytes, ends));
        }
        let Some((_, bytes, ends)) = &self.latest else { return Err(invalid("it has no such line")) };
        let index = number - member.first;
        let start = if index == 0 { Some(0) } else { ends.get(index - 1).copied() };
        let range = start.zip(ends.get(index).copied());
        range.map(|(start, end)| &bytes[start..end]).ok_or_else(|| invalid("it has no such line"))
    }

    /// The readable lines of a member.
    fn read(&self, member: Member) -> io::Result<Vec<u8>> {
        let mut file = files::open(&self.path)?;
        file.seek(SeekFrom::Start(member.start))?;
        let mut pressed = vec![0; member.size as usize];
        file.read_exact(&mut pressed)?;
        let most = MEMBER_BYTES as u64 + LINE_BYTES;
        let mut bytes = Vec::new();
        let _ = GzDecoder::new(&*pressed).take(most).read_to_end(&mut bytes); // each line has its checksum
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1));
        Ok(bytes)
    }
}

/// Length and number of lines of the member that begins here; `None` if no member does.
fn head_at(file: &mut File, start: u64, end: u64) -> io::Result<Option<(u32, u32)>> {
    let mut head = [0; HEAD_BYTES];
    file.seek(SeekFrom::Start(start))?;
    if end - start < HEAD_BYTES as u64 {
        return Ok(None);
    }
    file.read_exact(&mut head)?;
    let number = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    let (size, count) = (number(HEAD.len()), number(HEAD.len() + 4));
    let fits = size as usize > HEAD_BYTES && u64::from(size) <= end - start;
    Ok((head[..HEAD.len()] == HEAD && fits).then_some((size, count)))
}

fn invalid(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_and_the_file_is_plain_gzip() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lines.gz");
        let members = [member(b"one\ntwo\n", 2).unwrap(), member(b"three\n", 1).unwrap()];
        std::fs::write(&path, members.concat()).unwrap();
        let mut archive = Archive::open(&path).unwrap();
        let lines: Vec<Vec<u8>> = [2, 0, 1].map(|number| archive.line(number).unwrap().to_vec()).to_vec();
        assert_eq!(lines, [b"three\n".to_vec(), b"one\n".to_vec(), b"two\n".to_vec()]);
        assert!(archive.line(3).is_err());
        let mut all = String::new();
        flate2::read::MultiGzDecoder::new(&*members.concat()).read_to_string(&mut all).unwrap();
        assert_eq!(all, "one\ntwo\nthree\n");
    }

    #[test]
    fn what_of_a_damaged_file_can_be_read_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lines.gz");
        let mut bytes = [member(b"one\n", 1).unwrap(), member(b"two\n", 1).unwrap()].concat();
        let last = bytes.len() - 1;
        bytes[last] ^= 1; // the length of the second member's lines
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(Archive::salvage(&path).unwrap(), [b"one\n", b"two\n"]);
        bytes.truncate(last - 3);
        std::fs::write(&path, &bytes).unwrap();
        assert!(Archive::open(&path).is_err());
    }
}
