//! Free edges gathered into openings, and which of them a ray leaves through.

use super::skin::{FreeEdge, Skin};
use crate::math::{Bounds, DMat3, DVec3};

/// Free edges that hang together.
#[derive(Debug, Clone)]
pub(super) struct Opening {
    /// Facets whose edges they are, each once.
    pub facets: Vec<u32>,
    /// Length of the border, metres.
    pub length: f64,
    /// Middle of the border.
    pub centre: DVec3,
    /// Widest crack, metres, if nothing but cracks.
    pub crack: Option<f64>,
    edges: Vec<(DVec3, DVec3)>,
    /// Plane of the opening (axes and normal) and its outline there, counter-clockwise.
    axes: [DVec3; 3],
    outline: Vec<[f64; 2]>,
}

/// Openings that escaping rays are told apart by: the longest; shorter ones are counted with their neighbours.
const MOST: usize = 32;
/// Border edges up to which the distance of a ray is measured edge by edge.
const FEW_EDGES: usize = 64;

/// The longest openings, in order of their first free edge.
pub(super) fn openings(skin: &Skin) -> Vec<Opening> {
    let mut all: Vec<Opening> = clusters(skin).into_iter().map(|edges| Opening::new(&edges)).collect();
    if all.len() > MOST {
        let mut lengths: Vec<f64> = all.iter().map(|o| o.length).collect();
        lengths.sort_by(|a, b| b.total_cmp(a));
        all.retain(|o| o.length >= lengths[MOST - 1]);
        all.truncate(MOST);
    }
    all
}

/// Free edges joined where their ends are near each other.
fn clusters(skin: &Skin) -> Vec<Vec<FreeEdge>> {
    let free = &skin.free;
    let reach = free.iter().filter_map(|e| e.crack).fold(8.0 * skin.tolerance, f64::max) * 2.0;
    let mut ends: Vec<(DVec3, usize)> = free.iter().enumerate().flat_map(|(k, e)| [(e.from, k), (e.to, k)]).collect();
    ends.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)));
    let mut root: Vec<usize> = (0..free.len()).collect();
    for (i, (p, a)) in ends.iter().enumerate() {
        for (q, b) in ends[i + 1..].iter().take_while(|(q, _)| q.x - p.x <= reach) {
            if p.distance(*q) <= reach {
                let (a, b) = (find(&mut root, *a), find(&mut root, *b));
                root[a.max(b)] = a.min(b);
            }
        }
    }
    let mut groups: Vec<Vec<FreeEdge>> = vec![Vec::new(); free.len()];
    for (k, e) in free.iter().enumerate() {
        groups[find(&mut root, k)].push(*e);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

pub(super) fn find(root: &mut [usize], mut k: usize) -> usize {
    while root[k] != k {
        root[k] = root[root[k]];
        k = root[k];
    }
    k
}

impl Opening {
    fn new(free: &[FreeEdge]) -> Self {
        let edges: Vec<(DVec3, DVec3)> = free.iter().map(|e| (e.from, e.to)).collect();
        let length: f64 = edges.iter().map(|(a, b)| a.distance(*b)).sum();
        let centre = edges.iter().map(|(a, b)| a.midpoint(*b) * (a.distance(*b) / length)).sum();
        let mut facets: Vec<u32> = free.iter().map(|e| e.facet).collect();
        facets.sort_unstable();
        facets.dedup();
        let widths: Option<Vec<f64>> = free.iter().map(|e| e.crack).collect();
        let crack = widths.map(|w| w.into_iter().fold(0.0, f64::max));
        let axes = plane_of(&edges, centre);
        let flat = |p: &DVec3| [(*p - centre).dot(axes[0]), (*p - centre).dot(axes[1])];
        let outline = hull(edges.iter().flat_map(|(a, b)| [flat(a), flat(b)]).collect());
        Self { facets, length, centre, crack, edges, axes, outline }
    }

    /// Largest extents of the border along x, y and z, metres.
    pub(super) fn extent(&self) -> DVec3 {
        let points: Vec<DVec3> = self.edges.iter().flat_map(|(a, b)| [*a, *b]).collect();
        let b = Bounds::of(&points);
        b.hi - b.lo
    }

    /// True if a ray goes through the outline.
    fn is_crossed(&self, origin: DVec3, direction: DVec3) -> bool {
        let speed = direction.dot(self.axes[2]);
        let t = (self.centre - origin).dot(self.axes[2]) / speed;
        let p = origin + direction * t - self.centre;
        speed.abs() > 1e-9 && t > 0.0 && inside(&self.outline, [p.dot(self.axes[0]), p.dot(self.axes[1])])
    }

    /// How far a ray misses the border, metres.
    fn miss(&self, origin: DVec3, direction: DVec3) -> f64 {
        if self.edges.len() > FEW_EDGES {
            return ray_to_segment(origin, direction, self.centre, self.centre);
        }
        self.edges.iter().map(|(a, b)| ray_to_segment(origin, direction, *a, *b)).fold(f64::INFINITY, f64::min)
    }
}

/// Number of the opening that an escaping ray leaves through, or passes nearest to.
pub(super) fn left_through(openings: &[Opening], origin: DVec3, direction: DVec3) -> Option<usize> {
    let crossed: Vec<usize> = match openings {
        [_] => return Some(0),
        _ => (0..openings.len()).filter(|k| openings[*k].is_crossed(origin, direction)).collect(),
    };
    let among = match crossed[..] {
        [one] => return Some(one),
        [] => (0..openings.len()).collect(),
        _ => crossed,
    };
    let misses = among.into_iter().map(|k| (k, openings[k].miss(origin, direction)));
    misses.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}

/// Axes of the plane nearest to all edges: the third is the direction of least spread.
fn plane_of(edges: &[(DVec3, DVec3)], centre: DVec3) -> [DVec3; 3] {
    let mut spread = DMat3::ZERO;
    for p in edges.iter().flat_map(|(a, b)| [*a - centre, *b - centre, a.midpoint(*b) - centre]) {
        spread += DMat3::from_cols(p * p.x, p * p.y, p * p.z);
    }
    let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
    // The largest axis of what is left when the spread is taken from a multiple of one is that of least spread.
    let least = largest_axis(DMat3::from_diagonal(DVec3::splat(trace.max(f64::MIN_POSITIVE))) - spread);
    let x = least.any_orthonormal_vector();
    [x, least.cross(x), least]
}

fn largest_axis(m: DMat3) -> DVec3 {
    let mut square = m;
    for _ in 0..40 {
        square *= square;
        let size = square.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        if size == 0.0 {
            return DVec3::Z;
        }
        square *= 1.0 / size;
    }
    let columns = [square.x_axis, square.y_axis, square.z_axis];
    let longest = columns.into_iter().max_by(|a, b| a.length().total_cmp(&b.length())).unwrap_or(DVec3::Z);
    longest.normalize_or(DVec3::Z)
}

/// Convex hull, counter-clockwise.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn inside(outline: &[[f64; 2]], p: [f64; 2]) -> bool {
    outline.len() > 2 && (0..outline.len()).all(|k| turn(outline[k], outline[(k + 1) % outline.len()], p) >= 0.0)
}

