//! All pairs of a matrix, taken apart.

use super::causes::{Pair, ROUNDING};
use crate::estimate::{PointSight, Sight, open_factor, open_mean};
use crate::math::{DVec3, Frame};
use crate::scene::Stage;
use crate::solution::FormFactors;
use rayon::prelude::*;

/// All pairs of which anything is seen: by the hemi-cube, from the centre, or from the patch. Compressed rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// Row i holds `row_starts[i] .. row_starts[i + 1]`.
    pub row_starts: Vec<usize>,
    /// Column of each pair, ascending within a row.
    pub columns: Vec<u32>,
    /// The pairs.
    pub pairs: Vec<Pair>,
}

/// What the area averages come from.
#[derive(Clone, Copy)]
pub struct Truth<'a> {
    /// The judge's form factors, with standard errors.
    pub form_factors: &'a FormFactors,
    /// Standard error of a pair that has no entry: nothing for one that is proved to be nothing, one hit for one that
    /// no ray has hit.
    pub unseen_error: &'a (dyn Fn(usize, usize) -> f64 + Sync),
}

impl Split {
    /// Takes every pair of a matrix apart. `stands` says where the hemi-cubes stand. `progress` is told of rows done.
    pub fn of(
        stage: &Stage,
        stands: &[Option<(DVec3, Frame)>],
        cube: &FormFactors,
        truth: Truth,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Self {
        let sight = PointSight::new(stage);
        let row = |i: usize| {
            let Some((eye, frame)) = stands[i] else { return Vec::new() };
            let seen = sight.row(stage.patches[i].facet, eye, frame.z);
            let open = |(j, pair): (u32, Pair)| (j, opened_to_point(stage, j, pair, eye, frame.z));
            let row = merged(i, &seen, cube, truth).into_iter().map(open).collect();
            progress(1);
            row
        };
        let mut split = Self::from_rows((0..stands.len()).into_par_iter().map(row).collect());
        split.open_means(stage);
        split
    }

    /// Area averages with nothing between. What two patches exchange is the same both ways: computed once.
    fn open_means(&mut self, stage: &Stage) {
        let forward = |i: usize| {
            let of = |(j, p): (usize, &Pair)| if j > i { opened_mean(stage, i, j, p) } else { 0.0 };
            self.row(i).map(of).collect::<Vec<f64>>()
        };
        let upper: Vec<f64> = (0..self.len()).into_par_iter().flat_map_iter(forward).collect();
        let backward = |i: usize| {
            let of = |(j, p): (usize, &Pair)| {
                let known = if j < i { self.find(j, i).map(|k| upper[k]).filter(|m| *m > 0.0) } else { None };
                match known {
                    Some(mean) => mean * stage.patches[j].area / stage.patches[i].area,
                    None => opened_mean(stage, i, j, p),
                }
            };
            self.row(i).zip(&upper[self.row_starts[i]..]).map(|(e, u)| if e.0 > i { *u } else { of(e) }).collect()
        };
        let all: Vec<f64> = (0..self.len()).into_par_iter().flat_map_iter::<_, Vec<f64>>(backward).collect();
        for (pair, open) in self.pairs.iter_mut().zip(all) {
            // Within the error of the whole it is the whole: the two were computed by different sums.
            let whole = (pair.mean - open).abs() <= 2.0 * (ROUNDING.0 + ROUNDING.1 * pair.mean);
            pair.open_mean = if whole { pair.mean } else { open };
        }
    }

    fn from_rows(rows: Vec<Vec<(u32, Pair)>>) -> Self {
        let mut split = Self { row_starts: vec![0], columns: Vec::new(), pairs: Vec::new() };
        for row in rows {
            for (j, pair) in row {
                split.columns.push(j);
                split.pairs.push(pair);
            }
            split.row_starts.push(split.columns.len());
        }
        split
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.row_starts.len() - 1
    }

    /// True if there are no patches.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (column, pair) of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Pair)> + '_ {
        let span = self.row_starts[i]..self.row_starts[i + 1];
        self.columns[span.clone()].iter().zip(&self.pairs[span]).map(|(j, p)| (*j as usize, p))
    }

    /// Number of a pair.
    fn find(&self, i: usize, j: usize) -> Option<usize> {
        let span = self.row_starts[i]..self.row_starts[i + 1];
        self.columns[span.clone()].binary_search(&(j as u32)).ok().map(|k| span.start + k)
    }

    /// One pair; `None` where nothing is seen of it.
    pub fn get(&self, i: usize, j: usize) -> Option<&Pair> {
        self.find(i, j).map(|k| &self.pairs[k])
    }

