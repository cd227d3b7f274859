//! Output files of commands. They are written completely or not at all, and replace an existing file only
//! on request.

use std::path::{Path, PathBuf};

use experiments::Failure;
use experiments::files::NewFile;

/// The folder and the name of a file to write. An existing path with this name is refused, unless it is a
/// file and `force` is given.
pub(crate) fn place<'p>(flag: &str, path: &'p Path, force: bool) -> Result<(PathBuf, &'p str), Failure> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name =
        name.ok_or_else(|| Failure::input(format!("{flag}: {} is not the name of a file", path.display())))?;
    match path.symlink_metadata() {
        Ok(there) if !(force && there.is_file()) => {
            let advice = if there.is_file() { "; --force replaces it" } else { "" };
            return Err(Failure::input(format!(
                "{flag}: {} exists; nothing was overwritten{advice}",
                path.display()
            )));
        }
        _ => {}
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Failure::input(format!("{flag}: there is no folder {}", folder.display())));
    }
    Ok((folder.to_owned(), name))
}

/// Refuses to write to a non-empty folder, unless `force` is given.
pub(crate) fn check_folder(flag: &str, path: &Path, force: bool) -> Result<(), Failure> {
    let is_empty = match std::fs::read_dir(path) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => true,
        Err(error) => return Err(Failure::input(format!("{flag}: {}: {error}", path.display()))),
    };
    if !is_empty && !force {
        let rule = "is not empty; nothing was written; --force writes to it all the same";
        return Err(Failure::input(format!("{flag}: {} {rule}", path.display())));
    }
    Ok(())
}

/// Creates a folder, if it does not exist.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path)
        .map_err(|error| Failure::storage(format!("cannot write to {}: {error}", path.display())))
}

/// Writes a file at its [`place`].
pub(crate) fn write(folder: &Path, name: &str, content: &[u8]) -> Result<(), Failure> {
    NewFile::write(folder, name, content).map(drop)
}
