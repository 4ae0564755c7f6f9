//! The error that is to be explained, and the norms it is measured in.

use crate::scene::Stage;
use crate::solution::{Radiosity, Replicates};

/// An error is only looked into if its square is beyond so many times that of the reference's noise.
const BEYOND_NOISE: f64 = 4.0;

/// A solution, the truth, and the difference; patches x bands throughout.
pub(super) struct Case<'a> {
    pub stage: &'a Stage,
    pub areas: Vec<f64>,
    pub bands: usize,
    /// Mean of the reference.
    pub truth: Vec<f64>,
    pub emission: Vec<f64>,
    pub reflectance: Vec<f64>,
    pub solution: Vec<f64>,
    /// Solution - truth.
    pub error: Vec<f64>,
    /// Per band: one over its sum of `A B^2`, so that all bands count alike; 0 where it is dark.
    scale: Vec<f64>,
    /// `sum A Y^2` of the reference.
    signal: f64,
    /// The reference's own noise in both norms.
    noise: Squares,
    /// The squared error without that noise.
    whole: Squares,
}

/// One square in two norms.
#[derive(Debug, Clone, Copy)]
pub(super) struct Squares {
    /// Luminance, as in eq. 7: `sum A Y^2`.
    pub luminance: f64,
    /// All bands alike, each relative to its own light: what hypotheses compete in, so that a band of little weight is
    /// not left out of the comparison.
    pub bands: f64,
}

impl<'a> Case<'a> {
    /// `None` where there is nothing to explain, or nothing to explain it with.
    pub fn new(stage: &'a Stage, reference: &Replicates, solution: &Radiosity) -> Option<Self> {
        let (n, bands) = (stage.patch_count(), stage.band_count());
        let fits = solution.bands == bands && solution.len() == n && reference.len() == n && reference.bands == bands;
        if !fits || reference.count() < 2 || solution.values.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let (areas, truth) = (stage.areas(), reference.mean().values);
        let total = |c: usize| (0..n).map(|i| areas[i] * truth[i * bands + c].powi(2)).sum::<f64>();
        let scale = (0..bands).map(total).map(|t| if t > 0.0 { 1.0 / t } else { 0.0 }).collect();
        let nothing = Squares { luminance: 0.0, bands: 0.0 };
        let mut case = Self {
            error: solution.values.iter().zip(&truth).map(|(b, t)| b - t).collect(),
            solution: solution.values.clone(),
            emission: stage.emissions(),
            reflectance: stage.reflectances(),
            stage,
            areas,
            bands,
            truth,
            scale,
            signal: 0.0,
            noise: nothing,
            whole: nothing,
        };
        case.signal = case.squares(&case.truth).luminance;
        case.noise = case.noise_of(reference);
        let raw = case.squares(&case.error);
        case.whole = raw.less(case.noise);
        let known = case.signal > 0.0 && raw.luminance > BEYOND_NOISE * case.noise.luminance;
        (known && raw.bands > BEYOND_NOISE * case.noise.bands).then_some(case)
    }

    fn noise_of(&self, reference: &Replicates) -> Squares {
        let r = reference.count() as f64;
        let mut sum = Squares { luminance: 0.0, bands: 0.0 };
        for values in &reference.replicates {
            let off: Vec<f64> = values.iter().zip(&self.truth).map(|(v, t)| v - t).collect();
            let one = self.squares(&off);
            sum.luminance += one.luminance / (r * (r - 1.0));
            sum.bands += one.bands / (r * (r - 1.0));
        }
        sum
    }

    /// Both squared norms of a difference of radiosities.
    pub fn squares(&self, x: &[f64]) -> Squares {
        let rows = || self.areas.iter().zip(x.chunks_exact(self.bands));
        let luminance = rows().map(|(a, v)| a * self.stage.photometry.luminance(v).powi(2)).sum();
        Squares { luminance, bands: self.inner(x, x) }
    }

    /// Inner product that counts all bands alike.
    pub fn inner(&self, x: &[f64], y: &[f64]) -> f64 {
        let of = |x: &[f64], y: &[f64]| x.iter().zip(y).zip(&self.scale).map(|((x, y), g)| g * x * y).sum::<f64>();
        let rows = x.chunks_exact(self.bands).zip(y.chunks_exact(self.bands));
        self.areas.iter().zip(rows).map(|(a, (x, y))| a * of(x, y)).sum()
    }

