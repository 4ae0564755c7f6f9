//! Polygons and their division.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::raw::Counts;
use crate::math::{DVec3, area, convex_defect, diameter, plane_defect, unit_normal};
use crate::scene::{Grid, MAX_ELEMENTS, MAX_PATCHES};
use toml::Spanned;

/// Largest distance from the mean plane, as a share of the diameter.
pub(super) const PLANE_TOLERANCE: f64 = 1e-6;
/// Largest turn the wrong way (sine) that still counts as a straight corner.
pub(super) const CONVEX_TOLERANCE: f64 = 1e-6;
/// Smallest area, as a share of the diameter squared.
pub(super) const AREA_TOLERANCE: f64 = 1e-12;

/// Most corners of a polygon: checks look at all pairs.
pub(super) const MAX_CORNERS: usize = 4096;

/// What is wrong with a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flaw {
    NoArea,
    NotPlanar(f64),
    NotConvex,
}

/// The first flaw of a loop of finite corners, if it has one.
pub(super) fn flaw(corners: &[DVec3]) -> Option<Flaw> {
    let size = diameter(corners);
    if corners.len() < 3 || size == 0.0 || area(corners) <= AREA_TOLERANCE * size * size {
        return Some(Flaw::NoArea);
    }
    let defect = plane_defect(corners);
    if defect > PLANE_TOLERANCE {
        return Some(Flaw::NotPlanar(defect * size));
    }
    (convex_defect(corners) < -CONVEX_TOLERANCE).then_some(Flaw::NotConvex)
}

/// True if a corner is straight: the bilinear map of such a quadrilateral has no inverse there.
fn has_straight_corner(corners: &[DVec3]) -> bool {
    let n = unit_normal(corners);
    let k = corners.len();
    (0..k).any(|i| {
        let e = (corners[(i + 1) % k] - corners[i]).normalize_or_zero();
        let f = (corners[(i + 2) % k] - corners[(i + 1) % k]).normalize_or_zero();
        e.cross(f).dot(n) < CONVEX_TOLERANCE
    })
}

/// Reads and checks a polygon of the scene file.
pub(super) fn polygon(check: Check, value: &Spanned<Vec<Spanned<Vec<f64>>>>) -> Checked<Vec<DVec3>> {
    let refuse = |message: String, mend: &str| check.refuse(Refusal::Geometry, value.span(), message, mend);
    let raw = value.get_ref();
    if raw.len() < 3 {
        return refuse(format!("the polygon has {} vertices", raw.len()), "give three or more");
    }
    let corners: Vec<DVec3> =
        raw.iter().enumerate().map(|(i, v)| check.point(&format!("vertex {i}"), v)).collect::<Checked<_>>()?;
    let size = diameter(&corners);
    let double =
        (0..corners.len()).find(|i| corners[*i].distance(corners[(i + 1) % corners.len()]) <= AREA_TOLERANCE * size);
    if let Some(i) = double.filter(|_| size > 0.0) {
        return refuse(
            format!("vertices {i} and {} of the polygon are the same point", (i + 1) % corners.len()),
            "leave one of them out",
        );
    }
    match flaw(&corners) {
        None => Ok(corners),
        Some(Flaw::NoArea) => refuse("the polygon has no area".into(), "check the vertices"),
        Some(Flaw::NotPlanar(d)) => refuse(
            format!("the polygon is not planar: a vertex lies {d:.3e} m off its mean plane"),
            "split it into triangles, or move the vertices into one plane (1e-6 of the diagonal is allowed)",
        ),
        Some(Flaw::NotConvex) => refuse(
            "the polygon is not convex".into(),
            "split it into convex parts, and check the order of the vertices",
        ),
    }
}

/// How faces are to be divided.
#[derive(Clone, Copy)]
pub(super) struct Division<'a> {
    pub patches: Option<&'a Spanned<Counts>>,
    pub elements: Option<&'a Spanned<Counts>>,
    pub max_edge: Option<f64>,
    /// Mesh faces of every size follow one pair of counts.
    pub mesh: bool,
}

