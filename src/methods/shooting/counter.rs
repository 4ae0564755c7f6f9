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

    /// The row of shares: of all rays, then of all rays without those of each randomisation. `rays` are the rays of one
    /// randomisation. Leaves the counter zero.
    pub fn take(&mut self, rays: u64) -> Row {
        let r = self.randomisations;
        let (all, without) = ((rays * r as u64) as f64, (rays * (r as u64 - 1)) as f64);
        let mut row = Row::new(r + 1);
        for sink in self.touched.drain(..) {
            let s = sink as usize;
            self.seen[s] = false;
            let counts = &mut self.counts[s << self.shift..][..r];
            if counts.iter().all(|c| *c == 0) {
                continue;
            }
            let sum: i32 = counts.iter().sum();
            let leave_out = counts.iter().map(|c| f64::from(sum - c) / without);
            row.push(sink, std::iter::once(f64::from(sum) / all).chain(leave_out));
            counts.fill(0);
        }
        row
    }
}
