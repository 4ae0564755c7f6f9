//! The patch system, the transport operator, and what follows from one application of it.

use super::SolverError;
use crate::math::Compensated;
use crate::solution::FormFactors;
use rayon::prelude::*;

/// Rows handed to a thread at a time.
const ROWS_PER_TASK: usize = 64;

/// Right-hand side and reflectances of `(I - diag(rho) F) B = E`, the matrix form of the radiosity equation;
/// row-major, n x bands [CG85 eq. 2].
#[derive(Debug, Clone, Copy)]
pub struct System<'a> {
    /// Self-emitted radiosity E, W/m^2.
    pub emission: &'a [f64],
    /// Reflectance rho.
    pub reflectance: &'a [f64],
    /// Number of bands.
    pub bands: usize,
}

impl System<'_> {
    /// Number of receivers.
    pub fn len(&self) -> usize {
        self.emission.len() / self.bands.max(1)
    }

    /// True if there are no receivers.
    pub fn is_empty(&self) -> bool {
        self.emission.is_empty()
    }

    /// Refuses vectors that do not fit `n` receivers, and values that are not finite.
    pub fn check(&self, n: usize) -> Result<(), SolverError> {
        for (what, v) in [("the emission", self.emission), ("the reflectance", self.reflectance)] {
            check_len(what, v, n * self.bands)?;
            check_finite(what, v, self.bands)?;
        }
        Ok(())
    }
}

/// Refuses a vector of the wrong length.
pub(super) fn check_len(what: &'static str, v: &[f64], expected: usize) -> Result<(), SolverError> {
    if v.len() == expected { Ok(()) } else { Err(SolverError::Shape { what, got: v.len(), expected }) }
}

/// Refuses the first value that is not finite.
pub(super) fn check_finite(what: &'static str, v: &[f64], bands: usize) -> Result<(), SolverError> {
    match v.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(k) => Err(SolverError::NotFinite { what, receiver: k / bands, band: k % bands, value: v[k] }),
    }
}

/// The geometry of a scene as a linear operator: `y = F x` for all bands at once.
pub trait Transport: Sync {
    /// Number of receivers: rows of F.
    fn len(&self) -> usize;

    /// Number of sources: columns of F. Differs from [`Transport::len`] where elements receive from patches.
    fn sources(&self) -> usize {
        self.len()
    }

    /// True if there are no receivers.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `y = F x`; x is sources x bands, y receivers x bands. Same bytes on any number of threads.
    fn apply(&self, x: &[f64], bands: usize, y: &mut [f64]);
}

impl Transport for FormFactors {
    fn len(&self) -> usize {
        self.row_starts.len() - 1
    }

    fn sources(&self) -> usize {
        self.n
    }

    fn apply(&self, x: &[f64], bands: usize, y: &mut [f64]) {
        y.par_chunks_mut(bands * ROWS_PER_TASK).enumerate().for_each(|(task, block)| {
            for (k, out) in block.chunks_exact_mut(bands).enumerate() {
                gather_row(self, task * ROWS_PER_TASK + k, x, out);
            }
        });
    }
}

/// `out = sum_j F_ij x_j`, one value per band.
pub(super) fn gather_row(f: &FormFactors, i: usize, x: &[f64], out: &mut [f64]) {
    match out.len() {
        1 => out.copy_from_slice(&gather_bands::<1>(f, i, x)),
        3 => out.copy_from_slice(&gather_bands::<3>(f, i, x)),
        bands => {
            out.fill(0.0);
            for (j, v) in f.row(i) {
                out.iter_mut().zip(&x[j * bands..]).for_each(|(o, x)| *o += v * x);
            }
        }
    }
}

/// The same with the number of bands known to the compiler.
fn gather_bands<const BANDS: usize>(f: &FormFactors, i: usize, x: &[f64]) -> [f64; BANDS] {
    let mut out = [0.0; BANDS];
    for (j, v) in f.row(i) {
        let source = &x[j * BANDS..(j + 1) * BANDS];
        for c in 0..BANDS {
            out[c] += v * source[c];
        }
    }
    out
}

/// One gather, `E + rho F B`, per receiver and band [CG85 eq. 1]. The receivers of `system` are the rows of
/// `transport`; `radiosity` is its columns: element values from patch radiosities, for one.
pub fn gather_once<T: Transport + ?Sized>(
    system: &System,
    transport: &T,
    radiosity: &[f64],
) -> Result<Vec<f64>, SolverError> {
    system.check(transport.len())?;
    check_len("the radiosity", radiosity, transport.sources() * system.bands)?;
    let mut out = vec![0.0; system.emission.len()];
    transport.apply(radiosity, system.bands, &mut out);
    for (k, y) in out.iter_mut().enumerate() {
        *y = system.emission[k] + system.reflectance[k] * *y;
    }
    Ok(out)
}

