//! A hash of sources that ignores what decides no result: comments, blank space and `#[cfg(test)]` modules.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

/// A hash of files, and of the files in folders: of their paths below `root`, and of their contents. The
/// files of `#[cfg(test)]` modules are left out.
pub fn hash(root: &Path, places: &[PathBuf]) -> u64 {
    let mut files = Vec::new();
    places.iter().for_each(|place| collect(place, &mut files));
    files.sort();
    let sources: Vec<(PathBuf, Source)> = files.into_iter().map(|path| (path.clone(), read(&path))).collect();
    let tests: Vec<&PathBuf> = sources.iter().flat_map(|(_, source)| &source.tests).collect();
    let is_test = |path: &Path| tests.iter().any(|test| path.with_extension("").starts_with(test));
    let mut hasher = DefaultHasher::new();
    for (path, source) in sources.iter().filter(|(path, _)| !is_test(path)) {
        let path = path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace('\\', "/");
        (path, &source.code).hash(&mut hasher);
    }
    hasher.finish()
}

/// A file, as far as it decides results.
struct Source {
    code: Vec<u8>,
    /// Paths of its test modules that are files of their own, without extensions.
    tests: Vec<PathBuf>,
}

fn collect(place: &Path, files: &mut Vec<PathBuf>) {
    if !place.is_dir() {
        return files.push(place.to_owned());
    }
    for entry in std::fs::read_dir(place).into_iter().flatten().flatten() {
        collect(&entry.path(), files);
    }
}

fn read(path: &Path) -> Source {
    let bytes = std::fs::read(path).unwrap_or_default();
    let is_rust = path.extension().is_some_and(|extension| extension == "rs");
    let text = std::str::from_utf8(&bytes).ok().filter(|_| is_rust);
    let Some(tokens) = text.and_then(|text| text.parse::<TokenStream>().ok()) else {
        return Source { code: bytes, tests: Vec::new() };
    };
    let (mut code, mut tests) = (String::new(), Vec::new());
    write(tokens, &mut code, &mut tests);
    let is_root = ["mod", "lib", "main"].iter().any(|name| path.file_stem() == Some(name.as_ref()));
    let folder = if is_root { path.with_file_name("") } else { path.with_extension("") };
    Source { code: code.into_bytes(), tests: tests.iter().map(|name| folder.join(name)).collect() }
}

/// Writes the tokens that decide results, and collects the names of test modules without a body.
fn write(tokens: TokenStream, code: &mut String, tests: &mut Vec<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        if let Some((length, name)) = test_module(&tokens[at..]) {
            tests.extend(name);
            at += length;
            continue;
        }
        if let Some((length, attribute)) = attribute(&tokens[at..])
            && attribute.starts_with("doc ")
        {
            at += length;
            continue;
        }
        match token {
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Parenthesis => ["(", ")"],
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    Delimiter::None => ["", ""],
                };
                code.push_str(open);
                write(group.stream(), code, tests);
                code.push_str(close);
            }
            TokenTree::Punct(sign) if sign.spacing() == Spacing::Joint => code.push(sign.as_char()),
            token => {
                code.push_str(&token.to_string());
                code.push(' ');
            }
        }
        at += 1;
    }
}

/// The attribute at the start of these tokens: its number of tokens, and its text.
fn attribute(tokens: &[TokenTree]) -> Option<(usize, String)> {
    let is = |at: usize, sign| matches!(tokens.get(at), Some(TokenTree::Punct(it)) if it.as_char() == sign);
    let place = 1 + usize::from(is(1, '!'));
    match tokens.get(place) {
        Some(TokenTree::Group(group)) if is(0, '#') && group.delimiter() == Delimiter::Bracket => {
            Some((place + 1, group.stream().to_string()))
        }
        _ => None,
    }
}

/// The test module at the start of these tokens: its number of tokens, and its name if it is another file.
fn test_module(tokens: &[TokenTree]) -> Option<(usize, Option<String>)> {
    let (mut at, mut is_test) = (0, false);
    while let Some((length, text)) = attribute(&tokens[at..]) {
        is_test |= text.replace(' ', "") == "cfg(test)";
        at += length;
    }
    match tokens.get(at..at + 3)? {
        [TokenTree::Ident(word), TokenTree::Ident(name), body] if is_test && word == "mod" => {
            Some((at + 3, matches!(body, TokenTree::Punct(_)).then(|| name.to_string())))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "//! A crate.\n/// Adds.\nfn add(a: u32, b: u32) -> u32 {\n    a + b // a sum\n}\n";

    /// The hash of a crate with this `lib.rs`, and with these lines in the file of a module `more`.
    fn hash_of(lib: &str, more: &str) -> u64 {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("lib.rs"), lib).unwrap();
        std::fs::write(folder.path().join("more.rs"), more).unwrap();
        hash(folder.path(), &[folder.path().to_owned()])
    }

    #[test]
    fn comments_and_blank_space_change_nothing() {
        let same = "#![doc = \"Another one.\"]\nfn add(a: u32,b: u32)->u32 { /* now\n */ a+b }";
        assert_eq!(hash_of(CODE, ""), hash_of(same, "// nothing"));
    }

    #[test]
    fn a_test_changes_nothing_in_the_same_file_or_in_another_one() {
        let with_test = format!("{CODE}#[cfg(test)]\n#[expect(unused)]\nmod tests {{ fn f() {{}} }}\n");
        assert_eq!(hash_of(&with_test, ""), hash_of(CODE, ""));
        let with_file = format!("{CODE}#[cfg(test)]\nmod more;\n");
        let without = hash_of(&with_file, "fn f() {}");
        assert_eq!(without, hash_of(&with_file, "fn g() {}"));
    }

    #[test]
    fn code_changes_it() {
        let changed = [
            hash_of(&CODE.replace("a + b", "a - b"), ""),
            hash_of(CODE, "fn f() {}"),
            hash_of(&format!("{CODE}mod tests {{}}"), ""),
            hash_of(&format!("{CODE}#[cfg(not(test))] mod tests {{}}"), ""),
            hash_of(&format!("{CODE}const A: &str = \"// a\";"), ""),
            hash_of(&format!("{CODE}const A: &str = \"// b\";"), ""),
        ];
        let mut all = changed.to_vec();
        all.push(hash_of(CODE, ""));
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), changed.len() + 1);
    }
}

/// The program in the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
