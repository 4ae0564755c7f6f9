//! The same form factors a second way, sharing nothing but vectors and bodies with the first: shadows are hulls of
//! projected corners, taken off the receiver in its own plane piece by piece, and the patch is halved
//! where the integrand asks for it. Nothing is known here of where kinks lie.

use super::body::Body;
use super::geometry::{Plane, Vector, along, area, cross, dot, in_front, length, plane_of, sub, unit};
use super::quadrature::Integral;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;

type Point = [f64; 2];
type Quad = [Vector; 4];

/// Times every quad is divided before the estimates of error are listened to: they miss what is smaller than a quad.
const EVENLY_DIVIDED: usize = 4;

const NODES: [f64; 5] =
    [0.046_910_077_030_668, 0.230_765_344_947_158_45, 0.5, 0.769_234_655_052_841_5, 0.953_089_922_969_332];
const WEIGHTS: [f64; 5] = [
    0.118_463_442_528_094_54,
    0.239_314_335_249_683_24,
    0.284_444_444_444_444_44,
    0.239_314_335_249_683_24,
    0.118_463_442_528_094_54,
];

/// The form factor of `sender` to `receiver` with `bodies` between. The error is the sum over all quads of what
/// halving each once more changed, so that it is large rather than small.
pub fn form_factor(
    sender: &[Vector],
    receiver: &[Vector],
    bodies: &[Body],
    tolerance: f64,
    most_quads: usize,
) -> Integral {
    let (front, facing) = (plane_of(sender), plane_of(receiver));
    let (from, to) = (in_front(sender, &facing), in_front(receiver, &front));
    if from.is_empty() || to.is_empty() {
        return Integral::default();
    }
    let relevant = |b: &Body| b.in_front(&facing).and_then(|b| b.in_front(&front));
    let view = View::new(&to, facing, front.normal, bodies.iter().filter_map(relevant).collect());
    let mut first = quads(&from);
    for _ in 0..EVENLY_DIVIDED {
        first = first.iter().flat_map(|q| halves(q)[0]).flat_map(|q| halves(&q)[1]).collect();
    }
    let mut heap: BinaryHeap<Part> = first.into_iter().map(|q| Part::new(q, rule(&q, &view), &view)).collect();
    let whole = area(sender);
    let mut error: f64 = heap.iter().map(|p| p.error).sum();
    while error > tolerance * whole && heap.len() < most_quads {
        let Some(worst) = heap.pop() else { break };
        error -= worst.error;
        for (quad, value) in worst.halves {
            let part = Part::new(quad, value, &view);
            error += part.error;
            heap.push(part);
        }
    }
    let sum = |f: fn(&Part) -> f64| heap.iter().map(f).sum::<f64>() / whole;
    Integral { value: sum(|p| p.halves.iter().map(|q| q.1).sum()), error: sum(|p| p.error) }
}

/// A quad with the values of its halves, cut the way that changes its value more.
struct Part {
    halves: [(Quad, f64); 2],
    error: f64,
}

impl Part {
    fn new(quad: Quad, value: f64, view: &View) -> Self {
        let cuts = halves(&quad).map(|cut| {
            let halves = cut.map(|q| (q, rule(&q, view)));
            Self { error: (halves[0].1 + halves[1].1 - value).abs(), halves }
        });
        let [across, along] = cuts;
        if across.error >= along.error { across } else { along }
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error)
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

/// A convex polygon as quads: itself, or three for each triangle of its fan.
fn quads(polygon: &[Vector]) -> Vec<Quad> {
    if let &[a, b, c, d] = polygon {
        return vec![[a, b, c, d]];
    }
    let fan = (1..polygon.len() - 1).map(|k| [polygon[0], polygon[k], polygon[k + 1]]);
    fan.flat_map(|t| {
        let middle = t.iter().fold([0.0; 3], |m, &c| along(m, 1.0 / 3.0, c));
        [0, 1, 2].map(|k| [t[k], half(t[k], t[(k + 1) % 3]), middle, half(t[k], t[(k + 2) % 3])])
    })
    .collect()
}

fn half(a: Vector, b: Vector) -> Vector {
    along(a, 0.5, sub(b, a))
}

/// A quad cut in two, either way.
fn halves(&[a, b, c, d]: &Quad) -> [[Quad; 2]; 2] {
    let (ab, bc, cd, da) = (half(a, b), half(b, c), half(c, d), half(d, a));
    [[[a, ab, cd, d], [ab, b, c, cd]], [[a, b, bc, da], [da, bc, c, d]]]
}

/// Five by five points of Gauss in the bilinear coordinates of a quad.
fn rule(&[a, b, c, d]: &Quad, view: &View) -> f64 {
    let mut sum = 0.0;
    for (s, ws) in NODES.iter().zip(WEIGHTS) {
        let (low, high) = (along(a, *s, sub(b, a)), along(d, *s, sub(c, d)));
        for (t, wt) in NODES.iter().zip(WEIGHTS) {
            let x = along(low, *t, sub(high, low));
            let by_s = along(sub(b, a), *t, sub(sub(c, d), sub(b, a)));
            sum += ws * wt * length(cross(by_s, sub(high, low))) * view.factor(x);
        }
    }
    sum
}

/// What is looked at, in coordinates of the receiver's plane.
struct View {
    target: Vec<Point>,
    origin: Vector,
    axes: [Vector; 2],
    plane: Plane,
    normal: Vector,
    bodies: Vec<Body>,
}

impl View {
    fn new(target: &[Vector], plane: Plane, normal: Vector, bodies: Vec<Body>) -> Self {
        let first = unit(sub(target[1], target[0]));
        let axes = [first, cross(plane.normal, first)];
        let mut view = Self { target: Vec::new(), origin: target[0], axes, plane, normal, bodies };
        view.target = target.iter().map(|&c| view.flat(c)).collect();
        view
    }