/// Least distance between a ray and a segment.
fn ray_to_segment(origin: DVec3, direction: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (along, from) = (b - a, origin - a);
    let (l2, mixed) = (along.length_squared(), direction.dot(along));
    let denominator = l2 - mixed * mixed;
    let free =
        if denominator > 1e-12 * l2 { (from.dot(along) - mixed * from.dot(direction)) / denominator } else { 0.0 };
    let off = |s: f64| {
        let p = a + along * s;
        let t = (p - origin).dot(direction).max(0.0);
        p.distance(origin + direction * t)
    };
    // The unbounded answer may ask for a point behind the ray: then an end, or what is nearest to its origin, is.
    let beside = if l2 > 0.0 { (from.dot(along) / l2).clamp(0.0, 1.0) } else { 0.0 };
    [free.clamp(0.0, 1.0), 0.0, 1.0, beside].into_iter().map(off).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{cube, stage};
    use super::*;

    #[test]
    fn rays_leave_through_the_hole_they_are_aimed_at() {
        let mut faces = cube(DVec3::ZERO, 1.0);
        faces.remove(5);
        faces.remove(1);
        // A plate in the room: free edges, but nothing leaves there.
        faces
            .push([[0.4, 0.4, 0.5], [0.6, 0.4, 0.5], [0.6, 0.6, 0.5], [0.4, 0.6, 0.5]].map(DVec3::from_array).to_vec());
        let openings = openings(&Skin::of(&stage(&faces)));
        // The two holes share an edge's ends, so they are one opening; the plate is another.
        assert_eq!(openings.len(), 2);
        let through = |p: [f64; 3], d: [f64; 3]| {
            left_through(&openings, DVec3::from_array(p), DVec3::from_array(d).normalize()).expect("openings")
        };
        let plate = usize::from(openings[0].length > 2.0);
        assert_eq!(through([0.1, 0.1, 0.0], [0.0, 0.0, 1.0]), 1 - plate);
        assert!(openings[plate].extent().distance(DVec3::new(0.2, 0.2, 0.0)) < 1e-12);
    }

    #[test]
    fn distances_to_segments() {
        let seg = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0));
        assert!((ray_to_segment(DVec3::new(1.0, 0.0, 3.0), -DVec3::Z, seg.0, seg.1) - 1.0).abs() < 1e-12);
        assert!((ray_to_segment(DVec3::new(1.0, 0.0, 3.0), DVec3::Z, seg.0, seg.1) - 10f64.sqrt()).abs() < 1e-12);
        assert!((ray_to_segment(DVec3::new(-1.0, 1.0, 0.0), DVec3::X, seg.0, seg.1)).abs() < 1e-12);
    }
}
