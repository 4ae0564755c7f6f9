//! Restarted GMRES for the patch system, all bands in lockstep.
//!
//! Every band has a Krylov space of its own, but each step applies the transport once to all of them: the
//! matrix is read once however many bands there are. Bands that have arrived wait with a zero vector.
//! `(I - diag(rho) F)` is not symmetric, so conjugate gradients do not apply; GMRES never breaks down on it.

use super::system::{check_finite, check_len, ratio};
use super::{Norm, SolverError, System, Transport, gather_once};

/// Name in messages.
const NAME: &str = "GMRES";

/// How far inside the tolerance a cycle aims, so that the true residual ends below it too.
const AIM: f64 = 0.25;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Params<'a> {
    /// Largest `|E - (I - rho F) B| / |E|` of any band.
    pub tolerance: f64,
    /// Steps between restarts: vectors of n x bands kept at a time.
    pub restart: usize,
    /// Steps allowed, over all restarts.
    pub max_iterations: usize,
    /// The norm of the residual.
    pub norm: Norm<'a>,
}

impl Default for Params<'_> {
    fn default() -> Self {
        Self { tolerance: 1e-12, restart: 30, max_iterations: 1000, norm: Norm::default() }
    }
}

/// How the iteration ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// Steps, per band.
    pub iterations: Vec<usize>,
    /// Applications of the transport, shared by all bands.
    pub applications: usize,
    /// True relative residual, per band.
    pub residual: Vec<f64>,
}

/// Solves `(I - diag(rho) F) B = E` from an initial guess (`None`: from E) [CG85 eq. 2]. Calls `on_step` with the
/// number of the step and the estimated relative residual of each band.
pub fn solve<T: Transport + ?Sized>(
    system: &System,
    transport: &T,
    guess: Option<&[f64]>,
    params: &Params,
    mut on_step: impl FnMut(usize, &[f64]),
) -> Result<(Vec<f64>, Info), SolverError> {
    system.check(transport.len())?;
    check_len("the columns of the transport", system.emission, transport.sources() * system.bands)?;
    let mut b = guess.unwrap_or(system.emission).to_vec();
    check_len("the initial guess", &b, system.emission.len())?;
    check_finite("the initial guess", &b, system.bands)?;
    let mut run = Run::new(system, transport, params);
    run.clear_dark_bands(&mut b);
    loop {
        run.restart_from(&b)?;
        if run.residual.iter().all(|r| *r <= params.tolerance) {
            return Ok((b, run.info));
        }
        if run.steps >= params.max_iterations {
            return Err(run.not_converged());
        }
        run.cycle(&mut on_step);
        run.correct(&mut b);
    }
}

/// The least-squares problem of one band within a cycle.
#[derive(Debug, Clone, Default)]
struct BandSpace {
    /// Columns of the triangular factor of the Hessenberg matrix.
    columns: Vec<Vec<f64>>,
    /// Givens rotations (cosine, sine).
    rotations: Vec<(f64, f64)>,
    /// Rotated right-hand side; its last entry is the residual, up to sign.
    rhs: Vec<f64>,
    /// True while the band still takes steps in this cycle.
    active: bool,
}

/// State between steps.
struct Run<'a, T: Transport + ?Sized> {
    system: &'a System<'a>,
    transport: &'a T,
    params: &'a Params<'a>,
    /// |E| per band.
    scale: Vec<f64>,
    /// Orthonormal per band; n x bands each.
    basis: Vec<Vec<f64>>,
    spaces: Vec<BandSpace>,
    residual: Vec<f64>,
    steps: usize,
    info: Info,
}

impl<'a, T: Transport + ?Sized> Run<'a, T> {
    fn new(system: &'a System<'a>, transport: &'a T, params: &'a Params<'a>) -> Self {
        let bands = system.bands;
        let info = Info { iterations: vec![0; bands], applications: 0, residual: vec![] };
        let scale = (0..bands).map(|c| params.norm.of(system.emission, bands, c)).collect();
        let spaces = vec![BandSpace::default(); bands];
        Self { system, transport, params, scale, basis: vec![], spaces, residual: vec![], steps: 0, info }
    }

    /// A band without light has radiosity 0, whatever the guess says.
    fn clear_dark_bands(&self, b: &mut [f64]) {
        for c in (0..self.system.bands).filter(|c| self.scale[*c] == 0.0) {
            b.iter_mut().skip(c).step_by(self.system.bands).for_each(|x| *x = 0.0);
        }
    }

