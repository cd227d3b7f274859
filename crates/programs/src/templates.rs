//! Programs to begin with, in several languages. Each groups by energy, as the policy ENG does.

use std::str::FromStr;

/// A language that there is a program in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// Python 3, without packages.
    Python,
    /// Rust, a package of its own.
    Rust,
    /// Julia, with the package JSON.
    Julia,
    /// R, with the package jsonlite.
    R,
    /// JavaScript for Node, without packages.
    Js,
}

/// A file of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TemplateFile {
    /// Where it belongs.
    pub path: String,
    /// What is in it.
    pub text: String,
}

/// A word that is no [`Language`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("must be python, rust, julia, r or js, found {found:?}")]
pub struct UnknownLanguage {
    /// The word.
    pub found: String,
}

/// Three questions: a team of two roles, one robot, and sizes that are free.
const QUESTIONS: &str = include_str!("../templates/questions.jsonl");

impl Language {
    /// All languages.
    pub const ALL: [Self; 5] = [Self::Python, Self::Rust, Self::Julia, Self::R, Self::Js];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Python => "python",
            Self::Rust => "rust",
            Self::Julia => "julia",
            Self::R => "r",
            Self::Js => "js",
        }
    }

    /// The files of a program with this name; the first one is the program.
    #[must_use]
    pub fn files(self, name: &str) -> Vec<TemplateFile> {
        let questions = |path: String| TemplateFile { path, text: QUESTIONS.to_owned() };
        let file = |path: String, text: &str| TemplateFile { path, text: text.replace("NAME", name) };
        let one = |ending: &str, text: &str| {
            vec![file(format!("{name}.{ending}"), text), questions(format!("{name}.questions.jsonl"))]
        };
        match self {
            Self::Python => one("py", include_str!("../templates/python.py")),
            Self::Julia => one("jl", include_str!("../templates/julia.jl")),
            Self::R => one("R", include_str!("../templates/r.R")),
            Self::Js => one("js", include_str!("../templates/js.js")),
            Self::Rust => vec![
                file(format!("{name}/src/main.rs"), include_str!("../templates/rust.rs")),
                file(format!("{name}/Cargo.toml"), include_str!("../templates/rust.toml")),
                questions(format!("{name}/questions.jsonl")),
            ],
        }
    }

    /// The command that starts the program with this path, without its ending.
    #[must_use]
    pub fn command(self, path: &str) -> Vec<String> {
        let manifest = format!("{path}/Cargo.toml");
        let file = |ending: &str| format!("{path}.{ending}");
        match self {
            Self::Python => vec!["python3".to_owned(), file("py")],
            Self::Julia => vec!["julia".to_owned(), file("jl")],
            Self::R => vec!["Rscript".to_owned(), file("R")],
            Self::Js => vec!["node".to_owned(), file("js")],
            Self::Rust => {
                let words = ["cargo", "run", "--quiet", "--release", "--manifest-path", &manifest];
                words.map(str::to_owned).to_vec()
            }
        }
    }

    /// The command that asks the program with this path, without its ending, three questions.
    #[must_use]
    pub fn test(self, path: &str) -> String {
        match self {
            Self::Rust => format!("cargo test --quiet --manifest-path {path}/Cargo.toml"),
            _ => format!("{} --test", self.command(path).join(" ")),
        }
    }

    /// The policy with this label whose program has this path, without its ending.
    #[must_use]
    pub fn policy(self, label: &str, path: &str) -> String {
        let sources = match self {
            Self::Rust => format!(", sources: [\"{path}/src/*.rs\"]"),
            _ => String::new(),
        };
        format!("{label}=EXEC(command: {:?}{sources})", self.command(path))
    }
}

impl FromStr for Language {
    type Err = UnknownLanguage;

    fn from_str(text: &str) -> Result<Self, UnknownLanguage> {
        let found = Self::ALL.into_iter().find(|language| language.name() == text);
        found.ok_or_else(|| UnknownLanguage { found: text.to_owned() })
    }
}
