//! Lights as the judge sees them: one sample of each from a point, what it brings if nothing stands between.

use super::sky::{angle, relative_radiance};
use super::spherical::{direction, solid_angle};
use crate::math::{DVec3, Frame, area, unit_normal};
use crate::sampling::{cosine_hemisphere, fold};
use crate::scene::{Distribution, IntensityCurve, Light, LightShape, SkyModel};
use std::f64::consts::PI;

/// Triangles that fill more than this, sr, are sampled by solid angle: near a lamp, samples by area would have no bound.
const NEAR: f64 = 1e-2;

/// A look at one place of a lamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Aim {
    /// Unit vector to it.
    pub direction: DVec3,
    /// How far away it is, m.
    pub distance: f64,
    /// Factor (irradiance per strength) that the sample stands for: their mean is the factor of the lamp.
    pub factor: f64,
}

/// A light, ready to be looked at.
pub(super) struct Lamp<'a> {
    shape: &'a LightShape,
    triangles: Vec<Triangle>,
}

struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
    area: f64,
}

impl<'a> Lamp<'a> {
    pub fn new(light: &'a Light) -> Self {
        let triangles = match &light.shape {
            LightShape::Area { polygon } => fan(polygon),
            LightShape::Polyhedron { faces } => faces.iter().flat_map(|f| fan(f)).collect(),
            _ => Vec::new(),
        };
        Self { shape: &light.shape, triangles }
    }

    /// True for lights that are seen in one direction only.
    pub fn is_hard(&self) -> bool {
        matches!(self.shape, LightShape::Parallel { .. } | LightShape::Point { .. })
    }

    /// Unit vector to a hard light; `None` for the others.
    pub fn towards(&self, point: DVec3) -> Option<DVec3> {
        match self.shape {
            LightShape::Parallel { direction } => Some(-direction.normalize_or_zero()),
            LightShape::Point { position, .. } => Some((*position - point).normalize_or_zero()),
            _ => None,
        }
    }

    /// Relative radiance of a sky in a direction; 0 for other lights.
    pub fn sky(&self, direction: DVec3) -> f64 {
        match self.shape {
            LightShape::Sky { model, up } => relative_radiance(model, *up, direction),
            _ => 0.0,
        }
    }

    /// A look from a point of a surface with this unit normal at the place of the lamp that (u, v) stands for; `None`
    /// where nothing can come from.
    pub fn aim(&self, point: DVec3, normal: DVec3, [u, v]: [f64; 2]) -> Option<Aim> {
        let aim = match self.shape {
            LightShape::Parallel { direction } => {
                let to = -direction.normalize_or_zero();
                Aim { direction: to, distance: f64::INFINITY, factor: to.dot(normal) }
            }
            LightShape::Point { position, distribution, curve } => {
                let (direction, distance) = way(point, *position)?;
                let share = emitted(*distribution, -direction) * curve.as_ref().map_or(1.0, |c| curved(c, -direction));
                Aim { direction, distance, factor: share * direction.dot(normal) / (distance * distance) }
            }
            LightShape::Linear { from, to } => tube(*from, *to, point, normal, u)?,
            LightShape::Area { .. } | LightShape::Polyhedron { .. } => self.face(point, normal, u, v)?,
            LightShape::Sky { model, up } => dome(model, *up, normal, u, v),
        };
        (aim.factor > 0.0).then_some(aim)
    }

