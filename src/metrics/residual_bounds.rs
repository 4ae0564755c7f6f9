//! From the norm of a residual to two-sided bounds on the error of a solution: algebra alone, no statistics.
//!
//! Notation, per band: `K = diag(rho) F`, true radiosity `B* = E + K B*`, judged solution B, error `e = B - B*`,
//! one-bounce residual `r = E + K B - B`, and n bounces of it `v = r + K r + ... + K^(n-1) r`.
//!
//! **`r = -(I - K) e`**: subtract `B* = E + K B*`. Hence **`v = -(I - K^n) e`**, for the sum telescopes.
//!
//! **`|K x| <= rho_max |x|`** in the area norm `|x|^2 = sum A_i x_i^2`. F is reciprocal (`A_i F_ij = A_j F_ji`), has
//! no negative entry and rows that sum to at most 1. By Cauchy and Schwarz `(sum_j F_ij x_j)^2 <= sum_j F_ij x_j^2`,
//! so `|F x|^2 <= sum_j x_j^2 sum_i A_i F_ij = sum_j A_j x_j^2 sum_i F_ji <= |x|^2`; `diag(rho)` shrinks the rest.
//!
//! **One band**, `q = rho_max^n`: `|v| / (1 + q) <= |e| <= |v| / (1 - q)`.
//!
//! **Luminance** `e_Y = sum_c w_c e_c` of bands with reflectances of their own. Bands with equal reflectances share K
//! and are one group g, with `u_g = sum w_c v_c` and `e_g` likewise; `|e_g| <= |u_g| / (1 - q_g)`. For any
//! `K_0 = diag(rho_0) F` of norm at most `rho_0,max`, `q_0 = rho_0,max^n`,
//! `v_Y = -(I - K_0^n) e_Y + sum_g (K_g^n - K_0^n) e_g`, and the last sum is at most
//! `D = sum_g d_g |u_g| / (1 - q_g)`, where `d_g = max|rho_g - rho_0| sum_(k<n) rho_g,max^k rho_0,max^(n-1-k)` (again
//! a telescoping sum) or `q_g + q_0`, whichever is less. So
//! `(|v_Y| - D) / (1 + q_0) <= |e_Y| <= (|v_Y| + D) / (1 - q_0)`. Every K_0 is right; the best of zero and the
//! groups' own is taken. With one group this is the bound of one band.
//!
//! **Relative**, against `|B*_Y|`: `B* = B - e` lies within `|e_Y|` of B, and, as `e_Y = -v_Y + sum_g K_g^n e_g`,
//! within `T = sum_g q_g |u_g| / (1 - q_g)` of `B + v`. Both bracket its norm. Of B - E (reflected light) the same
//! holds, since both sides lose the same E.

use crate::stats::Estimate;
use serde::Serialize;

/// Lower and upper bound of a relative error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorBounds {
    /// The relative error is at least this.
    pub low: f64,
    /// The relative error is at most this; `None` where the truth may be as dark as the error is large.
    pub high: Option<f64>,
}

/// Bands with the same reflectances, seen as one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Group {
    /// `|u_g|`, the area norm of its weighted series.
    pub norm: Estimate,
    /// Largest reflectance.
    pub rho_max: f64,
    /// `max |rho_g - rho_h|` over the patches, for every group h.
    pub apart: Vec<f64>,
}

/// What the bounds are made of; each estimate with an interval that holds it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Norms {
    /// `|v_Y|`.
    pub series: Estimate,
    /// Groups of bands; never empty.
    pub groups: Vec<Group>,
    /// `|B + v|` of the quantity judged: the solution with its residual made good.
    pub corrected: Estimate,
    /// `|B|` of the quantity judged, exact.
    pub solution: f64,
    /// Bounces n.
    pub bounces: u32,
}

impl Norms {
    /// Bounds on the relative error.
    pub fn bounds(&self) -> ErrorBounds {
        let (low, high) = self.absolute();
        let rest: f64 = self.groups.iter().map(|g| power(g.rho_max, self.bounces) * self.error_of(g)).sum();
        let darkest = (self.solution - high).max(self.corrected.low - rest);
        let brightest = (self.solution + high).min(self.corrected.high + rest);
        ErrorBounds {
            low: if low > 0.0 { low / brightest } else { 0.0 },
            high: if high == 0.0 { Some(0.0) } else { (darkest > 0.0).then(|| high / darkest) },
        }
    }

    /// Bounds on `|e_Y|`.
    fn absolute(&self) -> (f64, f64) {
        let mut best = self.on_base(0.0, |g| power(g.rho_max, self.bounces));
        for (h, base) in self.groups.iter().enumerate() {
            let (low, high) = self.on_base(power(base.rho_max, self.bounces), |g| self.distance(g, h));
            best = (best.0.max(low), best.1.min(high));
        }
        best
    }

