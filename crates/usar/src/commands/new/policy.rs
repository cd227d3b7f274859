//! `usar new policy`: writes a policy in a language of the user's choice.

use programs::templates::{Language, TemplateFile};

use crate::output::{create_new, trouble};
use crate::prelude::*;

/// Write a policy in Python, Rust, Julia, R or JavaScript
#[derive(Debug, Args)]
#[command(after_help = "\
Writes a program that answers questions, and three questions to test it with. It groups by energy, as ENG \
does, until you change its function `decide`. The files must not exist yet. docs/programs.md has the \
messages between the command and a program.

Examples:
  usar new policy mine --lang python       mine.py
  usar new policy --lang r mine            mine.R; needs the package jsonlite
  usar new policy mine --lang rust         the folder mine, a package of its own")]
pub(crate) struct Arguments {
    /// Name of the policy: lower-case letters, digits, `-` and `_`; begins with a letter
    name: String,
    /// Language of the program
    #[arg(long, value_name = "python|rust|julia|r|js")]
    lang: Language,
    /// File or folder to write [default: this folder]
    #[arg(long)]
    out: Option<PathBuf>,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let is_first = self.name.starts_with(|c: char| c.is_ascii_lowercase());
        let is_other = |c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || "-_".contains(c));
        if !is_first || self.name.contains(is_other) {
            refuse!(
                "NAME: must begin with a lower-case letter, and have lower-case letters, digits, `-` and `_` \
                 only, found {:?}",
                self.name
            );
        }
        let folder = self.out.as_deref().unwrap_or(Path::new(""));
        let files = self.lang.files(&self.name);
        let place = |file: &TemplateFile| folder.join(&file.path);
        if let Some(there) = files.iter().map(place).find(|path| path.exists()) {
            refuse!("NAME: {} exists; nothing was overwritten", there.display());
        }
        for file in &files {
            let path = place(file);
            let parent = path.parent().unwrap_or(folder);
            let made = std::fs::create_dir_all(parent);
            made.map_err(|error| trouble("NAME", parent, &error))?;
            let written = create_new("NAME", &path)?.write_all(file.text.as_bytes());
            written.map_err(|error| trouble("NAME", &path, &error))?;
            Report::from(path.display().to_string()).print()?;
        }
        let name = folder.join(&self.name).display().to_string();
        let policy = self.lang.policy(&self.name, &name);
        Ok(Report::of([
            "\nTest it, and run it beside others:".to_owned(),
            format!("  {}", self.lang.test(&name)),
            format!("  usar check --policy '{policy}'"),
            format!("  usar sweep paper --policies 'ENG,{policy}'"),
        ]))
    }
}
