//! A position in a RON text, and the steps over its smallest parts.

pub(crate) struct Cursor<'a> {
    text: &'a str,
    at: usize,
    /// Line breaks before `counted`.
    breaks: usize,
    counted: usize,
}

impl<'a> Cursor<'a> {
    /// A cursor at the beginning of a text.
    pub(crate) fn new(text: &'a str) -> Self {
        Self { text, at: 0, breaks: 0, counted: 0 }
    }

    /// Bytes before the position; never more than the text has.
    pub(crate) fn at(&self) -> usize {
        self.at.min(self.text.len())
    }

    pub(crate) fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    pub(crate) fn advance(&mut self) {
        self.at += 1;
    }

    pub(crate) fn go_back(&mut self, at: usize) {
        self.at = at;
    }

    pub(crate) fn end(&mut self) {
        self.at = self.text.len();
    }

    /// The text from an earlier position to this one.
    pub(crate) fn since(&self, start: usize) -> &'a str {
        self.text.get(start..self.at()).unwrap_or_default()
    }

    /// The line of the position, from 1.
    pub(crate) fn line(&mut self) -> usize {
        let new = String::from_utf8_lossy(&self.text.as_bytes()[self.counted..self.at()]);
        self.breaks += new.matches('\n').count();
        self.counted = self.at();
        1 + self.breaks
    }

    fn starts_with(&self, what: &[u8]) -> bool {
        self.text.as_bytes()[self.at()..].starts_with(what)
    }

    fn skip_while(&mut self, goes_on: impl Fn(u8) -> bool) {
        while self.peek().is_some_and(&goes_on) {
            self.at += 1;
        }
    }

    /// Skips white space, `// ...` and nested `/* ... */`.
    pub(crate) fn skip_blank(&mut self) {
        while let Some(byte) = self.peek() {
            if self.starts_with(b"//") {
                self.skip_while(|byte| byte != b'\n');
            } else if self.starts_with(b"/*") {
                self.skip_block_comment();
            } else if byte.is_ascii_whitespace() {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    pub(crate) fn skip_block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.text.len() {
            if self.starts_with(b"/*") {
                depth += 1;
                self.at += 2;
            } else if self.starts_with(b"*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.at += 1;
            }
        }
    }

    /// Skips `#![enable(...)]` before the value of a text.
    pub(crate) fn skip_attributes(&mut self) {
        self.skip_blank();
        while self.starts_with(b"#!") {
            self.skip_while(|byte| byte != b']');
            self.at += 1;
            self.skip_blank();
        }
    }

    /// Steps over letters, digits and `_`, and returns them; of `r#name`, it returns the part after `r#`.
    pub(crate) fn identifier(&mut self) -> &'a str {
        let is_raw = self.starts_with(b"r#")
            && self.text.as_bytes().get(self.at + 2).is_some_and(|byte| is_of_name(*byte));
        let start = if is_raw { self.at + 2 } else { self.at };
        self.at = start;
        self.skip_while(|byte| is_of_name(byte) || is_raw && b".+-".contains(&byte));
        self.since(start)
    }

    /// Steps over a number, or over any other text up to a blank, a comment or the end of the entry.
    pub(crate) fn word(&mut self) {
        self.skip_while(|byte| !b",)]}/".contains(&byte) && !byte.is_ascii_whitespace());
    }

    /// Steps over a string or a character.
    pub(crate) fn quoted(&mut self, quote: u8) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == quote {
                break;
            }
        }
        self.at = self.at();
    }

    /// Steps over the rest of `r#"..."#` after the `r`.
    pub(crate) fn raw_string(&mut self) {
        let mut end = vec![b'"'];
        while self.peek() == Some(b'#') {
            end.push(b'#');
            self.at += 1;
        }
        self.at += 1;
        while self.at < self.text.len() && !self.starts_with(&end) {
            self.at += 1;
        }
        self.at += end.len();
    }
}

/// Whether a byte may occur in a name. Each byte of a letter beyond ASCII may.
pub(crate) fn is_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || !byte.is_ascii()
}
