//! Lines of the domain where the shape of what is visible changes: between them the integrand is analytic, but for
//! curves where edges of two bodies and of the target meet in one ray.

use super::view::{Body, View};
use crate::math::{DVec2, DVec3, Plane};

/// A line `normal . p = offset` of the domain's plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub normal: DVec2,
    pub offset: f64,
}

impl Line {
    pub fn height(&self, p: DVec2) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Share of the domain's extent by which a line has to enter it.
const ENTERS: f64 = 1e-10;

/// Sines and relative heights below this are rounding.
const ROUNDING: f64 = 1e-12;

/// Collects the lines of a view.
struct Events<'a> {
    view: &'a View,
    target: Vec<DVec3>,
    enters: f64,
    lines: Vec<Line>,
}

/// The event lines that cross the domain. `together`: also those where two bodies line up.
pub(super) fn lines(view: &View, together: bool) -> Vec<Line> {
    let (lo, hi) = view.domain.iter().fold((view.domain[0], view.domain[0]), |(l, h), p| (l.min(*p), h.max(*p)));
    let mut events = Events {
        view,
        target: view.target.iter().map(|p| p.extend(0.0)).collect(),
        enters: ENTERS * (hi - lo).max_element(),
        lines: Vec::new(),
    };
    for body in &view.bodies {
        events.target_with(body);
    }
    if together {
        for (k, first) in view.bodies.iter().enumerate() {
            for second in &view.bodies[k + 1..] {
                events.corners_with_edges(first, second);
                events.corners_with_edges(second, first);
                events.parallel_edges(first, second);
            }
        }
    }
    events.lines
}

