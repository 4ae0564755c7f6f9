//! Finished rows as bytes: some two per entry, and nothing is believed when they are read back.

use super::{Block, Entry, FinishedRow};
use crate::raycast::Tally;

impl FinishedRow {
    /// The row as bytes. Addresses are stored as steps from one to the next, all numbers in groups of seven bits.
    pub fn to_bytes(&self, block: Block) -> Vec<u8> {
        let mut out = Vec::with_capacity(32 + 3 * self.entries.len());
        let t = &self.tally;
        for x in [self.row as u64, t.escapes, t.back_hits, t.decided_again, self.entries.len() as u64] {
            put(&mut out, x);
        }
        let mut next = 0;
        for e in &self.entries {
            let address = e.patch() as u64 * u64::from(block.randomisations) + e.randomisation() as u64;
            put(&mut out, address - next);
            put(&mut out, e.count());
            next = address + 1;
        }
        out
    }

    /// The row that these bytes hold; `None` unless each ray of the block is accounted for exactly once.
    pub fn from_bytes(bytes: &[u8], block: Block) -> Option<Self> {
        let mut rest = bytes;
        let mut get = || take(&mut rest);
        let (row, escapes, back_hits, decided_again, count) = (get()?, get()?, get()?, get()?, get()?);
        let r = u64::from(block.randomisations);
        let addresses = block.patches as u64 * r;
        // An entry takes two bytes at least: a damaged number must not ask for memory.
        if count > (bytes.len() / 2) as u64 || count > addresses {
            return None;
        }
        let mut entries = Vec::with_capacity(count as usize);
        let (mut next, mut hits) = (0u64, 0u64);
        for _ in 0..count {
            let address = next.checked_add(get()?).filter(|a| *a < addresses)?;
            let n = get()?;
            if n == 0 || n > block.rays {
                return None;
            }
            entries.push(Entry::new((address / r) as u32, (address % r) as u16, n));
            hits += n;
            next = address + 1;
        }
        let rays = block.rays * r;
        let accounted = hits.checked_add(escapes)?.checked_add(back_hits)? == rays;
        let tally = Tally { rays, escapes, back_hits, decided_again };
        (accounted && rest.is_empty()).then_some(Self { row: usize::try_from(row).ok()?, entries, tally })
    }
}

fn put(out: &mut Vec<u8>, mut x: u64) {
    while x >= 0x80 {
        out.push(x as u8 | 0x80);
        x >>= 7;
    }
    out.push(x as u8);
}

fn take(bytes: &mut &[u8]) -> Option<u64> {
    let mut x = 0u64;
    for shift in (0..64).step_by(7) {
        let (first, rest) = bytes.split_first()?;
        *bytes = rest;
        x |= u64::from(first & 0x7f).checked_shl(shift)?;
        if first & 0x80 == 0 {
            return Some(x);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: Block = Block { start: 64, rays: 128, patches: 300, randomisations: 8 };

    fn sample() -> FinishedRow {
        let entries = vec![Entry::new(0, 0, 128), Entry::new(0, 7, 127), Entry::new(1, 0, 100), Entry::new(299, 7, 60)];
        let tally = Tally { rays: 1024, escapes: 600, back_hits: 9, decided_again: 612 };
        FinishedRow { row: 4321, entries, tally }
    }

    #[test]
    fn rows_come_back() {
        let bytes = sample().to_bytes(BLOCK);
        assert_eq!(FinishedRow::from_bytes(&bytes, BLOCK), Some(sample()));
        assert!(bytes.len() < 24, "{} bytes", bytes.len());
    }

    #[test]
    fn rows_that_lose_or_gain_a_ray_are_refused() {
        let bytes = sample().to_bytes(BLOCK);
        for cut in 0..bytes.len() {
            assert_eq!(FinishedRow::from_bytes(&bytes[..cut], BLOCK), None, "cut at {cut}");
        }
        let longer = [&bytes[..], &[0]].concat();
        assert_eq!(FinishedRow::from_bytes(&longer, BLOCK), None);
        let other = Block { rays: 64, ..BLOCK };
        assert_eq!(FinishedRow::from_bytes(&bytes, other), None);
        let smaller = Block { patches: 299, ..BLOCK };
        assert_eq!(FinishedRow::from_bytes(&bytes, smaller), None);
        let mut lost = sample();
        lost.tally.escapes -= 1;
        assert_eq!(FinishedRow::from_bytes(&lost.to_bytes(BLOCK), BLOCK), None);
        // Whatever the bytes are, the answer is a row or a refusal.
        for seed in 0..2000u64 {
            let noise: Vec<u8> = (0..40).map(|k| (seed.wrapping_mul(k + 0x9E37_79B9) >> (k % 13)) as u8).collect();
            let _ = FinishedRow::from_bytes(&noise, BLOCK);
        }
    }
}
