//! Delta tables as they are made and as they are got wrong.

use super::model::{Mistake, Model, Rule};
use crate::math::Compensated;
use crate::methods::hemicube::{Delta, DeltaTable, delta_side, delta_top};
use std::f64::consts::PI;

/// Deltas of all pixels of a top and of a side, with the faces that count.
#[derive(Debug, Clone)]
pub(super) struct Table {
    /// Pixels along an edge of the top.
    n: usize,
    /// N rows of N, row by row, row 0 at y = -1.
    pub top: Vec<f64>,
    /// Rows of N, row 0 at the horizon.
    pub side: Vec<f64>,
    /// Factors of the faces, in the order of [`crate::methods::hemicube::Face::ALL`].
    pub faces: [f64; 5],
    /// True if columns mirror each other, and on the top rows do.
    mirrored: bool,
}

impl Table {
    pub fn new(n: u32, model: Model) -> Self {
        let mut table = match (model.rule, model.mistake) {
            (Rule::Exact, _) => Self::exact(n),
            (_, mistake) => Self::midpoint(n as usize, mistake),
        };
        table.faces = model.mistake.faces();
        if model.rule == Rule::Normalised {
            let scale = 1.0 / table.total();
            table.faces.iter_mut().for_each(|f| *f *= scale);
        }
        table
    }

    fn exact(n: u32) -> Self {
        let (deltas, n) = (DeltaTable::new(n, Delta::Exact), n as usize);
        let half = n / 2;
        let from_axis = |k: usize| if k < half { half - 1 - k } else { k - half };
        let cells = |rows: usize| (0..rows).flat_map(move |b| (0..n).map(move |a| (a, b)));
        let top = cells(n).map(|(a, b)| deltas.top(from_axis(a), from_axis(b))).collect();
        let side = cells(half).map(|(a, b)| deltas.side(from_axis(a), b)).collect();
        Self { n, top, side, faces: [1.0; 5], mirrored: true }
    }

    fn midpoint(n: usize, mistake: Mistake) -> Self {
        let rule = Coordinates::new(n, mistake);
        let rows = rows(n, mistake);
        let cells = |rows: usize| (0..rows).flat_map(move |b| (0..n).map(move |a| (a, b)));
        let top: Vec<f64> = cells(n).map(|(a, b)| rule.top(rule.across(a), rule.across(b))).collect();
        let side = match mistake {
            Mistake::TopTableOnSides => top[..n * (n / 2)].to_vec(),
            Mistake::SidesUpsideDown => {
                cells(rows).map(|(a, b)| rule.side(rule.across(a), rule.up(rows - 1 - b))).collect()
            }
            _ => cells(rows).map(|(a, b)| rule.side(rule.across(a), rule.up(b))).collect(),
        };
        Self { n, top, side, faces: [1.0; 5], mirrored: mistake != Mistake::PixelCorner && n.is_multiple_of(2) }
    }

    /// What the row of a patch that sees no gap sums to.
    pub fn total(&self) -> f64 {
        let sum = |deltas: &[f64]| summed(deltas.iter().copied());
        self.faces[0] * sum(&self.top) + self.faces[1..].iter().sum::<f64>() * sum(&self.side)
    }

    /// The same of a model's table, without making it.
    pub fn total_of(n: u32, model: Model) -> f64 {
        let Model { rule, mistake } = model;
        if rule != Rule::Midpoint || mistake == Mistake::TopTableOnSides {
            return Self::new(n, model).total();
        }
        let coordinates = Coordinates::new(n as usize, mistake);
        let across = mirrored((0..n as usize).map(|k| coordinates.across(k)).collect());
        let pairs = (0..across.len()).flat_map(|b| (0..=b).map(move |a| (a, b)));
        let top = summed(pairs.map(|(a, b)| {
            let ((x, w), (y, v)) = (across[a], across[b]);
            // (x, y) stands for (y, x) as well.
            if a == b { w * v * coordinates.top(x, y) } else { 2.0 * w * v * coordinates.top(x, y) }
        }));
        let heights = (0..rows(n as usize, mistake)).map(|b| coordinates.up(b));
        let side = summed(
            heights
                .flat_map(|z| across.iter().map(move |(y, w)| (*y, z, *w)))
                .map(|(y, z, w)| w * coordinates.side(y, z)),
        );
        let faces = mistake.faces();
        faces[0] * top + faces[1..].iter().sum::<f64>() * side
    }

