//! Finds the known word that a mistyped word was meant to be.

/// The nearest of these words to a mistyped word, if it is near enough. Near enough is at most a third of
/// the characters, or two (one, for words with fewer than four characters), added, left out, changed, or
/// swapped with the next. Of equally near words, the first.
#[must_use]
pub fn nearest<'w>(word: &str, words: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let typed: Vec<char> = word.chars().take(MOST_CHARS).collect();
    let most = if typed.len() < 4 { 1 } else { (typed.len() / 3).max(2) };
    let near = words.into_iter().filter(|known| *known != word).map(|known| (edits(&typed, known), known));
    near.filter(|(edits, _)| *edits <= most).min_by_key(|(edits, _)| *edits).map(|(_, known)| known)
}

/// Number of characters that are compared; the rest of longer words is ignored.
const MOST_CHARS: usize = 64;

/// Number of edits that turn one word into the other, regardless of the case of ASCII letters (optimal
/// string alignment; Boytsov 2011).
fn edits(typed: &[char], known: &str) -> usize {
    let lower = |c: char| c.to_ascii_lowercase();
    let (a, b): (Vec<char>, Vec<char>) =
        (typed.iter().map(|c| lower(*c)).collect(), known.chars().take(MOST_CHARS).map(lower).collect());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            let mut least = (rows[i - 1][j] + 1).min(row[j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
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
