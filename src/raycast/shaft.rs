//! What stands between two convex polygons: a proof that nothing does, that one body hides all, or the list of those
//! that may hide something.

use crate::math::{DVec3, Plane, Polytope};

/// What is known of the space between two polygons.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Between {
    /// Nothing stands there: every point of one sees every point of the other.
    Nothing,
    /// One body stands before all of it: no point of one sees a point of the other.
    Wall,
    /// These bodies, by number, may stand there; no others do.
    Some(Vec<u32>),
}

/// The convex hull of two polygons, each in front of the other, by its planes: normals inwards.
#[derive(Debug, Clone)]
pub struct Shaft {
    planes: Vec<Plane>,
    corners: [Vec<DVec3>; 2],
    slack: f64,
}

impl Shaft {
    /// The shaft between two convex polygons, each wholly in front of the other. What reaches into it by no more than
    /// `slack` (m) counts as touching.
    pub fn new(a: &[DVec3], b: &[DVec3], slack: f64) -> Self {
        let mut planes = Vec::with_capacity(2 + a.len() + b.len());
        for (one, other) in [(a, b), (b, a)] {
            let face = Plane::of(one);
            planes.push(face);
            for k in 0..one.len() {
                let plane = supporting(one[k], one[(k + 1) % one.len()], face.normal, other);
                // Believed only as far as it holds: rounding near degenerate corners must not prove anything.
                planes.extend(plane.filter(|p| a.iter().chain(b).all(|v| p.height(*v) >= -slack)));
            }
        }
        Self { planes, corners: [a.to_vec(), b.to_vec()], slack }
    }

    /// Which of the candidates stand in the shaft.
    pub fn between<'a>(&self, bodies: &'a [Polytope], candidates: impl Iterator<Item = u32> + 'a) -> Between {
        let mut found = Vec::new();
        for k in candidates {
            let body = &bodies[k as usize];
            if self.misses(body) {
                continue;
            }
            if self.is_walled_by(body) {
                return Between::Wall;
            }
            found.push(k);
        }
        if found.is_empty() { Between::Nothing } else { Between::Some(found) }
    }

    /// True if a plane proves that the body hides nothing: it lies on the far side of the shaft's, or the shaft on
    /// the far side of its own.
    pub fn misses(&self, body: &Polytope) -> bool {
        let beyond = |plane: &Plane| body.vertices().iter().all(|v| plane.height(*v) <= self.slack);
        let clear = |plane: &Plane| self.corners.iter().flatten().all(|v| plane.height(*v) >= -self.slack);
        self.planes.iter().any(beyond) || body.planes().iter().any(clear)
    }

    /// True if every segment from corner to corner meets the body, and so, both being convex, every segment.
    pub fn is_walled_by(&self, body: &Polytope) -> bool {
        self.corners[0].iter().all(|p| self.corners[1].iter().all(|q| meets(body, *p, *q, self.slack)))
    }
}

/// The plane through an edge of one polygon that touches the other and has both on its inner side.
fn supporting(from: DVec3, to: DVec3, normal: DVec3, other: &[DVec3]) -> Option<Plane> {
    let along = (to - from).try_normalize()?;
    let inwards = normal.cross(along);
    // In the plane across the edge, the corner seen furthest outwards from the polygon's own side.
    let mut best: Option<(f64, f64)> = None;
    for q in other {
        let (u, w) = ((*q - from).dot(inwards), (*q - from).dot(normal).max(0.0));
        if best.is_none_or(|(bu, bw)| bu * w - u * bw > 0.0) {
            best = Some((u, w));
        }
    }
    let (u, w) = best?;
    let inner = (inwards * w - normal * u).try_normalize()?;
    Some(Plane { normal: inner, offset: inner.dot(from) })
}

/// Whether the segment passes through the body, by more than `slack` from its rim.
fn meets(body: &Polytope, p: DVec3, q: DVec3, slack: f64) -> bool {
    if body.is_flat() {
        return pierces(body, p, q, slack);
    }
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for plane in body.planes() {
        let (hp, hq) = (plane.height(p) + slack, plane.height(q) + slack);
        if hp > 0.0 && hq > 0.0 {
            return false;
        }
        let t = hp / (hp - hq);
        if hp > 0.0 {
            enter = enter.max(t);
        } else if hq > 0.0 {
            leave = leave.min(t);
        }
    }
    enter <= leave
}

/// Whether the segment goes through a polygon, from one side to the other.
fn pierces(body: &Polytope, p: DVec3, q: DVec3, slack: f64) -> bool {
    let plane = &body.planes()[0];
    let (hp, hq) = (plane.height(p), plane.height(q));
    if hp.min(hq) >= -slack || hp.max(hq) <= slack {
        return false;
    }
    let through = p.lerp(q, hp / (hp - hq));
    body.edges().iter().all(|e| {
        let [a, b] = e.ends.map(|v| body.vertices()[v as usize]);
        // An edge is listed in the direction of its left face; of the front, the inside lies to the left.
        let forwards = if e.left == 0 { b - a } else { a - b };
        plane.normal.cross(forwards).dot(through - a) > slack * forwards.length()
    })
}
