//! Coincident facets: contact, thin plates, and overlaps that face the same way.
//!
//! Two coincident facets that face opposite ways are locally the same thing whether they are the two sides of
//! a thin plate or a box standing on a floor. What tells them apart is what lies in front: a box's floor has
//! the inside of the box before it. A fan of directions decides: where more than half of what it meets first
//! are backs of one-sided facets, the place is inside a solid, and the pair is a contact.

use super::{Facet, Region};
use crate::math::{Bounds, BoxTree, DVec3, Frame, area, centroid, diameter, intersect_convex, subtract_convex};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Planes closer than this share of the scene's diagonal are one plane, and overlaps narrower than it are
/// touching edges. It is far above the rounding of coordinates written in single precision and far below
/// any plate a thickness would be modelled for.
pub const COINCIDENCE_TOLERANCE: f64 = 1e-7;

/// Directions of the fan that looks for the inside of solids.
const FAN: u32 = 24;
/// Least cosine of the fan's directions to the normal: grazing rays run along the plane itself.
const FAN_MIN_COSINE: f64 = 0.15;

/// How two coincident facets lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Relation {
    /// Facing the same way.
    SameFacing,
    /// Facing away from each other: a thin plate.
    BackToBack,
    /// Facing each other with nothing between.
    Contact,
}

/// The common part of two coincident facets.
#[derive(Debug)]
pub(super) struct Overlap {
    /// The facet that comes first.
    pub first: u32,
    /// The other.
    pub second: u32,
    /// Their common part, convex.
    pub polygon: Vec<DVec3>,
    pub relation: Relation,
}

impl Overlap {
    /// True if the same place radiates twice to one side.
    pub(super) fn radiates_twice(&self, facets: &[Facet]) -> bool {
        let two_sided = |i: u32| facets[i as usize].first_back_patch.is_some();
        match self.relation {
            Relation::SameFacing => true,
            Relation::BackToBack => two_sided(self.first) || two_sided(self.second),
            Relation::Contact => false,
        }
    }
}

/// What the search needs to know of all facets.
struct Survey<'a> {
    facets: &'a [Facet],
    /// Object number of each surface.
    objects: &'a [u32],
    tree: BoxTree,
    tolerance: f64,
    /// Largest distance of a corner from the facet's own mean plane.
    flatness: Vec<f64>,
    /// Directions of the fan, z along the normal.
    fan: Vec<DVec3>,
}

/// All pairs of coincident facets, in order of their numbers.
pub(super) fn coincidences(facets: &[Facet], objects: &[u32]) -> Vec<Overlap> {
    let tolerance = tolerance(facets);
    let survey = Survey {
        facets,
        objects,
        tree: BoxTree::new(facets.iter().map(|f| Bounds::of(&f.vertices).grown(tolerance)).collect()),
        tolerance,
        flatness: facets.iter().map(flatness).collect(),
        fan: (0..FAN).map(fan_direction).collect(),
    };
    let pairs: Vec<Vec<Overlap>> = (0..facets.len() as u32).into_par_iter().map(|i| survey.overlaps_of(i)).collect();
    pairs.into_iter().flatten().collect()
}

/// Distance within which planes are one, metres.
fn tolerance(facets: &[Facet]) -> f64 {
    let all = facets.iter().map(|f| Bounds::of(&f.vertices)).reduce(Bounds::joined);
    all.map_or(0.0, |b| COINCIDENCE_TOLERANCE * b.lo.distance(b.hi))
}

fn flatness(facet: &Facet) -> f64 {
    let middle = facet.vertices.iter().sum::<DVec3>() / facet.vertices.len() as f64;
    facet.vertices.iter().map(|v| (*v - middle).dot(facet.normal).abs()).fold(0.0, f64::max)
}

