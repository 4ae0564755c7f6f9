//! Samples of (point on a lamp x point on a patch): one net per randomisation, shared by all patches of a pass.

use crate::sampling::{Stream, owen_scrambled, sobol};
use rayon::prelude::*;

/// Four coordinates of 31 bits per sample: two choose a point on a lamp, two a point on the patch.
pub(super) struct AimNet {
    pub samples: Vec<[i32; 4]>,
    pub randomisation: Vec<u16>,
}

impl AimNet {
    /// Samples `first .. first + count` of every randomisation.
    pub fn new(stream: Stream, randomisations: u16, first: u64, count: u64) -> Self {
        let of = |r: u16| {
            let s = stream.child(u64::from(r));
            (first..first + count).map(move |k| sample(s, k))
        };
        let samples = (0..randomisations).into_par_iter().flat_map_iter(of).collect();
        let randomisation = (0..randomisations).flat_map(|r| (0..count).map(move |_| r)).collect();
        Self { samples, randomisation }
    }
}

fn sample(stream: Stream, index: u64) -> [i32; 4] {
    std::array::from_fn(|d| (owen_scrambled(sobol(index, d), stream.child(d as u64)) >> 33) as i32)
}
