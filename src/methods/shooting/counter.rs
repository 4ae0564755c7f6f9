//! Where rays end, counted with sign.

use super::row::Row;

/// Signed counts of one row; zero between rows.
#[derive(Debug, Default)]
pub(super) struct Counter {
    counts: Vec<i32>,
    seen: Vec<bool>,
    touched: Vec<u32>,
    /// Rays of each randomisation.
    rays: Vec<Vec<(u32, i8)>>,
}

impl Counter {
    /// A counter for `sinks` places where rays may end.
    pub fn new(sinks: usize, randomisations: u16) -> Self {
        let rays = vec![Vec::new(); usize::from(randomisations)];
        Self { counts: vec![0; sinks], seen: vec![false; sinks], touched: Vec::new(), rays }
    }

    /// Counts a ray.
    #[inline]
    pub fn add(&mut self, sink: u32, randomisation: u16, by: i8) {
        let s = sink as usize;
        if !self.seen[s] {
            self.seen[s] = true;
            self.touched.push(sink);
        }
        self.counts[s] += i32::from(by);
        self.rays[usize::from(randomisation)].push((sink, by));
    }

    /// The row of what was counted; each randomisation has `rays` rays. Leaves the counter zero.
    pub fn take(&mut self, rays: u64) -> Row {
        let all = (rays * self.rays.len() as u64) as f64;
        let empty = |list: &mut Vec<(u32, i8)>| {
            let length = list.len();
            std::mem::replace(list, Vec::with_capacity(length))
        };
        let mut row =
            Row { rays: self.rays.iter_mut().map(empty).collect(), share: 1.0 / rays as f64, ..Row::default() };
        for sink in self.touched.drain(..) {
            let s = sink as usize;
            self.seen[s] = false;
            match std::mem::take(&mut self.counts[s]) {
                0 => {}
                count => row.push_exact(sink, f64::from(count) / all),
            }
        }
        row
    }
}
