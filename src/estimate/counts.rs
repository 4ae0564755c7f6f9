//! Hit counts per (row, patch hit, randomisation): integers, hence the same on any number of threads.

use super::FinishedRow;
use crate::raycast::Tally;
use crate::solution::FormFactors;

/// How often the rays of one randomisation of a row hit one patch, packed into eight bytes:
/// patch (24 bits), randomisation (12), count (28).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry(u64);

impl Entry {
    /// Largest patch number, exclusive.
    pub const MAX_PATCHES: usize = 1 << 24;
    /// Largest number of randomisations.
    pub const MAX_RANDOMISATIONS: u16 = 1 << 12;
    /// Largest number of rays of one randomisation of one row.
    pub const MAX_COUNT: u64 = (1 << 28) - 1;

    /// Packs an entry.
    pub fn new(patch: u32, randomisation: u16, count: u64) -> Self {
        debug_assert!((patch as usize) < Self::MAX_PATCHES && count <= Self::MAX_COUNT);
        Self(u64::from(patch) << 40 | u64::from(randomisation) << 28 | count)
    }

    /// Patch hit.
    pub fn patch(self) -> usize {
        (self.0 >> 40) as usize
    }

    /// Randomisation.
    pub fn randomisation(self) -> usize {
        (self.0 >> 28 & 0xfff) as usize
    }

    /// Number of hits.
    pub fn count(self) -> u64 {
        self.0 & Self::MAX_COUNT
    }

    /// Patch and randomisation: what entries are merged by.
    fn address(self) -> u64 {
        self.0 >> 28
    }
}

/// The hit counts of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct HitCounts {
    /// Number of patches that can be hit.
    pub patches: usize,
    /// Number of randomisations R.
    pub randomisations: u16,
    /// Rays per row and randomisation.
    pub rays: u64,
    /// Entries of each row, ascending by (patch, randomisation); empty for rows that take no part.
    pub rows: Vec<Vec<Entry>>,
    /// Rows that take part.
    pub active: Vec<bool>,
    /// What became of all rays.
    pub tally: Tally,
}

impl HitCounts {
    /// No rays yet.
    pub fn empty(patches: usize, randomisations: u16, active: Vec<bool>) -> Self {
        let rows = vec![Vec::new(); active.len()];
        Self { patches, randomisations, rays: 0, rows, active, tally: Tally::default() }
    }

    /// Adds what a later block of rays found for one row.
    pub(super) fn add(&mut self, more: FinishedRow) {
        let row = &mut self.rows[more.row];
        let old = std::mem::take(row);
        *row = if old.is_empty() { more.entries } else { merge(&old, &more.entries) };
        self.tally += more.tally;
    }

    /// Rays of a row over all randomisations.
    fn total(&self) -> f64 {
        self.rays as f64 * f64::from(self.randomisations)
    }

    /// Runs of entries of one patch: (patch, entries).
    pub fn by_patch(&self, row: usize) -> impl Iterator<Item = (usize, &[Entry])> {
        self.rows[row].chunk_by(|a, b| a.patch() == b.patch()).map(|run| (run[0].patch(), run))
    }

    /// Hits of a pair in each randomisation.
    pub fn of_pair(&self, row: usize, patch: usize) -> Vec<u64> {
        let mut counts = vec![0; usize::from(self.randomisations)];
        for (_, run) in self.by_patch(row).filter(|(j, _)| *j == patch) {
            run.iter().for_each(|e| counts[e.randomisation()] = e.count());
        }
        counts
    }

    /// Mean form factors with the standard errors that the spread of the randomisations shows.
    pub fn form_factors(&self) -> FormFactors {
        let row = |i: usize| self.by_patch(i).map(|(j, run)| (j as u32, self.mean(run), self.std_err(run))).collect();
        // As many columns as patches, however many elements the rows are of.
        FormFactors { n: self.patches, ..FormFactors::from_rows((0..self.rows.len()).map(row).collect()) }
    }

