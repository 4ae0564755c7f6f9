//! What the pixels of a hemi-cube show, summed with any table and held against a row of somebody's.

use super::tables::Table;
use crate::math::{DVec3, Frame};
use crate::methods::hemicube::{Delta, DeltaTable, Face, Hemicube, Item, Params, World, stand};
use crate::scene::{Patch, Stage};
use crate::solution::FormFactors;
use serde::Serialize;

/// Where a hemi-cube's x axis points about the normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Along the first edge of the patch.
    FirstEdge,
    /// Along the second edge.
    SecondEdge,
    /// World x laid on the patch, or y where the normal is x.
    WorldX,
    /// World y laid on the patch, or z where the normal is y.
    WorldY,
    /// World z laid on the patch, or x where the normal is z.
    WorldZ,
    /// The world axis least along the normal, laid on the patch.
    LeastWorld,
    /// The frame of Frisvad 2012, as mended by Duff and others in 2017.
    Frisvad,
}

/// How the hemi-cubes of a matrix are turned about their normals; quarter turns are alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Axes {
    /// The x axis.
    pub axis: Axis,
    /// Turned by a further 45 degrees.
    pub diagonal: bool,
}

impl Axes {
    /// All that are tried.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let axes = [
            Axis::FirstEdge,
            Axis::LeastWorld,
            Axis::WorldZ,
            Axis::WorldY,
            Axis::WorldX,
            Axis::SecondEdge,
            Axis::Frisvad,
        ];
        [false, true].into_iter().flat_map(move |diagonal| axes.into_iter().map(move |axis| Self { axis, diagonal }))
    }

    fn frame(self, patch: &Patch) -> Frame {
        let (n, c) = (patch.normal, &patch.corners);
        let world = |k: usize| {
            let axis = DVec3::AXES[k % 3];
            if n.dot(axis).abs() > 1.0 - 1e-6 { DVec3::AXES[(k + 1) % 3] } else { axis }
        };
        let along = match self.axis {
            Axis::FirstEdge => c[1] - c[0],
            Axis::SecondEdge => c[2] - c[1],
            Axis::WorldX => world(0),
            Axis::WorldY => world(1),
            Axis::WorldZ => world(2),
            Axis::LeastWorld => least(n),
            Axis::Frisvad => frisvad(n),
        };
        let frame = Frame::with_x_axis(n, along);
        if self.diagonal { frame.turned(std::f64::consts::FRAC_PI_4) } else { frame }
    }

    /// Axes that turn the hemi-cube of a patch differently, the first of each kind.
    pub(super) fn different(patch: &Patch) -> Vec<Self> {
        let mut kept: Vec<(Self, Frame)> = Vec::new();
        for axes in Self::all() {
            let frame = axes.frame(patch);
            let alike = |other: &Frame| {
                let cos = frame.x.dot(other.x).abs();
                cos.max(frame.x.dot(other.y).abs()) > 1.0 - 1e-9
            };
            if !kept.iter().any(|(_, other)| alike(other)) {
                kept.push((axes, frame));
            }
        }
        kept.into_iter().map(|(axes, _)| axes).collect()
    }
}

/// The world axis with the smallest component of a direction, the first of equals.
fn least(n: DVec3) -> DVec3 {
    let a = n.abs();
    // A hair of slack: components equal but for rounding are equal.
    if a.x <= a.y + 1e-9 && a.x <= a.z + 1e-9 {
        DVec3::X
    } else if a.y <= a.z + 1e-9 {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

fn frisvad(n: DVec3) -> DVec3 {
    let sign = 1_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x)
}

/// Entries of a matrix that our pixels reproduce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Confirmed {
    /// Reproduced within the digits given.
    pub entries: usize,
    /// Entries compared: not zero in theirs or in ours.
    pub of: usize,
    /// Rows compared.
    pub rows: usize,
    /// Rows reproduced in every entry.
    pub whole_rows: usize,
}

impl Confirmed {
    /// Share of the entries.
    pub fn share(&self) -> f64 {
        if self.of == 0 { 0.0 } else { self.entries as f64 / self.of as f64 }
    }

    /// True where most entries of several are reproduced: no accident.
    pub(super) fn holds(&self) -> bool {
        self.entries >= 6 && self.share() >= 0.5
    }

    fn add(&mut self, other: Self) {
        self.entries += other.entries;
        self.of += other.of;
        self.rows += other.rows;
        self.whole_rows += other.whole_rows;
    }
}

/// Takes pictures at one resolution.
#[derive(Debug)]
pub(super) struct Camera<'a> {
    stage: &'a Stage,
    world: &'a World,
    table: DeltaTable,
}

impl<'a> Camera<'a> {
    pub fn new(stage: &'a Stage, world: &'a World, n: u32) -> Self {
        Self { stage, world, table: DeltaTable::new(n, Delta::Midpoint) }
    }

    /// Items of the five faces of the hemi-cube on a patch.
    fn picture(&self, patch: usize, axes: Axes) -> Option<[Vec<Item>; 5]> {
        let patch = &self.stage.patches[patch];
        let (eye, _) = stand(patch, &Params::default())?;
        let mut cube = Hemicube::new(self.world, &self.table);
        cube.aim(eye, &axes.frame(patch));
        Some(Face::ALL.map(|face| {
            cube.project(face);
            cube.scan(face);
            cube.items().to_vec()
        }))
    }

    /// Compares rows with every table; one result per table.
    pub fn compare(
        &self,
        f: &FormFactors,
        rows: &[usize],
        axes: Axes,
        tables: &[&Table],
        slack: &dyn Fn(f64) -> f64,
    ) -> Vec<Confirmed> {
        let mut found = vec![Confirmed::default(); tables.len()];
        for i in rows {
            let Some(picture) = self.picture(*i, axes) else { continue };
            for (table, found) in tables.iter().zip(&mut found) {
                found.add(agreement(f, *i, &summed(&picture, table, f.n), slack));
            }
        }
        found
    }
}

/// A row: the deltas of a table over the items of a picture.
fn summed(picture: &[Vec<Item>; 5], table: &Table, patches: usize) -> Vec<f64> {
    let mut row = vec![0.0; patches];
    for (face, items) in Face::ALL.into_iter().zip(picture) {
        for (item, delta) in items.iter().zip(table.face(face).into_iter().flatten()) {
            if let Some(j) = item.as_patch() {
                row[j as usize] += delta;
            }
        }
    }
    row
}

fn agreement(f: &FormFactors, i: usize, ours: &[f64], slack: &dyn Fn(f64) -> f64) -> Confirmed {
    let mut theirs = vec![0.0; f.n];
    f.row(i).for_each(|(j, v)| theirs[j] = v);
    let pairs = || theirs.iter().zip(ours).filter(|(a, b)| **a != 0.0 || **b != 0.0);
    let entries = pairs().filter(|(a, b)| (**a - **b).abs() <= slack(**a)).count();
    let of = pairs().count();
    Confirmed { entries, of, rows: 1, whole_rows: usize::from(entries == of) }
}
