//! The uncertainty that is left of an exchange once closure and reciprocity are known to hold.

use super::exchanges::Pair;
use rayon::prelude::*;

/// Most rows for which the multiplier matrix is inverted; its cost grows with the cube.
pub(super) const EXACT_ROWS: usize = 1500;

/// Share of the diagonal added before the inversion: two plates alone leave one direction open, which no exchange sees.
const RIDGE: f64 = 1e-9;

/// Variance of each exchange after enforcement: `v - v^2 (M_ii + M_jj + 2 M_ij)`, M the inverse of the multiplier matrix
/// `D + V` of the rows that bind. Linear propagation, for the pairs above 0 at the solution (`holds`); the others keep
/// their variance, an upper bound. With more than [`EXACT_ROWS`] rows the bound `v (1 - v / min(D_i, D_j))`, which one
/// row alone brings about; more constraints only take away.
pub(super) fn variances(pairs: &[Pair], holds: &[bool], binds: &[bool]) -> (Vec<f64>, bool) {
    let mut diagonal = vec![0.0; binds.len()];
    for (p, _) in pairs.iter().zip(holds).filter(|(_, h)| **h) {
        diagonal[p.i as usize] += p.variance;
        diagonal[p.j as usize] += p.variance;
    }
    let rows: Vec<usize> = (0..binds.len()).filter(|i| binds[*i] && diagonal[*i] > 0.0).collect();
    let exact = rows.len() <= EXACT_ROWS;
    let mut place = vec![usize::MAX; binds.len()];
    rows.iter().enumerate().for_each(|(k, i)| place[*i] = k);
    let inverse = if exact { inverse_columns(pairs, holds, &diagonal, &rows, &place) } else { vec![] };
    let taken = |p: &Pair| {
        let (i, j) = (p.i as usize, p.j as usize);
        if exact {
            squared_length(&inverse, (place[i], diagonal[i]), (place[j], diagonal[j]))
        } else {
            [i, j].iter().filter(|k| binds[**k]).map(|k| 1.0 / diagonal[*k]).fold(0.0, f64::max)
        }
    };
    let left = |(p, holds): (&Pair, &bool)| {
        if *holds { p.variance * (1.0 - p.variance * taken(p)).clamp(0.0, 1.0) } else { p.variance }
    };
    (pairs.par_iter().zip(holds).map(left).collect(), exact)
}

/// `(e_i + e_j)^T M (e_i + e_j)` from the columns of the inverse Cholesky factor of the scaled matrix. Rows that do
/// not bind have no column.
fn squared_length(columns: &[Vec<f64>], (i, di): (usize, f64), (j, dj): (usize, f64)) -> f64 {
    let (a, b) = (columns.get(i), columns.get(j));
    let n = columns.len();
    let entry = |column: Option<&Vec<f64>>, first: usize, d: f64, k: usize| match column {
        Some(c) if k >= first => c[k - first] / d.sqrt(),
        _ => 0.0,
    };
    (i.min(j).min(n)..n).map(|k| (entry(a, i, di, k) + entry(b, j, dj, k)).powi(2)).sum()
}

/// Columns of the inverse of the Cholesky factor of `D^-1/2 (D + V) D^-1/2`, each from its diagonal down.
fn inverse_columns(pairs: &[Pair], holds: &[bool], diagonal: &[f64], rows: &[usize], place: &[usize]) -> Vec<Vec<f64>> {
    let n = rows.len();
    let mut lower: Vec<Vec<f64>> = (0..n).map(|k| vec![0.0; k + 1]).collect();
    (0..n).for_each(|k| lower[k][k] = 1.0 + RIDGE);
    for (p, _) in pairs.iter().zip(holds).filter(|(_, h)| **h) {
        let (a, b) = (place[p.i as usize], place[p.j as usize]);
        if a < n && b < n {
            lower[a.max(b)][a.min(b)] = p.variance / (diagonal[p.i as usize] * diagonal[p.j as usize]).sqrt();
        }
    }
    factorise(&mut lower);
    (0..n).into_par_iter().map(|first| inverse_column(&lower, first)).collect()
}

/// Cholesky in place, row by row. The matrix is positive definite by its ridge.
fn factorise(lower: &mut [Vec<f64>]) {
    for i in 0..lower.len() {
        let (above, rest) = lower.split_at_mut(i);
        let row = &mut rest[0];
        for j in 0..i {
            let sum: f64 = row[..j].iter().zip(&above[j][..j]).map(|(a, b)| a * b).sum();
            row[j] = (row[j] - sum) / above[j][j];
        }
        let sum: f64 = row[..i].iter().map(|a| a * a).sum();
        row[i] = (row[i] - sum).max(f64::EPSILON * RIDGE).sqrt();
    }
}

fn inverse_column(lower: &[Vec<f64>], first: usize) -> Vec<f64> {
    let mut column: Vec<f64> = Vec::with_capacity(lower.len() - first);
    for k in first..lower.len() {
        let unit = if k == first { 1.0 } else { 0.0 };
        let sum: f64 = column.iter().zip(&lower[k][first..k]).map(|(a, b)| a * b).sum();
        column.push((unit - sum) / lower[k][k]);
    }
    column
}
