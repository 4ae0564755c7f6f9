//! The value of one patch: faces of its plane exactly, the nearest faces for the rest.

use super::cells::{Cell, Flat, divide};
use super::facelets::Facelets;
use super::mean::Mean;
use crate::math::{Bounds, DVec3, area, compensated_sum, diameter, intersect_convex};
use crate::sampling::{PointMap, sobol};
use crate::scene::Patch;

/// Least cosine between normals of one plane: 2.6 degrees, as much as single precision turns a small face; what
/// really leans is told by its distance.
const COPLANAR_COSINE: f64 = 0.999;
/// Least cosine between a patch and a near face: 60 degrees. Neighbours on a curved surface differ by less, and the
/// other wall of a corner, at 90 degrees, stays out.
const NEAR_COSINE: f64 = 0.5;
/// Points on the part of a patch that no face of its plane covers.
const POINTS: u64 = 64;
/// Gaps between faces that are narrower than the tolerance are seams, unless they add up to more than this share of
/// the patch.
const SEAMS: f64 = 0.01;

/// What one patch takes from the faces.
#[derive(Debug, Clone)]
pub(super) struct Taken {
    /// Mean per band, and standard deviation within the patch; `None` if nothing was found.
    pub value: Option<(Vec<f64>, Vec<f64>)>,
    /// Share of the area that faces of the plane cover.
    pub covered: f64,
    /// Share that took the value of the nearest face.
    pub near: f64,
    /// Share that took nothing.
    pub unmatched: f64,
    /// Area that several faces cover, m^2.
    pub doubled: f64,
    /// Furthest distance to a nearest face that was used, metres.
    pub furthest: f64,
    /// Faces used, by number, some of them more than once.
    pub faces: Vec<usize>,
}

impl Taken {
    fn nothing(unmatched: f64) -> Self {
        Self { value: None, covered: 0.0, near: 0.0, unmatched, doubled: 0.0, furthest: 0.0, faces: Vec::new() }
    }
}

/// Within which distances faces belong to a patch, metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distances {
    /// In one plane.
    pub plane: f64,
    /// Nearest surface.
    pub reach: f64,
}

/// Takes the value of a patch from the faces.
pub(super) fn take(patch: &Patch, facelets: &Facelets, distances: Distances) -> Taken {
    if !patch.is_present() {
        return Taken::nothing(0.0);
    }
    let whole = patch.region.area();
    let flats = coplanar(patch, facelets, distances.plane);
    let pieces = patch.region.pieces.iter();
    let cells: Vec<Cell> = pieces.flat_map(|p| divide(p.clone(), &flats, 1e-12 * whole)).collect();
    let (covered, bare): (Vec<Cell>, Vec<Cell>) = cells.into_iter().partition(|c| !c.facelets.is_empty());
    let bare = without_seams(bare, whole, distances.plane);
    let bare_share = (compensated_sum(bare.iter().map(|p| area(p))) / whole).min(1.0);

    let mut mean = Mean::new(facelets.bands());
    covered.iter().for_each(|c| integrate(c, facelets, &mut mean));
    let mut taken = Taken::nothing(0.0);
    taken.faces = covered.iter().flat_map(|c| &c.facelets).map(|k| facelets.get(*k).face).collect();
    taken.doubled = doubled(&covered, distances.plane);
    taken.covered = if covered.is_empty() { 0.0 } else { 1.0 - bare_share };
    if let Some(points) = PointMap::new(&bare) {
        let weight = bare_share * whole / POINTS as f64;
        let hits = from_nearest(patch, facelets, &points, weight, distances.reach, &mut mean, &mut taken);
        taken.near = bare_share * hits as f64 / POINTS as f64;
    }
    taken.unmatched = (1.0 - taken.covered - taken.near).max(0.0);
    if taken.unmatched < 1e-9 {
        taken.unmatched = 0.0;
    }
    taken.value = mean.result();
    taken
}

/// Faces of the plane of a patch, laid into it.
fn coplanar(patch: &Patch, facelets: &Facelets, tolerance: f64) -> Vec<Flat> {
    let origin = patch.corners[0];
    let mut near = Vec::new();
    facelets.near(&Bounds::of(&patch.corners).grown(tolerance), |k| {
        if facelets.get(k).normal.dot(patch.normal) > COPLANAR_COSINE {
            near.push(k);
        }
    });
    near.sort_unstable();
    let lay = |p: &DVec3| *p - patch.normal * patch.normal.dot(*p - origin);
    let flat = |k: u32| {
        let face = facelets.get(k);
        let laid: Vec<DVec3> = face.corners.iter().map(lay).collect();
        let common = intersect_convex(&laid, &patch.corners);
        let away = |p: &DVec3| (*p - face.corners[0]).dot(face.normal).abs() > tolerance;
        let apart = common.len() < 3 || common.iter().any(away);
        // The face itself and not what is common: edges that clipping left have a length, but no direction.
        (!apart).then(|| Flat { facelet: k, bounds: Bounds::of(&common).grown(tolerance), polygon: laid })
    };
    near.into_iter().filter_map(flat).collect()
}

