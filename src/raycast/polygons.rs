//! Double-precision intersection of rays with planar convex polygons.

use super::coplanar::plane_groups;
use crate::math::{DVec3, unit_normal};
use crate::scene::{Facet, NO_FACET, Stage};

/// Facets as half-spaces: one plane and its edges each, ready for intersection.
///
/// Coordinates are taken from the scene's centre. A facet whose corners do not lie in one plane to rounding
/// (scene files may be off by a millionth) is cut into a fan of triangles, so that it meets its neighbours
/// corner to corner and the scene stays closed.
pub(super) struct Polygons {
    /// The plane of a polygon, then its edges, polygon by polygon.
    rows: Vec<Row>,
    /// What each polygon is.
    polygons: Vec<Polygon>,
    /// Plane group of each facet.
    groups: Vec<u32>,
    /// Normal of each facet's front.
    normals: Vec<DVec3>,
    /// The polygon that is each facet, [`SEVERAL`] where it was cut up.
    sole: Vec<u32>,
    centre: DVec3,
    diagonal: f64,
    rim: f64,
}

/// (a, b, c, d) with unit (a, b, c): `a x + b y + c z + d` is the distance before a plane, or inside an edge.
pub(super) type Row = [f64; 4];

#[derive(Clone, Copy)]
struct Polygon {
    first_row: u32,
    edges: u32,
    facet: u32,
    group: u32,
}

/// A ray, taken from the scene's centre.
#[derive(Clone, Copy)]
pub(super) struct Ray {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// Plane group that is not seen.
    pub(super) own: u32,
}

/// The nearest hit so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub(super) distance: f64,
    pub(super) facet: u32,
    front: bool,
}

impl Nearest {
    pub(super) const NONE: Self = Self { distance: f64::INFINITY, facet: NO_FACET, front: false };

    /// Takes a hit if it is nearer, or as near within `slack` and preferred: a front beats a back, then the
    /// lower facet number.
    fn offer(&mut self, other: Self, slack: f64) -> bool {
        let preferred = (other.front, !other.facet) > (self.front, !self.facet);
        let take = other.distance < self.distance - slack || (other.distance <= self.distance + slack && preferred);
        if take {
            *self = other;
        }
        take
    }
}

/// No group: what a camera stands on.
const NO_GROUP: u32 = u32::MAX;

/// No single polygon: the facet was cut up.
const SEVERAL: u32 = u32::MAX;

/// Rounding of a coordinate, as a fraction of the scene's diagonal: polygons reach this far beyond their
/// edges, so that neighbours overlap instead of leaving a crack, and an origin this close to a plane is on it.
const RIM: f64 = 1e-12;

impl Polygons {
    /// The polygons of a stage, and a box (low, high) around each in units of the diagonal.
    pub(super) fn new(stage: &Stage) -> (Self, Vec<(DVec3, DVec3)>) {
        let (lo, hi) = stage.bounds();
        let nothing = stage.facets.is_empty();
        let (centre, diagonal) = if nothing { (DVec3::ZERO, 1.0) } else { ((lo + hi) * 0.5, (hi - lo).length()) };
        let farthest = if nothing { 1.0 } else { lo.abs().max(hi.abs()).max_element() };
        let mut all = Self {
            rows: Vec::new(),
            polygons: Vec::with_capacity(stage.facets.len()),
            groups: plane_groups(stage),
            normals: stage.facets.iter().map(|f| f.normal).collect(),
            sole: Vec::new(),
            centre,
            diagonal,
            rim: RIM * diagonal + 8.0 * f64::EPSILON * farthest,
        };
        let mut boxes = Vec::with_capacity(stage.facets.len());
        stage.facets.iter().zip(0..).for_each(|(f, number)| all.push_facet(f, number, &mut boxes));
        (all, boxes)
    }

    fn push_facet(&mut self, facet: &Facet, number: u32, boxes: &mut Vec<(DVec3, DVec3)>) {
        let v: Vec<DVec3> = facet.vertices.iter().map(|v| *v - self.centre).collect();
        let n = unit_normal(&v);
        let mean = v.iter().sum::<DVec3>() / v.len() as f64;
        if v.iter().all(|p| (*p - mean).dot(n).abs() <= self.rim) {
            self.push(&v, number, boxes);
        } else {
            (1..v.len() - 1).for_each(|k| self.push(&[v[0], v[k], v[k + 1]], number, boxes));
        }
    }

