//! The classic mistakes, by name: transposed, exchange areas instead of factors, one triangle, a constant factor.

use super::Surroundings;
use super::impossible::unobstructed;
use super::residue::residue;
use crate::solution::FormFactors;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// How a matrix is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// `F_ij` in row i, column j.
    AsIs,
    /// `F_ij` in row j, column i.
    Transposed,
    /// `A_i F_ij` instead of `F_ij`.
    ExchangeAreas,
    /// Each pair once, the other direction left to reciprocity.
    OneTriangle,
}

/// What explains the defects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mistake {
    /// How the matrix is laid out.
    pub layout: Layout,
    /// All entries are this many times too large; 1 where they are not.
    pub scale: f64,
    /// The constant that it is within half a per cent: "pi", "1/pi", "2".
    pub constant: Option<String>,
}

/// Constants that people multiply by or forget, with their names.
const CONSTANTS: &[(f64, &str)] = &[
    (PI, "pi"),
    (1.0 / PI, "1/pi"),
    (2.0, "2"),
    (0.5, "1/2"),
    (2.0 * PI, "2 pi"),
    (0.5 / PI, "1/(2 pi)"),
    (4.0 * PI, "4 pi"),
    (0.25 / PI, "1/(4 pi)"),
    (4.0, "4"),
    (0.25, "1/4"),
    (100.0, "100 (per cent)"),
];

/// A constant factor is named from this deviation on.
const NOTABLE: f64 = 0.02;
/// Pairs looked at for a constant factor in the open.
const COMPARED: usize = 2000;

/// The mistake that explains a matrix, if one does. Only asked about matrices that are broken.
pub(super) fn mistake(f: &FormFactors, around: &Surroundings) -> Option<Mistake> {
    if !f.values.iter().all(|v| v.is_finite()) {
        return None;
    }
    let layout = layout(f, around);
    let straight = straightened(f, around, layout);
    let scale = if around.closed { scale_of_rows(&straight, around) } else { scale_of_pairs(&straight, around) };
    let (layout, scale) = match scale {
        // Where all areas are alike, exchanges are factors times that area.
        Some(s) if layout == Layout::AsIs && equal_area(around).is_some_and(|a| (s / a - 1.0).abs() < 0.005) => {
            (Layout::ExchangeAreas, None)
        }
        other => (layout, other),
    };
    let named = scale.and_then(|s| CONSTANTS.iter().find(|(c, _)| (s / c - 1.0).abs() < 0.005));
    let scale = named.map(|(c, _)| *c).or(scale).unwrap_or(1.0);
    let found = layout != Layout::AsIs || scale != 1.0;
    found.then(|| Mistake { layout, scale, constant: named.map(|(_, name)| (*name).to_string()) })
}

/// The matrix as it was meant.
pub fn undo(f: &FormFactors, around: &Surroundings, mistake: &Mistake) -> FormFactors {
    let mut f = straightened(f, around, mistake.layout);
    f.values.iter_mut().chain(f.std_err.iter_mut().flatten()).for_each(|v| *v /= mistake.scale);
    f
}

/// The layout under which the exchange is least one-sided; another than the plain one only if it halves that.
fn layout(f: &FormFactors, around: &Surroundings) -> Layout {
    let below = (0..f.n).flat_map(|i| f.row(i).map(move |(j, _)| (j < i, j > i)));
    let (has_below, has_above) = below.fold((false, false), |all, one| (all.0 | one.0, all.1 | one.1));
    if has_below != has_above {
        return Layout::OneTriangle;
    }
    let one_sided = |layout| residue(&straightened(f, around, layout), around).one_sided;
    let plain = one_sided(Layout::AsIs);
    let others = [Layout::Transposed, Layout::ExchangeAreas].map(|l| (one_sided(l), l));
    let best = if others[1].0 < others[0].0 { others[1] } else { others[0] };
    if plain > 1e-6 && best.0 < 0.5 * plain { best.1 } else { Layout::AsIs }
}

/// Undoes a layout.
fn straightened(f: &FormFactors, around: &Surroundings, layout: Layout) -> FormFactors {
    let areas = &around.areas;
    let mut rows: Vec<Vec<(u32, f64, f64)>> = vec![Vec::new(); f.n];
    for i in 0..f.n {
        for k in f.row_starts[i]..f.row_starts[i + 1] {
            let (j, value, se) = (f.columns[k] as usize, f.values[k], f.std_err.as_ref().map_or(0.0, |e| e[k]));
            let times = |factor: f64| (value * factor, se * factor);
            let mut put = |i: usize, j: usize, (value, se): (f64, f64)| rows[i].push((j as u32, value, se));
            match layout {
                Layout::AsIs => put(i, j, (value, se)),
                Layout::Transposed => put(j, i, (value, se)),
                Layout::ExchangeAreas => put(i, j, times(if areas[i] > 0.0 { 1.0 / areas[i] } else { 0.0 })),
                Layout::OneTriangle => {
                    put(i, j, (value, se));
                    if i != j && areas[j] > 0.0 {
                        put(j, i, times(areas[i] / areas[j]));
                    }
                }
            }
        }
    }
    rows.iter_mut().for_each(|row| row.sort_unstable_by_key(|e| e.0));
    let mut out = FormFactors::from_rows(rows);
    if f.std_err.is_none() {
        out.std_err = None;
    }
    out
}

/// The one factor that all row sums of a closed scene are off by.
fn scale_of_rows(f: &FormFactors, around: &Surroundings) -> Option<f64> {
    let rows = (0..f.n).filter(|i| around.areas[*i] > 0.0);
    common(rows.map(|i| f.row_sum(i)).collect(), 0.9)
}

/// The one factor between most entries and what they were with nothing in between.
fn scale_of_pairs(f: &FormFactors, around: &Surroundings) -> Option<f64> {
    let stride = f.stored().div_ceil(COMPARED).max(1);
    let entries = (0..f.n).flat_map(|i| (f.row_starts[i]..f.row_starts[i + 1]).map(move |k| (i, k)));
    let ratio = |(i, k): (usize, usize)| {
        let j = f.columns[k] as usize;
        let open = around.forbids(i, j).is_none().then(|| unobstructed(around, i, j)).flatten()?;
        (open > 0.0).then(|| f.values[k] / open)
    };
    common(entries.filter(|(_, k)| k % stride == 0).filter_map(ratio).collect(), 0.5)
}

/// The median, if it is notably not 1 and a `share` of the values lies around it within a tenth of that.
fn common(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let median = *values.get(values.len() / 2)?;
    if median <= 0.0 || (median - 1.0).abs() <= NOTABLE {
        return None;
    }
    let width = 0.1 * (median - 1.0).abs();
    let near = values.iter().filter(|v| (**v - median).abs() <= width).count();
    (near as f64 >= share * values.len() as f64).then_some(median)
}

/// The area of all patches, where they are alike.
fn equal_area(around: &Surroundings) -> Option<f64> {
    let mut present = around.areas.iter().copied().filter(|a| *a > 0.0);
    let first = present.next()?;
    present.all(|a| (a / first - 1.0).abs() < 0.001).then_some(first).filter(|a| (a - 1.0).abs() > NOTABLE)
}
