//! What one point sees of the polygons in one plane, convex bodies standing between: exact.
//!
//! A body hides a cone of directions from a point, bounded by planes through its outline. Cones are found once for a
//! point; on the plane of a screen each is a few half-planes.

use super::shadow::{EDGE_ON, HalfPlane, Scratch, Shadow, lambert, lies};
use super::view::{MARGIN, SLACK, longest_edge, out_of_plane, roughness, size};
use crate::formfactor::lambert::{above, facing_point};
use crate::math::{DVec2, DVec3, Plane, Polytope};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Heights below this share of the distance are rounding.
const ON_PLANE: f64 = 1e-15;

/// A body that can hide, made ready once.
#[derive(Debug, Clone)]
pub struct Obstacle {
    body: Polytope,
    /// How far its corners are rounded out of its faces, m.
    rough: f64,
    /// Angle under which the corners of a plate may seem to lie out of its plane, with a margin.
    warp: f64,
}

impl Obstacle {
    /// Makes a body ready.
    pub fn new(body: Polytope) -> Self {
        let rough = roughness(&body);
        let warp = if body.is_flat() { MARGIN * rough / size(&body) } else { 0.0 };
        Self { body, rough, warp }
    }
}

/// A convex polygon that is looked at, made ready once.
#[derive(Debug, Clone)]
pub struct Screen {
    polygon: Vec<DVec3>,
    plane: Plane,
    rough: f64,
    /// Origin and unit axes of its plane.
    origin: DVec3,
    axes: [DVec3; 2],
}

impl Screen {
    /// Makes a polygon ready, counter-clockwise seen from the front.
    pub fn new(polygon: &[DVec3]) -> Self {
        let plane = Plane::of(polygon);
        let u = longest_edge(polygon);
        let u = (u - plane.normal * u.dot(plane.normal)).normalize_or(plane.normal.any_orthonormal_vector());
        let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
        let origin = middle - plane.normal * plane.height(middle);
        let rough = out_of_plane(&plane, polygon);
        Self { polygon: polygon.to_vec(), rough, origin, axes: [u, plane.normal.cross(u)], plane }
    }

    fn place(&self, p: DVec3) -> DVec2 {
        DVec2::new((p - self.origin).dot(self.axes[0]), (p - self.origin).dot(self.axes[1]))
    }

    fn half_plane(&self, point: DVec3, normal: DVec3) -> HalfPlane {
        let [u, v] = self.axes;
        HalfPlane { a: normal.dot(u), b: normal.dot(v), c: normal.dot(self.origin - point) }
    }
}

/// What a body hides from a point.
struct Cone<'a> {
    number: u32,
    obstacle: &'a Obstacle,
    /// The part of the body above the horizon.
    body: Cow<'a, Polytope>,
    /// Inward normals of the planes through the point around it.
    normals: Vec<DVec3>,
}

/// A point with a horizon, and what all bodies hide from it.
pub struct Eye<'a> {
    point: DVec3,
    normal: DVec3,
    extent: f64,
    cones: Vec<Cone<'a>>,
}

impl<'a> Eye<'a> {
    /// A point that looks over the horizon of the unit vector `normal`. `own`: the body it stands on, by number, which
    /// hides nothing. `extent` of the scene, m: what rounding is measured by.
    pub fn new(point: DVec3, normal: DVec3, obstacles: &'a [Obstacle], own: Option<u32>, extent: f64) -> Self {
        let horizon = Plane { normal, offset: normal.dot(point) };
        let cone = |(number, obstacle): (usize, &'a Obstacle)| {
            let number = number as u32;
            if own == Some(number) {
                return None;
            }
            let body = part_in_front(&obstacle.body, &horizon, SLACK * extent + MARGIN * obstacle.rough)?;
            let normals = outline(&body, point, obstacle.warp, EDGE_ON * extent)?;
            Some(Cone { number, obstacle, body, normals })
        };
        Self { point, normal, extent, cones: obstacles.iter().enumerate().filter_map(cone).collect() }
    }

