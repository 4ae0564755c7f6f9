//! What one point sees of the polygons in one plane, convex bodies standing between: exact.

use super::shadow::Scratch;
use super::view::View;
use crate::formfactor::lambert::above;
use crate::math::{DVec2, DVec3, Polytope};
use std::f64::consts::PI;

/// Heights below this share of the distance are rounding.
const ON_PLANE: f64 = 1e-15;

/// A point before a plane, with the shadows that bodies throw on it, cast once for all polygons of the plane.
pub struct PointView {
    view: View,
    scratch: Scratch,
    polygon: Vec<DVec2>,
    /// Plane of the receiver: what lies below is not seen.
    point: DVec3,
    normal: DVec3,
    all_hidden: bool,
}

impl PointView {
    /// The view from `point` over the horizon of the unit vector `normal` onto the plane of `whole`, a convex polygon
    /// that lies above that horizon and holds all that will be asked for. Bodies may stand anywhere: what lies behind
    /// the plane or below the horizon hides nothing.
    pub fn new(point: DVec3, normal: DVec3, whole: &[DVec3], bodies: &[&Polytope]) -> Self {
        let u = normal.any_orthonormal_vector();
        // Any triangle at the point stands for its plane; its size says what is rounding.
        let size = whole.iter().map(|p| p.distance(point)).fold(0.0, f64::max);
        let stand = [point, point + u * size, point + normal.cross(u) * size];
        let view = View::new(&stand, whole, bodies);
        let mut scratch = Scratch::default();
        let all_hidden = view.cast_shadows(view.origin, &mut scratch);
        Self { view, scratch, polygon: Vec::new(), point, normal, all_hidden }
    }

    /// Form factors from the point to a convex polygon of the plane: with nothing between, and what is seen of it.
    pub fn factors(&mut self, polygon: &[DVec3]) -> (f64, f64) {
        let reach = polygon.iter().map(|p| p.distance(self.point)).fold(0.0, f64::max);
        let risen = above(polygon, self.normal, self.normal.dot(self.point), ON_PLANE * reach);
        if risen.len() < 3 {
            return (0.0, 0.0);
        }
        let x = self.view.origin;
        self.view.on_target(&risen, &mut self.polygon);
        let open = self.view.lambert(x, &self.polygon);
        let hidden = if self.all_hidden { open } else { self.view.in_shadow(x, &self.polygon, &mut self.scratch) };
        let unit = 1.0 / (2.0 * PI);
        ((open * unit).clamp(0.0, 1.0), ((open - hidden) * unit).clamp(0.0, 1.0))
    }
}