/// The parts that nothing covers, without the seams between faces.
fn without_seams(bare: Vec<Cell>, whole: f64, tolerance: f64) -> Vec<Vec<DVec3>> {
    let (seams, open): (Vec<_>, Vec<_>) = bare.into_iter().map(|c| c.polygon).partition(|p| is_sliver(p, tolerance));
    let narrow: f64 = seams.iter().map(|p| area(p)).sum();
    if narrow > SEAMS * whole { open.into_iter().chain(seams).collect() } else { open }
}

fn is_sliver(polygon: &[DVec3], tolerance: f64) -> bool {
    area(polygon) <= 2.0 * tolerance * diameter(polygon)
}

/// Area that several faces cover, seams left out.
fn doubled(covered: &[Cell], tolerance: f64) -> f64 {
    let several = covered.iter().filter(|c| c.facelets.len() > 1 && !is_sliver(&c.polygon, tolerance));
    compensated_sum(several.map(|c| area(&c.polygon)))
}

/// Adds the mean function of the faces of a cell: linear on it, so exact from the corners of its triangles.
fn integrate(cell: &Cell, facelets: &Facelets, mean: &mut Mean) {
    let weight = 1.0 / cell.facelets.len() as f64;
    let at = |p: &DVec3| {
        let mut values = vec![0.0; facelets.bands()];
        cell.facelets.iter().for_each(|k| facelets.add_value(*k, *p, weight, &mut values));
        values
    };
    let values: Vec<Vec<f64>> = cell.polygon.iter().map(at).collect();
    for i in 1..cell.polygon.len() - 1 {
        let size = area(&[cell.polygon[0], cell.polygon[i], cell.polygon[i + 1]]);
        mean.add_triangle(size, [&values[0], &values[i], &values[i + 1]]);
    }
}

/// Adds the values of the nearest faces at points of a net; returns how many of the points found one.
fn from_nearest(
    patch: &Patch,
    facelets: &Facelets,
    points: &PointMap,
    weight: f64,
    reach: f64,
    mean: &mut Mean,
    taken: &mut Taken,
) -> usize {
    // Points of the net in the middle of their strata.
    let coordinate = |k, dimension| sobol(k, dimension) as f64 / 2f64.powi(64) + 0.5 / POINTS as f64;
    let mut hits = 0;
    for k in 0..POINTS {
        let point = points.at(coordinate(k, 0), coordinate(k, 1));
        let Some(near) = nearest(facelets, point, patch.normal, reach) else { continue };
        let mut values = vec![0.0; facelets.bands()];
        facelets.add_value(near.facelet, near.point, 1.0, &mut values);
        mean.add_point(weight, &values);
        taken.furthest = taken.furthest.max(near.distance);
        taken.faces.push(facelets.get(near.facelet).face);
        hits += 1;
    }
    hits
}

/// A place on a face near to a point.
pub(super) struct Near {
    facelet: u32,
    point: DVec3,
    /// Metres.
    pub distance: f64,
}

/// The nearest place within reach on a face that looks the same way, up to 60 degrees; of equals that of the lower
/// number.
pub(super) fn nearest(facelets: &Facelets, point: DVec3, normal: DVec3, reach: f64) -> Option<Near> {
    // Small boxes first: most of what lies within reach is not the nearest.
    let mut radius = reach / 64.0;
    loop {
        let mut best: Option<Near> = None;
        facelets.near(&Bounds::of(&[point]).grown(radius), |k| {
            let face = facelets.get(k);
            if face.normal.dot(normal) < NEAR_COSINE {
                return;
            }
            let place = face.nearest_point(point);
            let distance = place.distance(point);
            let better = |b: &Near| distance < b.distance || (distance == b.distance && k < b.facelet);
            if distance <= radius && best.as_ref().is_none_or(better) {
                best = Some(Near { facelet: k, point: place, distance });
            }
        });
        if best.is_some() || radius >= reach {
            return best;
        }
        radius = (4.0 * radius).min(reach);
    }
}
