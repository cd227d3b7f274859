//! The page: the viewer, with the recordings embedded.

use std::io::Read;

use ron_tree::visible;

use crate::prelude::*;
use crate::recordings::Shown;

/// The viewer, built from the folder `viewer`.
const VIEWER: &str = include_str!("../../../assets/viewer.html");

/// Marks the place of the recordings in the viewer.
const PLACE: &str = "<!--recordings-->";

/// Start of every page that this command writes.
const START: &str = "<!doctype html><!-- usar view -->";

/// Writes a page completely or not at all. An existing page is replaced; any other existing file is not.
pub(super) fn write(path: &Path, shown: &[Shown], is_list: bool) -> Result<(), Failure> {
    if let Ok(file) = std::fs::File::open(path) {
        let mut start = Vec::new();
        let _ = file.take(START.len() as u64).read_to_end(&mut start); // what cannot be read is not ours
        if start != START.as_bytes() {
            refuse!(
                "--out: {} exists and is not a page of `usar view`; nothing was overwritten",
                path.display()
            );
        }
    }
    Destination::new("--out", path, true)?.write(page(shown, is_list).as_bytes())
}

/// The page with these recordings embedded: all of them side by side, or a list to choose from.
pub(crate) fn page(shown: &[Shown], is_list: bool) -> String {
    let (before, after) = VIEWER.split_once(PLACE).unwrap_or((VIEWER, ""));
    let mut page = before.to_owned();
    for Shown { name, bytes } in shown {
        page.push_str("<script type=\"application/x-usrec\" data-name=\"");
        page.push_str(&escaped(name));
        page.push_str(if is_list { "\" data-listed>" } else { "\">" });
        base64(&mut page, bytes);
        page.push_str("</script>\n");
    }
    page + after
}

/// A text escaped as the value of an attribute.
fn escaped(text: &str) -> String {
    visible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Appends bytes in base64 (RFC 4648, section 4).
fn base64(out: &mut String, bytes: &[u8]) {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    out.reserve(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for digit in 0..4 {
            let is_padding = digit > three.len();
            let value = bits >> (18 - 6 * digit) & 63;
            out.push(if is_padding { '=' } else { char::from(DIGITS[value as usize]) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_the_texts_of_the_rfc() {
        let text = |bytes: &str| {
            let mut text = String::new();
            base64(&mut text, bytes.as_bytes());
            text
        };
        let expected = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        assert!((0..=6).all(|length| text(&"foobar"[..length]) == expected[length]));
    }

    #[test]
    fn the_page_has_a_place_for_recordings_and_names_are_no_markup() {
        assert!(VIEWER.starts_with(START) && VIEWER.matches(PLACE).count() == 1);
        let shown = Shown { name: "<script>\"&".into(), bytes: vec![1, 2, 3] };
        assert!(page(&[shown], false).contains("data-name=\"&lt;script&gt;&quot;&amp;\">AQID</script>"));
    }
}