impl Events<'_> {
    /// Where corners and edges of the target line up with edges and corners of a body, and where faces turn away.
    fn target_with(&mut self, body: &Body) {
        for corner in 0..self.target.len() {
            let q = self.target[corner];
            for e in &body.edges {
                let sides = [e.left, e.right].map(|f| body.planes[f as usize].height(q) > 0.0);
                if sides[0] != sides[1] {
                    let [a, b] = e.ends.map(|v| body.vertices[v as usize]);
                    self.through(q, [a, b], [(q, a), (q, b)]);
                }
            }
            let next = self.target[(corner + 1) % self.target.len()];
            for v in 0..body.vertices.len() {
                let w = body.vertices[v];
                if self.may_be_outline(body, v as u32, q, next) {
                    self.through(w, [q, next], [(q, w), (next, w)]);
                }
            }
        }
        let enters = self.may_enter(body);
        for plane in &body.planes {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for q in &self.target {
                low = low.min(plane.height(*q));
                high = high.max(plane.height(*q));
            }
            // Also where the plane only touches the target: a board on a wall begins to hide what stands on its edge.
            let reach = ROUNDING * self.view.extent;
            if enters || (low <= reach && high >= -reach) {
                self.plane(plane.normal, plane.normal * plane.offset);
            }
        }
    }

    /// False if a face has the whole domain before it: no point of it lies within the body.
    fn may_enter(&self, body: &Body) -> bool {
        let view = self.view;
        let before = |p: &Plane| view.domain.iter().all(|c| p.height(view.point(*c)) >= -ROUNDING * view.extent);
        !body.is_flat && !body.planes.iter().any(before)
    }

    /// False if, from everywhere on the shadows that corner `v` gets from the edge `q`-`next`, all faces around the
    /// corner are seen or none is.
    fn may_be_outline(&self, body: &Body, v: u32, q: DVec3, next: DVec3) -> bool {
        let w = body.vertices[v as usize];
        let height = |p: DVec3| self.view.above_domain(p);
        if height(w) >= height(q).min(height(next)) {
            return true;
        }
        let ends = [q, next].map(|q| self.image(q, w).map(|x| self.view.point(x)));
        let [Some(a), Some(b)] = ends else { return true };
        let (mut seen, mut unseen) = (false, false);
        for e in body.edges.iter().filter(|e| e.ends.contains(&v)) {
            for face in [e.left, e.right] {
                let plane = &body.planes[face as usize];
                let (ha, hb) = (plane.height(a), plane.height(b));
                seen |= ha > 0.0 || hb > 0.0;
                unseen |= ha <= 0.0 || hb <= 0.0;
            }
        }
        seen && unseen
    }

    /// Where corners of one body line up with edges of another.
    fn corners_with_edges(&mut self, corners: &Body, edges: &Body) {
        for w in &corners.vertices {
            for e in &edges.edges {
                let sides = [e.left, e.right].map(|f| edges.planes[f as usize].height(*w) > 0.0);
                if sides[0] != sides[1] {
                    let [a, b] = e.ends.map(|v| edges.vertices[v as usize]);
                    if self.reaches_target(*w, a, b) {
                        self.through(*w, [a, b], [(*w, a), (*w, b)]);
                    }
                }
            }
        }
    }

    /// Where parallel edges of two bodies line up.
    fn parallel_edges(&mut self, first: &Body, second: &Body) {
        for e in &first.edges {
            let [a, b] = e.ends.map(|v| first.vertices[v as usize]);
            for f in &second.edges {
                let [c, d] = f.ends.map(|v| second.vertices[v as usize]);
                if (b - a).cross(d - c).length() <= ROUNDING * (b - a).length() * (d - c).length() {
                    self.plane((b - a).cross(c - a), a);
                }
            }
        }
    }

    /// False if no line through `w` and the segment meets the target.
    fn reaches_target(&self, w: DVec3, a: DVec3, b: DVec3) -> bool {
        let image = |c: DVec3| {
            let t = w.z / (w.z - c.z);
            t.is_finite().then(|| (w + (c - w) * t).truncate())
        };
        let [Some(p), Some(q)] = [a, b].map(image) else { return true };
        if (w.z > a.z) != (w.z > b.z) {
            return true;
        }
        !outside(&self.view.target, p, q)
    }

    /// Where the line from `p` through `w` meets the domain's plane, beyond both.
    fn image(&self, p: DVec3, w: DVec3) -> Option<DVec2> {
        let (hp, hw) = (self.view.above_domain(p), self.view.above_domain(w));
        let t = hp / (hp - hw);
        t.is_finite().then(|| self.view.in_domain(p + (w - p) * t))
    }

    /// The plane through a point and a segment, if the shadow that the two pairs bound reaches the domain.
    fn through(&mut self, point: DVec3, segment: [DVec3; 2], rays: [(DVec3, DVec3); 2]) {
        let ahead = |(p, w): &(DVec3, DVec3)| self.view.above_domain(*p) > self.view.above_domain(*w);
        let sides = [ahead(&rays[0]), ahead(&rays[1])];
        let images = rays.map(|(p, w)| self.image(p, w));
        if let [Some(a), Some(b)] = images
            && sides[0] == sides[1]
            && outside(&self.view.domain, a, b)
        {
            return;
        }
        self.plane((segment[0] - point).cross(segment[1] - point), point);
    }

    /// The trace of a plane in the domain, if it crosses it and is new.
    fn plane(&mut self, normal: DVec3, through: DVec3) {
        let view = self.view;
        let along = DVec2::new(normal.dot(view.axes[0]), normal.dot(view.axes[1]));
        let length = along.length();
        if length <= ROUNDING * normal.length() || length == 0.0 {
            return;
        }
        let mut line = Line { normal: along / length, offset: normal.dot(through - view.origin) / length };
        if line.normal.x < 0.0 || (line.normal.x == 0.0 && line.normal.y < 0.0) {
            line = Line { normal: -line.normal, offset: -line.offset };
        }
        let heights = view.domain.iter().map(|p| line.height(*p));
        let (low, high) = heights.fold((0.0f64, 0.0f64), |(l, h), x| (l.min(x), h.max(x)));
        if high <= self.enters || low >= -self.enters {
            return;
        }
        let same = |l: &Line| (l.normal - line.normal).length() < 1e-9 && (l.offset - line.offset).abs() < self.enters;
        if !self.lines.iter().any(same) {
            self.lines.push(line);
        }
    }
}

/// Whether a segment lies beyond one edge of a convex polygon.
fn outside(polygon: &[DVec2], a: DVec2, b: DVec2) -> bool {
    (0..polygon.len()).any(|k| {
        let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let edge = q - p;
        edge.perp_dot(a - p) <= 0.0 && edge.perp_dot(b - p) <= 0.0
    })
}
