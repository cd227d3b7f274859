//! Reads whole files that users write. Only regular files of limited size are read, so that reading neither
//! blocks nor exhausts memory.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use crate::nearest::nearest;

/// Largest size of a user's text in bytes: 4 MiB.
pub const MAX_TEXT_BYTES: u64 = crate::limits::TEXT_BYTES.most as u64;

/// Why a file cannot be read, as the rest of a sentence after its name.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refuses to read it.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// There is no such file. The text is empty, or names a file that may be meant.
    #[error("cannot be read: there is no such file{0}")]
    Missing(String),
    /// The path is a folder.
    #[error("is a folder, not a file")]
    Folder,
    /// The path is a pipe, a socket or a device.
    #[error("is not a regular file")]
    NotRegular,
    /// The file has too many bytes.
    #[error("is larger than the {} MiB that such a file may have", .0 >> 20)]
    TooLarge(u64),
    /// The file is not UTF-8.
    #[error("is not text in UTF-8: {0}")]
    NotText(String),
}

/// Opens a regular file of at most this many bytes; returns it with its length.
///
/// # Errors
/// The file does not exist, is not a regular file, is too large, or cannot be opened.
pub fn open(path: &Path, most: u64) -> Result<(fs::File, u64), ReadError> {
    let there = fs::metadata(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => ReadError::Missing(meant(path)),
        _ => ReadError::Unreadable(error),
    })?;
    match there.len() {
        _ if there.is_dir() => Err(ReadError::Folder),
        _ if !there.is_file() => Err(ReadError::NotRegular),
        length if length > most => Err(ReadError::TooLarge(most)),
        length => Ok((fs::File::open(path)?, length)),
    }
}

/// What has the most similar name in the folder of a missing path, as the end of a sentence; empty if there
/// is none.
pub fn meant(path: &Path) -> String {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort_unstable();
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    nearest(&name, names.iter().map(String::as_str))
        .map_or(String::new(), |name| format!("; did you mean {}?", path.with_file_name(name).display()))
}

/// Reads a file of at most this many bytes.
///
/// # Errors
/// Those of [`open`], or the file cannot be read.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    open(path, most)?.0.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(ReadError::TooLarge(most)) } else { Ok(bytes) }
}

/// The first bytes of a file, at most this many, and the file's length.
///
/// # Errors
/// Those of [`read`].
pub fn read_start(path: &Path, bytes: u64, most: u64) -> Result<(Vec<u8>, u64), ReadError> {
    let (file, length) = open(path, most)?;
    let mut start = Vec::new();
    file.take(bytes).read_to_end(&mut start)?;
    Ok((start, length))
}

/// Reads a text of at most [`MAX_TEXT_BYTES`], without a byte order mark at its beginning.
///
/// # Errors
/// Those of [`read`], or the file is not text in UTF-8.
pub fn read_text(path: &Path) -> Result<String, ReadError> {
    let mut bytes = read(path, MAX_TEXT_BYTES)?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(ReadError::NotText("it is in UTF-16; save it as UTF-8".to_owned()));
    }
    if bytes.starts_with("\u{feff}".as_bytes()) {
        bytes.drain(.."\u{feff}".len());
    }
    String::from_utf8(bytes).map_err(|error| {
        let sound = error.utf8_error().valid_up_to();
        let before = &error.as_bytes()[..sound];
        let line = before.split(|byte| *byte == b'\n').count();
        ReadError::NotText(format!("byte {} (line {line}) is of no character", sound + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_sensible_size_are_read() {
        let refused = |path: &str| read_text(path.as_ref()).unwrap_err().to_string();
        assert_eq!(refused("/"), "is a folder, not a file");
        assert_eq!(refused("/dev/zero"), "is not a regular file");
        assert!(refused("/nowhere").starts_with("cannot be read: "));
        let folder = std::env::temp_dir().join(format!("ron-tree-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let file = folder.join("file");
        fs::File::create(&file).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(refused(file.to_str().unwrap()), "is larger than the 4 MiB that such a file may have");
        for (bytes, found) in [
            (&b"\xff\xfe(\0"[..], "is not text in UTF-8: it is in UTF-16; save it as UTF-8"),
            (b"(\na: \"\xe9\")", "is not text in UTF-8: byte 7 (line 2) is of no character"),
        ] {
            fs::write(&file, bytes).unwrap();
            assert_eq!(refused(file.to_str().unwrap()), found);
        }
        fs::write(&file, "\u{feff}(a: 1)").unwrap();
        assert_eq!(read_text(&file).unwrap(), "(a: 1)");
        fs::remove_dir_all(&folder).unwrap();
    }
}