    /// A place on the faces turned to the point: a triangle by its solid angle, a place on it by area or, near, by solid
    /// angle.
    fn face(&self, point: DVec3, normal: DVec3, u: f64, v: f64) -> Option<Aim> {
        let seen = |t: &Triangle| {
            let to = t.corners.map(|c| c - point);
            let turned = t.normal.dot(to[0]) < 0.0 && to.iter().any(|q| q.dot(normal) > 0.0);
            let unit = to.map(|q| q.normalize_or_zero());
            if turned { (solid_angle(unit), unit) } else { (0.0, unit) }
        };
        let total: f64 = self.triangles.iter().map(|t| seen(t).0).sum();
        let mut rest = u * total;
        let mut chosen = None;
        for t in &self.triangles {
            let (size, unit) = seen(t);
            if size > 0.0 {
                chosen = Some((t, size, unit, (rest / size).clamp(0.0, 1.0)));
                if rest < size {
                    break;
                }
            }
            rest -= size;
        }
        let (t, size, unit, u) = chosen?;
        if size > NEAR {
            let to = direction(unit, size, u, v);
            let distance = t.normal.dot(t.corners[0] - point) / t.normal.dot(to);
            let factor = to.dot(normal) * total / PI;
            return (distance > 0.0).then_some(Aim { direction: to, distance, factor });
        }
        let (a, b) = fold(u, v);
        let [o, p, q] = t.corners;
        let (to, distance) = way(point, o + (p - o) * a + (q - o) * b)?;
        let kernel = to.dot(normal) * -to.dot(t.normal) / (PI * distance * distance);
        Some(Aim { direction: to, distance, factor: kernel * t.area * total / size })
    }
}

/// Triangles of a convex polygon.
fn fan(polygon: &[DVec3]) -> Vec<Triangle> {
    if polygon.len() < 3 {
        return Vec::new();
    }
    let normal = unit_normal(polygon);
    let triangle = |w: &[DVec3]| {
        let corners = [polygon[0], w[0], w[1]];
        Triangle { corners, normal, area: area(&corners) }
    };
    polygon[1..].windows(2).map(triangle).filter(|t| t.area > 0.0).collect()
}

/// Unit vector and distance from one place to another; `None` if they are the same.
fn way(from: DVec3, to: DVec3) -> Option<(DVec3, f64)> {
    let way = to - from;
    let distance = way.length();
    (distance > 0.0).then(|| (way / distance, distance))
}

/// Share of a point light's intensity in a direction (unit, away from it).
fn emitted(distribution: Distribution, direction: DVec3) -> f64 {
    match distribution {
        Distribution::Isotropic => 1.0,
        Distribution::Lambert(axis) => direction.dot(axis).max(0.0),
    }
}

/// The curve's value in a direction (unit, away from the light).
fn curved(curve: &IntensityCurve, direction: DVec3) -> f64 {
    let degrees = angle(direction, curve.axis).to_degrees();
    let between = |w: &[(f64, f64)]| {
        let ((a, fa), (b, fb)) = (w[0], w[1]);
        (a <= degrees && degrees <= b).then(|| if b > a { fa + (fb - fa) * (degrees - a) / (b - a) } else { fb })
    };
    curve.samples.windows(2).find_map(between).unwrap_or(0.0)
}

/// A place on a tube, chosen evenly by the angle that the tube fills as seen from the point: the square of the distance
/// is gone from the weight.
fn tube(from: DVec3, to: DVec3, point: DVec3, normal: DVec3, u: f64) -> Option<Aim> {
    let (axis, length) = way(from, to)?;
    let begin = (from - point).dot(axis);
    let foot = from - axis * begin;
    let across = foot.distance(point);
    let end = begin + length;
    let fill = (across * length).atan2(across * across + begin * end);
    if !(fill > 0.0 && across > 0.0) {
        return None;
    }
    let along = (across * (begin.atan2(across) + u * fill).tan()).clamp(begin, end);
    let (direction, distance) = way(point, foot + axis * along)?;
    let sine = axis.cross(direction).length();
    Some(Aim { direction, distance, factor: sine * direction.dot(normal) * fill / across })
}

/// A direction of the sky above a surface, by cosine.
fn dome(model: &SkyModel, up: DVec3, normal: DVec3, u: f64, v: f64) -> Aim {
    let frame = Frame::with_x_axis(normal, normal.any_orthonormal_vector());
    let direction = frame.to_world(cosine_hemisphere(u, v)).normalize();
    Aim { direction, distance: f64::INFINITY, factor: PI * relative_radiance(model, up, direction) }
}
