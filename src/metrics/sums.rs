//! The sums of eq. 7 over a set of patches, with all that its interval needs. One pass, O(R N).

use crate::math::Compensated;

/// Noise directions are looked for among at most so many bundles of replicates: the cost stays linear in R.
const MAX_BUNDLES: usize = 32;

/// Area-weighted sums over patches for one set of independent replicates.
///
/// With `d_r` the difference solution - reference of replicate r, `D` its mean, `Y_r` the reference, `Y` its mean,
/// `e_r = d_r - D = Y - Y_r` and `<a, b> = sum A a b`.
#[derive(Debug, Clone)]
pub(super) struct Sums {
    /// Number of replicates.
    pub replicates: usize,
    /// `<D, D>`.
    pub difference: f64,
    /// `<Y, Y>`.
    pub reference: f64,
    /// `sum <e_r, e_r> / (R (R - 1))`: the noise norm squared, sum A se^2. 0 for a single replicate.
    pub noise: f64,
    /// `<e_r, D>` per replicate.
    pub along_difference: Vec<f64>,
    /// `<-e_r, Y>` per replicate.
    pub along_reference: Vec<f64>,
    /// Largest eigenvalue of the covariance of one replicate's noise, lifted noise floor taken off.
    pub top_variance: f64,
}

impl Sums {
    /// Sums over `patches` of `solution` against the replicates `rows`.
    pub fn over(patches: impl Iterator<Item = usize>, areas: &[f64], solution: &[f64], rows: &[&[f64]]) -> Self {
        let r = rows.len();
        let mut bundles = Bundles::new(r);
        let mut sums = [Compensated::default(); 3];
        let (mut x, mut z) = (vec![0.0; r], vec![0.0; r]);
        let mut e = vec![0.0; r];
        for i in patches {
            let a = areas[i];
            let y = rows.iter().map(|row| row[i]).sum::<f64>() / r as f64;
            let d = solution[i] - y;
            e.iter_mut().zip(rows).for_each(|(e, row)| *e = y - row[i]);
            sums[0].add(a * d * d);
            sums[1].add(a * y * y);
            sums[2].add(a * e.iter().map(|e| e * e).sum::<f64>());
            for k in 0..r {
                x[k] += a * e[k] * d;
                z[k] -= a * e[k] * y;
            }
            bundles.add(a, &e);
        }
        Self {
            replicates: r,
            difference: sums[0].value(),
            reference: sums[1].value(),
            noise: if r > 1 { sums[2].value() / (r * (r - 1)) as f64 } else { 0.0 },
            along_difference: x,
            along_reference: z,
            top_variance: bundles.top_variance(),
        }
    }

    /// `<d_r, d_s>` averaged over pairs of different replicates.
    pub fn debiased_difference(&self) -> f64 {
        self.difference - self.noise
    }

    /// `<Y_r, Y_s>` averaged over pairs of different replicates.
    pub fn debiased_reference(&self) -> f64 {
        self.reference - self.noise
    }

    /// Variances of `<D, D> - q <Y, Y>` and of `<Y, Y>`, and their covariance, to first order in the noise.
    pub fn spread(&self, q: f64) -> Spread {
        let r = self.replicates as f64;
        if r < 2.0 {
            return Spread::default();
        }
        // d<D, D> = 2 <e, D> and d<Y, Y> = 2 <-e, Y>: twice twice, over the variance of a mean.
        let scale = 4.0 / (r * (r - 1.0));
        let mut spread = Spread::default();
        for (x, z) in self.along_difference.iter().zip(&self.along_reference) {
            let w = x - q * z;
            spread.residual += scale * w * w;
            spread.reference += scale * z * z;
            spread.both += scale * w * z;
        }
        spread
    }
}

/// Variances of `<D, D> - q <Y, Y>` (the residual) and `<Y, Y>`, and their covariance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spread {
    pub residual: f64,
    pub reference: f64,
    pub both: f64,
}

impl Spread {
    /// Of the mean over independent sets.
    pub fn of_mean(sets: &[Spread]) -> Self {
        let scale = 1.0 / (sets.len() * sets.len()) as f64;
        let mean = |f: fn(&Spread) -> f64| scale * sets.iter().map(f).sum::<f64>();
        Self { residual: mean(|s| s.residual), reference: mean(|s| s.reference), both: mean(|s| s.both) }
    }
}

/// Inner products between bundles of replicates.
struct Bundles {
    count: usize,
    /// Bundle of each replicate and what a replicate weighs there: 1 / sqrt(size), so that each bundle has the
    /// covariance of one replicate.
    of: Vec<(usize, f64)>,
    gram: Vec<f64>,
    row: Vec<f64>,
}

impl Bundles {
    fn new(replicates: usize) -> Self {
        let count = replicates.min(MAX_BUNDLES);
        let size = |g: usize| (replicates - g).div_ceil(count);
        let of = (0..replicates).map(|r| (r % count, 1.0 / (size(r % count) as f64).sqrt())).collect();
        Self { count, of, gram: vec![0.0; count * count], row: vec![0.0; count] }
    }