    /// The true residual, and a Krylov space that starts from it.
    fn restart_from(&mut self, b: &[f64]) -> Result<(), SolverError> {
        let bands = self.system.bands;
        let mut r = gather_once(self.system, self.transport, b)?;
        self.info.applications += 1;
        r.iter_mut().zip(b).for_each(|(r, b)| *r -= b);
        let norms: Vec<f64> = (0..bands).map(|c| self.params.norm.of(&r, bands, c)).collect();
        self.residual = norms.iter().zip(&self.scale).map(|(r, e)| ratio(*r, *e)).collect();
        self.info.residual.clone_from(&self.residual);
        if let Some(band) = self.residual.iter().position(|r| !r.is_finite()) {
            return Err(SolverError::Diverged { solver: NAME, iterations: self.steps, band });
        }
        for (c, space) in self.spaces.iter_mut().enumerate() {
            let active = self.residual[c] > self.params.tolerance;
            *space = BandSpace { active, rhs: vec![norms[c]], ..BandSpace::default() };
            scale_band(&mut r, bands, c, if active { 1.0 / norms[c] } else { 0.0 });
        }
        self.basis = vec![r];
        Ok(())
    }

    /// Steps until every band has arrived or the cycle is full.
    fn cycle(&mut self, on_step: &mut impl FnMut(usize, &[f64])) {
        for _ in 0..self.params.restart.max(1) {
            if self.steps >= self.params.max_iterations || self.spaces.iter().all(|s| !s.active) {
                return;
            }
            self.steps += 1;
            let w = self.expand();
            self.basis.push(w);
            on_step(self.steps, &self.residual);
        }
    }

    /// One application of `I - diag(rho) F` to the newest basis vector, made orthonormal band by band.
    fn expand(&mut self) -> Vec<f64> {
        let (bands, v) = (self.system.bands, &self.basis[self.basis.len() - 1]);
        let mut w = vec![0.0; v.len()];
        self.transport.apply(v, bands, &mut w);
        self.info.applications += 1;
        for (k, w) in w.iter_mut().enumerate() {
            *w = v[k] - self.system.reflectance[k] * *w;
        }
        for c in 0..bands {
            if self.spaces[c].active {
                self.orthogonalise(&mut w, c);
            } else {
                scale_band(&mut w, bands, c, 0.0);
            }
        }
        w
    }

    fn orthogonalise(&mut self, w: &mut [f64], c: usize) {
        let (bands, norm) = (self.system.bands, &self.params.norm);
        let mut h = Vec::with_capacity(self.basis.len() + 1);
        for v in &self.basis {
            let along = norm.dot(v, w, bands, c);
            w.iter_mut().zip(v).skip(c).step_by(bands).for_each(|(w, v)| *w -= along * v);
            h.push(along);
        }
        let rest = norm.of(w, bands, c);
        h.push(rest);
        let left = self.spaces[c].absorb(h);
        self.info.iterations[c] += 1;
        self.residual[c] = ratio(left, self.scale[c]);
        // `rest` of 0 means that the space holds the exact solution.
        let going_on = self.residual[c] > AIM * self.params.tolerance && rest > 0.0;
        self.spaces[c].active = going_on;
        scale_band(w, bands, c, if going_on { 1.0 / rest } else { 0.0 });
    }

    /// Adds the best correction within each band's space.
    fn correct(&self, b: &mut [f64]) {
        let bands = self.system.bands;
        for (c, space) in self.spaces.iter().enumerate() {
            for (y, v) in space.coefficients().iter().zip(&self.basis) {
                b.iter_mut().zip(v).skip(c).step_by(bands).for_each(|(b, v)| *b += y * v);
            }
        }
    }

    fn not_converged(&self) -> SolverError {
        let worst = |a: &usize, b: &usize| self.residual[*a].total_cmp(&self.residual[*b]);
        let band = (0..self.residual.len()).max_by(worst).unwrap_or(0);
        SolverError::NotConverged { solver: NAME, iterations: self.steps, band, residual: self.residual[band] }
    }
}

impl BandSpace {
    /// Takes in one Hessenberg column, rotates it to triangular form, returns the residual that is left.
    fn absorb(&mut self, mut h: Vec<f64>) -> f64 {
        for (k, (cos, sin)) in self.rotations.iter().enumerate() {
            (h[k], h[k + 1]) = (cos * h[k] + sin * h[k + 1], cos * h[k + 1] - sin * h[k]);
        }
        let k = self.rotations.len();
        let radius = h[k].hypot(h[k + 1]);
        let (cos, sin) = if radius == 0.0 { (1.0, 0.0) } else { (h[k] / radius, h[k + 1] / radius) };
        h[k] = radius;
        h.truncate(k + 1);
        self.columns.push(h);
        self.rotations.push((cos, sin));
        let last = self.rhs[k];
        self.rhs[k] = cos * last;
        self.rhs.push(-sin * last);
        self.rhs[k + 1].abs()
    }