    fn mean(&self, run: &[Entry]) -> f64 {
        run.iter().map(|e| e.count()).sum::<u64>() as f64 / self.total()
    }

    fn std_err(&self, run: &[Entry]) -> f64 {
        let r = f64::from(self.randomisations);
        let sum: u64 = run.iter().map(|e| e.count()).sum();
        let mean = sum as f64 / r;
        let hit: f64 = run.iter().map(|e| (e.count() as f64 - mean).powi(2)).sum();
        let missed = (r - run.len() as f64) * mean * mean;
        ((hit + missed) / (r * (r - 1.0))).sqrt() / self.rays as f64
    }

    /// sqrt(sum se^2) / sqrt(sum F^2) over the matrix.
    pub fn relative_error(&self) -> f64 {
        let (mut noise, mut signal) = (0.0, 0.0);
        for i in 0..self.rows.len() {
            for (_, run) in self.by_patch(i) {
                noise += self.std_err(run).powi(2);
                signal += self.mean(run).powi(2);
            }
        }
        if signal == 0.0 { 0.0 } else { (noise / signal).sqrt() }
    }

    /// Area-weighted flows between groups of patches, per randomisation: `sum over i in g, j in h of A_i F_ij`,
    /// m^2, at `[r][g * groups + h]`.
    pub fn flows(&self, areas: &[f64], group: &[usize], groups: usize) -> Vec<Vec<f64>> {
        let mut flows = vec![vec![0.0; groups * groups]; usize::from(self.randomisations)];
        for (i, row) in self.rows.iter().enumerate() {
            for e in row {
                let f = e.count() as f64 / self.rays as f64;
                flows[e.randomisation()][group[i] * groups + group[e.patch()]] += areas[i] * f;
            }
        }
        flows
    }
}

fn merge(a: &[Entry], b: &[Entry]) -> Vec<Entry> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut i, mut k) = (0, 0);
    while i < a.len() && k < b.len() {
        match a[i].address().cmp(&b[k].address()) {
            std::cmp::Ordering::Less => {
                out.push(a[i]);
                i += 1;
            }
            std::cmp::Ordering::Greater => {
                out.push(b[k]);
                k += 1;
            }
            std::cmp::Ordering::Equal => {
                out.push(Entry(a[i].0 + b[k].count()));
                i += 1;
                k += 1;
            }
        }
    }
    out.extend_from_slice(&a[i..]);
    out.extend_from_slice(&b[k..]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_pack_and_merge() {
        let e = Entry::new(12_345, 31, 99);
        assert_eq!((e.patch(), e.randomisation(), e.count()), (12_345, 31, 99));
        let a = [Entry::new(1, 0, 2), Entry::new(3, 1, 1)];
        let b = [Entry::new(1, 0, 5), Entry::new(1, 1, 1), Entry::new(4, 0, 1)];
        assert_eq!(merge(&a, &b), [Entry::new(1, 0, 7), Entry::new(1, 1, 1), Entry::new(3, 1, 1), Entry::new(4, 0, 1)]);
    }

    #[test]
    fn mean_and_standard_error_by_hand() {
        // Counts 1, 0, 2, 1 of 4 rays each: mean 1 / 4, sample variance of counts 2/3, se = sqrt(2/3/4) / 4.
        let mut c = HitCounts::empty(2, 4, vec![true]);
        c.rays = 4;
        let entries = vec![Entry::new(1, 0, 1), Entry::new(1, 2, 2), Entry::new(1, 3, 1)];
        c.add(FinishedRow { row: 0, entries, tally: Tally::default() });
        let f = c.form_factors();
        assert_eq!(f.get(0, 1), 0.25);
        assert!((f.std_err_of(0, 1).unwrap() - (2.0f64 / 12.0).sqrt() / 4.0).abs() < 1e-15);
        assert_eq!(c.of_pair(0, 1), [1, 0, 2, 1]);
    }
}
