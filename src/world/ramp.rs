//! Colours by elevation alone: a one-dimensional table instead of a map [G86, "Cheap chrome effects"].

use crate::math::{Compensated, DVec3};
use std::f64::consts::PI;

/// A table of values over elevation, from straight down to straight up, in steps of equal angle. Each entry is an area of
/// one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    bands: usize,
    /// Band by band: integrals from straight down up to each border of an entry, in entries.
    below: Vec<Vec<f64>>,
}

impl Ramp {
    /// A table of entries from below to above, bands side by side; `None` where the values do not fill whole entries or
    /// there are none.
    pub fn new(bands: usize, values: &[f64]) -> Option<Self> {
        if bands == 0 || values.is_empty() || !values.len().is_multiple_of(bands) {
            return None;
        }
        let band = |b: usize| {
            let mut sum = Compensated::default();
            let mut below = vec![0.0];
            below.extend(values.iter().skip(b).step_by(bands).map(|v| {
                sum.add(*v);
                sum.value()
            }));
            below
        };
        Some(Self { bands, below: (0..bands).map(band).collect() })
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.below[0].len() - 1
    }

    /// True if there are no entries, which no table is.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values in a direction of any length but 0, filtered over `width` radians of elevation: the mean of the table over
    /// that interval, two look-ups whatever its width. Beyond straight up and straight down the table goes on downwards
    /// and upwards again, as elevations do on the far side. Without width it is the entry's own value.
    pub fn lookup(&self, d: DVec3, width: f64) -> Vec<f64> {
        let n = self.len() as f64;
        let elevation = d.z.atan2(d.x.hypot(d.y));
        let at = (elevation / PI + 0.5) * n;
        // Below a billionth of an entry the difference of sums has no digits left; the middle's entry is what it tends to.
        let half = (0.5 * width.abs() / PI * n).min(n);
        if half.is_nan() || half < 1e-9 {
            let entry = (at.max(0.0) as usize).min(self.len() - 1);
            return self.below.iter().map(|b| b[entry + 1] - b[entry]).collect();
        }
        self.below.iter().map(|b| (integral(b, at + half) - integral(b, at - half)) / (2.0 * half)).collect()
    }
}

/// Integral of a table from straight down up to `x` entries, mirrored beyond both ends.
fn integral(below: &[f64], x: f64) -> f64 {
    let last = below.len() - 1;
    let (n, all) = (last as f64, below[last]);
    if x < 0.0 {
        return -integral(below, -x);
    }
    if x > n {
        return 2.0 * all - integral(below, (2.0 * n - x).max(0.0));
    }
    let entry = (x as usize).min(last - 1);
    below[entry] + (below[entry + 1] - below[entry]) * (x - entry as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn towards(elevation: f64, azimuth: f64) -> DVec3 {
        DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin()) * 3.0
    }

    #[test]
    fn it_is_the_mean_over_an_interval_of_elevation() {
        let values: Vec<f64> = (0..36).flat_map(|k| [f64::from(k), f64::from(k * k % 7)]).collect();
        let ramp = Ramp::new(2, &values).expect("whole");
        assert_eq!((ramp.len(), ramp.bands()), (36, 2));
        for (elevation, width) in [(0.1, 0.3), (-1.2, 0.01), (1.5, 0.4), (-1.56, 2.0), (0.3, 1e-4), (0.7, 3.0)] {
            let found = ramp.lookup(towards(elevation, 2.0), width);
            // Against many points, elevations mirrored at the poles.
            let mut expected = [0.0; 2];
            const N: u32 = 200_000;
            for k in 0..N {
                let e: f64 = elevation + width * ((f64::from(k) + 0.5) / f64::from(N) - 0.5);
                let entry = ((e.sin().asin() / PI + 0.5) * 36.0) as usize;
                (0..2).for_each(|b| expected[b] += values[entry * 2 + b] / f64::from(N));
            }
            for (f, e) in found.iter().zip(expected) {
                assert!((f - e).abs() < 1e-3, "{elevation} {width}: {f} {e}");
            }
            // At a given elevation, the colour is constant.
            assert_eq!(found.len(), 2);
            let elsewhere = ramp.lookup(towards(elevation, -0.4), width);
            assert!(found.iter().zip(elsewhere).all(|(a, b)| (a - b).abs() < 1e-9));
        }
    }

    #[test]
    fn a_linear_ramp_keeps_its_middle() {
        let values: Vec<f64> = (0..1000).map(|k| f64::from(k) + 0.5).collect();
        let ramp = Ramp::new(1, &values).expect("whole");
        for elevation in [-0.9, -0.2, 0.0, 0.5, 1.0] {
            let middle = (elevation / PI + 0.5) * 1000.0;
            for width in [0.2, 0.5, 1.0] {
                // The table has steps: their integral is at most 1/8 off that of the line, over the width in entries.
                let off = (ramp.lookup(towards(elevation, 1.0), width)[0] - middle).abs();
                assert!(off < 0.125 / (width / PI * 1000.0) + 1e-9, "{elevation} {width}: {off}");
            }
            assert!((ramp.lookup(towards(elevation, 1.0), 0.0)[0] - middle).abs() <= 0.5 + 1e-9);
        }
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        assert!(Ramp::new(0, &[1.0]).is_none() && Ramp::new(2, &[]).is_none() && Ramp::new(2, &[1.0; 3]).is_none());
        let one = Ramp::new(1, &[4.0]).expect("whole");
        for width in [0.0, 1e-12, 1.0, 1e9, f64::INFINITY, -1.0, f64::NAN] {
            assert!((one.lookup(DVec3::new(0.1, 0.2, 0.3), width)[0] - 4.0).abs() < 1e-9, "{width}");
        }
    }
}
