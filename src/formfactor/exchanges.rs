//! What each pair of patches exchanges, from both directions of a matrix: the unknowns of the enforcement.

use super::Surroundings;
use super::residue::for_pairs;
use crate::solution::FormFactors;

/// Variance of an exchange stated as exact, as a share of its square: rounding.
const EXACT: f64 = 1e-28;

/// A pair i < j: exchange `A_i F_ij` in m^2 and its variance in m^4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pair {
    pub i: u32,
    pub j: u32,
    pub value: f64,
    pub variance: f64,
}

/// Both directions of a pair i < j: what each says of the exchange, m^2, and its grain, the variance per unit of exchange.
#[derive(Debug, Clone, Copy)]
pub(super) struct Both {
    pub i: usize,
    pub j: usize,
    /// `A_i F_ij`.
    pub there: f64,
    /// `A_j F_ji`.
    pub back: f64,
    grains: (f64, f64),
}

impl Both {
    /// Weights of the two directions. Where both are exact, both count alike.
    fn weights(&self) -> (f64, f64) {
        let (a, b) = self.grains;
        if self.is_exact() { (1.0, 1.0) } else { (1.0 / a, 1.0 / b) }
    }

    fn is_exact(&self) -> bool {
        self.grains.0 == 0.0 || self.grains.1 == 0.0
    }

    /// The size both agree on, m^2.
    fn size(&self) -> f64 {
        let (a, b) = self.weights();
        (a * self.there.abs() + b * self.back.abs()) / (a + b)
    }

    /// The most likely exchange.
    fn combined(&self) -> Pair {
        let ((a, b), size) = (self.weights(), self.size());
        let value = (a * self.there + b * self.back) / (a + b);
        let counted = if self.is_exact() { 0.0 } else { size / (a + b) };
        Pair { i: self.i as u32, j: self.j as u32, value, variance: counted.max(EXACT * size * size) }
    }

    /// Standard error of `there - back`, m^2.
    pub fn defect_std_err(&self) -> f64 {
        let counted = if self.is_exact() { 0.0 } else { (self.grains.0 + self.grains.1) * self.size() };
        counted.max(EXACT * self.size().powi(2)).sqrt()
    }
}

/// Both directions of all stored pairs that geometry allows, by row and column.
///
/// The variance of a direction is taken at the size the two agree on: the variance of a share counted by rays grows with
/// the share, and weighing by the variance at one's own value would favour whichever direction happened to come out low.
/// A direction without a value has seen 0 of the exchange, with the typical noise of its row. Without standard errors
/// the variance is taken to be proportional to the exchange.
pub(super) fn both_directions(f: &FormFactors, around: &Surroundings) -> Vec<Both> {
    let areas = &around.areas;
    let known = errors_are_known(f);
    let typical: Vec<Option<f64>> = (0..f.n).map(|i| typical_grain(f, areas[i], i).filter(|_| known)).collect();
    let mut out = Vec::with_capacity(f.stored() / 2 + 1);
    for_pairs(f, |i, j, there, back| {
        if around.forbids(i, j).is_none() {
            let own = [grain(f, areas[i], i, j), grain(f, areas[j], j, i)];
            let grains = if known { grains(own, [typical[i], typical[j]]) } else { (1.0, 1.0) };
            out.push(Both { i, j, there: areas[i] * there, back: areas[j] * back, grains });
        }
    });
    out.sort_unstable_by_key(|b| (b.i, b.j));
    out
}

/// Estimates of the exchanges: both directions weighed by their inverse variances.
pub(super) fn combine(f: &FormFactors, around: &Surroundings) -> Vec<Pair> {
    both_directions(f, around).iter().map(Both::combined).filter(|p| p.value != 0.0).collect()
}

/// True if every stored entry has a standard error that is a number.
pub(super) fn errors_are_known(f: &FormFactors) -> bool {
    f.std_err.as_ref().is_some_and(|e| e.iter().all(|e| e.is_finite() && *e >= 0.0))
}

/// Variance of the exchange A_i F_ij per unit of exchange, m^2; `None` where no error is stated.
fn grain(f: &FormFactors, area: f64, i: usize, j: usize) -> Option<f64> {
    let (value, std_err) = (f.get(i, j).abs(), f.std_err_of(i, j)?);
    (value > 0.0 && std_err.is_finite()).then(|| area * std_err * std_err / value)
}

/// The grains of both directions. An unknown one is that of its row; so is a 0 beside a partner that is not exact too,
/// which is a coincidence of equal counts and no certainty.
fn grains(own: [Option<f64>; 2], typical: [Option<f64>; 2]) -> (f64, f64) {
    if own == [Some(0.0); 2] {
        return (0.0, 0.0);
    }
    let stated = own.map(|g| g.filter(|g| *g > 0.0));
    let of = |k: usize| stated[k].or(typical[k]).or(stated[1 - k]).or(typical[1 - k]).unwrap_or(0.0);
    (of(0), of(1))
}

