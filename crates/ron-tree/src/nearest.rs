//! Finds the known word that a mistyped word was meant to be.

/// Number of characters that are compared; the rest of longer words is ignored.
const MOST_CHARS: usize = 64;

/// The nearest of these words to a mistyped word, if it is near enough. Near enough is at most a third of
/// the characters, or two (one, for words with fewer than four characters), added, left out, changed, or
/// swapped with the next, regardless of the case of ASCII letters. Of equally near words, the first.
pub fn nearest<'w>(word: &str, words: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let start = |word: &str| word.chars().take(MOST_CHARS).collect::<String>().to_ascii_lowercase();
    let typed = start(word);
    let count = typed.chars().count();
    let most = if count < 4 { 1 } else { (count / 3).max(2) };
    let edits = |known: &str| strsim::osa_distance(&typed, &start(known));
    let near = words.into_iter().filter(|known| *known != word).map(|known| (edits(known), known));
    near.filter(|(edits, _)| *edits <= most).min_by_key(|(edits, _)| *edits).map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_that_was_meant_is_found() {
        let words = ["rest_s", "reach_m", "rest_reserve", "Disc", "Box"];
        for (typed, meant) in [
            ("rest", Some("rest_s")),
            ("rest_sec", Some("rest_s")),
            ("raech_m", Some("reach_m")),
            ("reserve", None),
            ("disc", Some("Disc")),
            ("Disk", Some("Disc")),
            ("box", Some("Box")),
            ("", None),
        ] {
            assert_eq!(nearest(typed, words), meant, "{typed}");
        }
        assert_eq!(nearest(&"x".repeat(1_000_000), words), None);
    }
}
