//! Which files of a folder belong to a sweep or a report. No other file is deleted or overwritten, and no
//! link is followed.

use std::fs;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

use ron_tree::visible;
use store::files::{self, NewFile};
use store::lock::is_lock;
use store::owned::names_in;
use store::{Failure, at, refuse};
use tempfile::{SpooledTempFile, spooled_tempfile_in};

use super::names::{INPUTS, MANIFEST, PLOTS, RECORDINGS, REPORT};
use super::tables::TABLES;
use super::{host, journal};

/// The file that lists the names of the files that a report wrote, one on each line, relative to the
/// folder.
const REPORTED: &str = "report.files";

/// File name extension of a recording.
const RECORDING: &str = ".usrec";

/// The names of all files that a sweep writes.
fn known_names() -> impl Iterator<Item = &'static str> {
    let logs = [MANIFEST, journal::FILE, journal::ARCHIVE, host::FILE];
    logs.into_iter().chain(INPUTS).chain(TABLES.into_iter().flat_map(|[csv, parquet, _]| [csv, parquet]))
}

/// Deletes the Parquet files, because they would belong to other tables.
pub(super) fn remove_parquets(path: &Path) -> std::io::Result<()> {
    TABLES.iter().try_for_each(|[_, parquet, _]| files::remove(&path.join(parquet)))
}

/// Refuses to start over in a folder with files that neither a sweep nor a report has written.
pub(super) fn check_may_be_cleared(path: &Path) -> Result<(), Failure> {
    let reported = reported(path);
    let is_known = |name: &str| {
        let name = name.strip_suffix(".new").unwrap_or(name);
        let is_folder = path.join(name).symlink_metadata().is_ok_and(|there| there.is_dir());
        is_folder && [PLOTS, RECORDINGS].contains(&name)
            || name == REPORTED
            || is_lock(name)
            || known_names().any(|known| known == name)
            || reported.contains(&name.into())
    };
    let mut strangers = names_in(path)?;
    strangers.retain(|name| !is_known(name));
    for name in names_in(&path.join(PLOTS)).unwrap_or_default() {
        let name = format!("{PLOTS}/{name}");
        if !reported.contains(&name) {
            strangers.push(name);
        }
    }
    let recordings = files_in(&path.join(RECORDINGS)).into_iter();
    let others = recordings.filter(|name| !is_recording(name));
    strangers.extend(others.map(|name| format!("{RECORDINGS}/{name}")));
    if strangers.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "--fresh: {} has files that are not the sweep's: {}; nothing was deleted",
        path.display(),
        strangers.join(", ")
    )))
}

/// The files that the last report wrote, from its list: report.html, figures, and replays.
fn reported(path: &Path) -> Vec<String> {
    let list = files::read(&path.join(REPORTED)).unwrap_or_default();
    let is_figure = |name: &str| {
        let figure = name.strip_prefix(PLOTS).and_then(|name| name.strip_prefix('/'));
        let has_kind = |kind| name.ends_with(kind);
        figure.is_some_and(|figure| !figure.contains(['/', '\\']))
            && (has_kind(".svg") || has_kind(".csv") || has_kind(".html"))
    };
    let names = String::from_utf8_lossy(&list).lines().map(str::to_owned).collect::<Vec<_>>();
    names.into_iter().filter(|name| name == REPORT || is_figure(name)).collect()
}

/// A file of a report that is larger than this waits on the disk until all are made, in bytes.
const MOST_IN_MEMORY: usize = 1 << 20;

/// The files of a report until all of them are made.
pub struct Report {
    folder: PathBuf,
    /// Names relative to the folder. A large file waits without a name in the folder.
    files: Vec<(String, SpooledTempFile)>,
}

impl Report {
    /// A report in this folder, without any file yet.
    pub fn of(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), files: Vec::new() }
    }

    /// Adds a text file, by its name relative to the folder. Characters that act unseen are written by their
    /// numbers: names and titles of users' files cannot turn the direction of a page.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, name: String, text: &str) -> Result<(), Failure> {
        let mut file = spooled_tempfile_in(MOST_IN_MEMORY, &self.folder);
        let written = file.write_all(visible(text).as_bytes()).and_then(|()| file.rewind());
        written.map_err(|error| self.trouble(&error))?;
        self.files.push((name, file));
        Ok(())
    }

    /// Writes the files in the place of those of the previous report.
    ///
    /// # Errors
    /// A file with one of these names exists that no report has written, or the disk does not take it.
    pub fn write(mut self) -> Result<(), Failure> {
        let (path, before) = (&self.folder, reported(&self.folder));
        let plots = path.join(PLOTS);
        if plots.symlink_metadata().is_ok_and(|there| !there.is_dir()) {
            refuse!("{}: is not a folder", plots.display());
        }
        for (name, _) in &self.files {
            if !before.contains(name) && path.join(name).symlink_metadata().is_ok() {
                let name = path.join(name);
                refuse!("{}: is not of a report of this program; nothing was overwritten", name.display());
            }
        }
        remove_report(path).map_err(|error| self.trouble(&error))?;
        if self.files.iter().any(|(name, _)| name.starts_with(PLOTS)) {
            fs::create_dir_all(&plots).map_err(|error| self.trouble(&error))?;
        }
        let names: Vec<&str> = self.files.iter().map(|(name, _)| name.as_str()).collect();
        NewFile::write(path, REPORTED, (names.join("\n") + "\n").as_bytes())?;
        for (name, content) in &mut self.files {
            let mut file = NewFile::new(&self.folder, name)?;
            std::io::copy(content, &mut file).map_err(at(&self.folder.join(&*name)))?;
            file.finish()?;
        }
        Ok(())
    }

    fn trouble(&self, error: &std::io::Error) -> Failure {
        Failure::storage(format!("cannot write to {}: {error}", self.folder.display()))
    }
}

/// Deletes the files that a report wrote.
pub(super) fn remove_report(path: &Path) -> std::io::Result<()> {
    for name in reported(path) {
        files::remove(&path.join(name))?;
    }
    let _ = fs::remove_dir(path.join(PLOTS)); // it stays where something else is in it
    files::remove(&path.join(REPORTED))
}

fn is_recording(name: &str) -> bool {
    name.strip_suffix(".new").unwrap_or(name).ends_with(RECORDING)
}

/// Deletes recordings.
fn remove_recordings(path: &Path) -> std::io::Result<()> {
    let folder = path.join(RECORDINGS);
    for name in files_in(&folder).iter().filter(|name| is_recording(name)) {
        files::remove(&folder.join(name))?;
    }
    for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
        let _ = fs::remove_dir(entry.path()); // it stays where something else is in it
    }
    let _ = fs::remove_dir(folder);
    Ok(())
}

/// The files in a folder and in its subfolders, by their names relative to the folder. A link to a folder
/// counts as a file.
fn files_in(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for name in names_in(folder).unwrap_or_default() {
        let path = folder.join(&name);
        if path.symlink_metadata().is_ok_and(|there| there.is_dir()) {
            found.extend(names_in(&path).unwrap_or_default().iter().map(|inner| format!("{name}/{inner}")));
        } else {
            found.push(name);
        }
    }
    found
}

/// Deletes the incomplete files of a killed process.
pub(super) fn remove_unfinished(path: &Path) -> std::io::Result<()> {
    known_names().try_for_each(|name| files::remove(&path.join(format!("{name}.new"))))
}

/// Deletes the files that a sweep wrote.
pub(super) fn clear(path: &Path) -> std::io::Result<()> {
    remove_report(path)?;
    remove_recordings(path)?;
    known_names().try_for_each(|name| files::remove(&path.join(name)))
}
