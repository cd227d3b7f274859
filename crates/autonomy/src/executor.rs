//! Who does the work of a step: one thread, or all of them. The results are the same bit for bit.

use rayon::prelude::*;

/// From so many robots on, a step is worth more than one thread.
const MANY_ROBOTS: usize = 500;

/// Parts into which a large team is divided for each thread, so that no thread waits long for another.
const PARTS_PER_THREAD: usize = 4;

/// Does the work for a team in parts.
#[derive(Debug, Clone, Copy, Default)]
pub enum Executor {
    /// One part, on this thread.
    #[default]
    Serial,
    /// Many parts, on all threads.
    Threads,
}

impl Executor {
    /// The executor for a team of so many robots: a small one is not divided.
    #[must_use]
    pub fn for_team(self, robots: usize) -> Self {
        if robots < MANY_ROBOTS { Self::Serial } else { self }
    }

    /// Robots of a part.
    pub fn part(self, robots: usize) -> usize {
        let parts = match self {
            Self::Serial => 1,
            Self::Threads => PARTS_PER_THREAD * rayon::current_num_threads(),
        };
        robots.div_ceil(parts).max(1)
    }

    /// Does the work of each part.
    pub fn run<P: Send>(self, parts: impl Iterator<Item = P> + Send, work: impl Fn(P) + Sync) {
        let work = &work;
        match self {
            Self::Serial => parts.for_each(work),
            Self::Threads => {
                rayon::scope(|scope| parts.for_each(|part| scope.spawn(move |_| work(part))));
            }
        }
    }

    /// Adds to a list what becomes of each item, in the same order.
    pub fn extend<I: Sync, T: Send>(
        self,
        list: &mut Vec<T>,
        items: &[I],
        of: impl Fn(&I) -> T + Sync + Send,
    ) {
        match self {
            Self::Serial => list.extend(items.iter().map(of)),
            Self::Threads => list.par_extend(items.par_iter().map(of)),
        }
    }
}
