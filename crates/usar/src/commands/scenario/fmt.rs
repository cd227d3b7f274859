//! `usar scenario fmt`: sets the layout of scenario and sweep files.

use scenario::{formatted, read_text};

use crate::prelude::*;

/// Format scenario and sweep files
#[derive(Debug, Args)]
#[command(after_help = "\
Indents, blanks and commas are set; line breaks and comments stay where they are, and no value changes. The \
files are written over.

Examples:
  usar scenario fmt mine.ron
  usar scenario fmt --dry-run scenarios/*.ron     exit status 1 if a file is laid out otherwise")]
pub(crate) struct Arguments {
    /// Scenario or sweep files (RON)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Write nothing; say what would be written
    #[arg(long)]
    dry_run: bool,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        // All files are read before the first one is written.
        let texts = self.files.iter().map(|file| laid_out(file)).collect::<Result<Vec<_>, _>>()?;
        let mut others = 0;
        for (file, text) in self.files.iter().zip(texts) {
            let Some(text) = text else { continue };
            others += 1;
            if !self.dry_run {
                Destination::new("FILE", file, true)?.write(text.as_bytes())?;
            }
            let what = if self.dry_run { "is laid out otherwise" } else { "written" };
            Report::from(format!("{}: {what}", file.display())).print()?;
        }
        if self.dry_run && others > 0 {
            let all = self.files.len();
            return Err(Failure::run(format!("{others} of {all} files; `usar scenario fmt` lays them out")));
        }
        Ok(Report::default())
    }
}

/// The text of a file in the right layout; `None` if the file already has it.
fn laid_out(file: &Path) -> Result<Option<String>, Failure> {
    let text = read_text(file).map_err(Failure::input)?;
    let new = formatted(&text, file).map_err(Failure::input)?;
    Ok((new != text).then_some(new))
}
