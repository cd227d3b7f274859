//! What is wrong with a folder's trials, of which only the first are said one by one.

use std::path::Path;

/// Damaged lines of a journal that are named.
const MOST_NAMED: usize = 5;

/// Damaged lines on their way to the user.
pub(super) struct Damages<'a> {
    path: &'a Path,
    say: &'a mut dyn FnMut(String),
    count: usize,
}

impl<'a> Damages<'a> {
    pub(super) fn new(path: &'a Path, say: &'a mut dyn FnMut(String)) -> Self {
        Self { path, say, count: 0 }
    }

    pub(super) fn say(&mut self, damage: String) {
        self.count += 1;
        if self.count <= MOST_NAMED {
            (self.say)(damage);
        }
    }

    pub(super) fn finish(self) {
        if self.count > MOST_NAMED {
            let more = self.count - MOST_NAMED;
            (self.say)(format!("{}: {more} further lines cannot be used", self.path.display()));
        }
    }
}
