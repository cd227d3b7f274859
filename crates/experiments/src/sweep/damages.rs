//! Reports of damaged trials in a folder. Only the first few are reported one by one.

use std::path::Path;

/// Largest number of damaged lines that are reported one by one.
const MOST_NAMED: usize = 5;

/// Passes reports of damaged lines to the user.
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
