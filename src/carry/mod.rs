//! Values on anybody's mesh, carried onto the patches of a scene; and what their numbers mean.
//!
//! A patch takes the mean of the function that their faces carry over the part of it that radiates: exactly, by
//! clipping, where faces lie in its plane; by points that take the nearest face where they do not (curved surfaces
//! that two programs divide differently). What finds no face is told and never filled in.

mod cells;
mod facelets;
mod mean;
mod patch;
mod quantity;
mod told;

pub use quantity::{Quantity, Transfer, UnitsError, band_order, select_bands};

use crate::math::{DVec3, area, centroid, compensated_sum, diameter};
use crate::scene::{Patch, Stage};
use crate::solution::{MeshValues, Radiosity};
use facelets::Facelets;
use patch::{Distances, Taken, nearest, take};
use rayon::prelude::*;

/// Faces within this share of the scene's diagonal lie in the plane of a patch. It is far above coordinates that were
/// written with six digits, and far below what stands in front of a wall.
const PLANE_TOLERANCE: f64 = 1e-5;
/// A nearest face may be this share of the patch's diameter away, unless told otherwise: two divisions of one
/// cylinder are, up to six or more segments around it.
const REACH_OF_PATCH: f64 = 0.1;
/// But no more than this share of the scene's diagonal: large patches would reach for what is another surface.
const REACH_OF_SCENE: f64 = 0.01;
/// A patch has its value if no more than this share of its area is unmatched.
pub const MOST_UNMATCHED: f64 = 1e-3;
/// So many unmatched patches are told with the distance of the nearest face.
const WITH_DISTANCE: usize = 10;

/// How values are carried.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CarryOptions {
    /// How far the nearest face may be from a place that no face of its plane covers, metres; `None`: a tenth of the
    /// patch's diameter, but no more than a hundredth of the scene's diagonal.
    pub reach: Option<f64>,
}

/// Values of a mesh on the patches of a stage.
#[derive(Debug, Clone)]
pub struct Carried {
    /// Mean over the matched part of each patch, in the quantity of the file and with its bands; 0 for patches that
    /// take no part or matched nothing ([`Carried::matched`] tells which).
    pub values: Radiosity,
    /// Standard deviation of what stood on each patch, laid out like the values: what the mean hides.
    pub spread: Vec<f64>,
    /// Where each patch has its value from.
    pub shares: Vec<Shares>,
    /// Areas of the patches, m^2.
    areas: Vec<f64>,
    /// True if all faces were turned around: none matched as it is wound.
    pub turned: bool,
    /// Unmatched patches that faces would cover if they were wound the other way.
    pub would_match_turned: usize,
    /// Area that several faces cover, m^2; their values were averaged there.
    pub doubled: f64,
    /// Furthest distance from a patch to a nearest face that was used, metres.
    pub furthest: f64,
    /// Faces that no patch took anything of.
    pub idle: Vec<IdleFace>,
    /// Number of faces.
    pub faces: usize,
    /// Distance from the middle of the first unmatched patches to the nearest face that looks their way, metres.
    distances: Vec<Option<f64>>,
}

/// Where a patch has its value from: shares of its area that add up to 1 (all 0 for a patch that takes no part).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Covered by faces of its plane: exact.
    pub covered: f64,
    /// From the nearest face, by points.
    pub near: f64,
    /// From nothing.
    pub unmatched: f64,
}

/// A patch that has no value, or not on all of its area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unmatched {
    /// Number of the patch.
    pub patch: usize,
    /// Share of its area that matched nothing.
    pub share: f64,
    /// That area, m^2.
    pub area: f64,
    /// Distance from its middle to the nearest face that looks its way, metres; for the first ten, where there is
    /// one.
    pub nearest: Option<f64>,
}

/// A face that no patch took anything of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdleFace {
    /// Its place among the faces.
    pub face: usize,
    /// Its area, m^2.
    pub area: f64,
    /// Its middle, metres.
    pub middle: DVec3,
}

/// Carries the values of a mesh onto the patches of a stage. Faces are planar and convex; bent ones count as the
/// triangles from their first corner.
pub fn carry(values: &MeshValues, stage: &Stage, options: &CarryOptions) -> Carried {
    let diagonal = diagonal(stage);
    let distances = |p: &Patch| Distances {
        plane: PLANE_TOLERANCE * diagonal,
        reach: options.reach.unwrap_or_else(|| default_reach(p, diagonal)),
    };
    let take_all =
        |faces: &Facelets| -> Vec<Taken> { stage.patches.par_iter().map(|p| take(p, faces, distances(p))).collect() };
    let mut facelets = Facelets::new(values, false);
    let mut taken = take_all(&facelets);
    let mut turned = false;
    let mut would_match_turned = 0;
    if taken.iter().any(|t| t.unmatched > MOST_UNMATCHED) || taken.iter().all(|t| t.covered == 0.0) {
        let other = Facelets::new(values, true);
        let others = take_all(&other);
        if prefers(&others, &taken) {
            (facelets, taken, turned) = (other, others, true);
        } else {
            let pairs = taken.iter().zip(&others);
            would_match_turned = pairs.filter(|(own, o)| own.unmatched > MOST_UNMATCHED && o.covered > 0.5).count();
        }
    }
    let mut carried = gather(values, stage, &taken);
    (carried.turned, carried.would_match_turned) = (turned, would_match_turned);
    carried.distances = distances_of(&carried, stage, &facelets, 2.0 * diagonal);
    carried
}

