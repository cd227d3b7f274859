//! Problems from files, and made ones.

use mrta::{Problem, generate};

use usar::prelude::*;

/// The file of a problem in a folder of its own, in the form of `HeteroMRTA`.
const IN_FOLDER: &str = "config.json";

/// Reads a problem, or all of a folder in the order of their names. The error has all that is wrong with all.
pub(super) fn read(path: &Path, limit: usize) -> Result<Vec<Problem>, Failure> {
    let files = if path.is_dir() { files(path)? } else { vec![path.to_owned()] };
    let mut problems = Vec::new();
    let mut wrong = Vec::new();
    for file in files.iter().take(limit) {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(file).map_err(Failure::input_at(&name))?;
        match mrta::read(&name_of(file), &text) {
            Ok(problem) => problems.push(problem),
            Err(error) => wrong.extend(error.to_string().lines().map(|line| format!("{name}: {line}"))),
        }
    }
    if wrong.is_empty() { Ok(problems) } else { Err(Failure::input(wrong.join("\n"))) }
}

/// The name of a file without its ending; of a `config.json`, that of its folder.
fn name_of(file: &Path) -> String {
    let whole = std::path::absolute(file).unwrap_or_default();
    let folder = whole.parent().filter(|_| file.ends_with(IN_FOLDER)).and_then(Path::file_name);
    folder.or(file.file_stem()).unwrap_or_default().to_string_lossy().into_owned()
}

fn files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(folder).map_err(Failure::input_at(folder.display()))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let file = |path: PathBuf| if path.is_dir() { path.join(IN_FOLDER) } else { path };
    let is_problem = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|kind| kind == "json");
    let mut files: Vec<PathBuf> = paths.map(file).filter(is_problem).collect();
    files.sort();
    if files.is_empty() {
        let rule = "must have problems (.json, or config.json in subfolders), found none";
        refuse!("{}: {rule}", folder.display());
    }
    Ok(files)
}

/// Problems of the published form, with the seeds from `seed` on.
pub(super) fn generated(count: u32, seed: u64) -> impl Iterator<Item = Problem> {
    (0..count)
        .map(move |number| generate(&format!("generated_{number:06}"), seed.wrapping_add(u64::from(number))))
}
