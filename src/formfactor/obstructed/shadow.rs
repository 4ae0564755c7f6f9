//! What of the target a point does not see: the shadows of convex bodies, cut out of one another exactly.

use super::view::{Body, View};
use crate::math::{DVec2, DVec3};

/// Heights over a plate below this share of the pair's extent are rounding.
pub(super) const EDGE_ON: f64 = 1e-13;

/// Room for the polygons of one evaluation, used again and again.
#[derive(Default)]
pub(super) struct Scratch {
    /// Half-planes of each body's shadow.
    pub shadows: Vec<Vec<HalfPlane>>,
    /// Bodies whose shadows cut the polygon at hand.
    cutting: Vec<usize>,
    part: Vec<DVec2>,
    other: Vec<DVec2>,
    pieces: Pieces,
    next: Pieces,
}

/// `a u + b v + c >= 0`.
#[derive(Clone, Copy)]
pub(super) struct HalfPlane {
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

impl HalfPlane {
    pub fn at(&self, p: DVec2) -> f64 {
        self.a * p.x + self.b * p.y + self.c
    }
}

/// Convex polygons one after the other.
#[derive(Default)]
struct Pieces {
    points: Vec<DVec2>,
    ends: Vec<usize>,
}

impl Pieces {
    fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    fn push(&mut self, polygon: &[DVec2]) {
        self.points.extend_from_slice(polygon);
        self.ends.push(self.points.len());
    }

    fn get(&self, k: usize) -> &[DVec2] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.points[start..self.ends[k]]
    }
}

impl View {
    /// `2 pi` times the form factor from the point `x` of the domain to the part of the target that the bodies hide.
    pub fn hidden(&self, x: DVec3, scratch: &mut Scratch) -> f64 {
        if self.cast_shadows(x, scratch) {
            return self.lambert(x, &self.target);
        }
        self.in_shadow(x, &self.target, scratch)
    }

    /// The shadows that the bodies throw from `x` on the target; true where one of them hides all of it.
    pub fn cast_shadows(&self, x: DVec3, scratch: &mut Scratch) -> bool {
        scratch.shadows.resize_with(self.bodies.len(), Vec::new);
        let slack = EDGE_ON * self.extent;
        let all = self.bodies.iter().zip(&mut scratch.shadows);
        // Whatever the others hide, the one that hides all does too.
        all.fold(false, |hidden, (body, shadow)| body.shadow(x, &self.target, slack, shadow) == Shadow::Hides || hidden)
    }

    /// `2 pi` times the form factor from `x` to the part of a polygon on the target that lies in the shadows cast.
    pub fn in_shadow(&self, x: DVec3, polygon: &[DVec2], scratch: &mut Scratch) -> f64 {
        scratch.in_shadow(x, self.normal, polygon)
    }

    /// Lambert's sum over a polygon in the target's plane: `2 pi` times the form factor.
    pub fn lambert(&self, x: DVec3, polygon: &[DVec2]) -> f64 {
        lambert(x, self.normal, polygon)
    }
}

impl Scratch {
    /// `2 pi` times the form factor from `x`, with this normal, to the part of a polygon in the plane z = 0 that lies in
    /// the shadows.
    pub fn in_shadow(&mut self, x: DVec3, normal: DVec3, polygon: &[DVec2]) -> f64 {
        let scratch = self;
        scratch.cutting.clear();
        for (k, shadow) in scratch.shadows.iter_mut().enumerate().filter(|(_, s)| !s.is_empty()) {
            match lies(polygon, shadow) {
                Shadow::Misses => {}
                Shadow::Hides => return lambert(x, normal, polygon),
                Shadow::Cuts => scratch.cutting.push(k),
            }
        }
        let mut sum = 0.0;
        for n in 0..scratch.cutting.len() {
            scratch.part.clear();
            scratch.part.extend_from_slice(polygon);
            let shadow = &scratch.shadows[scratch.cutting[n]];
            if !cut_to(&mut scratch.part, &mut scratch.other, shadow) {
                continue;
            }
            if n == 0 {
                sum += lambert(x, normal, &scratch.part);
                continue;
            }
            scratch.pieces.clear();
            scratch.pieces.push(&scratch.part);
            for k in &scratch.cutting[..n] {
                let earlier = &scratch.shadows[*k];
                scratch.next.clear();
                for piece in 0..scratch.pieces.ends.len() {
                    let polygon = scratch.pieces.get(piece);
                    subtract(polygon, earlier, &mut scratch.part, &mut scratch.other, &mut scratch.next);
                }
                std::mem::swap(&mut scratch.pieces, &mut scratch.next);
            }
            for piece in 0..scratch.pieces.ends.len() {
                sum += lambert(x, normal, scratch.pieces.get(piece));
            }
        }
        sum
    }
}

