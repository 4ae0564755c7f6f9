//! Point to polygon: the contour formula of Lambert, exact.

use super::edge::Edge;
use crate::math::{DVec3, clip_to_half_space, unit_normal};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Heights below this share of the largest distance are rounding: the point or vertex lies in the plane.
const ON_PLANE: f64 = 1e-15;

/// The same for a point given by itself, whose own coordinates are rounded.
const HEIGHT_OF_A_POINT: f64 = 1e-12;

/// Form factor from a differential area to a convex planar polygon, nothing standing between: the share (0 to 1) of
/// the light leaving `point` diffusely about `normal` (of any length) that arrives on the polygon's front.
///
/// Lambert's formula: `1/(2 pi) sum_i angle_i (unit normal of the triangle of edge i and the point) . normal`, over
/// the part of the polygon above the horizon of `normal` (Lambert, *Photometria*, 1760; the closed form of equation 4
/// of CG85). Vertices counter-clockwise seen from the front; any unit of length.
///
/// Exact to rounding (1e-15 absolute, for coordinates that are exact). A point in the plane of the polygon, also on
/// its rim, sees it edge-on: 0; so does a point behind it. Along the rim the factor jumps, and 0 is the value on it.
/// Degenerate polygons (fewer than three vertices, no area): 0. Coordinates that are not finite: NaN.
///
/// ```
/// use etalon::formfactor::point_to_polygon;
/// use etalon::math::DVec3;
///
/// // A corner of the unit square sees, one metre above, the opposite unit square facing down.
/// let ceiling = [[0., 0.], [0., 1.], [1., 1.], [1., 0.]].map(|[x, y]| DVec3::new(x, y, 1.0));
/// let factor = point_to_polygon(DVec3::ZERO, DVec3::Z, &ceiling);
/// let exact = (0.5f64).sqrt() * (0.5f64).sqrt().atan() / std::f64::consts::PI;
/// assert!((factor - exact).abs() < 1e-15);
/// ```
pub fn point_to_polygon(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> f64 {
    if polygon.len() < 3 {
        return 0.0;
    }
    if !(point.is_finite() && normal.is_finite() && polygon.iter().all(|p| p.is_finite())) {
        return f64::NAN;
    }
    let normal = normal.normalize_or_zero();
    // Seen from the point: differences are what the formula lives on.
    let seen: Vec<DVec3> = polygon.iter().map(|p| *p - point).collect();
    let reach = seen.iter().map(|p| p.length()).fold(0.0, f64::max);
    // From the nearest vertex, so that a far one does not blur the height.
    let nearest = seen.iter().copied().min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let height = -unit_normal(&seen).dot(nearest.unwrap_or_default());
    if height <= ON_PLANE * reach {
        return 0.0;
    }
    let visible = above(&seen, normal, 0.0, ON_PLANE * reach);
    (contour_sum(DVec3::ZERO, normal, &Edge::around(&visible)) / (2.0 * PI)).clamp(0.0, 1.0)
}

/// The part of a convex polygon that a point over the horizon of the unit vector `normal` sees from its front; `None`
/// if it sees nothing of it.
pub(super) fn facing_point(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> Option<Vec<DVec3>> {
    let reach = polygon.iter().map(|p| p.distance(point)).fold(0.0, f64::max);
    let height = (point - polygon[0]).dot(unit_normal(polygon));
    // In floating point a point "in" the plane stands a few roundings off it.
    if height <= HEIGHT_OF_A_POINT * reach {
        return None;
    }
    let part = above(polygon, normal, normal.dot(point), HEIGHT_OF_A_POINT * reach);
    (part.len() >= 3).then(|| part.into_owned())
}

/// The part of a convex polygon with `normal . p >= offset`; empty where nothing rises above it by more than `slack`.
pub(super) fn above(polygon: &[DVec3], normal: DVec3, offset: f64, slack: f64) -> Cow<'_, [DVec3]> {
    let side = |p: &DVec3| normal.dot(*p) - offset;
    if polygon.iter().all(|p| side(p) <= slack) {
        return Cow::Borrowed(&[]);
    }
    if polygon.iter().all(|p| side(p) >= -slack) {
        return Cow::Borrowed(polygon);
    }
    let part = clip_to_half_space(polygon, normal, offset);
    if part.len() < 3 { Cow::Borrowed(&[]) } else { Cow::Owned(part) }
}

/// Lambert's sum, `2 pi` times the form factor, of a polygon that lies wholly above the horizon.
pub(super) fn contour_sum(point: DVec3, normal: DVec3, edges: &[Edge]) -> f64 {
    let term = |e: &Edge| {
        let (a, b) = (e.from - point, e.to - point);
        // The edge itself, not the difference of a and b: short edges far away keep their digits. From the nearer end.
        let near = if a.length_squared() < b.length_squared() { a } else { b };
        let cross = near.cross(e.direction) * e.length;
        let sine = cross.length();
        // Seen end-on, an edge turns nothing. Minus: the front is the side that faces the point.
        if sine > 0.0 { -sine.atan2(a.dot(b)) * cross.dot(normal) / sine } else { 0.0 }
    };
    edges.iter().map(term).sum()
}
