//! Where samples lie: one scrambled net, shifted anew for every pixel, randomisation and purpose.

use crate::sampling::{Stream, owen_scrambled, sobol};

/// The points of one randomisation in four dimensions, to be shifted.
///
/// Shifts are exclusive ors with random words: nets stay nets, every point is uniform, and what two different shifts
/// give is independent whatever the net.
#[derive(Debug, Clone)]
pub(super) struct Net {
    points: Vec<[u64; 4]>,
    shifts: Stream,
}

/// Which two of the four dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pair {
    /// Places in a pixel, or directions.
    First,
    /// Places on lamps.
    Second,
}

impl Net {
    /// `count` points, at least one.
    pub fn new(stream: Stream, count: u64) -> Self {
        let scramble = stream.child(0);
        let point = |k| [0, 1, 2, 3].map(|d| owen_scrambled(sobol(k, d), scramble.child(d as u64)));
        Self { points: (0..count.max(1)).map(point).collect(), shifts: stream.child(1) }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The shift of a place (a pixel), one of its randomisations and a purpose.
    pub fn shift(&self, place: u64, randomisation: u64, purpose: u64) -> [u64; 2] {
        let own = self.shifts.child(place).child(randomisation).child(purpose);
        [own.at(0), own.at(1)]
    }

    /// Point k, shifted, in the open unit square.
    pub fn at(&self, k: usize, pair: Pair, shift: [u64; 2]) -> [f64; 2] {
        let p = &self.points[k];
        let first = if pair == Pair::First { 0 } else { 2 };
        [fraction(p[first] ^ shift[0]), fraction(p[first + 1] ^ shift[1])]
    }
}

/// Middle of the 2^-53 cell that a 64-bit fraction lies in.
fn fraction(x: u64) -> f64 {
    ((x >> 11) as f64 + 0.5) * f64::powi(2.0, -53)
}
