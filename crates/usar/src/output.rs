//! What commands write: tables and JSON to stdout, and files. A file is written completely or not at all, and
//! replaces another one only on request.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use experiments::files::NewFile;
use experiments::{Failure, refuse};
use reports::table::{Format, Table, shown_as};
use serde::Serialize;
use terminal_size::{Height, Width, terminal_size_of};

use crate::printable::Printable;

/// Version of the JSON that the commands print.
const SCHEMA_VERSION: u32 = 1;

/// The destination of sentences: stdout, or stderr if stdout is for other programs.
pub(crate) fn sentences(format: Format) -> Box<dyn Write> {
    if format.is_for_programs() {
        Box::new(Printable::new(io::stderr()).with_columns(columns_of(terminal_size_of(io::stderr()))))
    } else {
        Box::new(Printable::new(io::stdout().lock()).with_columns(columns_of(terminal_size_of(io::stdout()))))
    }
}

/// Columns of a terminal of this size, or of the variable `COLUMNS`; `None` for neither.
pub(crate) fn columns_of(terminal: Option<(Width, Height)>) -> Option<u16> {
    let of_terminal = terminal.map(|(Width(columns), _)| columns);
    of_terminal.or_else(|| std::env::var("COLUMNS").ok()?.parse().ok()).filter(|columns| *columns > 0)
}

/// Writes a table in the selected format. All tables of the program are written here.
pub(crate) fn print_table(out: &mut dyn Write, table: &Table) -> Result<(), Failure> {
    let format = shown_as();
    let text = format.write(table)?;
    if !format.is_for_programs() {
        return Ok(out.write_all(text.as_bytes())?);
    }
    let mut stdout = Printable::new(io::stdout().lock());
    Ok(stdout.write_all(text.as_bytes())?)
}

/// An object, and the version of its layout.
#[derive(Serialize)]
struct Versioned<'o, O> {
    schema_version: u32,
    #[serde(flatten)]
    object: &'o O,
}

/// Writes an object as a line of JSON to stdout, with its version. All JSON of the program but that of tables
/// is written here.
pub(crate) fn print_json(object: &impl Serialize) -> Result<(), Failure> {
    print_plain_json(&Versioned { schema_version: SCHEMA_VERSION, object })
}

/// The same for an object that has a version of its own.
pub(crate) fn print_plain_json(object: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(object).map_err(Failure::run)?;
    Ok(writeln!(Printable::new(io::stdout().lock()), "{text}")?)
}

/// A table as CSV; its first row is the header.
pub(crate) fn csv_of(rows: impl IntoIterator<Item = Vec<String>>) -> Result<Vec<u8>, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.into_iter().try_for_each(|row| table.write_record(row)).map_err(Failure::run)?;
    table.into_inner().map_err(Failure::run)
}

/// Where a file is written.
pub(crate) struct Destination {
    folder: PathBuf,
    name: String,
}

impl Destination {
    /// The destination with this path. An existing path is refused, unless it is a file and `force` is given.
    pub(crate) fn new(flag: &str, path: &Path, force: bool) -> Result<Self, Failure> {
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

    /// The folder and the name.
    pub(crate) fn parts(&self) -> (&Path, &str) {
        (&self.folder, &self.name)
    }

    /// The file, to be written piece by piece.
    pub(crate) fn begin(&self) -> Result<NewFile, Failure> {
        NewFile::new(&self.folder, &self.name)
    }

    /// Writes the file.
    pub(crate) fn write(&self, content: &[u8]) -> Result<(), Failure> {
        NewFile::write(&self.folder, &self.name, content).map(drop)
    }
}

fn exists(flag: &str, path: &Path) -> String {
    format!("{flag}: {} exists; nothing was overwritten", path.display())
}

/// The failure of writing to a path that an option names.
pub(crate) fn trouble(flag: &str, path: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::AlreadyExists => Failure::input(exists(flag, path)),
        _ => Failure::storage(format!("{flag}: cannot write {}: {error}", path.display())),
    }
}

/// Begins a file that must not exist yet. What is written to it is there at once.
pub(crate) fn create_new(flag: &str, path: &Path) -> Result<File, Failure> {
    File::create_new(path).map_err(|error| trouble(flag, path, &error))
}

/// Refuses to write to a non-empty folder, unless `force` is given; else creates it.
pub(crate) fn make_folder(path: &Path, force: bool) -> Result<(), Failure> {
    check_folder(path, force)?;
    std::fs::create_dir_all(path)
        .map_err(|error| Failure::storage(format!("cannot write to {}: {error}", path.display())))
}

/// Refuses a folder that [`make_folder`] would refuse, and makes none.
pub(crate) fn check_folder(path: &Path, force: bool) -> Result<(), Failure> {
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