    /// The view onto a screen; `None` where nothing of it is seen. `own`: the body the screen is part of.
    pub fn onto<'s>(&mut self, screen: &'s Screen, own: Option<u32>) -> Option<PointView<'s>> {
        let whole = facing_point(self.point, self.normal, &screen.polygon)?;
        let whole: Vec<DVec2> = whole.iter().map(|p| screen.place(*p)).collect();
        let mut scratch = Scratch::default();
        let (point, extent) = (self.point, self.extent);
        for cone in self.cones.iter_mut().filter(|c| own != Some(c.number)) {
            let Some(mut shadow) = cone.shadow(point, extent, screen, &whole) else { continue };
            match lies(&whole, &mut shadow) {
                Shadow::Misses => {}
                Shadow::Hides => return None,
                Shadow::Cuts => scratch.shadows.push(shadow),
            }
        }
        let [u, v] = screen.axes;
        let n = self.normal;
        let normal = DVec3::new(n.dot(u), n.dot(v), n.dot(screen.plane.normal));
        let x = screen.place(self.point).extend(screen.plane.height(self.point));
        Some(PointView { screen, x, normal, scratch, polygon: Vec::new(), point: self.point, horizon: n })
    }
}

impl Cone<'_> {
    /// The shadow of the body on a screen, as far as it stands before it.
    fn shadow(&mut self, point: DVec3, extent: f64, screen: &Screen, whole: &[DVec2]) -> Option<Vec<HalfPlane>> {
        let mut out = Vec::new();
        for k in 0..self.normals.len() {
            let h = screen.half_plane(point, self.normals[k]);
            // Most bodies stand aside: a plane with the screen on its far side tells, and likely of the next one too.
            if whole.iter().all(|p| h.at(*p) <= 0.0) {
                self.normals.swap(0, k);
                return None;
            }
            out.push(h);
        }
        let slack = SLACK * extent + MARGIN * (self.obstacle.rough + screen.rough);
        match part_in_front(&self.body, &screen.plane, slack)? {
            Cow::Borrowed(_) => Some(out),
            Cow::Owned(part) => {
                let normals = outline(&part, point, self.obstacle.warp, EDGE_ON * extent)?;
                Some(normals.iter().map(|n| screen.half_plane(point, *n)).collect())
            }
        }
    }
}

/// The part of a body in front of a plane; `None` if it rises nowhere above it by more than `slack`.
fn part_in_front<'b>(body: &'b Polytope, plane: &Plane, slack: f64) -> Option<Cow<'b, Polytope>> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in body.vertices() {
        let h = plane.height(*v);
        low = low.min(h);
        high = high.max(h);
    }
    if high <= slack {
        None
    } else if low >= -slack {
        Some(Cow::Borrowed(body))
    } else {
        body.in_front(plane, slack).map(Cow::Owned)
    }
}

/// Inward normals of the planes through a point around a body; `None` for a plate seen edge-on, none at all for a body
/// around the point.
fn outline(body: &Polytope, point: DVec3, warp: f64, edge_on: f64) -> Option<Vec<DVec3>> {
    let above = if body.is_flat() { edge_on.max(warp * body.centre().distance(point)) } else { 0.0 };
    let mut seen = 0u64;
    for (k, plane) in body.planes().iter().enumerate() {
        seen |= u64::from(plane.height(point) > above) << (k & 63);
    }
    if seen == 0 && body.is_flat() {
        return None;
    }
    let inwards = body.centre() - point;
    let mut normals = Vec::new();
    for e in body.edges() {
        if (seen >> (e.left & 63) & 1) == (seen >> (e.right & 63) & 1) {
            continue;
        }
        let [a, b] = e.ends.map(|k| body.vertices()[k as usize] - point);
        let normal = a.cross(b);
        normals.push(if normal.dot(inwards) < 0.0 { -normal } else { normal });
    }
    Some(normals)
}

/// A point before a screen, with the shadows that bodies throw on it.
pub struct PointView<'s> {
    screen: &'s Screen,
    /// The point and its normal in coordinates of the screen.
    x: DVec3,
    normal: DVec3,
    scratch: Scratch,
    polygon: Vec<DVec2>,
    point: DVec3,
    horizon: DVec3,
}

impl PointView<'_> {
    /// Form factors from the point to a convex polygon within the screen: with nothing between, and what is seen of it.
    pub fn factors(&mut self, polygon: &[DVec3]) -> (f64, f64) {
        let reach = polygon.iter().map(|p| p.distance(self.point)).fold(0.0, f64::max);
        let risen = above(polygon, self.horizon, self.horizon.dot(self.point), ON_PLANE * reach);
        if risen.len() < 3 {
            return (0.0, 0.0);
        }
        self.polygon.clear();
        self.polygon.extend(risen.iter().map(|p| self.screen.place(*p)));
        let open = lambert(self.x, self.normal, &self.polygon);
        let hidden = self.scratch.in_shadow(self.x, self.normal, &self.polygon);
        let unit = 1.0 / (2.0 * PI);
        ((open * unit).clamp(0.0, 1.0), ((open - hidden) * unit).clamp(0.0, 1.0))
    }
}
