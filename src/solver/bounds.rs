//! Guaranteed two-sided radiosities from two-sided form factors.
//!
//! Known: `F_lo <= F <= F_hi` entry by entry, `s_lo <= sum_j F_ij <= s_hi` for every row, `E >= 0`, `0 <= rho < 1` and
//! `rho s_hi < 1`. Unknown: which F of these is the true one. For `B >= 0` let
//! `T_hi(B)_i = E_i + rho_i max_f sum_j f_j B_j` over all rows f that the bounds of row i allow, `T_lo` with the least.
//!
//! - The greatest sum takes F_lo and hands what is left up to s_hi to the brightest patches first, each up to its
//!   F_hi (a fractional knapsack); the least hands what is missing up to s_lo to the darkest first.
//! - `T_hi` is monotone and shrinks distances in the largest component by `rho_max s_hi < 1`, so it has one fixed
//!   point, the limit from wherever it starts. The true radiosity has `B = E + rho F B <= T_hi(B)`; applied again and
//!   again, `B <= T_hi(B) <= T_hi(T_hi(B)) <= ...`, which ends at that fixed point: **B lies below it**. Likewise B lies
//!   above the fixed point of `T_lo`.
//! - Every iterate is a bound already, should it be stopped early: `M = max E / (1 - rho_max s_hi)` has
//!   `T_hi(M) <= M`, so iterates from M fall towards the fixed point and never below; those from E rise likewise.
//!
//! Without the row sums, `F_hi` alone would do as the matrix of a linear system, but its rows sum to more than one,
//! and nothing is left of the bound where `rho` times that sum reaches one.

use super::SolverError;
use super::system::System;
use crate::solution::FormFactorBounds;
use rayon::prelude::*;

/// The bounds are widened by this, relative, against the rounding of sums.
const ROUNDING: f64 = 1e-12;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Largest change in the last iteration, relative to the brightest radiosity. Stopping early widens the bounds
    /// and never breaks them.
    pub tolerance: f64,
    /// Iterations allowed.
    pub max_iterations: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self { tolerance: 1e-9, max_iterations: 10_000 }
    }
}

/// Radiosities between which the true ones lie; n x bands, W/m^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Bracket {
    /// At least this.
    pub low: Vec<f64>,
    /// At most this.
    pub high: Vec<f64>,
    /// Iterations of the longer of the two, over all bands.
    pub iterations: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Low,
    High,
}

/// Brackets the radiosities of every patch at once: all of them hold whenever the form factors lie within their bounds.
///
/// # Errors
/// Shapes that do not fit; negative emission; bounds that no matrix fulfils (a row whose least or greatest sum misses
/// what rows sum to); `rho` times the row sum not below one.
pub fn bracket(system: &System, bounds: &FormFactorBounds, params: &Params) -> Result<Bracket, SolverError> {
    let n = bounds.low.n;
    system.check(n)?;
    check(system, bounds)?;
    let (mut low, mut high) = (vec![0.0; n * system.bands], vec![0.0; n * system.bands]);
    let mut iterations = 0;
    for c in 0..system.bands {
        let of = |v: &[f64]| v.iter().skip(c).step_by(system.bands).copied().collect::<Vec<f64>>();
        let band = Band { bounds, emission: of(system.emission), reflectance: of(system.reflectance) };
        for (end, out) in [(End::Low, &mut low), (End::High, &mut high)] {
            let (b, steps) = band.iterate(end, params);
            iterations = iterations.max(steps);
            let widen = if end == End::Low { 1.0 - ROUNDING } else { 1.0 + ROUNDING };
            (0..n).for_each(|i| out[i * system.bands + c] = widen * b[i]);
        }
    }
    Ok(Bracket { low, high, iterations })
}

