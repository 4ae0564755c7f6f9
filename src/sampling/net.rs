//! One randomised net of (position x direction) samples, shared by all patches of a pass.

use super::{Stream, cosine_hemisphere, owen_scrambled, sobol};
use rayon::prelude::*;

/// Samples `indices` of each of R randomisations, in an order in which neighbours look the same way.
///
/// Positions are 31-bit fractions that each patch shifts by a key of its own (exclusive or: nets stay nets);
/// directions are unit vectors about +z, cosine-distributed, that each patch turns about its normal by an
/// angle of its own. Given the shifts, the randomisations are independent and each is unbiased.
#[derive(Debug, Clone)]
pub struct Net {
    /// First position coordinate, 31 bits.
    pub u: Vec<i32>,
    /// Second position coordinate, 31 bits.
    pub v: Vec<i32>,
    /// Local directions: x, y, z; unit to single precision, which halves what a pass reads.
    pub direction: [Vec<f32>; 3],
    /// Randomisation each sample belongs to.
    pub randomisation: Vec<u16>,
}

struct Sample {
    key: u64,
    u: i32,
    v: i32,
    direction: [f32; 3],
    randomisation: u16,
}

impl Net {
    /// Builds samples `first .. first + count` of every randomisation under `stream`.
    pub fn new(stream: Stream, randomisations: u16, first: u64, count: u64) -> Self {
        let mut samples: Vec<Sample> = (0..randomisations)
            .into_par_iter()
            .flat_map_iter(|r| {
                let s = stream.child(u64::from(r));
                (first..first + count).map(move |k| Sample::new(s, r, k))
            })
            .collect();
        samples.par_sort_unstable_by_key(|s| s.key);
        Self {
            u: samples.iter().map(|s| s.u).collect(),
            v: samples.iter().map(|s| s.v).collect(),
            direction: std::array::from_fn(|c| samples.iter().map(|s| s.direction[c]).collect()),
            randomisation: samples.iter().map(|s| s.randomisation).collect(),
        }
    }

    /// Number of samples over all randomisations.
    pub fn len(&self) -> usize {
        self.u.len()
    }

    /// True if there are no samples.
    pub fn is_empty(&self) -> bool {
        self.u.is_empty()
    }
}

impl Sample {
    fn new(stream: Stream, randomisation: u16, index: u64) -> Self {
        let digit = |d: usize| owen_scrambled(sobol(index, d), stream.child(d as u64));
        // Directions get the first two dimensions, whose joint net is the best one.
        let (s, t) = (digit(0), digit(1));
        let direction = cosine_hemisphere(fraction(s), fraction(t));
        let order = morton((s >> 56) as u32, (t >> 56) as u32);
        Self {
            // Equal cells are ordered by address, so that the order is total.
            key: u64::from(order) << 48 | u64::from(randomisation) << 36 | (index & 0xf_ffff_ffff),
            u: (digit(2) >> 33) as i32,
            v: (digit(3) >> 33) as i32,
            direction: direction.as_vec3().to_array(),
            randomisation,
        }
    }
}

/// Middle of the 2^-53 cell a 64-bit fraction lies in.
fn fraction(x: u64) -> f64 {
    ((x >> 11) as f64 + 0.5) * f64::powi(2.0, -53)
}

/// Interleaves the low 8 bits of two numbers.
fn morton(x: u32, y: u32) -> u32 {
    (0..8).fold(0, |m, b| m | (x >> b & 1) << (2 * b + 1) | (y >> b & 1) << (2 * b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Role;

    #[test]
    fn each_randomisation_is_there_whole_and_unit_length() {
        let net = Net::new(Stream::new(Role::Judge, 3), 8, 64, 64);
        assert_eq!(net.len(), 512);
        for r in 0..8 {
            assert_eq!(net.randomisation.iter().filter(|x| **x == r).count(), 64);
        }
        for k in 0..net.len() {
            let length: f32 = net.direction.iter().map(|c| c[k] * c[k]).sum();
            assert!((length - 1.0).abs() < 4e-7 && net.direction[2][k] > 0.0);
        }
    }

    #[test]
    fn a_block_is_part_of_the_longer_one() {
        let s = Stream::new(Role::Judge, 0);
        let (short, long) = (Net::new(s, 2, 0, 16), Net::new(s, 2, 0, 64));
        let all: Vec<_> = long.u.iter().zip(&long.v).collect();
        assert!(short.u.iter().zip(&short.v).all(|p| all.contains(&p)));
    }

    #[test]
    fn cosines_integrate_better_than_random() {
        // E[cos] = 2/3 under the cosine density; 1,024 random points have a standard error of 7.4e-3, scrambled
        // ones must do ten times better.
        let net = Net::new(Stream::new(Role::Judge, 1), 1, 0, 1024);
        let mean: f64 = net.direction[2].iter().map(|z| f64::from(*z)).sum::<f64>() / 1024.0;
        assert!((mean - 2.0 / 3.0).abs() < 7.4e-4, "{mean}");
    }
}