    fn add(&mut self, area: f64, noise: &[f64]) {
        self.row.fill(0.0);
        for ((g, w), e) in self.of.iter().zip(noise) {
            self.row[*g] += w * e;
        }
        for g in 0..self.count {
            let c = area * self.row[g];
            for h in 0..=g {
                self.gram[g * self.count + h] += c * self.row[h];
            }
        }
    }

    /// Largest eigenvalue of the noise covariance by the noise-reduction method of Yata and Aoshima (2012): with
    /// far more patches than replicates every sample eigenvalue is lifted by about the mean of the others.
    fn top_variance(mut self) -> f64 {
        let n = self.count;
        if n < 2 {
            return 0.0;
        }
        for g in 0..n {
            for h in 0..g {
                self.gram[h * n + g] = self.gram[g * n + h];
            }
        }
        let freedom = (n - 1) as f64;
        let top = largest_eigenvalue(&self.gram, n) / freedom;
        let trace = (0..n).map(|g| self.gram[g * n + g]).sum::<f64>() / freedom;
        if n == 2 { top } else { (top - (trace - top).max(0.0) / (freedom - 1.0)).max(0.0) }
    }
}

/// Largest eigenvalue of a symmetric positive semi-definite n x n matrix, by power iteration from its longest column.
fn largest_eigenvalue(m: &[f64], n: usize) -> f64 {
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let longest = (0..n).max_by(|a, b| norm(&m[a * n..(a + 1) * n]).total_cmp(&norm(&m[b * n..(b + 1) * n])));
    let mut v = longest.map_or(Vec::new(), |g| m[g * n..(g + 1) * n].to_vec());
    let mut value = 0.0;
    for _ in 0..1000 {
        let length = norm(&v);
        if length == 0.0 {
            return 0.0;
        }
        v.iter_mut().for_each(|x| *x /= length);
        let next: Vec<f64> = (0..n).map(|g| m[g * n..(g + 1) * n].iter().zip(&v).map(|(a, b)| a * b).sum()).collect();
        let before = std::mem::replace(&mut value, norm(&next));
        v = next;
        if (value - before).abs() <= 1e-12 * value {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    fn sums_of_noise(patches: usize, replicates: usize, common: f64, own: f64, seed: u64) -> Sums {
        let mut random = Random(seed);
        let rows: Vec<Vec<f64>> = (0..replicates)
            .map(|_| {
                let z = common * random.normal();
                (0..patches).map(|_| 1.0 + z + own * random.normal()).collect()
            })
            .collect();
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        Sums::over(0..patches, &vec![1.0; patches], &vec![1.0; patches], &rows)
    }

    #[test]
    fn noise_is_the_squared_norm_of_the_standard_errors() {
        // Patch 0 (area 1) reads 1 and 3, patch 1 (area 5) reads 2 twice: se 1 and 0.
        let sums = Sums::over(0..2, &[1.0, 5.0], &[2.0, 3.0], &[&[1.0, 2.0], &[3.0, 2.0]]);
        assert_eq!((sums.noise, sums.difference, sums.reference), (1.0, 5.0, 24.0));
        assert_eq!(sums.along_difference, [0.0, 0.0]);
        assert_eq!(sums.along_reference, [-2.0, 2.0]);
    }

    #[test]
    fn the_strongest_direction_is_measured_without_the_bulk_of_the_rest() {
        // A common factor of variance 0.01 over 400 patches: 4; independent noise adds 0.04 in that direction,
        // and 16 to the trace.
        for replicates in [16, 64, 200] {
            let n = 60;
            let mean = |common, own| {
                (0..n).map(|s| sums_of_noise(400, replicates, common, own, s).top_variance).sum::<f64>() / n as f64
            };
            let (common, both, bulk) = (mean(0.1, 0.0), mean(0.1, 0.2), mean(0.0, 0.2));
            assert!((common / 4.0 - 1.0).abs() < 0.2, "{replicates}: {common}");
            assert!((both / 4.04 - 1.0).abs() < 0.2, "{replicates}: {both}");
            assert!(bulk < 0.5, "{replicates}: {bulk}");
        }
    }

    #[test]
    fn eigenvalues_by_hand() {
        assert!((largest_eigenvalue(&[2.0, 1.0, 1.0, 2.0], 2) - 3.0).abs() < 1e-9);
        assert!((largest_eigenvalue(&[1.0, 0.0, 0.0, 5.0], 2) - 5.0).abs() < 1e-9);
        assert_eq!(largest_eigenvalue(&[0.0; 9], 3), 0.0);
    }

    #[test]
    fn one_replicate_has_no_noise() {
        let sums = Sums::over(0..1, &[2.0], &[3.0], &[&[1.0]]);
        assert_eq!((sums.noise, sums.top_variance, sums.debiased_difference()), (0.0, 0.0, 8.0));
    }
}