    /// The same with the hemi-cube turned by a quarter.
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        turned.faces[1..].rotate_right(1);
        let cells = (0..self.n).flat_map(|b| (0..self.n).map(move |a| (a, b)));
        // What lay along x lies along y.
        turned.top = cells.map(|(a, b)| self.top[b + (self.n - 1 - a) * self.n]).collect();
        turned
    }

    /// The different deltas of the faces that count, ascending.
    pub fn deltas(&self) -> Vec<f64> {
        let (n, half) = (self.n, if self.mirrored { self.n / 2 } else { self.n });
        let mut all = Vec::new();
        if self.faces[0] != 0.0 {
            let from = |b: usize| if self.mirrored { b } else { 0 };
            all.extend((0..half).flat_map(|b| (from(b)..half).map(move |a| a + b * n)).map(|k| self.top[k]));
            all.iter_mut().for_each(|d| *d *= self.faces[0]);
        }
        if let Some(factor) = self.faces[1..].iter().find(|f| **f != 0.0) {
            all.extend(self.side.chunks_exact(n).flat_map(|row| &row[..half]).map(|d| factor * d));
        }
        all.retain(|d| *d > 0.0);
        all.sort_unstable_by(f64::total_cmp);
        all.dedup_by(|b, a| (*b - *a) <= 1e-12 * *a);
        all
    }
}

/// Rows of pixels on a side.
fn rows(n: usize, mistake: Mistake) -> usize {
    match mistake {
        Mistake::TallSides | Mistake::SquashedSides => n,
        Mistake::OddRowOnHorizon => n.div_ceil(2),
        _ => n / 2,
    }
}

/// The different distances from the axis, each with how many there are.
fn mirrored(mut across: Vec<f64>) -> Vec<(f64, f64)> {
    across.iter_mut().for_each(|x| *x = x.abs());
    across.sort_unstable_by(f64::total_cmp);
    let alike = across.chunk_by(|a, b| b - a < 1e-9);
    alike.map(|xs| (xs[0], xs.len() as f64)).collect()
}

fn summed(deltas: impl Iterator<Item = f64>) -> f64 {
    let mut sum = Compensated::default();
    deltas.for_each(|d| sum.add(d));
    sum.value()
}

/// Where a maker of tables believes the pixels to be, and what formula is evaluated there.
struct Coordinates {
    mistake: Mistake,
    n: f64,
    /// Area of a pixel.
    area: f64,
}

impl Coordinates {
    fn new(n: usize, mistake: Mistake) -> Self {
        let n = n as f64;
        let edge = if matches!(mistake, Mistake::PixelEdgeHalved | Mistake::HalfWidth) { 1.0 / n } else { 2.0 / n };
        Self { mistake, n, area: edge * edge }
    }

    /// x or y of a column.
    fn across(&self, k: usize) -> f64 {
        let k = k as f64;
        match self.mistake {
            Mistake::PixelCorner => 2.0 * k / self.n - 1.0,
            Mistake::EdgeToEdge => 2.0 * k / (self.n - 1.0) - 1.0,
            Mistake::HalfWidth => (k + 0.5) / self.n - 0.5,
            _ => (2.0 * k + 1.0) / self.n - 1.0,
        }
    }

    /// z of a side's row.
    fn up(&self, k: usize) -> f64 {
        let k = k as f64;
        match self.mistake {
            Mistake::PixelCorner | Mistake::OddRowOnHorizon => 2.0 * k / self.n,
            Mistake::EdgeToEdge => k / (0.5 * self.n - 1.0),
            Mistake::HalfWidth | Mistake::SquashedSides => (k + 0.5) / self.n,
            _ => (2.0 * k + 1.0) / self.n,
        }
    }

    fn top(&self, x: f64, y: f64) -> f64 {
        match self.mistake {
            Mistake::ExponentOne => self.area / (PI * (x * x + y * y + 1.0)),
            Mistake::NoPi => PI * delta_top(x, y, self.area),
            Mistake::TwoPi => 0.5 * delta_top(x, y, self.area),
            _ => delta_top(x, y, self.area),
        }
    }

    fn side(&self, y: f64, z: f64) -> f64 {
        match self.mistake {
            Mistake::SideWithoutZ => delta_top(y, z, self.area),
            Mistake::ExponentOne => z * self.area / (PI * (y * y + z * z + 1.0)),
            Mistake::NoPi => PI * delta_side(y, z, self.area),
            Mistake::TwoPi => 0.5 * delta_side(y, z, self.area),
            _ => delta_side(y, z, self.area),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_those_of_the_tables() {
        for model in Model::all() {
            let n = if model.mistake.is_odd() { 31 } else { 30 };
            let (made, quick) = (Table::new(n, model).total(), Table::total_of(n, model));
            assert!((made - quick).abs() < 1e-14 * made.abs().max(1.0), "{model:?}: {made} {quick}");
        }
    }

    #[test]
    fn four_quarter_turns_are_none() {
        for mistake in [Mistake::PixelCorner, Mistake::MissingSide, Mistake::MissingTwoSides] {
            let table = Table::new(8, Model { rule: Rule::Midpoint, mistake });
            let turned = table.turned();
            assert!((turned.top != table.top) || (turned.faces != table.faces));
            let back = turned.turned().turned().turned();
            assert_eq!((back.top, back.faces), (table.top, table.faces));
        }
    }
}
