//! `submission.json`: a record of the submission, in the folder of the shards.

use experiments::files::{self, NewFile};
use ron_tree::without_types;
use serde::{Deserialize, Serialize};

use super::plan::Plan;
use crate::prelude::*;

/// Name of the file.
const FILE: &str = "submission.json";
/// Name of the script of the shards.
pub(crate) const ARRAY: &str = "array.sh";
/// Name of the script of the merge job.
pub(crate) const MERGE: &str = "merge.sh";
/// Name of the folder with the output of the jobs.
pub(crate) const LOGS: &str = "logs";
/// Version of the file's layout.
const SCHEMA_VERSION: u32 = 1;

/// A record of the submission.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Submission {
    schema_version: u32,
    /// Name of the sweep.
    pub name: String,
    /// The distribution over shards.
    pub plan: Plan,
    /// Folder for the merged sweep.
    pub out: PathBuf,
    /// The array's job number in Slurm.
    pub array: Option<String>,
    /// The merge job's number in Slurm.
    pub merge: Option<String>,
}

impl Submission {
    pub(super) fn new(name: &str, plan: Plan, out: PathBuf) -> Self {
        Self { schema_version: SCHEMA_VERSION, name: name.to_owned(), plan, out, array: None, merge: None }
    }

    /// Reads the submission from a folder of shards; `None` if there is none.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, Failure> {
        let path = folder.join(FILE);
        if path.symlink_metadata().is_err() {
            return Ok(None);
        }
        let text = files::read(&path).map_err(Failure::input_at(path.display()))?;
        let read: Self = serde_json::from_slice(&text)
            .map_err(|error| Failure::input(format!("{}: {}", path.display(), without_types(&error))))?;
        if read.schema_version != SCHEMA_VERSION {
            let (path, other) = (path.display(), read.schema_version);
            refuse!("{path}: its layout has version {other}; this is {SCHEMA_VERSION}");
        }
        Ok(Some(read))
    }

    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(Failure::run)? + "\n";
        NewFile::write(folder, FILE, text.as_bytes()).map(drop)
    }
}
