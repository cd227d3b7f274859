//! Whole numbers in few bytes: seven bits in each byte, and the sign in the lowest bit.

/// Appends a number; small numbers take one byte (LEB128).
pub(crate) fn write_unsigned(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Appends a signed number: 0, -1, 1, -2 and so on become 0, 1, 2, 3 (zigzag).
pub(crate) fn write_signed(out: &mut Vec<u8>, value: i64) {
    write_unsigned(out, ((value << 1) ^ (value >> 63)) as u64);
}

/// Reads numbers from bytes, one after the other.
pub(crate) struct Numbers<'b> {
    bytes: &'b [u8],
}

/// The error for bytes that are not the expected numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotNumbers;

impl<'b> Numbers<'b> {
    pub(crate) fn new(bytes: &'b [u8]) -> Self {
        Self { bytes }
    }

    /// Number of bytes left.
    pub(crate) fn left(&self) -> usize {
        self.bytes.len()
    }

    pub(crate) fn unsigned(&mut self) -> Result<u64, NotNumbers> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let (byte, rest) = self.bytes.split_first().ok_or(NotNumbers)?;
            self.bytes = rest;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(NotNumbers)
    }

    pub(crate) fn signed(&mut self) -> Result<i64, NotNumbers> {
        let value = self.unsigned()?;
        Ok((value >> 1).cast_signed() ^ -(value & 1).cast_signed())
    }

    /// A number of things, each of which takes at least one of the remaining bytes.
    pub(crate) fn count(&mut self) -> Result<usize, NotNumbers> {
        let count = usize::try_from(self.unsigned()?).map_err(|_| NotNumbers)?;
        if count <= self.left() { Ok(count) } else { Err(NotNumbers) }
    }

    pub(crate) fn small(&mut self) -> Result<i32, NotNumbers> {
        i32::try_from(self.signed()?).map_err(|_| NotNumbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_were_written() {
        let values = [0, 1, -1, 63, -64, 64, 12_345, -98_765, i64::MAX, i64::MIN];
        let mut bytes = Vec::new();
        values.iter().for_each(|value| write_signed(&mut bytes, *value));
        let mut numbers = Numbers::new(&bytes);
        assert!(values.iter().all(|value| numbers.signed() == Ok(*value)));
        assert_eq!((numbers.left(), numbers.signed()), (0, Err(NotNumbers)));
    }

    #[test]
    fn a_number_that_never_ends_is_refused() {
        assert_eq!(Numbers::new(&[0xff; 20]).unsigned(), Err(NotNumbers));
        assert_eq!(Numbers::new(&[9, 0, 0]).count(), Err(NotNumbers));
    }
}
