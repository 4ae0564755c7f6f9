//! Polygon to polygon, exact, with nothing standing between.

use super::far::{self, Shape};
use super::lambert::above;
use super::{contour, thin};
use crate::math::{DVec3, area, clip_to_half_space, unit_normal};
use std::borrow::Cow;

/// Heights below this share of the pair's extent are rounding: the vertex lies in the plane.
const ON_PLANE: f64 = 1e-14;

/// Rounding of the contour integral, as an error of the form factor, above which the slower way is taken.
const ROUNDING: f64 = 1e-13;

/// The same relative to the form factor, where there is another fast way.
const RELATIVE_ROUNDING: f64 = 1e-11;

/// Half the side of the square around a speck, in radii of the speck, outside which Gauss points on it suffice.
const NEIGHBOURHOOD: f64 = 8.0;

/// Form factor F_ab of two convex planar polygons with nothing standing between: the share (0 to 1) of the light that
/// leaves the front of `a` diffusely and arrives on the front of `b`.
///
/// `1/A_a` times the double area integral of `cos cos / (pi r^2)`, by whichever keeps the digits: Gauss points with a
/// proven bound far away, the double contour integral (inner integral, parallel and touching edges in closed form)
/// near, the area integral of Lambert's formula for needles and specks. Parts behind the other polygon's plane are cut
/// off first. Vertices counter-clockwise seen from the front; any unit of length; the polygons may stand anywhere,
/// share edges and touch.
///
/// Accurate to 1e-12 absolute, and to 1e-9 relative down to factors of 1e-6 near and of any size far away. Where the
/// planes cross within the polygons at a tiny angle t, where they cross is only known to 1e-16 / t, and so is the
/// result. Polygons in one plane (within 1e-14 of
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
    // One order whichever way it is asked: reciprocity holds to the last bit but the division, needles and specks aside.
    let swapped = b.iter().flat_map(|p| p.to_array()).lt(a.iter().flat_map(|p| p.to_array()));
    let (first, second) = if swapped { near_one(b, a) } else { near_one(a, b) };
    let (area_first, area_second) = (area(&first), area(&second));
    if area_first == 0.0 || area_second == 0.0 {
        return 0.0;
    }
    let asked = if swapped { area_second } else { area_first };
    (visible_exchange(&first, &second, asked) / asked).clamp(0.0, 1.0)
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

/// `A_a F_ab` of polygons that may cross each other's planes. `area` is what its error will be divided by.
fn visible_exchange(a: &[DVec3], b: &[DVec3], area: f64) -> f64 {
    let (front_a, front_b) = (in_front(a, b), in_front(b, a));
    if front_a.is_empty() || front_b.is_empty() {
        return 0.0;
    }
    let (shape_a, shape_b) = (Shape::of(&front_a), Shape::of(&front_b));
    if let Some(exchange) = fast_exchange(&shape_a, &shape_b, area) {
        return exchange;
    }
    // Of a thin polygon the whole, since clipping blurs its width.
    if shape_a.area <= shape_b.area {
        small_exchange(a, &shape_a, &shape_b)
    } else {
        small_exchange(b, &shape_b, &shape_a)
    }
}

/// The ways that cost microseconds, if one of them keeps the digits.
fn fast_exchange(a: &Shape, b: &Shape, area: f64) -> Option<f64> {
    if let Some(exchange) = far::exchange(a, b) {
        return Some(exchange);
    }
    let contour = contour::exchange(&a.edges, &b.edges);
    if contour.rounding <= (ROUNDING * area).min(RELATIVE_ROUNDING * contour.value) {
        return Some(contour.value);
    }
    let slowly = far::exchange_slowly(a, b);
    slowly.or_else(|| (contour.rounding <= ROUNDING * area).then_some(contour.value))
}

/// A needle or a speck before a larger polygon. `whole` is `small` with what lies behind the plane of `large`.
fn small_exchange(whole: &[DVec3], small: &Shape, large: &Shape) -> f64 {
    let Some((near, rest)) = around(small, large) else { return thin::exchange(whole, small.normal, large) };
    let part = |piece: &Vec<DVec3>| {
        let piece = Shape::of(piece);
        let fast = fast_exchange(small, &piece, small.area);
        fast.unwrap_or_else(|| thin::exchange(whole, small.normal, &piece))
    };
    rest.iter().chain([&near]).map(part).sum()
}

/// What of a much larger polygon lies around a speck, and the rest in convex pieces.
fn around(small: &Shape, large: &Shape) -> Option<(Vec<DVec3>, Vec<Vec<DVec3>>)> {
    let reach = NEIGHBOURHOOD * small.radius;
    if reach > 0.5 * large.radius {
        return None;
    }
    let u = large.edges.first()?.direction;
    let v = large.normal.cross(u);
    let (mut near, mut rest) = (large.polygon.to_vec(), Vec::new());
    for side in [u, -u, v, -v] {
        let offset = side.dot(small.centre) + reach;
        rest.push(clip_to_half_space(&near, side, offset));
        near = clip_to_half_space(&near, -side, -offset);
        if near.len() < 3 {
            return None;
        }
    }
    rest.retain(|piece| piece.len() >= 3);
    Some((near, rest))
}