    fn flat(&self, c: Vector) -> Point {
        let d = sub(c, self.origin);
        [dot(d, self.axes[0]), dot(d, self.axes[1])]
    }

    fn factor(&self, x: Vector) -> f64 {
        let mut pieces = vec![self.target.clone()];
        for body in &self.bodies {
            let shadow = self.shadow(body, x);
            if shadow.len() >= 3 {
                pieces = pieces.into_iter().flat_map(|p| without(p, &shadow)).collect();
            }
        }
        pieces.iter().map(|p| self.lambert(p, x)).sum()
    }

    /// The hull of a body's corners projected from `x`; what rises to the height of `x` is cut off just below it.
    fn shadow(&self, body: &Body, x: Vector) -> Vec<Point> {
        let top = self.plane.height(x);
        let ceiling = Plane { normal: self.plane.normal, offset: self.plane.offset + top * (1.0 - 1e-9) }.turned();
        let project = |c: Vector| self.flat(along(x, top / (top - self.plane.height(c)), sub(c, x)));
        if body.corners.iter().all(|&c| ceiling.height(c) > 0.0) {
            return hull(body.corners.iter().map(|&c| project(c)).collect());
        }
        let cut = body.faces().iter().flat_map(|f| in_front(f, &ceiling));
        hull(cut.filter(|&c| ceiling.height(c) >= -1e-11).map(project).collect())
    }

    fn lambert(&self, piece: &[Point], x: Vector) -> f64 {
        let at = |p: Point| sub(along(along(self.origin, p[0], self.axes[0]), p[1], self.axes[1]), x);
        let mut sum = 0.0;
        for k in 0..piece.len() {
            let (a, b) = (at(piece[k]), at(piece[(k + 1) % piece.len()]));
            let across = cross(b, a);
            let sine = length(across);
            if sine > 0.0 {
                sum += sine.atan2(dot(a, b)) / sine * dot(across, self.normal);
            }
        }
        sum / TAU
    }
}

/// Positive where `c` lies to the left of the line from `a` to `b`.
fn left_of(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The convex hull, counter-clockwise; empty without an area.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut chain: Vec<Point> = Vec::with_capacity(points.len() + 1);
    for upper in [false, true] {
        let start = chain.len();
        for k in 0..points.len() {
            let p = points[if upper { points.len() - 1 - k } else { k }];
            while chain.len() >= start + 2 && left_of(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
    }
    if chain.len() < 3 { Vec::new() } else { chain }
}

/// The convex pieces of `piece` outside of a convex polygon.
fn without(piece: Vec<Point>, hole: &[Point]) -> Vec<Vec<Point>> {
    let side = |k: usize| (hole[k], hole[(k + 1) % hole.len()]);
    let apart = (0..hole.len()).any(|k| piece.iter().all(|&c| left_of(side(k).0, side(k).1, c) <= 0.0));
    if apart {
        return vec![piece];
    }
    let (mut pieces, mut rest) = (Vec::new(), piece);
    for (a, b) in (0..hole.len()).map(side) {
        let outside = cut(&rest, b, a);
        rest = cut(&rest, a, b);
        if outside.len() >= 3 {
            pieces.push(outside);
        }
        if rest.len() < 3 {
            break;
        }
    }
    pieces
}

/// The part of a convex polygon to the left of a line.
fn cut(polygon: &[Point], a: Point, b: Point) -> Vec<Point> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for k in 0..polygon.len() {
        let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let (s, t) = (left_of(a, b, p), left_of(a, b, q));
        if s >= 0.0 {
            kept.push(p);
        }
        if s * t < 0.0 {
            let u = s / (s - t);
            kept.push([p[0] + u * (q[0] - p[0]), p[1] + u * (q[1] - p[1])]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_agrees_with_the_sweep_where_three_skew_edges_meet() {
        let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let ceiling = [[0.1, 0.0, 1.0], [0.0, 1.0, 1.1], [1.0, 0.6, 1.3]];
        let plates = [
            Body::plate(&[[0.2, 0.3, 0.3], [0.8, 0.2, 0.5], [0.7, 0.8, 0.4]]),
            Body::plate(&[[0.4, 0.1, 0.6], [0.9, 0.5, 0.8], [0.5, 0.9, 0.7], [0.1, 0.5, 0.55]]),
        ];
        let sweep = super::super::pair::form_factor(&floor, &ceiling, &plates[..1], 1e-10);
        let brute = form_factor(&floor, &ceiling, &plates[..1], 1e-7, 20_000);
        assert!((sweep.value - brute.value).abs() < 1e-8, "{sweep:?} {brute:?}");
        let sweep = super::super::pair::form_factor(&floor, &ceiling, &plates, 1e-9);
        let brute = form_factor(&floor, &ceiling, &plates, 1e-6, 20_000);
        assert!((sweep.value - brute.value).abs() < 1e-7, "{sweep:?} {brute:?}");
    }
}
