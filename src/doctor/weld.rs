//! Corners that are the same place get the same number.

use crate::math::DVec3;
use std::collections::HashMap;

/// Numbers of places: points nearer than `tolerance` to the first of a place belong to it.
pub(super) struct Weld {
    tolerance: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
    exact: HashMap<[u64; 3], u32>,
    places: Vec<DVec3>,
}

impl Weld {
    pub(super) fn new(tolerance: f64) -> Self {
        let tolerance = tolerance.max(f64::MIN_POSITIVE);
        Self { tolerance, cells: HashMap::new(), exact: HashMap::new(), places: Vec::new() }
    }

    /// Number of the place of a point, a new one if none is near.
    pub(super) fn number(&mut self, p: DVec3) -> u32 {
        // Adding 0 makes one zero of two.
        let bits = (p + DVec3::ZERO).to_array().map(f64::to_bits);
        if let Some(known) = self.exact.get(&bits) {
            return *known;
        }
        let number = self.near(p).unwrap_or_else(|| self.add(p));
        self.exact.insert(bits, number);
        number
    }

    fn near(&self, p: DVec3) -> Option<u32> {
        // Cells are four tolerances wide: whatever is near lies in one of the eight cells around the nearest corner.
        let corner = (p / (4.0 * self.tolerance)).round();
        let around = (0..8).map(|k| corner - DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)));
        let mut found = around.flat_map(|c| self.cells.get(&key(c)).into_iter().flatten());
        found.find(|n| self.places[**n as usize].distance(p) <= self.tolerance).copied()
    }

    fn add(&mut self, p: DVec3) -> u32 {
        let number = self.places.len() as u32;
        self.places.push(p);
        self.cells.entry(key((p / (4.0 * self.tolerance)).floor())).or_default().push(number);
        number
    }
}

fn key(cell: DVec3) -> [i64; 3] {
    cell.to_array().map(|c| c as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Role, Stream};

    #[test]
    fn near_points_are_one_place_wherever_they_lie() {
        let mut weld = Weld::new(1e-6);
        let s = Stream::new(Role::Witness, 1);
        for k in 0..2000 {
            let p = DVec3::new(s.unit(6 * k), s.unit(6 * k + 1), s.unit(6 * k + 2)) * 4.0 - 2.0;
            let aside = DVec3::new(s.unit(6 * k + 3), s.unit(6 * k + 4), s.unit(6 * k + 5)) - 0.5;
            let number = weld.number(p);
            assert_eq!(weld.number(p + aside.normalize() * 0.9e-6), number, "point {k}");
            assert_ne!(weld.number(p + aside.normalize() * 2.5e-6), number, "point {k}");
        }
        assert_eq!(weld.number(DVec3::ZERO), weld.number(-DVec3::ZERO));
    }
}