impl Survey<'_> {
    /// Coincidences of facet `i` with later ones.
    fn overlaps_of(&self, i: u32) -> Vec<Overlap> {
        let mut later = Vec::new();
        let bounds = Bounds::of(&self.facets[i as usize].vertices).grown(self.tolerance);
        self.tree.near(&bounds, |j| {
            if j > i && self.may_coincide(i, j) {
                later.push(j);
            }
        });
        later.sort_unstable();
        later.into_iter().filter_map(|j| self.overlap(i, j)).collect()
    }

    /// Cheap test before any clipping: parallel, and more than an edge in common.
    fn may_coincide(&self, i: u32, j: u32) -> bool {
        let (a, b) = (&self.facets[i as usize], &self.facets[j as usize]);
        let parallel = a.normal.dot(b.normal).abs() > 0.999;
        // The boxes are larger by the tolerance on each side; an overlap is broader than it in some direction.
        parallel && self.tree.bounds(i).common_breadth(self.tree.bounds(j)) > 2.6 * self.tolerance
    }

    fn overlap(&self, i: u32, j: u32) -> Option<Overlap> {
        let (a, b) = (&self.facets[i as usize], &self.facets[j as usize]);
        if apart(a, b, self.tolerance) || apart(b, a, self.tolerance) {
            return None;
        }
        let polygon = intersect_convex(&b.vertices, &a.vertices);
        if polygon.len() < 3 || area(&polygon) <= self.tolerance * diameter(&polygon) {
            return None;
        }
        let slack = self.tolerance + self.flatness[i as usize] + self.flatness[j as usize];
        let origin = a.vertices[0];
        if polygon.iter().any(|p| (*p - origin).dot(a.normal).abs() > slack) {
            return None;
        }
        let relation = if a.normal.dot(b.normal) > 0.0 {
            Relation::SameFacing
        } else if self.solid_before(i, j, &polygon) || self.solid_before(j, i, &polygon) {
            Relation::Contact
        } else {
            Relation::BackToBack
        };
        Some(Overlap { first: i, second: j, polygon, relation })
    }

    /// True if the inside of a solid lies before facet `i`, where `j` coincides with it.
    fn solid_before(&self, i: u32, j: u32, place: &[DVec3]) -> bool {
        let normal = self.facets[i as usize].normal;
        // Not along an edge of the overlap: clipping leaves edges of no length.
        let frame = Frame::with_x_axis(normal, normal.any_orthonormal_vector());
        let origin = centroid(place);
        // Backs count up, all else down.
        let mut lead: i32 = 0;
        for (left, direction) in (0..FAN).rev().zip(&self.fan) {
            match self.first_met(origin, frame.to_world(*direction), normal, self.object(j)) {
                Some(true) => lead += 1,
                Some(false) => lead -= 1,
                None => {}
            }
            if lead.unsigned_abs() > left {
                break;
            }
        }
        lead > 0
    }

    fn object(&self, facet: u32) -> u32 {
        self.objects[self.facets[facet as usize].surface as usize]
    }

    /// Whether a ray meets a back first. A back and a front met together say nothing unless the back alone
    /// belongs to `object`, whose inside is looked for.
    fn first_met(&self, origin: DVec3, direction: DVec3, normal: DVec3, object: u32) -> Option<bool> {
        let mut nearest = [f64::INFINITY; 2];
        let mut own = [false; 2];
        let least = 2.0 * self.tolerance / direction.dot(normal);
        self.tree.along(origin, direction, |i| {
            if let Some((t, back)) =
                meet(&self.facets[i as usize], origin, direction, self.tolerance).filter(|(t, _)| *t > least)
            {
                let side = usize::from(back);
                if t < nearest[side] {
                    (nearest[side], own[side]) = (t, self.object(i) == object);
                }
            }
            nearest[0].min(nearest[1]) + 8.0 * self.tolerance
        });
        let [front, back] = nearest;
        match (front - back).abs() <= 4.0 * self.tolerance {
            true => (own[1] && !own[0]).then_some(true),
            false => Some(back < front),
        }
    }
}

