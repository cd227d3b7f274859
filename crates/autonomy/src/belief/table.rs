//! Tables of things by number.

use serde::{Deserialize, Serialize};

use crate::hash::part_of_many;

/// Things by number. Numbers may have gaps; the table grows to the largest number.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Table<T>(Vec<Option<T>>);

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Table<T> {
    /// The thing of this number.
    pub fn get(&self, number: usize) -> Option<&T> {
        self.0.get(number)?.as_ref()
    }

    /// All things with their numbers, in order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &T)> {
        (0..).zip(&self.0).filter_map(|(number, thing)| Some((number, thing.as_ref()?)))
    }

    /// A hash of all things, each as these words.
    pub(super) fn digest<const WORDS: usize>(&self, words: impl Fn(&T) -> [u32; WORDS]) -> u128 {
        part_of_many(self.0.iter().map(|thing| thing.as_ref().map_or([u32::MAX; WORDS], &words)))
    }

    pub(super) fn set(&mut self, number: usize, thing: T) {
        if self.0.len() <= number {
            self.0.resize_with(number + 1, || None);
        }
        self.0[number] = Some(thing);
    }
}