fn check(system: &System, bounds: &FormFactorBounds) -> Result<(), SolverError> {
    let n = bounds.low.n;
    if let Some(k) = system.emission.iter().position(|e| *e < 0.0) {
        return Err(SolverError::Negative { receiver: k / system.bands, value: system.emission[k] });
    }
    if let Some(k) = system.reflectance.iter().position(|rho| !(0.0..1.0).contains(&(rho * bounds.most_row_sum))) {
        let product = system.reflectance[k] * bounds.most_row_sum;
        return Err(SolverError::Singular { receiver: k / system.bands, product });
    }
    for i in 0..n {
        let stored = bounds.low.row_starts[i + 1] - bounds.low.row_starts[i];
        let unseen = bounds.unseen[i] * (n - stored) as f64;
        let (least, most) = bounds.row(i).fold((0.0, unseen), |(l, h), (_, low, high)| (l + low, h + high));
        let empty = stored == 0 && bounds.unseen[i] == 0.0;
        let fits = least <= bounds.most_row_sum * (1.0 + ROUNDING) && most >= bounds.least_row_sum * (1.0 - ROUNDING);
        if !empty && !fits {
            return Err(SolverError::BoundsMissRowSum { receiver: i, least, most });
        }
    }
    Ok(())
}

/// One band.
struct Band<'a> {
    bounds: &'a FormFactorBounds,
    emission: Vec<f64>,
    reflectance: Vec<f64>,
}

impl Band<'_> {
    fn iterate(&self, end: End, params: &Params) -> (Vec<f64>, usize) {
        let brightest = self.emission.iter().copied().fold(0.0, f64::max);
        let rho_max = self.reflectance.iter().copied().fold(0.0, f64::max);
        let most = brightest / (1.0 - rho_max * self.bounds.most_row_sum);
        let mut b = if end == End::Low { self.emission.clone() } else { vec![most; self.emission.len()] };
        for step in 1..=params.max_iterations {
            let next = self.apply(end, &b);
            let change = next.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            b = next;
            if change <= params.tolerance * most {
                return (b, step);
            }
        }
        (b, params.max_iterations)
    }

    fn apply(&self, end: End, b: &[f64]) -> Vec<f64> {
        let mut order: Vec<u32> = (0..b.len() as u32).collect();
        order.sort_by(|i, j| {
            let ascending = b[*i as usize].total_cmp(&b[*j as usize]);
            if end == End::Low { ascending } else { ascending.reverse() }
        });
        let spare = || vec![None; b.len()];
        (0..b.len()).into_par_iter().map_init(spare, |room, i| self.row(end, i, b, &order, room)).collect()
    }

    /// `E_i + rho_i` times the greatest (least) sum that row i allows. `room` is all `None`, and left so.
    fn row(&self, end: End, i: usize, b: &[f64], order: &[u32], room: &mut [Option<f64>]) -> f64 {
        let (mut sum, mut light) = (0.0, 0.0);
        for (j, low, high) in self.bounds.row(i) {
            sum += low;
            light += low * b[j];
            room[j] = Some(high - low);
        }
        let unseen = self.bounds.unseen[i];
        let whole = if end == End::Low { self.bounds.least_row_sum } else { self.bounds.most_row_sum };
        let mut left = whole - sum;
        for j in order.iter().map(|j| *j as usize) {
            if left <= 0.0 {
                break;
            }
            let share = room[j].unwrap_or(if i == j { 0.0 } else { unseen }).min(left);
            light += share * b[j];
            left -= share;
        }
        self.bounds.low.row(i).for_each(|(j, _)| room[j] = None);
        self.emission[i] + self.reflectance[i] * light
    }
}

#[cfg(test)]
mod tests {
    use super::super::krylov;
    use super::*;
    use crate::solution::FormFactors;
    use crate::stats::test_random::Random;

    /// A dense random matrix whose rows sum to `sum`, nothing on the diagonal.
    fn random_rows(random: &mut Random, n: usize, sum: f64) -> Vec<Vec<f64>> {
        let row = |i: usize, random: &mut Random| {
            let w: Vec<f64> = (0..n).map(|j| if i == j { 0.0 } else { random.uniform().powi(3) }).collect();
            let total: f64 = w.iter().sum();
            w.iter().map(|x| x * sum / total).collect()
        };
        (0..n).map(|i| row(i, random)).collect()
    }

