//! Polygon to polygon with convex bodies between: what they hide, integrated to an asked error.

mod cells;
mod events;
mod point;
mod shadow;
mod view;

pub use point::{Eye, Obstacle, PointView, Screen};

use crate::math::{DVec3, Plane, Polytope, area};
use shadow::Scratch;
use std::cell::RefCell;
use std::f64::consts::PI;
use view::View;

/// Heights below this share of the pair's extent are rounding.
const ON_PLANE: f64 = 1e-12;

/// How hard to try.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Error of the exchange to be reached, m^2.
    pub tolerance: f64,
    /// Points evaluated at most (a few more to finish a sweep).
    pub points: usize,
    /// Bodies up to which the domain is cut also where two of them line up; beyond, refinement finds those kinks.
    pub arranged_bodies: usize,
}

/// What bodies take from an exchange.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Hidden {
    /// `A_a F_ab` through the hidden part, m^2.
    pub exchange: f64,
    /// Estimated bound of its error, m^2.
    pub error: f64,
    /// Points at which visibility was evaluated exactly.
    pub points: usize,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The part of the exchange `A_a F_ab` (m^2) of two convex polygons that convex bodies between them hide.
///
/// The smaller polygon is cut along the lines where the shape of the visible part changes (corners against edges,
/// faces turning away: the visibility events); in each cell Lambert's formula of the hidden part of the other polygon,
/// the shadows cut out of one another exactly, is integrated by Gauss points until two orders agree.
/// Bodies may stand anywhere: what lies behind one of the polygons hides nothing.
pub fn hidden_exchange(a: &[DVec3], b: &[DVec3], bodies: &[&Polytope], effort: &Effort) -> Hidden {
    let Some((front_a, front_b)) = facing(a, b) else { return Hidden::default() };
    let (domain, target) = if area(&front_a) <= area(&front_b) { (front_a, front_b) } else { (front_b, front_a) };
    let view = View::new(&domain, &target, bodies);
    if view.bodies.is_empty() {
        return Hidden::default();
    }
    let count = view.bodies.len();
    let together = count > 1 && count <= effort.arranged_bodies;
    let lines = events::lines(&view, together);
    let kinks = count > 1 && !together;
    let unit = 1.0 / (2.0 * PI);
    SCRATCH.with_borrow_mut(|scratch| {
        let mut hidden = |p| view.hidden(view.point(p), scratch);
        let sum = cells::integrate(&view.domain, &lines, kinks, effort.tolerance / unit, effort.points, &mut hidden);
        Hidden { exchange: sum.value * unit, error: sum.error * unit, points: sum.points }
    })
}

/// Both polygons, each cut to what lies in front of the other; `None` if nothing does.
pub fn facing(a: &[DVec3], b: &[DVec3]) -> Option<(Vec<DVec3>, Vec<DVec3>)> {
    Some((in_front(a, b)?, in_front(b, a)?))
}

fn in_front(polygon: &[DVec3], other: &[DVec3]) -> Option<Vec<DVec3>> {
    let plane = Plane::of(other);
    let slack = ON_PLANE * polygon.iter().map(|p| p.distance(other[0])).fold(0.0, f64::max);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in polygon {
        let h = plane.height(*p);
        low = low.min(h);
        high = high.max(h);
    }
    if high <= slack {
        return None;
    }
    if low >= -slack {
        return Some(polygon.to_vec());
    }
    let part = crate::math::clip_to_half_space(polygon, plane.normal, plane.offset);
    (part.len() >= 3 && area(&part) > 0.0).then_some(part)
}