/// Lambert's sum over a polygon in the plane z = 0 from a point before it with this normal: `2 pi` times the form factor.
pub(super) fn lambert(x: DVec3, normal: DVec3, polygon: &[DVec2]) -> f64 {
    let (foot, h) = (x.truncate(), x.z);
    let mut sum = 0.0;
    let mut a = polygon[polygon.len() - 1] - foot;
    for p in polygon {
        let b = *p - foot;
        let cross = DVec3::new(h * (b.y - a.y), h * (a.x - b.x), a.perp_dot(b));
        let sine = cross.length();
        if sine > 0.0 {
            sum -= sine.atan2(a.dot(b) + h * h) * cross.dot(normal) / sine;
        }
        a = b;
    }
    sum
}

/// How a shadow lies to the target.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Shadow {
    Misses,
    Hides,
    Cuts,
}

impl Body {
    /// Half-planes whose common part this body hides from `x`, as far as they cut the target.
    fn shadow(&self, x: DVec3, target: &[DVec2], slack: f64, out: &mut Vec<HalfPlane>) -> Shadow {
        out.clear();
        let mut seen = 0u64;
        // Of a plate seen edge-on, within what its corners are out of its plane, nobody can tell on which side of its
        // edges it lies.
        let above = if self.is_flat { slack.max(self.warp * self.centre.distance(x)) } else { 0.0 };
        for (k, plane) in self.planes.iter().enumerate() {
            if plane.height(x) > above {
                seen |= 1 << (k & 63);
            }
        }
        if seen == 0 {
            // In the plane of a plate, or within a solid, whose walls are black from inside.
            return if self.is_flat { Shadow::Misses } else { Shadow::Hides };
        }
        let inwards = self.centre - x;
        for e in &self.edges {
            if (seen >> (e.left & 63) & 1) == (seen >> (e.right & 63) & 1) {
                continue;
            }
            let (a, b) = (self.vertices[e.ends[0] as usize] - x, self.vertices[e.ends[1] as usize] - x);
            let mut normal = a.cross(b);
            if normal.dot(inwards) < 0.0 {
                normal = -normal;
            }
            let half_plane = HalfPlane { a: normal.x, b: normal.y, c: -normal.dot(x) };
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for p in target {
                let h = half_plane.at(*p);
                low = low.min(h);
                high = high.max(h);
            }
            if high <= 0.0 {
                out.clear();
                return Shadow::Misses;
            }
            if low < 0.0 {
                out.push(half_plane);
            }
        }
        if out.is_empty() { Shadow::Hides } else { Shadow::Cuts }
    }
}

/// How the common part of half-planes lies to a convex polygon. A shadow that passes a corner by may count as cutting.
/// A half-plane with the polygon on its far side comes first from then on: it will tell of the next polygon too.
pub(super) fn lies(polygon: &[DVec2], shadow: &mut [HalfPlane]) -> Shadow {
    let mut hides = true;
    for k in 0..shadow.len() {
        let h = shadow[k];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in polygon {
            let at = h.at(*p);
            low = low.min(at);
            high = high.max(at);
        }
        if high <= 0.0 {
            shadow.swap(0, k);
            return Shadow::Misses;
        }
        hides &= low >= 0.0;
    }
    if hides { Shadow::Hides } else { Shadow::Cuts }
}

/// Cuts a polygon to half-planes; false if nothing of it is left.
fn cut_to(polygon: &mut Vec<DVec2>, other: &mut Vec<DVec2>, half_planes: &[HalfPlane]) -> bool {
    for h in half_planes {
        cut(polygon, h, 1.0, other);
        std::mem::swap(polygon, other);
        if polygon.len() < 3 {
            return false;
        }
    }
    true
}

/// The part of a polygon with `sign * h >= 0`.
fn cut(polygon: &[DVec2], h: &HalfPlane, sign: f64, out: &mut Vec<DVec2>) {
    out.clear();
    let Some(last) = polygon.last() else { return };
    let (mut a, mut ha) = (*last, sign * h.at(*last));
    for p in polygon {
        let (b, hb) = (*p, sign * h.at(*p));
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            out.push(a.lerp(b, ha / (ha - hb)));
        }
        if hb >= 0.0 {
            out.push(b);
        }
        (a, ha) = (b, hb);
    }
}

/// Appends the convex pieces of `polygon` outside of a shadow.
fn subtract(polygon: &[DVec2], shadow: &[HalfPlane], part: &mut Vec<DVec2>, other: &mut Vec<DVec2>, out: &mut Pieces) {
    // Most shadows miss most pieces: one half-plane with the piece on its far side tells.
    if shadow.iter().any(|h| polygon.iter().all(|p| h.at(*p) <= 0.0)) {
        out.push(polygon);
        return;
    }
    let (points, ends) = (out.points.len(), out.ends.len());
    part.clear();
    part.extend_from_slice(polygon);
    for h in shadow {
        cut(part, h, -1.0, other);
        if other.len() >= 3 {
            out.push(other);
        }
        cut(part, h, 1.0, other);
        std::mem::swap(part, other);
        if part.len() < 3 {
            out.points.truncate(points);
            out.ends.truncate(ends);
            out.push(polygon);
            return;
        }
    }
}