    fn sparse(rows: &[Vec<f64>]) -> FormFactors {
        let entries = |r: &Vec<f64>| r.iter().enumerate().map(|(j, v)| (j as u32, *v)).collect();
        FormFactors::from_exact_rows(rows.iter().map(entries).collect())
    }

    fn around(rows: &[Vec<f64>], width: f64, closed: bool) -> FormFactorBounds {
        let low: Vec<Vec<f64>> = rows.iter().map(|r| r.iter().map(|f| f * (1.0 - width)).collect()).collect();
        FormFactorBounds {
            low: sparse(&low),
            high: rows.iter().flatten().map(|f| f * (1.0 + width)).collect(),
            unseen: vec![0.0; rows.len()],
            least_row_sum: if closed { 1.0 } else { 0.0 },
            most_row_sum: 1.0,
        }
    }

    fn solve(rows: &[Vec<f64>], system: &System) -> Vec<f64> {
        krylov::solve(system, &sparse(rows), None, &krylov::Params::default(), |_, _| ()).expect("solvable").0
    }

    /// A matrix within the bounds, rows with the same sums: pairs of entries give and take at random.
    fn shaken(random: &mut Random, rows: &[Vec<f64>], width: f64) -> Vec<Vec<f64>> {
        let mut out = rows.to_vec();
        for (row, middle) in out.iter_mut().zip(rows) {
            for _ in 0..20 * middle.len() {
                let (j, k) = (pick(random, middle.len()), pick(random, middle.len()));
                if j == k {
                    continue;
                }
                let room = (middle[j] * (1.0 + width) - row[j]).min(row[k] - middle[k] * (1.0 - width));
                // Often all of it: the corners are where a wrong bound shows.
                let step = room * if random.uniform() < 0.7 { 1.0 } else { random.uniform() };
                (row[j], row[k]) = (row[j] + step, row[k] - step);
            }
        }
        out
    }

    fn pick(random: &mut Random, n: usize) -> usize {
        (random.uniform() * n as f64) as usize
    }

    /// 40 systems, 50 matrices within the bounds of each: no radiosity leaves its bracket, at reflectances where the
    /// plain matrix of upper bounds has no solution (0.9 x 1.3 > 1).
    #[test]
    fn every_matrix_within_the_bounds_has_its_radiosities_within_the_bracket() {
        let mut random = Random(7);
        let mut reached = 0.0f64;
        for _ in 0..40 {
            let n = 3 + pick(&mut random, 8);
            let rows = random_rows(&mut random, n, 1.0);
            let e: Vec<f64> = (0..n).map(|i| if i == 0 { 1.0 } else { 0.1 * random.uniform() }).collect();
            let rho: Vec<f64> = (0..n).map(|_| 0.9 * random.uniform().sqrt()).collect();
            let system = System { emission: &e, reflectance: &rho, bands: 1 };
            let b = bracket(&system, &around(&rows, 0.3, true), &Params::default()).expect("sound");
            for _ in 0..50 {
                let shaken = shaken(&mut random, &rows, 0.3);
                for (i, x) in solve(&shaken, &system).iter().enumerate() {
                    assert!(b.low[i] <= x * (1.0 + 1e-9) && *x <= b.high[i] * (1.0 + 1e-9), "{i}: {x} {b:?}");
                    reached = reached.max((x - b.low[i]) / (b.high[i] - b.low[i]).max(1e-12));
                }
            }
        }
        println!("the highest radiosity stands at {reached:.3} of its bracket");
        assert!(reached > 0.8, "the brackets are far too wide: {reached}");
    }