/// True if an edge of `a` leaves all of `b` outside, or no further inside than the tolerance: what the two have in
/// common is then a strip too narrow to count. Most neighbours are told apart here, before anything is clipped.
fn apart(a: &Facet, b: &Facet, tolerance: f64) -> bool {
    let k = a.vertices.len();
    (0..k).any(|i| {
        let inward = a.normal.cross(a.vertices[(i + 1) % k] - a.vertices[i]).normalize_or_zero();
        inward != DVec3::ZERO && b.vertices.iter().all(|p| inward.dot(*p - a.vertices[i]) <= tolerance)
    })
}

/// Direction k of a spiral over the hemisphere without its rim.
fn fan_direction(k: u32) -> DVec3 {
    let z = FAN_MIN_COSINE + (1.0 - FAN_MIN_COSINE) * (f64::from(k) + 0.5) / f64::from(FAN);
    let turn = f64::from(k) * PI * (3.0 - 5f64.sqrt());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * turn.cos(), r * turn.sin(), z)
}

/// Distance at which a ray meets a facet, and whether it meets its dark side. A little generous at the edges,
/// so that no ray slips through between neighbours.
fn meet(facet: &Facet, origin: DVec3, direction: DVec3, tolerance: f64) -> Option<(f64, bool)> {
    let speed = direction.dot(facet.normal);
    if speed.abs() < 1e-9 {
        return None;
    }
    let t = (facet.vertices[0] - origin).dot(facet.normal) / speed;
    let p = origin + direction * t;
    let corners = &facet.vertices;
    let inside = (0..corners.len()).all(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        facet.normal.cross(b - a).dot(p - a) >= -tolerance * a.distance(b)
    });
    inside.then_some((t, speed > 0.0 && facet.first_back_patch.is_none()))
}

/// What covers each side of each facet.
pub(super) struct Covers {
    /// Per facet: polygons on the front, on the back.
    sides: Vec<[Vec<Vec<DVec3>>; 2]>,
    tolerance: f64,
}

impl Covers {
    pub(super) fn of(facets: &[Facet], overlaps: &[Overlap]) -> Self {
        let mut covers = Self { sides: vec![[Vec::new(), Vec::new()]; facets.len()], tolerance: tolerance(facets) };
        overlaps.iter().for_each(|o| covers.add(facets, o));
        covers
    }

    fn add(&mut self, facets: &[Facet], o: &Overlap) {
        const FRONT: usize = 0;
        const BACK: usize = 1;
        let two_sided = |i: u32| facets[i as usize].first_back_patch.is_some();
        let mut cover = |facet: u32, side: usize| self.sides[facet as usize][side].push(o.polygon.clone());
        match o.relation {
            Relation::Contact => {
                cover(o.first, FRONT);
                cover(o.second, FRONT);
            }
            Relation::SameFacing => {
                cover(o.second, FRONT);
                if two_sided(o.first) && two_sided(o.second) {
                    cover(o.second, BACK);
                }
            }
            Relation::BackToBack => {
                if two_sided(o.first) {
                    cover(o.second, FRONT);
                }
                if two_sided(o.second) {
                    cover(o.second, BACK);
                }
            }
        }
    }

    /// What of a polygon on one side of a facet is not covered. Slivers that are all that is left of it are
    /// taken as covered too.
    pub(super) fn uncovered(&self, facet: u32, back: bool, polygon: &[DVec3]) -> Region {
        let covers = &self.sides[facet as usize][usize::from(back)];
        let near = Bounds::of(polygon);
        let mut pieces = vec![polygon.to_vec()];
        let mut touched = false;
        for cover in covers.iter().filter(|c| Bounds::of(c).grown(self.tolerance).meets(&near)) {
            touched = true;
            pieces = pieces.iter().flat_map(|p| subtract_convex(p, cover)).collect();
        }
        let region = Region { pieces };
        let dust = touched && region.area() <= (1e-9 * area(polygon)).max(self.tolerance * diameter(polygon));
        if dust { Region::default() } else { region }
    }

    /// True if a one-sided facet radiates nowhere because earlier ones facing the same way cover it.
    pub(super) fn hides(&self, facets: &[Facet], facet: u32) -> bool {
        let f = &facets[facet as usize];
        f.first_back_patch.is_none() && self.uncovered(facet, false, &f.vertices).pieces.is_empty()
    }
}
