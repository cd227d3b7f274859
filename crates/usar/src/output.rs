//! The files that commands write. A file is written completely or not at all, and replaces another one only
//! on request.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use experiments::files::NewFile;
use experiments::{Failure, refuse};

/// Where a file is written.
pub struct Destination {
    folder: PathBuf,
    name: String,
}

impl Destination {
    /// The destination with this path. An existing path is refused, unless it is a file and `force` is given.
    ///
    /// # Errors
    /// The path is no name of a file, is taken, or is in no folder.
    pub fn new(flag: &str, path: &Path, force: bool) -> Result<Self, Failure> {
        let name = path.file_name().and_then(|name| name.to_str()).map(str::to_owned);
        let name = name
            .ok_or_else(|| Failure::input(format!("{flag}: {} is not the name of a file", path.display())))?;
        match path.symlink_metadata() {
            Ok(there) if !(force && there.is_file()) => {
                let advice = if there.is_file() { "; --force replaces it" } else { "" };
                refuse!("{}{advice}", exists(flag, path));
            }
            _ => {}
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            refuse!("{flag}: there is no folder {}", folder.display());
        }
        Ok(Self { folder: folder.to_owned(), name })
    }

    /// The file, to be written piece by piece.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn begin(&self) -> Result<NewFile, Failure> {
        NewFile::new(&self.folder, &self.name)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn write(&self, content: &[u8]) -> Result<(), Failure> {
        NewFile::write(&self.folder, &self.name, content).map(drop)
    }
}

fn exists(flag: &str, path: &Path) -> String {
    format!("{flag}: {} exists; nothing was overwritten", path.display())
}

/// The failure of writing to a path that an option names.
pub fn trouble(flag: &str, path: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::AlreadyExists => Failure::input(exists(flag, path)),
        _ => Failure::storage(format!("{flag}: cannot write {}: {error}", path.display())),
    }
}

/// Begins a file that must not exist yet. What is written to it is there at once.
///
/// # Errors
/// The file exists, or cannot be made.
pub fn create_new(flag: &str, path: &Path) -> Result<File, Failure> {
    File::create_new(path).map_err(|error| trouble(flag, path, &error))
}

/// Refuses to write to a non-empty folder, unless `force` is given; else creates it.
///
/// # Errors
/// The folder is not empty, or cannot be made.
pub fn make_folder(path: &Path, force: bool) -> Result<(), Failure> {
    check_folder(path, force)?;
    std::fs::create_dir_all(path)
        .map_err(|error| Failure::storage(format!("cannot write to {}: {error}", path.display())))
}

/// Refuses a folder that [`make_folder`] would refuse, and makes none.
///
/// # Errors
/// The folder is not empty, or cannot be read.
pub fn check_folder(path: &Path, force: bool) -> Result<(), Failure> {
    let is_empty = match std::fs::read_dir(path) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => true,
        Err(error) => refuse!("--out: {}: {error}", path.display()),
    };
    if !is_empty && !force {
        let rule = "is not empty; nothing was written; --force writes to it all the same";
        refuse!("--out: {} {rule}", path.display());
    }
    Ok(())
}
