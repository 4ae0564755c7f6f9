//! How fast an error falls: the power of cost it follows, and the cost at which it reaches a level.

use crate::stats::{Estimate, two_sided_t};

/// Errors within this factor of the reference's noise floor say more of the reference than of the solution.
pub const FLOOR_FACTOR: f64 = 2.0;
/// A line takes two points; the third says how well it fits.
const FEWEST: usize = 3;
/// Relative errors below this are rounding.
const ROUNDING: f64 = 1e-9;
/// Halvings of the bracket of the scatter.
const HALVINGS: usize = 80;

/// One error on its way down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Cost: shots, rays, seconds; or the size of a mesh. At least 0.
    pub x: f64,
    /// The error with its interval.
    pub error: Estimate,
    /// What a perfect solution would read against this reference; `None` where the reference states no noise.
    pub floor: Option<f64>,
}

impl Point {
    /// True if the error stands clear of the noise and can be drawn on logarithmic axes.
    pub fn is_clear(&self) -> bool {
        let noise = FLOOR_FACTOR * self.floor.unwrap_or(0.0);
        self.x > 0.0 && self.error.low > 0.0 && self.error.value > noise
    }
}

/// A power law `error = exp(intercept) x^slope`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// Exponent, with its Student-t interval.
    pub slope: Estimate,
    /// Natural logarithm of the error at x = 1.
    pub intercept: f64,
    /// Points that the fit rests on.
    pub points: usize,
    /// The least and the largest x among them.
    pub range: (f64, f64),
}

/// Weighted least squares of log(error) on log(x), over the points clear of the noise ([`Point::is_clear`]).
///
/// Each point's variance is that of its own relative error plus a scatter common to all, as large as makes the
/// residuals what they should be [Paule & Mandel 1982]: points known exactly do not lie exactly on a power law. The
/// interval is Student's with two degrees of freedom fewer than points. Errors against one reference share its
/// noise, which shifts all of them alike; the slope is hardly moved by it.
///
/// `None` with fewer than three points, or where all have the same x.
pub fn fit_rate(points: &[Point], confidence: f64) -> Option<Rate> {
    let clear: Vec<&Point> = points.iter().filter(|p| p.is_clear()).collect();
    let x: Vec<f64> = clear.iter().map(|p| p.x.ln()).collect();
    if clear.len() < FEWEST || x.iter().all(|v| *v == x[0]) {
        return None;
    }
    let y: Vec<f64> = clear.iter().map(|p| p.error.value.ln()).collect();
    let variance = |p: &&Point| (p.error.std_err.unwrap_or(0.0) / p.error.value).max(ROUNDING).powi(2);
    let own: Vec<f64> = clear.iter().map(variance).collect();
    let line = Line::fit(&x, &y, &own, scatter(&x, &y, &own));
    let freedom = (clear.len() - 2) as f64;
    // Residuals smaller than the errors say are luck.
    let std_err = line.misfit.max(1.0).sqrt() * line.std_err;
    let half = two_sided_t(confidence, freedom) * std_err;
    let slope = Estimate { value: line.slope, std_err: Some(std_err), low: line.slope - half, high: line.slope + half };
    let ends = clear.iter().fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(p.x), b.max(p.x)));
    Some(Rate { slope, intercept: line.intercept, points: clear.len(), range: ends })
}

/// The common variance at which the weighted squares of the residuals are as many as the degrees of freedom; 0 where
/// the points' own variances explain them.
fn scatter(x: &[f64], y: &[f64], own: &[f64]) -> f64 {
    let misfit = |common: f64| Line::fit(x, y, own, common).misfit;
    if misfit(0.0) <= 1.0 {
        return 0.0;
    }
    // With the squares of the unweighted residuals as variance the misfit is at most 1.
    let even = vec![1.0; x.len()];
    let (mut low, mut high) = (0.0, Line::fit(x, y, &even, 0.0).misfit);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if misfit(middle) > 1.0 { low = middle } else { high = middle }
    }
    high
}

/// A weighted line.
struct Line {
    slope: f64,
    intercept: f64,
    /// Of the slope, by the variances given.
    std_err: f64,
    /// Weighted squares of the residuals over degrees of freedom.
    misfit: f64,
}

impl Line {
    fn fit(x: &[f64], y: &[f64], own: &[f64], common: f64) -> Self {
        let weights: Vec<f64> = own.iter().map(|v| 1.0 / (v + common)).collect();
        let total: f64 = weights.iter().sum();
        let mean = |v: &[f64]| v.iter().zip(&weights).map(|(a, w)| a * w).sum::<f64>() / total;
        let (mx, my) = (mean(x), mean(y));
        let over = |f: &dyn Fn(usize) -> f64| (0..x.len()).map(|k| weights[k] * f(k)).sum::<f64>();
        let sxx = over(&|k| (x[k] - mx).powi(2));
        let slope = over(&|k| (x[k] - mx) * (y[k] - my)) / sxx;
        let intercept = my - slope * mx;
        let misfit = over(&|k| (y[k] - intercept - slope * x[k]).powi(2)) / (x.len() - 2) as f64;
        Self { slope, intercept, std_err: sxx.recip().sqrt(), misfit }
    }
}

/// Where an error comes down to a level for good. Only snapshots are known: it is reached at or before this x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reached {
    /// First x from which on the value is at or below the level; `None` if the last one is above.
    pub by_value: Option<f64>,
    /// The same of the upper end of the interval.
    pub with_confidence: Option<f64>,
}

/// The first x at which the error is at or below `level` and stays so, by value and with the interval's confidence.
pub fn reached(points: &[Point], level: f64) -> Reached {
    let mut sorted: Vec<&Point> = points.iter().collect();
    // Stable: points of equal x stay in their order.
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    let first = |of: &dyn Fn(&Estimate) -> f64| {
        let above = sorted.iter().rposition(|p| of(&p.error) > level).map_or(0, |k| k + 1);
        sorted.get(above).map(|p| p.x)
    };
    Reached { by_value: first(&|e| e.value), with_confidence: first(&|e| e.high) }
}

#[cfg(test)]
mod tests;
