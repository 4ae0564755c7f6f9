//! Sobol' points in four dimensions, and Owen's nested uniform scrambling of them.

use super::stream::{Stream, mix};

/// Digits of a point; indices up to 2^52 give distinct points.
const BITS: u32 = 52;
/// Levels scrambled by their whole prefix; below them bits are independent random ones.
const SCRAMBLED_LEVELS: u32 = 32;

/// Direction numbers, left-aligned in 64 bits; primitive polynomials and initial values of Joe and Kuo (2008).
const DIRECTIONS: [[u64; BITS as usize]; 4] =
    [van_der_corput(), directions(1, 0, [1, 0, 0]), directions(2, 1, [1, 3, 0]), directions(3, 1, [1, 3, 1])];

const fn van_der_corput() -> [u64; BITS as usize] {
    let mut v = [0; BITS as usize];
    let mut k = 0;
    while k < BITS as usize {
        v[k] = 1 << (63 - k);
        k += 1;
    }
    v
}

/// Direction numbers from a primitive polynomial of `degree` with inner coefficients `a` and initial odd `m`.
const fn directions(degree: usize, a: u64, m: [u64; 3]) -> [u64; BITS as usize] {
    let mut v = [0u64; BITS as usize];
    let mut k = 0;
    while k < BITS as usize {
        if k < degree {
            v[k] = m[k] << (63 - k);
        } else {
            let mut x = v[k - degree] ^ (v[k - degree] >> degree);
            let mut j = 1;
            while j < degree {
                if (a >> (degree - 1 - j)) & 1 == 1 {
                    x ^= v[k - j];
                }
                j += 1;
            }
            v[k] = x;
        }
        k += 1;
    }
    v
}

/// Coordinate `dimension` (0 to 3) of point `index`, as a 64-bit fraction of 1.
pub fn sobol(index: u64, dimension: usize) -> u64 {
    let mut x = 0;
    let mut rest = index;
    while rest != 0 {
        x ^= DIRECTIONS[dimension][rest.trailing_zeros() as usize];
        rest &= rest - 1;
    }
    x
}

/// Owen scrambling: every binary digit is flipped by a coin that depends on all digits above it. The first
/// 2^m points of any index-aligned block stay a net; each point is uniform.
pub fn owen_scrambled(x: u64, stream: Stream) -> u64 {
    let mut flips = 0;
    for level in 0..SCRAMBLED_LEVELS {
        // A leading one marks the length of the prefix.
        let prefix = if level == 0 { 1 } else { (1 << level) | (x >> (64 - level)) };
        flips |= (stream.at(prefix) >> 63) << (63 - level);
    }
    let tail = mix(stream.at((1 << SCRAMBLED_LEVELS) | (x >> (64 - SCRAMBLED_LEVELS)))) >> SCRAMBLED_LEVELS;
    x ^ flips ^ tail
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Role;

    /// Every elementary interval of a pair of dimensions holds the same number of points. Dimensions (0, 1)
    /// form a (0, 2)-sequence; the other pairs are nets of quality t <= 2.
    fn worst_quality(scramble: bool, x: usize, y: usize) -> u32 {
        let m = 10;
        let stream = Stream::new(Role::Witness, 5);
        let digit = |i: u64, d: usize| {
            let p = sobol(i, d);
            if scramble { owen_scrambled(p, stream.child(d as u64)) } else { p }
        };
        let mut t = 0;
        for a in 0..=m {
            let b = m - a;
            let mut cells = vec![0u32; 1 << m];
            for i in 0..1u64 << m {
                let cx = digit(i, x).checked_shr(64 - a).unwrap_or(0);
                let cy = digit(i, y).checked_shr(64 - b).unwrap_or(0);
                cells[(cx << b | cy) as usize] += 1;
            }
            t = t.max(cells.iter().max().unwrap().ilog2());
        }
        t
    }

    #[test]
    fn nets_before_and_after_scrambling() {
        for (x, y) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let plain = worst_quality(false, x, y);
            assert!(plain <= if (x, y) == (0, 1) { 0 } else { 2 }, "dimensions {x} {y}: t = {plain}");
            assert_eq!(worst_quality(true, x, y), plain, "scrambling changed the net {x} {y}");
        }
    }

    #[test]
    fn known_first_points() {
        let half = 1u64 << 63;
        assert_eq!([0, 1, 2, 3].map(|i| sobol(i, 0)), [0, half, half >> 1, half | half >> 1]);
        assert_eq!([0, 1, 2, 3].map(|i| sobol(i, 1)), [0, half, half | half >> 1, half >> 1]);
    }

    #[test]
    fn a_scrambled_point_is_uniform() {
        // Point 5 over 4,096 scramblings, 16 bins: chi-square with 15 degrees, 1e-6 quantile 58.
        let mut bins = [0f64; 16];
        for seed in 0..4096 {
            let x = owen_scrambled(sobol(5, 2), Stream::new(Role::Witness, seed));
            bins[(x >> 60) as usize] += 1.0;
        }
        let chi2: f64 = bins.iter().map(|b| (b - 256.0).powi(2) / 256.0).sum();
        assert!(chi2 < 58.0, "{chi2}");
    }
}