    fn push(&mut self, loop_: &[DVec3], facet: u32, boxes: &mut Vec<(DVec3, DVec3)>) {
        let n = unit_normal(loop_);
        if n == DVec3::ZERO {
            return;
        }
        let first_row = self.rows.len() as u32;
        let mean = loop_.iter().sum::<DVec3>() / loop_.len() as f64;
        self.rows.push(row(n, mean));
        for (k, a) in loop_.iter().enumerate() {
            let inward = n.cross(loop_[(k + 1) % loop_.len()] - *a).normalize_or_zero();
            if inward != DVec3::ZERO {
                self.rows.push(row(inward, *a));
            }
        }
        let edges = self.rows.len() as u32 - first_row - 1;
        self.polygons.push(Polygon { first_row, edges, facet, group: self.groups[facet as usize] });
        let scaled = loop_.iter().map(|v| *v / self.diagonal);
        boxes.push(scaled.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v))));
    }

    /// Puts the polygons, and what is stored of them, into a new order.
    pub(super) fn reorder(&mut self, order: &[u32]) {
        let mut rows = Vec::with_capacity(self.rows.len());
        let mut polygons = Vec::with_capacity(order.len());
        for &old in order {
            let p = self.polygons[old as usize];
            let first_row = rows.len() as u32;
            rows.extend_from_slice(&self.rows[p.first_row as usize..][..p.edges as usize + 1]);
            polygons.push(Polygon { first_row, ..p });
        }
        (self.rows, self.polygons) = (rows, polygons);
        self.sole = vec![SEVERAL; self.groups.len()];
        let mut pieces = vec![0; self.groups.len()];
        for (p, number) in self.polygons.iter().zip(0..) {
            pieces[p.facet as usize] += 1;
            self.sole[p.facet as usize] = if pieces[p.facet as usize] == 1 { number } else { SEVERAL };
        }
    }

    pub(super) fn len(&self) -> usize {
        self.polygons.len()
    }

    pub(super) fn centre(&self) -> DVec3 {
        self.centre
    }

    pub(super) fn diagonal(&self) -> f64 {
        self.diagonal
    }

    pub(super) fn facet_of(&self, polygon: u32) -> u32 {
        self.polygons[polygon as usize].facet
    }

    pub(super) fn group_of(&self, polygon: u32) -> u32 {
        self.polygons[polygon as usize].group
    }

    /// Normal of a facet's front; zero for a camera.
    pub(super) fn normal_of(&self, facet: u32) -> DVec3 {
        if facet == NO_FACET { DVec3::ZERO } else { self.normals[facet as usize] }
    }

    /// The plane of a polygon.
    pub(super) fn plane(&self, polygon: u32) -> Row {
        self.rows_of(polygon)[0]
    }

    /// The edges of a facet; none if it is not one polygon.
    pub(super) fn outline(&self, facet: u32) -> &[Row] {
        let sole = self.sole[facet as usize];
        if sole == SEVERAL { &[] } else { &self.rows_of(sole)[1..] }
    }

    /// True if a point (from the centre) is inside a polygon's edges, or at most `margin` outside.
    pub(super) fn is_over(&self, polygon: u32, point: DVec3, margin: f64) -> bool {
        self.rows_of(polygon)[1..].iter().all(|edge| distance(edge, point) >= -margin)
    }

    /// Least and greatest distance of corners (in the scene's own coordinates) from the plane of a row.
    pub(super) fn span(&self, row: &Row, corners: &[DVec3]) -> (f64, f64) {
        let distances = corners.iter().map(|c| distance(row, *c - self.centre));
        distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), d| (lo.min(d), hi.max(d)))
    }

    /// True if corners lie on or beyond an edge, to within what no coordinate means.
    pub(super) fn is_beyond(&self, edge: &Row, corners: &[DVec3]) -> bool {
        self.span(edge, corners).1 <= 1e3 * self.rim
    }

    #[inline]
    fn rows_of(&self, polygon: u32) -> &[Row] {
        let p = self.polygons[polygon as usize];
        &self.rows[p.first_row as usize..][..p.edges as usize + 1]
    }

    /// The group that rays from a facet do not see.
    pub(super) fn own_group(&self, from: u32) -> u32 {
        if from == NO_FACET { NO_GROUP } else { self.groups[from as usize] }
    }

    /// Tests one polygon; true if it is the nearest now.
    #[inline]
    pub(super) fn test(&self, polygon: usize, ray: &Ray, nearest: &mut Nearest) -> bool {
        let p = self.polygons[polygon];
        if p.group == ray.own {
            return false;
        }
        let rows = &self.rows[p.first_row as usize..][..p.edges as usize + 1];
        let approach = along(&rows[0], ray.direction);
        let before = distance(&rows[0], ray.origin);
        // An origin in the plane itself, to rounding: meeting it is a matter of direction, and only its front
        // can be met. Otherwise a wall would be hit from behind by rays that start at its foot.
        let on_it = before.abs() <= self.rim;
        let t = -before / approach;
        let (reached, t) = if on_it { (approach < 0.0, t.max(0.0)) } else { (t >= 0.0 && approach != 0.0, t) };
        let slack = self.rim * (1.0 + 1e-3 / approach.abs().max(1e-6));
        if !reached || t > nearest.distance + slack {
            return false;
        }
        let at = ray.origin + ray.direction * t;
        let inside = rows[1..].iter().all(|edge| distance(edge, at) >= -slack);
        inside && nearest.offer(Nearest { distance: t, facet: p.facet, front: approach < 0.0 }, slack)
    }
}

/// The row of the plane through `p` with unit normal `n`.
fn row(n: DVec3, p: DVec3) -> Row {
    [n.x, n.y, n.z, -n.dot(p)]
}

#[inline]
fn along(row: &Row, direction: DVec3) -> f64 {
    row[0] * direction.x + row[1] * direction.y + row[2] * direction.z
}

#[inline]
pub(super) fn distance(row: &Row, point: DVec3) -> f64 {
    row[0] * point.x + row[1] * point.y + row[2] * point.z + row[3]
}
