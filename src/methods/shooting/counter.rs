//! Where rays end, counted with sign per receiver and randomisation.

use super::row::Row;

/// Signed counts of one row; zero between rows.
#[derive(Debug, Default)]
pub(super) struct Counter {
    /// Randomisations rounded up to 2^shift.
    shift: u32,
    randomisations: usize,
    counts: Vec<i32>,
    seen: Vec<bool>,
    touched: Vec<u32>,
}

impl Counter {
    /// A counter for `sinks` places where rays may end.
    pub fn new(sinks: usize, randomisations: u16) -> Self {
        let shift = usize::from(randomisations).next_power_of_two().ilog2();
        Self {
            shift,
            randomisations: usize::from(randomisations),
            counts: vec![0; sinks << shift],
            seen: vec![false; sinks],
            touched: Vec::new(),
        }
    }

    /// Counts a ray.
    #[inline]
    pub fn add(&mut self, sink: u32, randomisation: u16, by: i32) {
        let s = sink as usize;
        if !self.seen[s] {
            self.seen[s] = true;
            self.touched.push(sink);
        }
        self.counts[s << self.shift | usize::from(randomisation)] += by;
    }

    /// The row of shares: of all rays, and of the rays of each randomisation, of which each has `rays`. Leaves the counter
    /// zero.
    pub fn take(&mut self, rays: u64) -> Row {
        let r = self.randomisations;
        let (one, all) = (rays as f64, (rays * r as u64) as f64);
        let mut row = Row::default();
        for sink in self.touched.drain(..) {
            let s = sink as usize;
            self.seen[s] = false;
            let counts = &mut self.counts[s << self.shift..][..r];
            let hit = counts.iter().enumerate().filter(|(_, c)| **c != 0);
            let parts = hit.map(|(k, c)| (k as u16 + 1, f64::from(*c) / one));
            if counts.iter().any(|c| *c != 0) {
                row.push(sink, f64::from(counts.iter().sum::<i32>()) / all, parts);
                counts.fill(0);
            }
        }
        row
    }
}