    /// Weights of the basis vectors, by back substitution.
    fn coefficients(&self) -> Vec<f64> {
        let k = self.columns.len();
        let mut y = self.rhs[..k].to_vec();
        for i in (0..k).rev() {
            let known: f64 = (i + 1..k).map(|j| self.columns[j][i] * y[j]).sum();
            // A zero pivot belongs to a direction in which the operator does nothing: leave it out.
            y[i] = if self.columns[i][i] == 0.0 { 0.0 } else { (y[i] - known) / self.columns[i][i] };
        }
        y
    }
}

fn scale_band(v: &mut [f64], bands: usize, band: usize, factor: f64) {
    v.iter_mut().skip(band).step_by(bands).for_each(|x| *x *= factor);
}

#[cfg(test)]
mod tests {
    use super::super::system::tests::dense;
    use super::*;
    use crate::solver::gauss_seidel;

    #[test]
    fn nearly_white_furnaces_are_solved() {
        let f = dense(200, 1.0);
        for rho in [0.0, 0.5, 0.9, 0.99, 0.999] {
            let (e, rho) = (vec![1.0; 200], vec![rho; 200]);
            let system = System { emission: &e, reflectance: &rho, bands: 1 };
            let (b, info) = solve(&system, &f, None, &Params::default(), |_, _| ()).unwrap();
            let exact = 1.0 / (1.0 - rho[0]);
            assert!(b.iter().all(|b| (b / exact - 1.0).abs() < 1e-12), "rho {}: {info:?}", rho[0]);
            assert!(info.residual[0] <= 1e-12);
        }
    }

    #[test]
    fn one_lamp_in_a_nearly_white_room_with_short_cycles() {
        let f = dense(300, 1.0);
        let (mut e, rho) = (vec![0.0; 300], vec![0.999; 300]);
        e[17] = 3.0;
        let system = System { emission: &e, reflectance: &rho, bands: 1 };
        let params = Params { restart: 4, ..Params::default() };
        let (b, info) = solve(&system, &f, None, &params, |_, _| ()).unwrap();
        assert!(info.residual[0] <= 1e-12);
        let tight = gauss_seidel::Params { tolerance: 1e-15, max_iterations: 200_000 };
        let (other, _) = gauss_seidel::solve(&system, &f, &tight, |_| ()).unwrap();
        assert!(b.iter().zip(&other).all(|(a, b)| (a / b - 1.0).abs() < 1e-9));
    }

    #[test]
    fn bands_share_applications_and_keep_their_values() {
        let f = dense(60, 0.8);
        let e: Vec<f64> = (0..180).map(|k| if k % 3 == 1 { 0.0 } else { 1.0 + (k as f64).cos() }).collect();
        let rho: Vec<f64> = (0..180).map(|k| [0.1, 0.5, 0.95][k % 3]).collect();
        let system = System { emission: &e, reflectance: &rho, bands: 3 };
        let guess = vec![1.0; 180];
        let (b, info) = solve(&system, &f, Some(&guess), &Params::default(), |_, _| ()).unwrap();
        assert_eq!(info.iterations[1], 0);
        assert!(b.iter().skip(1).step_by(3).all(|b| *b == 0.0));
        assert!(info.applications <= info.iterations[2] + 4, "{info:?}");
        for c in [0, 2] {
            let of_band = |v: &[f64]| v.iter().skip(c).step_by(3).copied().collect::<Vec<_>>();
            let (e, rho) = (of_band(&e), of_band(&rho));
            let alone = System { emission: &e, reflectance: &rho, bands: 1 };
            let (single, _) = solve(&alone, &f, None, &Params::default(), |_, _| ()).unwrap();
            assert!((0..60).all(|i| (b[3 * i + c] - single[i]).abs() < 1e-11));
        }
    }

    #[test]
    fn a_good_guess_saves_the_work() {
        let f = dense(60, 1.0);
        let (e, rho) = (vec![1.0; 60], vec![0.9; 60]);
        let system = System { emission: &e, reflectance: &rho, bands: 1 };
        let (_, info) = solve(&system, &f, Some(&[10.0; 60]), &Params::default(), |_, _| ()).unwrap();
        assert_eq!((info.iterations[0], info.applications), (0, 1));
    }

    #[test]
    fn the_limit_is_told_with_the_residual() {
        let f = dense(60, 1.0);
        let e: Vec<f64> = (0..60).map(|k| f64::from(k == 3)).collect();
        let system = System { emission: &e, reflectance: &[0.9; 60], bands: 1 };
        let params = Params { max_iterations: 2, ..Params::default() };
        let failed = solve(&system, &f, None, &params, |_, _| ()).unwrap_err();
        let SolverError::NotConverged { iterations: 2, residual, .. } = failed else { panic!("{failed}") };
        assert!(residual > 1e-12 && residual < 1.0);
    }
}