    /// Inner product of one band.
    pub fn inner_band(&self, x: &[f64], y: &[f64], band: usize) -> f64 {
        let rows = x.iter().skip(band).step_by(self.bands).zip(y.iter().skip(band).step_by(self.bands));
        self.areas.iter().zip(rows).map(|(a, (x, y))| a * x * y).sum()
    }

    /// Shares of the squared error that stay if the solution is off by `change` for a reason that is known.
    pub fn left(&self, change: &[f64]) -> Squares {
        let rest: Vec<f64> = self.error.iter().zip(change).map(|(e, d)| e - d).collect();
        let left = self.squares(&rest).less(self.noise);
        Squares { luminance: left.luminance / self.whole.luminance, bands: left.bands / self.whole.bands }
    }

    /// Eq. 7 of a share of the squared luminance error.
    pub fn rms_of(&self, share: f64) -> f64 {
        (share * self.whole.luminance / self.signal).sqrt()
    }

    /// Squared distance of two changes as a share of the squared error.
    pub fn apart(&self, one: &[f64], other: &[f64]) -> f64 {
        let d: Vec<f64> = one.iter().zip(other).map(|(a, b)| a - b).collect();
        self.inner(&d, &d) / self.whole.bands
    }

    /// The least-squares amount of a change in the error; 0 for no change.
    pub fn amount(&self, change: &[f64]) -> f64 {
        let d = self.inner(change, change);
        if d > 0.0 { self.inner(&self.error, change) / d } else { 0.0 }
    }

    /// Luminances of patches x bands.
    pub fn luminances(&self, values: &[f64]) -> Vec<f64> {
        values.chunks_exact(self.bands).map(|v| self.stage.photometry.luminance(v)).collect()
    }

    /// Squared error of one patch, in the norm of all bands.
    pub fn error_of(&self, patch: usize) -> f64 {
        let span = patch * self.bands..(patch + 1) * self.bands;
        let sum: f64 = self.error[span].iter().zip(&self.scale).map(|(e, g)| g * e * e).sum();
        self.areas[patch] * sum
    }

    /// Groups of patches by the largest squared error first; at most `most`, those without any left out.
    pub fn worst(&self, group: impl Fn(usize) -> u32, most: usize) -> Vec<u32> {
        let mut sums = std::collections::BTreeMap::<u32, f64>::new();
        (0..self.areas.len()).for_each(|i| *sums.entry(group(i)).or_default() += self.error_of(i));
        let mut all: Vec<(u32, f64)> = sums.into_iter().filter(|(_, s)| *s > 0.0).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        all.into_iter().take(most).map(|(g, _)| g).collect()
    }

    /// Numbers of the surfaces with most of the squared error.
    pub fn worst_surfaces(&self, most: usize) -> Vec<u32> {
        self.worst(|i| self.stage.patches[i].surface, most)
    }

    /// Numbers of the present patches that a surface has.
    pub fn patches_of(&self, surface: u32) -> Vec<usize> {
        let patches = self.stage.patches.iter().enumerate();
        patches.filter(|(_, p)| p.surface == surface && p.is_present()).map(|(i, _)| i).collect()
    }

    /// A change that is `value(k)` at the given patches and nothing elsewhere.
    pub fn at(&self, patches: &[usize], value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut change = vec![0.0; self.truth.len()];
        for i in patches {
            (i * self.bands..(i + 1) * self.bands).for_each(|k| change[k] = value(k));
        }
        change
    }

    /// A change that is `value(k)` at every value of patches that take part.
    pub fn everywhere(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let part = |k: usize| self.areas[k / self.bands] > 0.0;
        (0..self.truth.len()).map(|k| if part(k) { value(k) } else { 0.0 }).collect()
    }
}

impl Squares {
    fn less(self, other: Self) -> Self {
        Self { luminance: (self.luminance - other.luminance).max(0.0), bands: (self.bands - other.bands).max(0.0) }
    }
}