/// The Euclidean norm over receivers, one value per band; weighted, `sqrt(sum w x^2)`, where weights are given.
#[derive(Debug, Clone, Copy, Default)]
pub struct Norm<'a> {
    /// One weight per receiver, areas for instance; `None` counts all alike.
    pub weights: Option<&'a [f64]>,
}

impl Norm<'_> {
    /// Inner product of one band of two vectors.
    pub fn dot(&self, a: &[f64], b: &[f64], bands: usize, band: usize) -> f64 {
        let pairs = a.iter().skip(band).step_by(bands).zip(b.iter().skip(band).step_by(bands));
        let mut sum = Compensated::default();
        match self.weights {
            None => pairs.for_each(|(a, b)| sum.add(a * b)),
            Some(w) => pairs.zip(w).for_each(|((a, b), w)| sum.add(w * a * b)),
        }
        sum.value()
    }

    /// Norm of one band of a vector.
    pub fn of(&self, a: &[f64], bands: usize, band: usize) -> f64 {
        self.dot(a, a, bands, band).sqrt()
    }
}

/// `|E - (I - rho F) B| / |E|` per band; 0 for a band without light and without radiosity.
pub fn relative_residual<T: Transport + ?Sized>(
    system: &System,
    transport: &T,
    radiosity: &[f64],
    norm: Norm,
) -> Result<Vec<f64>, SolverError> {
    let mut r = gather_once(system, transport, radiosity)?;
    check_len("the radiosity", radiosity, r.len())?;
    r.iter_mut().zip(radiosity).for_each(|(r, b)| *r -= b);
    Ok((0..system.bands)
        .map(|c| ratio(norm.of(&r, system.bands, c), norm.of(system.emission, system.bands, c)))
        .collect())
}

/// A quotient in which nothing over nothing is nothing.
pub(super) fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A fixed matrix whose rows sum to `sum`, with `n` receivers and no zero off the diagonal.
    pub(in crate::solver) fn dense(n: usize, sum: f64) -> FormFactors {
        let weight = |i: usize, j: usize| 1.0 + ((i * 7 + j * 13) % 11) as f64;
        let row = |i: usize| {
            let total: f64 = (0..n).filter(|j| *j != i).map(|j| weight(i, j)).sum();
            (0..n).filter(|j| *j != i).map(|j| (j as u32, weight(i, j) * sum / total)).collect()
        };
        FormFactors::from_exact_rows((0..n).map(row).collect())
    }

    #[test]
    fn every_band_is_carried_like_a_band_alone() {
        let f = dense(150, 1.0);
        for bands in [2, 3, 5] {
            let x: Vec<f64> = (0..150 * bands).map(|k| (k as f64 * 0.37).sin()).collect();
            let mut y = vec![0.0; x.len()];
            f.apply(&x, bands, &mut y);
            for c in 0..bands {
                let single: Vec<f64> = x.iter().skip(c).step_by(bands).copied().collect();
                let mut out = vec![0.0; 150];
                f.apply(&single, 1, &mut out);
                assert!((0..150).all(|i| out[i] == y[i * bands + c]), "band {c} of {bands}");
            }
        }
    }

    #[test]
    fn a_gather_of_unit_radiosity_is_emission_plus_reflectance() {
        let f = dense(20, 1.0);
        let (e, rho) = (vec![0.25; 20], vec![0.5; 20]);
        let system = System { emission: &e, reflectance: &rho, bands: 1 };
        let b = gather_once(&system, &f, &[1.0; 20]).unwrap();
        assert!(b.iter().all(|b| (b - 0.75).abs() < 1e-15));
        assert!(relative_residual(&system, &f, &[0.5; 20], Norm::default()).unwrap()[0] < 1e-15);
    }

    #[test]
    fn vectors_that_do_not_fit_are_refused() {
        let f = dense(4, 1.0);
        let system = System { emission: &[1.0; 4], reflectance: &[0.5; 3], bands: 1 };
        let refused = gather_once(&system, &f, &[0.0; 4]).unwrap_err();
        assert_eq!(refused.to_string(), "the reflectance has 3 values where the patch system needs 4");
        let system = System { emission: &[1.0, f64::NAN, 0.0, 0.0], reflectance: &[0.5; 4], bands: 2 };
        assert!(matches!(system.check(2), Err(SolverError::NotFinite { receiver: 0, band: 1, .. })));
    }

    #[test]
    fn weights_weigh() {
        let w = [4.0, 1.0];
        let norm = Norm { weights: Some(&w) };
        assert_eq!(norm.of(&[1.0, 9.0, 0.0, 9.0], 2, 0), 2.0);
        assert_eq!(Norm::default().of(&[3.0, 4.0], 1, 0), 5.0);
    }
}
