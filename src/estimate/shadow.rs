//! What stands between a point light and a surface.

use crate::math::DVec3;
use crate::raycast::{RayBatch, Tracer};
use crate::scene::Stage;

/// A facet counts as standing between only if the ray meets it this share of the way before the light: a light may lie
/// on a surface.
const SHORT_OF_THE_LIGHT: f64 = 1.0 - 1e-9;

/// Heights below this share of the scene's diagonal are rounding.
const ROUNDING: f64 = 1e-12;

/// For each point on facet `from` whether it sees the light.
pub(super) fn lit(tracer: &Tracer, from: u32, points: &[DVec3], light: DVec3) -> Vec<bool> {
    let mut rays = RayBatch::zeroed(points.len());
    rays.from = from;
    points.iter().enumerate().for_each(|(k, p)| rays.set(k, *p, (light - *p).normalize_or_zero()));
    let clear = |(p, hit): (&DVec3, Option<(u32, DVec3, u32)>)| {
        hit.is_none_or(|(_, at, _)| at.distance(*p) >= p.distance(light) * SHORT_OF_THE_LIGHT)
    };
    points.iter().zip(tracer.look(&rays)).map(clear).collect()
}

/// True if it can be shown that nothing stands between the light and a convex polygon: every facet lies outside of the
/// pyramid between them, on the far side of a plane. False says nothing.
pub(super) fn is_open(stage: &Stage, light: DVec3, polygon: &[DVec3]) -> bool {
    let (lo, hi) = stage.bounds();
    let slack = ROUNDING * (hi - lo).length();
    let planes = pyramid(light, polygon);
    let outside =
        |vertices: &[DVec3]| planes.iter().any(|(n, offset)| vertices.iter().all(|v| n.dot(*v) - offset <= slack));
    let aside = |vertices: &[DVec3], normal: DVec3| {
        let height = |p: &DVec3| normal.dot(*p - vertices[0]);
        let corners = || polygon.iter().chain([&light]).map(height);
        corners().all(|h| h >= -slack) || corners().all(|h| h <= slack)
    };
    stage.facets.iter().all(|f| outside(&f.vertices) || aside(&f.vertices, f.normal))
}

/// Planes (unit normal, offset) with the pyramid of apex `light` over the polygon on their upper side.
fn pyramid(light: DVec3, polygon: &[DVec3]) -> Vec<(DVec3, f64)> {
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let through = |n: DVec3, p: DVec3| {
        let n = n.normalize_or_zero();
        let up = polygon.iter().chain([&light]).all(|q| n.dot(*q - p) >= -1e-12 * (middle - light).length());
        (n != DVec3::ZERO && up).then(|| (n, n.dot(p)))
    };
    let k = polygon.len();
    let sides = (0..k).flat_map(|i| {
        let n = (polygon[i] - light).cross(polygon[(i + 1) % k] - light);
        [through(n, light), through(-n, light)]
    });
    let base = crate::math::unit_normal(polygon);
    let ends = [through(base, polygon[0]), through(-base, polygon[0]), through(middle - light, light)];
    sides.chain(ends).flatten().collect()
}