/// Gives a matrix the standard errors that stand in a second one at the same places. An entry that has none there is
/// given the typical noise of its row (0 where the whole row has none): missing is not zero. Also says how many.
pub fn attach_errors(f: FormFactors, errors: &FormFactors, areas: &[f64]) -> (FormFactors, usize) {
    let rows = 0..f.n;
    let stated =
        rows.flat_map(|i| f.row(i).map(move |(j, _)| if errors.holds(i, j) { errors.get(i, j) } else { f64::NAN }));
    let stated = stated.collect();
    let mut f = FormFactors { std_err: Some(stated), ..f };
    let typical: Vec<f64> = (0..f.n).map(|i| typical_grain(&f, areas[i], i).unwrap_or(0.0)).collect();
    let mut missing = 0;
    for i in 0..f.n {
        for k in f.row_starts[i]..f.row_starts[i + 1] {
            let guess = if areas[i] > 0.0 { (typical[i] * f.values[k].abs() / areas[i]).sqrt() } else { 0.0 };
            if let Some(se) = f.std_err.as_mut().and_then(|e| e.get_mut(k)).filter(|se| se.is_nan()) {
                *se = guess;
                missing += 1;
            }
        }
    }
    (f, missing)
}

/// The median of the grains of a row that are above 0.
fn typical_grain(f: &FormFactors, area: f64, i: usize) -> Option<f64> {
    let mut all: Vec<f64> = f.row(i).filter_map(|(j, _)| grain(f, area, i, j)).filter(|g| *g > 0.0).collect();
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(areas: &[f64]) -> Surroundings<'static> {
        Surroundings { areas: areas.to_vec(), closed: true, patches: &[] }
    }

    #[test]
    fn both_directions_count_by_their_variances() {
        // Exchanges 0.5 and 0.5 with standard errors 0.1 and 0.2: 1 / (100 + 25) is the variance of the mean.
        let f = FormFactors::from_rows(vec![vec![(1, 0.5, 0.1)], vec![(0, 0.25, 0.1)]]);
        let pairs = combine(&f, &around(&[1.0, 2.0]));
        assert_eq!(pairs.len(), 1);
        assert!((pairs[0].value - 0.5).abs() < 1e-15);
        assert!((pairs[0].variance - 1.0 / 125.0).abs() < 1e-15);
    }

    #[test]
    fn counts_by_rays_are_pooled_as_counts() {
        // 1 and 5 hits of 1000 rays each, variances as large as the counts: 3 hits, not the 1.67 that weighing each
        // by its own variance gives.
        let f =
            FormFactors::from_rows(vec![vec![(1, 0.001, 0.001)], vec![(0, 0.005, 0.005f64.sqrt() / 1000f64.sqrt())]]);
        assert!((combine(&f, &around(&[1.0, 1.0]))[0].value - 0.003).abs() < 1e-15);
    }

    #[test]
    fn what_one_direction_never_hit_counts_as_nothing_seen() {
        let se = |hits: f64| hits.sqrt() / 1000.0;
        let rows = vec![
            vec![(1, 0.004, se(4.0)), (2, 0.3, se(300.0))],
            vec![],
            vec![(0, 0.3, se(300.0)), (1, 0.1, se(100.0))],
        ];
        let pairs = combine(&FormFactors::from_rows(rows), &around(&[1.0, 1.0, 1.0]));
        // Row 1 states nothing: the grain of its partner is taken for it.
        assert!((pairs[0].value - 0.002).abs() < 1e-12, "{pairs:?}");
        assert_eq!(pairs.iter().map(|p| (p.i, p.j)).collect::<Vec<_>>(), [(0, 1), (0, 2), (1, 2)]);
    }

    #[test]
    fn a_zero_beside_an_uncertain_partner_is_no_certainty() {
        let se = |hits: f64| hits.sqrt() / 1000.0;
        let rows =
            vec![vec![(1, 0.016, 0.0), (2, 0.1, se(100.0))], vec![(0, 0.02, se(20.0))], vec![(0, 0.1, se(100.0))]];
        let pairs = combine(&FormFactors::from_rows(rows), &around(&[1.0, 1.0, 1.0]));
        assert!((pairs[0].value - 0.018).abs() < 1e-12, "{pairs:?}");
        let exact = FormFactors::from_rows(vec![vec![(1, 0.5, 0.0)], vec![(0, 0.5, 0.0)]]);
        assert!(combine(&exact, &around(&[1.0, 1.0]))[0].variance < 1e-28);
    }
}