/// True if the faces match turned around and not at all as they are wound.
fn prefers(turned: &[Taken], own: &[Taken]) -> bool {
    let covers = |all: &[Taken]| all.iter().any(|t| t.covered > 0.0);
    let matches = |all: &[Taken]| all.iter().any(|t| t.value.is_some());
    !covers(own) && (covers(turned) || (!matches(own) && matches(turned)))
}

fn diagonal(stage: &Stage) -> f64 {
    let (lo, hi) = stage.bounds();
    if lo.cmple(hi).all() { lo.distance(hi) } else { 0.0 }
}

fn default_reach(patch: &Patch, diagonal: f64) -> f64 {
    if patch.corners.is_empty() {
        return 0.0;
    }
    (REACH_OF_PATCH * diameter(&patch.corners)).min(REACH_OF_SCENE * diagonal)
}

/// Everything but what depends on the winding.
fn gather(values: &MeshValues, stage: &Stage, taken: &[Taken]) -> Carried {
    let bands = values.bands.len();
    let mut used = vec![false; values.len()];
    taken.iter().flat_map(|t| &t.faces).for_each(|f| used[*f] = true);
    let nothing = || (vec![0.0; bands], vec![0.0; bands]);
    let (means, spreads): (Vec<_>, Vec<_>) = taken.iter().map(|t| t.value.clone().unwrap_or_else(nothing)).unzip();
    let idle = |face: usize| {
        let corners = values.corners(face);
        IdleFace { face, area: area(corners), middle: centroid(corners) }
    };
    Carried {
        values: Radiosity { bands, values: means.concat(), std_err: None },
        spread: spreads.concat(),
        shares: taken.iter().map(|t| Shares { covered: t.covered, near: t.near, unmatched: t.unmatched }).collect(),
        areas: stage.areas(),
        turned: false,
        would_match_turned: 0,
        doubled: compensated_sum(taken.iter().map(|t| t.doubled)),
        furthest: taken.iter().map(|t| t.furthest).fold(0.0, f64::max),
        idle: (0..values.len()).filter(|f| !used[*f]).map(idle).collect(),
        faces: values.len(),
        distances: Vec::new(),
    }
}

fn distances_of(carried: &Carried, stage: &Stage, facelets: &Facelets, most: f64) -> Vec<Option<f64>> {
    let distance = |u: &Unmatched| {
        let patch = &stage.patches[u.patch];
        nearest(facelets, patch.region.centroid()?, patch.normal, most).map(|n| n.distance)
    };
    carried.unmatched().iter().take(WITH_DISTANCE).map(distance).collect()
}

impl Carried {
    /// True if a patch takes no part, or has its value on all of its area but a thousandth.
    pub fn matched(&self, patch: usize) -> bool {
        self.shares[patch].unmatched <= MOST_UNMATCHED
    }

    /// The patches that are unmatched in whole or in part, by number.
    pub fn unmatched(&self) -> Vec<Unmatched> {
        let patches = (0..self.shares.len()).filter(|i| !self.matched(*i));
        let of = |(k, patch): (usize, usize)| {
            let share = self.shares[patch].unmatched;
            let nearest = self.distances.get(k).copied().flatten();
            Unmatched { patch, share, area: share * self.areas[patch], nearest }
        };
        patches.enumerate().map(of).collect()
    }

    /// Shares of the area of the whole scene.
    pub fn of_scene(&self) -> Shares {
        let total = compensated_sum(self.areas.iter().copied());
        let share = |part: fn(&Shares) -> f64| {
            compensated_sum(self.shares.iter().zip(&self.areas).map(|(s, a)| part(s) * a)) / total
        };
        Shares { covered: share(|s| s.covered), near: share(|s| s.near), unmatched: share(|s| s.unmatched) }
    }

    /// How much values vary within patches: their spread against the values themselves, both as roots of mean squares
    /// by area over all bands. `None` where every value is 0.
    pub fn relative_spread(&self) -> Option<f64> {
        let bands = self.values.bands;
        let power = |values: &[f64]| {
            let patches = values.chunks(bands).zip(&self.areas);
            compensated_sum(patches.map(|(v, area)| area * v.iter().map(|x| x * x).sum::<f64>()))
        };
        let whole = power(&self.values.values);
        (whole > 0.0).then(|| (power(&self.spread) / whole).sqrt())
    }
}
