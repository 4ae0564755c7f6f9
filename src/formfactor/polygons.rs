//! Polygon to polygon, exact, with nothing standing between.

use super::far::{self, Shape};
use super::lambert::above;
use super::{contour, thin};
use crate::math::{DVec3, area, unit_normal};
use std::borrow::Cow;

/// Heights below this share of the pair's extent are rounding: the vertex lies in the plane.
const ON_PLANE: f64 = 1e-14;

/// Rounding of the contour integral, as an error of the form factor, above which the slower way is taken.
const ROUNDING: f64 = 1e-13;

/// Form factor F_ab of two convex planar polygons with nothing standing between: the share (0 to 1) of the light that
/// leaves the front of `a` diffusely and arrives on the front of `b`.
///
/// `1/A_a` times the double area integral of `cos cos / (pi r^2)`, by whichever keeps the digits: Gauss points with a
/// proven bound far away, the double contour integral (inner integral, parallel and touching edges in closed form)
/// near, the area integral of Lambert's formula for needles and specks. Parts behind the other polygon's plane are cut
/// off first. Vertices counter-clockwise seen from the front; any unit of length; the polygons may stand anywhere,
/// share edges and touch.
///
/// Accurate to 1e-12 absolute; beyond a few diameters also to 1e-9 relative. Polygons in one plane (within 1e-14 of
/// the pair's extent), facing away, or degenerate (fewer than three vertices, no area): 0. Coordinates that are not
/// finite: NaN. Same inputs, same bits; `A_a F_ab` and `A_b F_ba` agree to rounding.
///
/// ```
/// use etalon::formfactor::polygon_to_polygon;
/// use etalon::math::DVec3;
///
/// // Two unit squares with a common edge, at right angles: 0.20004377607540...
/// let floor = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]].map(DVec3::from_array);
/// let wall = [[0., 0., 0.], [0., 0., 1.], [1., 0., 1.], [1., 0., 0.]].map(DVec3::from_array);
/// assert!((polygon_to_polygon(&floor, &wall) - 0.200_043_776_075_403_15).abs() < 1e-14);
/// ```
pub fn polygon_to_polygon(a: &[DVec3], b: &[DVec3]) -> f64 {
    if a.len() < 3 || b.len() < 3 {
        return 0.0;
    }
    if !a.iter().chain(b).all(|p| p.is_finite()) {
        return f64::NAN;
    }
    let (a, b) = near_one(a, b);
    let area_a = area(&a);
    if area_a == 0.0 || area(&b) == 0.0 {
        return 0.0;
    }
    let (front_a, front_b) = (in_front(&a, &b), in_front(&b, &a));
    if front_a.is_empty() || front_b.is_empty() {
        return 0.0;
    }
    (exchange(&Shape::of(&front_a), &Shape::of(&front_b), area_a) / area_a).clamp(0.0, 1.0)
}

/// Both polygons moved and scaled together so that their extent is about 1. A power of two scales without rounding.
fn near_one(a: &[DVec3], b: &[DVec3]) -> (Vec<DVec3>, Vec<DVec3>) {
    let origin = a[0];
    let reach = a.iter().chain(b).map(|p| (*p - origin).abs().max_element()).fold(0.0, f64::max);
    let scale = if reach > 0.0 { 2f64.powi(-reach.log2().floor().clamp(-1000.0, 1000.0) as i32) } else { 1.0 };
    let moved = |polygon: &[DVec3]| polygon.iter().map(|p| (*p - origin) * scale).collect();
    (moved(a), moved(b))
}

/// The part of `polygon` in front of the plane of `other`; empty if it rises nowhere above it.
fn in_front<'a>(polygon: &'a [DVec3], other: &[DVec3]) -> Cow<'a, [DVec3]> {
    let normal = unit_normal(other);
    let offset = normal.dot(other.iter().sum::<DVec3>()) / other.len() as f64;
    above(polygon, normal, offset, ON_PLANE)
}

/// `A_a F_ab` of polygons wholly in front of each other. `area` is what the error of the exchange will be divided by.
fn exchange(a: &Shape, b: &Shape, area: f64) -> f64 {
    if let Some(exchange) = far::exchange(a, b) {
        return exchange;
    }
    let contour = contour::exchange(&a.edges, &b.edges);
    if contour.rounding <= ROUNDING * area {
        return contour.value;
    }
    if a.area <= b.area { thin::exchange(a, b) } else { thin::exchange(b, a) }
}