    /// Distance of another matrix from the exact values at the centres: `sqrt(sum A_i^2 d^2 / sum A_i^2 F^2)`.
    pub fn aliasing_of(&self, stage: &Stage, f: &FormFactors) -> f64 {
        let row = |i: usize| {
            let mut entries = f.row(i).peekable();
            let (mut error, mut all) = (0.0, 0.0);
            for (j, pair) in self.row(i) {
                // Seen by the other one alone.
                while let Some((_, value)) = entries.next_if(|e| e.0 < j) {
                    error += value * value;
                }
                let value = entries.next_if(|e| e.0 == j).map_or(0.0, |e| e.1);
                error += (value - pair.point).powi(2);
                all += pair.mean * pair.mean;
            }
            error += entries.map(|e| e.1 * e.1).sum::<f64>();
            let weight = stage.patches[i].area.powi(2);
            [weight * error, weight * all]
        };
        let rows: Vec<[f64; 2]> = (0..self.len()).into_par_iter().map(row).collect();
        let [error, all] = rows.iter().fold([0.0; 2], |s, r| [s[0] + r[0], s[1] + r[1]]);
        if all > 0.0 { (error / all).sqrt() } else { 0.0 }
    }

    /// A matrix on the same pairs.
    pub fn matrix(&self, of: impl Fn(&Pair) -> f64) -> FormFactors {
        FormFactors {
            n: self.len(),
            row_starts: self.row_starts.clone(),
            columns: self.columns.clone(),
            values: self.pairs.iter().map(of).collect(),
            std_err: None,
        }
    }

    /// The same pairs as progressive refinement uses them: the hemi-cube stands at the shooter j, and reciprocity
    /// brings `F_ij = F_ji A_j / A_i` to the receivers.
    pub fn from_shooters(&self, stage: &Stage) -> Self {
        let mut rows: Vec<Vec<(u32, Pair)>> = vec![Vec::new(); self.len()];
        for shooter in 0..self.len() {
            for (receiver, pair) in self.row(shooter) {
                let area = stage.patches[receiver].area;
                if area > 0.0 {
                    rows[receiver].push((shooter as u32, pair.scaled(stage.patches[shooter].area / area)));
                }
            }
        }
        Self::from_rows(rows)
    }
}

/// A matrix of rows at shooters as progressive refinement uses it, see [`Split::from_shooters`].
pub fn from_shooters(stage: &Stage, f: &FormFactors) -> FormFactors {
    let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); f.n];
    for shooter in 0..f.n {
        for (receiver, value) in f.row(shooter) {
            let area = stage.patches[receiver].area;
            if area > 0.0 {
                rows[receiver].push((shooter as u32, value * stage.patches[shooter].area / area));
            }
        }
    }
    FormFactors::from_exact_rows(rows)
}

/// The union of three rows, by column.
fn merged(i: usize, seen: &[Sight], cube: &FormFactors, truth: Truth) -> Vec<(u32, Pair)> {
    let span = |f: &FormFactors| f.row_starts[i]..f.row_starts[i + 1];
    let f = truth.form_factors;
    let mut columns: Vec<u32> = seen.iter().map(|s| s.patch).collect();
    columns.extend(&cube.columns[span(cube)]);
    columns.extend(&f.columns[span(f)]);
    columns.sort_unstable();
    columns.dedup();
    let (mut points, mut cubes, mut means) = (seen.iter().peekable(), span(cube).peekable(), span(f).peekable());
    let pair = |j: u32| {
        let mut pair = Pair::default();
        if let Some(s) = points.next_if(|s| s.patch == j) {
            (pair.point, pair.open_point) = (s.seen, s.open);
        }
        if let Some(k) = cubes.next_if(|k| cube.columns[*k] == j) {
            pair.cube = cube.values[k];
        }
        match means.next_if(|k| f.columns[*k] == j) {
            Some(k) => (pair.mean, pair.mean_error) = (f.values[k], f.std_err.as_ref().map_or(0.0, |e| e[k])),
            None => pair.mean_error = (truth.unseen_error)(i, j as usize),
        }
        (j, pair)
    };
    columns.into_iter().map(pair).collect()
}

/// Nothing is seen of the pair, from the centre or from anywhere: what there would be with nothing between says nothing.
fn is_hidden(pair: &Pair) -> bool {
    pair.point == 0.0 && pair.mean == 0.0
}

/// Adds what the centre would see with nothing between.
fn opened_to_point(stage: &Stage, j: u32, mut pair: Pair, eye: DVec3, normal: DVec3) -> Pair {
    if is_hidden(&pair) {
        return pair;
    }
    if pair.point == 0.0 {
        pair.open_point = open_factor(eye, normal, &stage.patches[j as usize].region);
    }
    if (pair.point - pair.open_point).abs() <= ROUNDING.0 {
        pair.open_point = pair.point;
    }
    pair
}

/// The area average with nothing between.
fn opened_mean(stage: &Stage, i: usize, j: usize, pair: &Pair) -> f64 {
    if is_hidden(pair) { 0.0 } else { open_mean(&stage.patches[i].region, &stage.patches[j].region) }
}
