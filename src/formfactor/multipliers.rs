//! Weighted least squares under row sums and non-negativity, by its multipliers.

use super::exchanges::Pair;
use crate::math::Compensated;

/// Most Newton steps.
const STEPS: usize = 80;
/// Steps without progress after which the best point so far is taken.
const PATIENCE: usize = 6;
/// Residual of the conjugate gradients, relative.
const TOLERANCE: f64 = 1e-12;
/// Added to the diagonal, relative: rows that may share out their multipliers in many ways (two plates) stay solvable.
const RIDGE: f64 = 1e-11;

/// `min sum (G - G^)^2 / var` with `sum_j G_ij = A_i` (or `<= A_i`) and `G >= 0`.
pub(super) struct Problem<'a> {
    /// Estimates G^ with their variances.
    pub pairs: &'a [Pair],
    /// Row sums to reach, m^2.
    pub areas: &'a [f64],
    /// Row sums are equal to the areas, not below.
    pub closed: bool,
}

/// The multipliers found.
pub(super) struct Solved {
    /// One per row, `G = max(0, G^ + var (l_i + l_j))`.
    pub multipliers: Vec<f64>,
    /// Row sum over area - 1.
    pub defects: Vec<f64>,
    /// Newton steps.
    pub steps: usize,
}

/// A point of the dual problem with what is known there.
struct Point {
    multipliers: Vec<f64>,
    /// Row sum - area, m^2: the slope of the dual.
    slope: Vec<f64>,
    /// Rows whose multiplier may move.
    free: Vec<bool>,
    /// Largest slope of the free rows, relative to the area.
    error: f64,
    dual: f64,
}

impl Problem<'_> {
    /// The exchange of a pair at these multipliers.
    pub fn exchange(p: &Pair, l: &[f64]) -> f64 {
        (p.value + p.variance * (l[p.i as usize] + l[p.j as usize])).max(0.0)
    }

    /// Semi-smooth Newton on the dual, which is convex and piecewise quadratic; multipliers of inequalities stay at or
    /// below 0 by projection.
    pub fn solve(&self) -> Solved {
        let all = self.diagonal(None, &vec![true; self.areas.len()]);
        let mut point = self.at(vec![0.0; self.areas.len()], &all);
        let (mut best, mut stale, mut steps) = ((point.error, point.multipliers.clone()), 0, 0);
        while point.error > 1e-16 && steps < STEPS && stale < PATIENCE {
            let Some(next) = self.step(&point, &all) else { break };
            steps += 1;
            stale = if next.error < 0.9 * best.0 { 0 } else { stale + 1 };
            if next.error < best.0 {
                best = (next.error, next.multipliers.clone());
            }
            point = next;
        }
        let end = self.at(best.1, &all);
        let relative = |i: usize| if self.areas[i] > 0.0 { end.slope[i] / self.areas[i] } else { 0.0 };
        Solved { defects: (0..self.areas.len()).map(relative).collect(), multipliers: end.multipliers, steps }
    }

    fn at(&self, multipliers: Vec<f64>, all: &[f64]) -> Point {
        let mut sums = vec![Compensated::default(); self.areas.len()];
        let mut dual = Compensated::default();
        for p in self.pairs {
            let g = Self::exchange(p, &multipliers);
            sums[p.i as usize].add(g);
            sums[p.j as usize].add(g);
            dual.add(0.5 * g * g / p.variance);
        }
        let slope: Vec<f64> = sums.into_iter().zip(self.areas).map(|(mut s, a)| (s.add(-a), s.value()).1).collect();
        multipliers.iter().zip(self.areas).for_each(|(l, a)| dual.add(-l * a));
        let free = |i: usize| all[i] > 0.0 && (self.closed || multipliers[i] < 0.0 || slope[i] > 0.0);
        let free: Vec<bool> = (0..self.areas.len()).map(free).collect();
        let relative = |i: usize| if free[i] { (slope[i] / self.areas[i]).abs() } else { 0.0 };
        let error = (0..self.areas.len()).map(relative).fold(0.0, f64::max);
        Point { multipliers, slope, free, error, dual: dual.value() }
    }

    /// One Newton step, shortened until it helps; `None` if it does not.
    fn step(&self, from: &Point, all: &[f64]) -> Option<Point> {
        let direction = self.direction(from, all);
        let mut length = 1.0;
        for _ in 0..60 {
            let moved = |(l, d): (&f64, &f64)| {
                let l = l + length * d;
                if self.closed { l } else { l.min(0.0) }
            };
            let multipliers: Vec<f64> = from.multipliers.iter().zip(&direction).map(moved).collect();
            let promised: f64 = (0..multipliers.len())
                .filter(|i| from.free[*i])
                .map(|i| from.slope[i] * (multipliers[i] - from.multipliers[i]))
                .sum();
            let next = self.at(multipliers, all);
            if next.error < 0.5 * from.error || next.dual <= from.dual + 1e-4 * promised.min(0.0) {
                return Some(next);
            }
            length *= 0.5;
        }
        None
    }

    /// Row sums of the variances: of all pairs, or of those above 0 at a point, and of free rows.
    fn diagonal(&self, at: Option<&[f64]>, free: &[bool]) -> Vec<f64> {
        let mut d = vec![0.0; self.areas.len()];
        for p in self.pairs.iter().filter(|p| at.is_none_or(|l| Self::exchange(p, l) > 0.0)) {
            for k in [p.i as usize, p.j as usize].into_iter().filter(|k| free[*k]) {
                d[k] += p.variance;
            }
        }
        d
    }

    /// Solves `(D + V) x = -slope` on the free rows by conjugate gradients, preconditioned by the diagonal.
    fn direction(&self, at: &Point, all: &[f64]) -> Vec<f64> {
        let n = self.areas.len();
        let free = &at.free;
        let moving: Vec<&Pair> = self.pairs.iter().filter(|p| Self::exchange(p, &at.multipliers) > 0.0).collect();
        let mut diagonal = self.diagonal(Some(&at.multipliers), free);
        (0..n).filter(|i| free[*i]).for_each(|i| diagonal[i] += RIDGE * all[i]);
        let apply = |x: &[f64]| {
            let mut y: Vec<f64> = (0..n).map(|i| if free[i] { RIDGE * all[i] * x[i] } else { 0.0 }).collect();
            for p in &moving {
                let (i, j) = (p.i as usize, p.j as usize);
                let flow = p.variance * (x[i] + x[j]);
                y[i] += if free[i] { flow } else { 0.0 };
                y[j] += if free[j] { flow } else { 0.0 };
            }
            y
        };
        let scaled = |r: &[f64]| -> Vec<f64> {
            (0..n).map(|i| if diagonal[i] > 0.0 { r[i] / diagonal[i] } else { 0.0 }).collect()
        };
        let mut residual: Vec<f64> = (0..n).map(|i| if free[i] { -at.slope[i] } else { 0.0 }).collect();
        let mut x = vec![0.0; n];
        let mut z = scaled(&residual);
        let mut search = z.clone();
        let mut product = dot(&residual, &z);
        let goal = TOLERANCE * TOLERANCE * product;
        for _ in 0..(4 * n + 50).min(5000) {
            let image = apply(&search);
            let curvature = dot(&search, &image);
            if product <= goal || curvature <= 0.0 {
                break;
            }
            let length = product / curvature;
            for i in 0..n {
                x[i] += length * search[i];
                residual[i] -= length * image[i];
            }
            z = scaled(&residual);
            let next = dot(&residual, &z);
            let share = next / product;
            product = next;
            (0..n).for_each(|i| search[i] = z[i] + share * search[i]);
        }
        x
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