impl Division<'_> {
    /// Grids of a face: patches, and elements within each.
    pub(super) fn of(&self, check: Check, corners: &[DVec3]) -> Checked<(Grid, Grid)> {
        let patches = match (self.patches, self.max_edge) {
            (Some(counts), _) => self.grid(check, "patches", counts, corners)?,
            (None, Some(max_edge)) => by_edge(corners, max_edge),
            (None, None) => unit_grid(corners),
        };
        let elements = match self.elements {
            Some(counts) => self.grid(check, "elements", counts, corners)?,
            None => unit_grid(corners),
        };
        Ok((patches, elements))
    }

    fn grid(&self, check: Check, what: &str, counts: &Spanned<Counts>, corners: &[DVec3]) -> Checked<Grid> {
        let list = match counts.get_ref() {
            Counts::One(n) => vec![*n],
            Counts::List(l) => l.clone(),
        };
        let refuse = |message: String, mend: &str| check.refuse(Refusal::Counts, counts.span(), message, mend);
        if let Some(n) = list.iter().find(|n| **n < 1) {
            return refuse(format!("{what} has the count {n}"), "give counts of 1 or more");
        }
        let limit = if what == "patches" { MAX_PATCHES } else { MAX_ELEMENTS };
        let cells = list.iter().fold(1u64, |p, n| p.saturating_mul(*n as u64));
        let cells = if list.len() == 1 { cells.saturating_mul(cells) } else { cells };
        let single = list.iter().all(|n| *n == 1);
        if cells > limit && !single {
            return refuse(
                format!("{what} asks for {cells} pieces of one face, more than the {limit} that fit into memory"),
                "use smaller counts",
            );
        }
        let count = |i: usize| list[i] as u32;
        let one_number = matches!(counts.get_ref(), Counts::One(_));
        match (corners.len(), list.len()) {
            (_, 1 | 2) if single => Ok(unit_grid(corners)),
            (4, 1 | 2) if has_straight_corner(corners) => match self.mesh {
                true => Ok(Grid::Whole),
                false => refuse(
                    format!("{what}: a quadrilateral with a straight corner cannot be divided"),
                    "write it as a triangle, or leave the counts out",
                ),
            },
            (4, 2) => Ok(Grid::Quad { na: count(0), nb: count(1) }),
            (4, 1) if one_number || self.mesh => Ok(Grid::Quad { na: count(0), nb: count(0) }),
            (4, n) => {
                refuse(format!("{what} has {n} counts for a quadrilateral"), "give two: [along v0->v1, along v0->v3]")
            }
            (3, 1) => Ok(Grid::Triangle { n: count(0) }),
            (3, 2) if self.mesh => Ok(Grid::Triangle { n: count(0).max(count(1)) }),
            (3, n) => refuse(format!("{what} has {n} counts for a triangle"), "give one: [n], for n x n triangles"),
            (_, 1 | 2) if self.mesh => Ok(Grid::Whole),
            (n, _) => refuse(
                format!("{what}: a polygon of {n} vertices is one patch"),
                "leave the counts out, or split it into quadrilaterals and triangles",
            ),
        }
    }
}

/// The grid of one cell.
fn unit_grid(corners: &[DVec3]) -> Grid {
    match corners.len() {
        3 => Grid::Triangle { n: 1 },
        4 if !has_straight_corner(corners) => Grid::Quad { na: 1, nb: 1 },
        _ => Grid::Whole,
    }
}

/// Divides so that no patch edge is longer than `max_edge`; polygons of five and more vertices stay whole.
/// Counts beyond all memory come out as the largest number and are refused with the total.
fn by_edge(corners: &[DVec3], max_edge: f64) -> Grid {
    let k = corners.len();
    let edge = |i: usize| corners[i].distance(corners[(i + 1) % k]);
    // A rounding error above a whole number of edges is not worth another row.
    let count = |length: f64| ((length / max_edge * (1.0 - 1e-9)).ceil()).clamp(1.0, f64::from(u32::MAX / 4)) as u32;
    match unit_grid(corners) {
        Grid::Quad { .. } => Grid::Quad { na: count(edge(0).max(edge(2))), nb: count(edge(1).max(edge(3))) },
        Grid::Triangle { .. } => Grid::Triangle { n: count(edge(0).max(edge(1)).max(edge(2))) },
        Grid::Whole => Grid::Whole,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_divide_without_a_rounding_row() {
        let rectangle = [(0.0, 0.0), (0.9, 0.0), (0.9, 1.2), (0.0, 1.2)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert_eq!(by_edge(&rectangle, 0.3), Grid::Quad { na: 3, nb: 4 });
        assert_eq!(by_edge(&rectangle, 0.29), Grid::Quad { na: 4, nb: 5 });
        assert_eq!(by_edge(&rectangle[..3], 0.5), Grid::Triangle { n: 3 });
    }

    #[test]
    fn a_straight_corner_makes_a_whole() {
        let flat = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert_eq!(flaw(&flat), None);
        assert_eq!(unit_grid(&flat), Grid::Whole);
    }
}