    /// The fixed point is itself the radiosity of a matrix within the bounds: no bracket could be narrower.
    #[test]
    fn the_bracket_is_as_narrow_as_can_be() {
        let mut random = Random(3);
        let rows = random_rows(&mut random, 6, 1.0);
        let system = System { emission: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.2], reflectance: &[0.7; 6], bands: 1 };
        let b = bracket(&system, &around(&rows, 0.3, true), &Params::default()).expect("sound");
        // The row that hands its slack to the brightest of the upper radiosities.
        let mut order: Vec<usize> = (0..6).collect();
        order.sort_by(|i, j| b.high[*j].total_cmp(&b.high[*i]));
        let brightest = |row: &Vec<f64>| {
            let mut out: Vec<f64> = row.iter().map(|f| 0.7 * f).collect();
            let mut left = 1.0 - out.iter().sum::<f64>();
            for j in &order {
                let step = (0.6 * row[*j]).min(left);
                out[*j] += step;
                left -= step;
            }
            out
        };
        let reached = solve(&rows.iter().map(brightest).collect::<Vec<_>>(), &system);
        assert!((0..6).all(|i| (reached[i] / b.high[i] - 1.0).abs() < 1e-6), "{reached:?} {b:?}");
    }

    #[test]
    fn exact_form_factors_leave_nothing_open() {
        let mut random = Random(5);
        let rows = random_rows(&mut random, 7, 0.8);
        let (e, rho) = ([1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0].repeat(2), vec![0.6; 14]);
        let system = System { emission: &e, reflectance: &rho, bands: 2 };
        let b = bracket(&system, &around(&rows, 0.0, false), &Params::default()).expect("sound");
        for (k, x) in solve(&rows, &system).iter().enumerate() {
            assert!((b.low[k] / x - 1.0).abs() < 1e-7 && (b.high[k] / x - 1.0).abs() < 1e-7, "{k}: {x}");
        }
    }

    /// A furnace: closed rows and equal emission leave B = E / (1 - rho) whatever the form factors are; only bounds
    /// that use the row sums know.
    #[test]
    fn a_furnace_is_known_whatever_its_form_factors() {
        let third = |i: usize| (0..4).map(|j| if i == j { 0.0 } else { 1.0 / 3.0 }).collect::<Vec<f64>>();
        let rows: Vec<Vec<f64>> = (0..4).map(third).collect();
        let system = System { emission: &[1.0; 4], reflectance: &[0.9; 4], bands: 1 };
        let b = bracket(&system, &around(&rows, 0.5, true), &Params::default()).expect("sound");
        assert!(b.low.iter().chain(&b.high).all(|b| (b - 10.0).abs() < 1e-6), "{b:?}");
    }

    #[test]
    fn pairs_never_seen_may_hold_what_is_left() {
        // Row 0: 0.6 on patch 1 for sure, at most 0.3 on each of the others; closed.
        let low = FormFactors::from_exact_rows(vec![vec![(1, 0.6)], vec![], vec![], vec![]]);
        let bounds = FormFactorBounds {
            low,
            high: vec![0.8],
            unseen: vec![0.3, 0.0, 0.0, 0.0],
            least_row_sum: 1.0,
            most_row_sum: 1.0,
        };
        let system = System { emission: &[0.0, 1.0, 5.0, 3.0], reflectance: &[0.5, 0.0, 0.0, 0.0], bands: 1 };
        let b = bracket(&system, &bounds, &Params::default()).expect("sound");
        // At most 0.6 on 1, 0.3 on 2 and 0.1 on 3; at least 0.8 on 1 (itself excluded) and 0.2 on 3.
        assert!((b.high[0] - 0.5 * (0.6 + 1.5 + 0.3)).abs() < 1e-9, "{b:?}");
        assert!((b.low[0] - 0.5 * (0.8 + 0.6)).abs() < 1e-9, "{b:?}");
    }

    #[test]
    fn bounds_that_no_matrix_fulfils_are_refused() {
        let rows = vec![vec![0.0, 0.5], vec![0.5, 0.0]];
        let system = System { emission: &[1.0, 0.0], reflectance: &[0.5; 2], bands: 1 };
        let e = bracket(&system, &around(&rows, 0.1, true), &Params::default()).unwrap_err();
        assert!(matches!(e, SolverError::BoundsMissRowSum { receiver: 0, .. }), "{e}");
        let dark = System { emission: &[-1.0, 0.0], ..system };
        let e = bracket(&dark, &around(&rows, 0.1, false), &Params::default()).unwrap_err();
        assert!(matches!(e, SolverError::Negative { receiver: 0, .. }), "{e}");
    }
}
