//! From space to the picture: depth planes, and where a sub-scanline meets a face.

use super::image::{DepthPlane, Span, SpanFace};
use crate::math::{DVec3, unit_normal};
use crate::view::Camera;

/// Nothing nearer than this share of a face's distance... is seen: depth must be above zero to have a reciprocal.
const NEAR: f64 = 1e-6;

/// A camera taken apart: what of a point is right, down and forward.
#[derive(Debug, Clone)]
pub struct Projection {
    /// Eye point, metres.
    pub eye: DVec3,
    right: DVec3,
    down: DVec3,
    forward: DVec3,
    /// Slope of the upper left corner's ray, right and down.
    corner: [f64; 2],
    /// Slope per pixel.
    step: f64,
}

impl Projection {
    /// Takes a camera apart.
    pub fn of(camera: &Camera) -> Self {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let half = (0.5 * camera.fov.to_radians()).tan();
        let [w, h] = camera.size.map(f64::from);
        let step = 2.0 * half / h;
        Self {
            eye: camera.eye,
            right,
            down: forward.cross(right),
            forward,
            corner: [-0.5 * w * step, -0.5 * h * step],
            step,
        }
    }

    /// The ray through a picture point, of length 1 along the viewing direction.
    pub fn ray(&self, x: f64, y: f64) -> DVec3 {
        self.forward + self.right * (self.corner[0] + x * self.step) + self.down * (self.corner[1] + y * self.step)
    }

    /// The point of the picture point (x, y) at a reciprocal depth.
    pub fn point(&self, x: f64, y: f64, reciprocal_depth: f64) -> DVec3 {
        self.eye + self.ray(x, y) / reciprocal_depth
    }

    /// Picture coordinates and depth of a point; `None` behind the eye.
    pub fn project(&self, p: DVec3) -> Option<(f64, f64, f64)> {
        let [r, d, z] = self.local(p);
        (z > 0.0).then(|| ((r / z - self.corner[0]) / self.step, (d / z - self.corner[1]) / self.step, z))
    }

    /// Right, down and forward of the eye, metres.
    fn local(&self, p: DVec3) -> [f64; 3] {
        let v = p - self.eye;
        [v.dot(self.right), v.dot(self.down), v.dot(self.forward)]
    }

    /// Reciprocal depth over the picture of the plane of a polygon; `None` where it is seen edge-on.
    pub fn depth(&self, vertices: &[DVec3]) -> Option<DepthPlane> {
        let normal = unit_normal(vertices);
        let middle = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let height = normal.dot(middle - self.eye);
        if height.abs() <= 1e-12 * (middle - self.eye).length() || !height.is_finite() {
            return None;
        }
        Some(DepthPlane {
            at: normal.dot(self.ray(0.0, 0.0)) / height,
            along_x: normal.dot(self.right) * self.step / height,
            along_y: normal.dot(self.down) * self.step / height,
        })
    }
}

impl SpanFace {
    /// Reciprocal depth of the face's plane over the picture; all zero where the plane goes through the eye.
    pub fn depth(&self, camera: &Camera) -> DepthPlane {
        let none = DepthPlane { at: 0.0, along_x: 0.0, along_y: 0.0 };
        Projection::of(camera).depth(&self.vertices).unwrap_or(none)
    }

    /// Unit normal of the front.
    pub fn normal(&self) -> DVec3 {
        unit_normal(&self.vertices)
    }
}

impl DepthPlane {
    /// Reciprocal depth at a picture point, 1/m.
    pub fn value(&self, x: f64, y: f64) -> f64 {
        self.at + self.along_y * y + self.along_x * x
    }

    /// False for the plane of a face that is seen edge-on.
    pub fn is_seen(&self) -> bool {
        self.at != 0.0 || self.along_x != 0.0 || self.along_y != 0.0
    }
}

/// A face as sub-scanlines meet it.
pub(super) struct Outline {
    face: u32,
    /// Right, down, forward per corner.
    corners: Vec<[f64; 3]>,
    /// Forward below which nothing is seen.
    near: f64,
}

impl Outline {
    /// The outline of a face before the eye; `None` if nothing of it is.
    pub(super) fn of(face: u32, vertices: &[DVec3], projection: &Projection) -> Option<Self> {
        let corners: Vec<_> = vertices.iter().map(|v| projection.local(*v)).collect();
        let far = corners.iter().map(|c| c[2]).fold(0.0, f64::max);
        let near = NEAR * far;
        (far > 0.0).then_some(Self { face, corners, near })
    }

    /// First and last sub-scanline that can meet the face, of `per_line` per pixel and at most `last`.
    pub(super) fn rows(&self, projection: &Projection, per_line: f64, last: u32) -> Option<(u32, u32)> {
        if self.corners.iter().any(|c| c[2] <= self.near) {
            return Some((0, last));
        }
        let y = |c: &[f64; 3]| (c[1] / c[2] - projection.corner[1]) / projection.step * per_line;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in self.corners.iter().map(y) {
            (low, high) = (low.min(v), high.max(v));
        }
        // One row of margin: rounding must not lose a row that the face just reaches.
        let (low, high) = ((low - 1.0).ceil(), (high + 1.0).floor());
        (high >= 0.0 && low <= f64::from(last)).then(|| (low.max(0.0) as u32, high.min(f64::from(last)) as u32))
    }

    /// The segment of the sub-scanline at height `y` (pixels) within the face, cut to the picture's width.
    ///
    /// The face is cut by the plane of eye and sub-scanline in space. A corner on the plane counts as above it, and an
    /// edge is always cut from its upper to its lower end: two faces with a common edge end at the same bits.
    pub(super) fn segment(&self, projection: &Projection, y: f64, width: f64) -> Option<Span> {
        let slope = projection.corner[1] + y * projection.step;
        let below = |c: &[f64; 3]| c[1] - slope * c[2];
        let mut ends = [[0.0; 2]; 2];
        let mut count = 0;
        let n = self.corners.len();
        for i in 0..n {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % n]);
            let (ga, gb) = (below(a), below(b));
            let (a, b, ga, gb) = match (ga > 0.0, gb > 0.0) {
                (false, true) => (a, b, ga, gb),
                (true, false) => (b, a, gb, ga),
                _ => continue,
            };
            let t = ga / (ga - gb);
            if count < 2 {
                ends[count] = [a[0] + t * (b[0] - a[0]), a[2] + t * (b[2] - a[2])];
            }
            count += 1;
        }
        if count < 2 {
            return None;
        }
        let [mut p, mut q] = ends;
        match (p[1] > self.near, q[1] > self.near) {
            (false, false) => return None,
            (true, true) => {}
            (true, false) => q = at_depth(p, q, self.near),
            (false, true) => p = at_depth(q, p, self.near),
        }
        let x = |e: [f64; 2]| ((e[0] / e[1] - projection.corner[0]) / projection.step).clamp(0.0, width);
        let (a, b) = (x(p), x(q));
        let (from, to) = if a <= b { (a, b) } else { (b, a) };
        (from < to).then_some(Span { from, to, face: self.face, lit: true })
    }
}

/// The point between `p` (before `depth`) and `q` (nearer) at a depth.
fn at_depth(p: [f64; 2], q: [f64; 2], depth: f64) -> [f64; 2] {
    let t = (p[1] - depth) / (p[1] - q[1]);
    [p[0] + t * (q[0] - p[0]), depth]
}