    /// The same through a `K_0` with `|K_0^n| <= q`, from which `distance` says how far each group's is.
    fn on_base(&self, q: f64, distance: impl Fn(&Group) -> f64) -> (f64, f64) {
        let apart: f64 = self.groups.iter().map(|g| distance(g) * self.error_of(g)).sum();
        ((self.series.low - apart).max(0.0) / (1.0 + q), (self.series.high + apart) / (1.0 - q))
    }

    /// Upper bound of `|e_g|`.
    fn error_of(&self, group: &Group) -> f64 {
        group.norm.high / (1.0 - power(group.rho_max, self.bounces))
    }

    /// Upper bound of `|K_g^n - K_h^n|`.
    fn distance(&self, g: &Group, h: usize) -> f64 {
        let (n, other) = (self.bounces, self.groups[h].rho_max);
        let telescope: f64 = (0..n).map(|k| power(g.rho_max, k) * power(other, n - 1 - k)).sum();
        (g.apart[h] * telescope).min(power(g.rho_max, n) + power(other, n))
    }

    /// What `factor` times the rays would make of it, if the values stay where they are.
    pub fn with_rays(&self, factor: f64) -> Self {
        let shrink = 1.0 / factor.sqrt();
        let narrow = |e: Estimate| Estimate {
            low: e.value - shrink * (e.value - e.low),
            high: e.value + shrink * (e.high - e.value),
            ..e
        };
        let groups = self.groups.iter().map(|g| Group { norm: narrow(g.norm), ..g.clone() }).collect();
        Self { series: narrow(self.series), corrected: narrow(self.corrected), groups, ..*self }
    }

    /// What n bounces would make of it, roughly: the series changes little once it holds the first few.
    pub fn with_bounces(&self, bounces: u32) -> Self {
        Self { bounces, ..self.clone() }
    }
}

fn power(x: f64, n: u32) -> f64 {
    x.powi(n.min(i32::MAX as u32) as i32)
}

#[cfg(test)]
mod tests {
    use super::super::residual_testing::Room;
    use super::*;

    fn exact(x: f64) -> Estimate {
        Estimate::exact(x)
    }

    fn one_group(series: f64, solution: f64, corrected: f64, rho_max: f64, bounces: u32) -> Norms {
        let groups = vec![Group { norm: exact(series), rho_max, apart: vec![0.0] }];
        Norms { series: exact(series), groups, corrected: exact(corrected), solution, bounces }
    }

    /// A furnace solution that is 5 % too bright everywhere: r = -(1 - rho) 0.05 B*, all of it along B.
    #[test]
    fn a_uniform_error_by_hand() {
        let (rho, truth) = (0.5, 2.0);
        let b = one_group(0.5 * 0.05 * truth, 1.05 * truth, 1.05 * truth - 0.5 * 0.05 * truth, rho, 1).bounds();
        // |e| lies between 0.05 / 1.5 and 0.05 / 0.5 = 0.1 of which the truth is 2.
        assert!((b.low - (0.05 / 1.5) / (2.05 + 0.05f64 * 1.0).min(2.1 + 0.1)).abs() < 0.01, "{b:?}");
        assert!(b.low < 0.05 && (b.high.unwrap() - 0.05).abs() < 1e-12, "{b:?}");
        // Many bounces leave nothing open.
        let series = |n: i32| (1.0 - rho.powi(n)) * 0.05 * truth;
        let b = one_group(series(40), 1.05 * truth, 1.05 * truth - series(40), rho, 40).bounds();
        assert!((b.low - 0.05).abs() < 1e-9 && (b.high.unwrap() - 0.05).abs() < 1e-9, "{b:?}");
    }

    #[test]
    fn an_error_that_may_be_all_the_light_has_no_upper_bound() {
        let b = one_group(1.0, 1.0, 0.5, 0.9, 1).bounds();
        assert_eq!(b.high, None);
        assert!(b.low > 0.0);
    }

    /// Random rooms (three bands, 2 to 12 patches, reflectances up to 0.95, equal or different over the bands) and
    /// random errors: the true relative error is never outside of the bounds, whatever n; and the bounds close in.
    #[test]
    fn the_true_error_lies_within() {
        let (mut one_bounce, mut many) = (0.0f64, 0.0f64);
        for seed in 0..400 {
            let room = Room::new(seed, 2 + seed as usize % 11, 3);
            let truth = room.true_error();
            for bounces in [1, 2, 3, 7, 60] {
                let b = room.norms(bounces).bounds();
                let slack = 1e-9 * truth;
                assert!(b.low <= truth + slack, "seed {seed}, n {bounces}: {b:?}, true {truth}");
                assert!(b.high.is_none_or(|h| h >= truth - slack), "seed {seed}, n {bounces}: {b:?}, true {truth}");
                match bounces {
                    1 => one_bounce += b.low / truth,
                    60 => many += b.low / truth,
                    _ => {}
                }
            }
        }
        println!("mean of lower bound over true error: one bounce {:.3}, 60 {:.3}", one_bounce / 400.0, many / 400.0);
        assert!(one_bounce / 400.0 > 0.3 && many / 400.0 > 0.9, "{one_bounce} {many}");
    }
}
