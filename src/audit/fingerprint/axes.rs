//! How people turn their hemi-cubes.

use crate::math::{DVec3, Frame};
use crate::scene::Patch;
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

    pub(super) fn frame(self, patch: &Patch) -> Frame {
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

    /// For each of [`Axes::all`] the number of the first that turns the hemi-cube of a patch alike.
    pub(super) fn classes(patch: &Patch) -> Vec<usize> {
        let frames: Vec<Frame> = Self::all().map(|axes| axes.frame(patch)).collect();
        let alike = |a: &Frame, b: &Frame| a.x.dot(b.x).abs().max(a.x.dot(b.y).abs()) > 1.0 - 1e-9;
        let first = |k: usize| frames[..k].iter().position(|f| alike(&frames[k], f)).unwrap_or(k);
        (0..frames.len()).map(first).collect()
    }

    /// Axes that turn the hemi-cube of a patch differently, the first of each kind.
    pub(super) fn different(patch: &Patch) -> Vec<Self> {
        let classes = Self::classes(patch);
        Self::all().enumerate().filter(|(k, _)| classes[*k] == *k).map(|(_, axes)| axes).collect()
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
