//! Stretches of a line cut by half-spaces, and their union.

use crate::math::{DVec3, Plane};

/// Stretches closer than this are one.
const SEAM: f64 = 1e-12;

/// Parameters of a line, `from` to `to`; empty where `from >= to`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
}

impl Stretch {
    /// A segment from its first to its last point.
    pub const SEGMENT: Self = Self { from: 0.0, to: 1.0 };

    /// Cuts off where `at + slope * t` is negative. Of two half-spaces with a common rim, one keeps what the other cuts
    /// off to the last bit, so that neighbours leave no gap.
    pub fn keep(&mut self, at: f64, slope: f64) {
        if slope > 0.0 {
            self.from = self.from.max(-at / slope);
        } else if slope < 0.0 {
            self.to = self.to.min(-at / slope);
        } else if at < 0.0 {
            self.to = f64::NEG_INFINITY;
        }
    }

    pub fn is_empty(&self) -> bool {
        // Also where a value is not a number.
        self.from.partial_cmp(&self.to) != Some(std::cmp::Ordering::Less)
    }
}

/// The part of the segment `a` to `b` in the common part of half-spaces `height >= 0`.
pub(super) fn within(a: DVec3, b: DVec3, sides: &[Plane]) -> Option<Stretch> {
    let mut part = Stretch::SEGMENT;
    for side in sides {
        let (ha, hb) = (side.height(a), side.height(b));
        part.keep(ha, hb - ha);
        if part.is_empty() {
            return None;
        }
    }
    Some(part)
}

/// Sorts stretches and joins those that overlap or touch.
pub(super) fn join(all: &mut Vec<(f64, f64)>) {
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.dedup_by(|next, last| {
        let one = next.0 <= last.1 + SEAM;
        if one {
            last.1 = last.1.max(next.1);
        }
        one
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_that_touch_become_one() {
        let mut all = vec![(0.5, 0.6), (0.0, 0.2), (0.2, 0.3), (0.55, 0.57), (0.8, 0.9)];
        join(&mut all);
        assert_eq!(all, [(0.0, 0.3), (0.5, 0.6), (0.8, 0.9)]);
    }

    #[test]
    fn a_segment_is_cut_by_half_spaces() {
        let sides = [Plane { normal: DVec3::X, offset: 1.0 }, Plane { normal: -2.0 * DVec3::X, offset: -6.0 }];
        let part = within(DVec3::ZERO, 4.0 * DVec3::X, &sides).expect("meets");
        assert_eq!((part.from, part.to), (0.25, 0.75));
        assert!(within(DVec3::Y, DVec3::Z, &sides).is_none());
    }
}
