//! What a log is written to.

use std::fs::File;
use std::io::{self, Read, Seek, Write};

/// A file, or something that stands for one in a test.
pub trait Medium: Read + Write + Seek {
    /// Cuts the file to this length.
    ///
    /// # Errors
    /// The disk refuses.
    fn cut(&mut self, length: u64) -> io::Result<()>;

    /// Returns when all that was written is on disk.
    ///
    /// # Errors
    /// The disk refuses.
    fn sync(&mut self) -> io::Result<()>;
}

impl Medium for File {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }
}
