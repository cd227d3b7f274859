//! Sequences of pictures as a GIF.

use std::collections::HashMap;
use std::io::Write;

use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, Frame, Repeat};

use crate::error::PictureError;
use crate::raster::Pixels;

/// Number of colours of an animation; one more number stands for an unchanged pixel.
const COLOURS: usize = 255;

/// The number of an unchanged pixel.
const SAME: u8 = 255;

/// How thoroughly colours are chosen: 1 is best, 30 fastest.
const THOROUGHNESS: i32 = 3;

/// A GIF that is being written and that repeats forever. Of each picture, it stores the difference from the
/// one before.
pub struct Animation<W: Write> {
    encoder: Encoder<W>,
    colours: NeuQuant,
    numbers: HashMap<[u8; 4], u8>,
    size: [u16; 2],
    before: Vec<u8>,
    delay: u16,
}

/// The smallest rectangle with all changed pixels: its upper left corner and its size.
struct Changed {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl<W: Write> Animation<W> {
    /// Begins a GIF. Its colours are chosen from the `samples`, which are some of its pictures. Each
    /// picture is shown for this many hundredths of a second.
    ///
    /// # Errors
    /// There is no sample, it is too large, or the output cannot be written.
    pub fn begin(out: W, samples: &[Pixels], hundredths: u16) -> Result<Self, PictureError> {
        let first = samples.first().ok_or(PictureError::OtherSize)?;
        let pixels_of = |length: u32| {
            let (width, height) = (first.width, first.height);
            let most = u32::from(u16::MAX);
            u16::try_from(length).map_err(|_| PictureError::TooLarge { width, height, most })
        };
        let size = [pixels_of(first.width)?, pixels_of(first.height)?];
        let pixels: Vec<u8> = samples.iter().flat_map(|sample| sample.rgba.iter().copied()).collect();
        let colours = NeuQuant::new(THOROUGHNESS, COLOURS, &pixels);
        let mut encoder = Encoder::new(out, size[0], size[1], &colours.color_map_rgb())?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self { encoder, colours, numbers: HashMap::new(), size, before: Vec::new(), delay: hundredths })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// It has another size than the samples, or cannot be written.
    pub fn push(&mut self, pixels: &Pixels) -> Result<(), PictureError> {
        if [pixels.width, pixels.height] != self.size.map(u32::from) {
            return Err(PictureError::OtherSize);
        }
        let (colours, numbers) = (&self.colours, &mut self.numbers);
        let mut number = |pixel: &[u8; 4]| {
            *numbers.entry(*pixel).or_insert_with(|| colours.index_of(pixel).min(COLOURS - 1) as u8)
        };
        let now: Vec<u8> = pixels.rgba.as_chunks().0.iter().map(&mut number).collect();
        let changed = self.changed(&now);
        let cut = |buffer: &[u8]| -> Vec<u8> {
            let rows = buffer.chunks_exact(usize::from(self.size[0])).skip(changed.top).take(changed.height);
            rows.flat_map(|row| row[changed.left..changed.left + changed.width].iter().copied()).collect()
        };
        let mut buffer = cut(&now);
        if !self.before.is_empty() {
            let before = cut(&self.before);
            buffer
                .iter_mut()
                .zip(before)
                .filter(|(now, before)| **now == *before)
                .for_each(|(now, _)| *now = SAME);
        }
        self.encoder.write_frame(&Frame {
            delay: self.delay,
            dispose: DisposalMethod::Keep,
            transparent: Some(SAME),
            left: changed.left as u16,
            top: changed.top as u16,
            width: changed.width as u16,
            height: changed.height as u16,
            buffer: buffer.into(),
            ..Frame::default()
        })?;
        self.before = now;
        Ok(())
    }

    /// Ends the GIF.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(self) -> Result<W, PictureError> {
        Ok(self.encoder.into_inner()?)
    }

    fn changed(&self, now: &[u8]) -> Changed {
        let width = usize::from(self.size[0]);
        let whole = Changed { left: 0, top: 0, width, height: usize::from(self.size[1]) };
        if self.before.is_empty() {
            return whole;
        }
        let other = || (0..now.len()).filter(|i| now[*i] != self.before[*i]);
        let (Some(first), Some(last)) = (other().next(), other().next_back()) else {
            return Changed { width: 1, height: 1, ..whole };
        };
        let (left, right) =
            other().fold((width, 0), |(left, right), i| (left.min(i % width), right.max(i % width)));
        let top = first / width;
        Changed { left, top, width: right - left + 1, height: last / width - top + 1 }
    }
}
