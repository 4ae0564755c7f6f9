//! What the pixels of a hemi-cube show, summed with any table and held against a row of somebody's.

use super::axes::Axes;
use super::borders::Borders;
use super::sheets::Sheet;
use crate::methods::hemicube::{Delta, DeltaTable, FACES, Face, Hemicube, Item, Params, Stand, World, stand};
use crate::scene::Stage;
use crate::solution::FormFactors;
use serde::Serialize;
use std::cell::LazyCell;

/// Entries of a matrix that our pixels reproduce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Confirmed {
    /// Reproduced within the digits given.
    pub entries: usize,
    /// Not so, but explained by pixels whose centre lies on the border between two patches: each may count for either,
    /// and what the patches of a row gain and lose by it adds up to nothing.
    pub by_borders: usize,
    /// Entries compared: not zero in theirs or in ours.
    pub of: usize,
    /// Rows compared.
    pub rows: usize,
    /// Rows reproduced in every entry.
    pub whole_rows: usize,
}

impl Confirmed {
    /// Share of the entries reproduced.
    pub fn share(&self) -> f64 {
        if self.of == 0 { 0.0 } else { self.entries as f64 / self.of as f64 }
    }

    /// Share of the entries reproduced or explained.
    pub fn explained(&self) -> f64 {
        if self.of == 0 { 0.0 } else { (self.entries + self.by_borders) as f64 / self.of as f64 }
    }

    /// True where most entries of several are reproduced, or a good part and borders explain all the others: no
    /// accident.
    pub(super) fn holds(&self) -> bool {
        let all = self.entries + self.by_borders == self.of;
        self.entries >= 6 && self.share() >= if all { 0.2 } else { 0.5 }
    }

    fn add(&mut self, other: Self) {
        self.entries += other.entries;
        self.by_borders += other.by_borders;
        self.of += other.of;
        self.rows += other.rows;
        self.whole_rows += other.whole_rows;
    }
}

impl std::iter::Sum for Confirmed {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |mut sum, one| {
            sum.add(one);
            sum
        })
    }
}

/// Takes pictures at one resolution.
#[derive(Debug)]
pub(super) struct Camera<'a> {
    stage: &'a Stage,
    world: &'a World,
    n: u32,
    table: DeltaTable,
}

/// How far our entries may be off theirs.
pub(super) type Slack<'a> = &'a (dyn Fn(f64) -> f64 + Sync);

impl<'a> Camera<'a> {
    pub fn new(stage: &'a Stage, world: &'a World, n: u32) -> Self {
        Self { stage, world, n, table: DeltaTable::new(n, Delta::Midpoint) }
    }

    /// Items of the five faces of the hemi-cube on a patch, seen through pixels shifted by so much.
    fn picture(&self, patch: usize, axes: Axes, shift: [f64; 2]) -> Option<[Vec<Item>; FACES]> {
        let patch = &self.stage.patches[patch];
        let (eye, _) = stand(patch, &Params::default())?;
        let mut cube = Hemicube::new(self.world, &self.table);
        cube.aim_at(&Stand { shift, ..Stand::at(eye, axes.frame(patch)) });
        Some(Face::ALL.map(|face| {
            cube.project(face);
            cube.scan(face);
            cube.items().to_vec()
        }))
    }

    /// Compares rows with every view of a sheet; one result per view. Borders are looked for if asked: five pictures
    /// in place of one.
    pub fn compare(
        &self,
        f: &FormFactors,
        rows: &[usize],
        axes: Axes,
        sheet: &Sheet,
        slack: Slack<'_>,
        borders: bool,
    ) -> Vec<Confirmed> {
        let mut found = vec![Confirmed::default(); sheet.views.len()];
        for i in rows {
            let Some(picture) = self.picture(*i, axes, [0.0; 2]) else { continue };
            let shifted = |shift| self.picture(*i, axes, shift);
            let at_borders = LazyCell::new(|| Borders::new(&picture, shifted));
            let sums = sheet.sums(&picture, f.n);
            let mut theirs = vec![0.0; f.n];
            f.row(*i).for_each(|(j, v)| theirs[j] = v);
            for (view, found) in sheet.views.iter().zip(&mut found) {
                let ours = sums.row(*view);
                let mut row = agreement(&theirs, &ours, slack);
                if borders && row.entries < row.of {
                    row.by_borders = at_borders.explained(&theirs, &ours, slack, |k, p| sheet.delta(*view, k, p));
                }
                found.add(row);
            }
        }
        found
    }

    /// What comparing a row costs, in pixels touched: about 4 ns each.
    pub fn cost(&self, sheet: &Sheet) -> f64 {
        picture_cost(self.n, sheet.tables(), self.stage.patches.len())
    }
}

/// What a picture of so many patches costs, summed with so many tables, in pixels touched.
pub(super) fn picture_cost(n: u32, tables: usize, patches: usize) -> f64 {
    const PER_PATCH: f64 = 100.0;
    3.0 * f64::from(n).powi(2) * (1.0 + tables as f64) + PER_PATCH * patches as f64
}

fn agreement(theirs: &[f64], ours: &[f64], slack: Slack<'_>) -> Confirmed {
    let pairs = || theirs.iter().zip(ours).filter(|(a, b)| **a != 0.0 || **b != 0.0);
    let entries = pairs().filter(|(a, b)| (**a - **b).abs() <= slack(**a)).count();
    let of = pairs().count();
    Confirmed { entries, by_borders: 0, of, rows: 1, whole_rows: usize::from(entries == of) }
}
