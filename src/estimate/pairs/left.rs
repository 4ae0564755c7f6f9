//! The pairs that are left to rays.

/// Pairs left to rays: some by themselves, and in scenes too large for all pairs those of which neither patch lies on
/// an emitting side.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Left {
    /// Patches on emitting sides, where only their pairs are covered; `None` where all are.
    covered: Option<Vec<bool>>,
    /// Columns of each row, ascending.
    rows: Vec<Vec<u32>>,
}

impl Left {
    /// Single pairs of `n` patches, both ways, and what is covered at all.
    pub(super) fn new(n: usize, pairs: &[(u32, u32)], covered: Option<Vec<bool>>) -> Self {
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); n];
        for (i, j) in pairs {
            rows[*i as usize].push(*j);
            rows[*j as usize].push(*i);
        }
        rows.iter_mut().for_each(|row| row.sort_unstable());
        Self { covered, rows }
    }

    /// True if the pair is left to rays.
    pub fn holds(&self, i: usize, j: usize) -> bool {
        let uncovered = self.covered.as_ref().is_some_and(|c| !c[i] && !c[j]);
        uncovered || self.rows[i].binary_search(&(j as u32)).is_ok()
    }

    /// True if every pair of the row is settled.
    pub fn is_settled(&self, i: usize) -> bool {
        self.rows[i].is_empty() && self.covered.as_ref().is_none_or(|c| c[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_pairs_and_what_is_not_covered() {
        let few = Left::new(4, &[(0, 2)], None);
        assert!(few.holds(0, 2) && few.holds(2, 0) && !few.holds(0, 1));
        assert_eq!((0..4).map(|i| few.is_settled(i)).collect::<Vec<_>>(), [false, true, false, true]);
        let lamps = Left::new(3, &[], Some(vec![true, false, false]));
        assert!(lamps.holds(1, 2) && !lamps.holds(0, 1) && !lamps.holds(1, 0));
        assert!(lamps.is_settled(0) && !lamps.is_settled(1));
    }
}
