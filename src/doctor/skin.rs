//! The skin of a scene: which edges of facets are joined to which others, and which are free.

use super::weld::Weld;
use crate::math::{Bounds, BoxTree, DVec3, unit_normal};
use crate::scene::{Facet, Stage};
use rayon::prelude::*;

/// Corners closer than this share of the diagonal are one: what single-precision coordinates can hold.
const WELD: f64 = 2e-7;
/// A neighbour closer than this share of the diagonal was meant to touch.
const NEAR: f64 = 2e-3;

/// How the facets of a stage hang together.
pub(super) struct Skin {
    /// Distance within which points are one, metres.
    pub tolerance: f64,
    /// Diagonal of the stage, metres.
    pub diagonal: f64,
    /// Pairs of facets joined along an edge, each once per common stretch.
    pub links: Vec<Link>,
    /// Stretches of edges that touch nothing.
    pub free: Vec<FreeEdge>,
    /// Corners inside edges of others.
    pub junctions: Vec<Junction>,
}

/// Two one-sided facets that share a stretch of an edge, and nobody else does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    pub facets: [u32; 2],
    /// True if the edge runs in opposite directions round them: both fronts on one side of the skin.
    pub agree: bool,
}

/// A stretch of an edge that touches no other facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeEdge {
    pub facet: u32,
    pub from: DVec3,
    pub to: DVec3,
    /// Distance to a facet so near that it was meant to touch, metres.
    pub crack: Option<f64>,
}

/// A corner of one facet inside an edge of another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Junction {
    /// Facet whose edge it is.
    pub edge_of: u32,
    /// Facet whose corner it is.
    pub corner_of: u32,
    pub point: DVec3,
    /// Distance of the corner from the edge, metres.
    pub off: f64,
}

/// An edge: corner `corner` of the facet to the next.
#[derive(Clone, Copy)]
struct Edge {
    ends: [u32; 2],
    facet: u32,
    corner: u32,
    forward: bool,
}

impl Skin {
    pub(super) fn of(stage: &Stage) -> Self {
        let (lo, hi) = stage.bounds();
        let diagonal = lo.distance(hi);
        let tolerance = WELD * diagonal;
        let mut edges = edges(stage, tolerance);
        edges.sort_unstable_by_key(|e| (e.ends, e.facet, e.corner));
        let mut skin = Self { tolerance, diagonal, links: Vec::new(), free: Vec::new(), junctions: Vec::new() };
        let mut single = Vec::new();
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            match group {
                [one] => single.push(*one),
                [a, b] => skin.link(stage, a, b),
                _ => {}
            }
        }
        skin.join_single(stage, &single);
        skin
    }

    fn link(&mut self, stage: &Stage, a: &Edge, b: &Edge) {
        let one_sided = |e: &Edge| stage.facets[e.facet as usize].first_back_patch.is_none();
        if one_sided(a) && one_sided(b) && a.facet != b.facet {
            self.links.push(Link { facets: [a.facet, b.facet], agree: a.forward != b.forward });
        }
    }

    /// Edges that share both ends with no other: what do they lie on?
    fn join_single(&mut self, stage: &Stage, single: &[Edge]) {
        let near = NEAR * self.diagonal;
        let boxes = stage.facets.iter().map(|f| Bounds::of(&f.vertices)).collect();
        let search = Search { stage, tree: BoxTree::new(boxes), tolerance: self.tolerance, near };
        let joined: Vec<Joined> = single.par_iter().map(|e| search.join(e)).collect();
        for j in joined {
            self.links.extend(j.links);
            self.free.extend(j.free);
            self.junctions.extend(j.junctions);
        }
    }
}

fn edges(stage: &Stage, tolerance: f64) -> Vec<Edge> {
    let mut weld = Weld::new(tolerance);
    let mut edges = Vec::new();
    for (facet, f) in (0..).zip(&stage.facets) {
        let numbers: Vec<u32> = f.vertices.iter().map(|v| weld.number(*v)).collect();
        for (corner, a) in (0..).zip(&numbers) {
            let b = &numbers[(corner as usize + 1) % numbers.len()];
            if a != b {
                edges.push(Edge { ends: [*a.min(b), *a.max(b)], facet, corner, forward: a < b });
            }
        }
    }
    edges
}

/// What one edge is joined to.
#[derive(Default)]
struct Joined {
    links: Vec<Link>,
    free: Vec<FreeEdge>,
    junctions: Vec<Junction>,
}

/// A stretch of an edge that lies on another facet: begin and end as shares of the edge.
struct Touch {
    facet: u32,
    begin: f64,
    end: f64,
    /// Direction of the other's edge along this one, where it runs along one.
    along: Option<bool>,
}

struct Search<'a> {
    stage: &'a Stage,
    tree: BoxTree,
    tolerance: f64,
    near: f64,
}

impl Search<'_> {
    fn join(&self, edge: &Edge) -> Joined {
        let corners = &self.stage.facets[edge.facet as usize].vertices;
        let (p, q) = (corners[edge.corner as usize], corners[(edge.corner as usize + 1) % corners.len()]);
        let mut around = Vec::new();
        self.tree.near(&Bounds::of(&[p, q]).grown(self.near), |g| {
            if g != edge.facet {
                around.push(g);
            }
        });
        around.sort_unstable();
        let touches: Vec<Touch> = around.iter().filter_map(|g| self.touch(p, q, *g)).collect();
        let mut joined = Joined::default();
        self.add_links(edge, &touches, &mut joined);
        self.add_junctions(edge, (p, q), &touches, &mut joined);
        for (begin, end) in uncovered(&touches, self.tolerance / p.distance(q)) {
            let (from, to) = (p.lerp(q, begin), p.lerp(q, end));
            let crack = self.crack(edge.facet, from, to, &around);
            joined.free.push(FreeEdge { facet: edge.facet, from, to, crack });
        }
        joined
    }

    /// The stretch of `p..q` that lies on facet `g`.
    fn touch(&self, p: DVec3, q: DVec3, g: u32) -> Option<Touch> {
        let facet = &self.stage.facets[g as usize];
        let (mut begin, mut end) = (0.0, 1.0);
        let slack = self.tolerance;
        let offset = facet.normal.dot(facet.vertices[0]);
        for n in [facet.normal, -facet.normal] {
            let d = if n == facet.normal { offset } else { -offset };
            clip(n.dot(p) - d + slack, n.dot(q) - d + slack, &mut begin, &mut end);
        }
        for (a, b) in sides(facet) {
            let inward = facet.normal.cross(b - a).normalize_or_zero();
            clip(inward.dot(p - a) + slack, inward.dot(q - a) + slack, &mut begin, &mut end);
        }
        if (end - begin) * p.distance(q) <= 4.0 * slack {
            return None;
        }
        let ends = [p.lerp(q, begin), p.lerp(q, end)];
        let along = sides(facet).find(|(a, b)| ends.iter().all(|e| off_line(*e, *a, *b) <= 3.0 * slack));
        Some(Touch { facet: g, begin, end, along: along.map(|(a, b)| (b - a).dot(q - p) > 0.0) })
    }

    /// A link where exactly one other edge runs along, told once: by the lower of two single edges.
    fn add_links(&self, edge: &Edge, touches: &[Touch], joined: &mut Joined) {
        let one_sided = |f: u32| self.stage.facets[f as usize].first_back_patch.is_none();
        for t in touches.iter().filter(|t| edge.facet < t.facet && one_sided(edge.facet) && one_sided(t.facet)) {
            let shared = |u: &&Touch| u.begin.max(t.begin) + 1e-6 < u.end.min(t.end);
            if let (Some(same_way), 1) = (t.along, touches.iter().filter(shared).count()) {
                joined.links.push(Link { facets: [edge.facet, t.facet], agree: !same_way });
            }
        }
    }

    fn add_junctions(&self, edge: &Edge, (p, q): (DVec3, DVec3), touches: &[Touch], joined: &mut Joined) {
        let least = 4.0 * self.tolerance;
        for t in touches.iter().filter(|t| t.along.is_some()) {
            for v in &self.stage.facets[t.facet as usize].vertices {
                let inside = v.distance(p) > least && v.distance(q) > least;
                let off = off_segment(*v, p, q);
                if inside && off <= least {
                    joined.junctions.push(Junction { edge_of: edge.facet, corner_of: t.facet, point: *v, off });
                }
            }
        }
    }

    /// Distance to a facet so near that the stretch was meant to touch it. One that merely lies parallel below
    /// (a lamp under a ceiling) was not.
    fn crack(&self, facet: u32, from: DVec3, to: DVec3, around: &[u32]) -> Option<f64> {
        let middle = from.midpoint(to);
        let own = self.stage.facets[facet as usize].normal;
        let distance = |g: &u32| {
            let other = &self.stage.facets[*g as usize];
            let apart = nearest_point(middle, other) - middle;
            let hovers = own.dot(other.normal).abs() > 0.99 && own.dot(apart).abs() > 0.5 * apart.length();
            (!hovers).then_some(apart.length())
        };
        let nearest = around.iter().filter_map(distance).fold(f64::INFINITY, f64::min);
        (nearest <= self.near && nearest <= 0.25 * from.distance(to)).then_some(nearest)
    }
}

fn sides(facet: &Facet) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    let v = &facet.vertices;
    (0..v.len()).map(|k| (v[k], v[(k + 1) % v.len()])).filter(|(a, b)| a != b)
}

/// Keeps the part of `begin..end` where a function that is linear from `at_p` to `at_q` is not negative.
fn clip(at_p: f64, at_q: f64, begin: &mut f64, end: &mut f64) {
    if at_p < 0.0 && at_q < 0.0 {
        *end = *begin;
    } else if at_p < 0.0 {
        *begin = begin.max(at_p / (at_p - at_q));
    } else if at_q < 0.0 {
        *end = end.min(at_p / (at_p - at_q));
    }
}

fn off_line(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    (p - a).cross((b - a).normalize()).length()
}

fn off_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t))
}

/// The point of a facet nearest to `p`.
fn nearest_point(p: DVec3, facet: &Facet) -> DVec3 {
    let n = unit_normal(&facet.vertices);
    let inside = sides(facet).all(|(a, b)| n.cross(b - a).dot(p - a) >= 0.0);
    if inside {
        return p - n * n.dot(p - facet.vertices[0]);
    }
    let on_side = |(a, b): (DVec3, DVec3)| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        a.lerp(b, t)
    };
    let points = sides(facet).map(on_side);
    points.min_by(|x, y| x.distance(p).total_cmp(&y.distance(p))).unwrap_or(facet.vertices[0])
}

/// Stretches of 0..1 longer than a few tolerances that no touch covers.
fn uncovered(touches: &[Touch], tolerance: f64) -> Vec<(f64, f64)> {
    let mut covers: Vec<(f64, f64)> = touches.iter().map(|t| (t.begin, t.end)).collect();
    covers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = Vec::new();
    let mut at = 0.0;
    for (begin, end) in covers.into_iter().chain([(1.0, 1.0)]) {
        if begin - at > 8.0 * tolerance {
            free.push((at, begin));
        }
        at = f64::max(at, end);
    }
    free
}

#[cfg(test)]
mod tests {
    use super::super::testing::{cube, stage};
    use super::*;

    #[test]
    fn a_cube_is_closed_and_of_one_mind() {
        let skin = Skin::of(&stage(&cube(DVec3::ZERO, 1.0)));
        assert_eq!((skin.links.len(), skin.free.len(), skin.junctions.len()), (12, 0, 0));
        assert!(skin.links.iter().all(|l| l.agree));
    }

    #[test]
    fn a_face_turned_over_disagrees_with_all_its_neighbours() {
        let mut faces = cube(DVec3::ZERO, 1.0);
        faces[2].reverse();
        let skin = Skin::of(&stage(&faces));
        let odd: Vec<&Link> = skin.links.iter().filter(|l| !l.agree).collect();
        assert_eq!(odd.len(), 4);
        assert!(odd.iter().all(|l| l.facets.contains(&2)));
    }

    #[test]
    fn a_missing_face_leaves_a_free_border_and_a_near_one_a_crack() {
        let mut faces = cube(DVec3::ZERO, 1.0);
        let lid = faces.pop().expect("a face");
        let open = Skin::of(&stage(&faces));
        assert_eq!(open.free.len(), 4);
        let length: f64 = open.free.iter().map(|e| e.from.distance(e.to)).sum();
        assert!((length - 4.0).abs() < 1e-12);
        // Put back 0.5 mm too far out: eight free edges, all of them cracks of that width.
        let out = unit_normal(&lid) * -0.0005;
        faces.push(lid.iter().map(|v| *v + out).collect());
        let cracked = Skin::of(&stage(&faces));
        assert_eq!(cracked.free.len(), 8);
        assert!(cracked.free.iter().all(|e| e.crack.is_some_and(|w| (w - 0.0005).abs() < 1e-9)));
    }

    #[test]
    fn edges_in_pieces_are_joined_and_their_corners_found() {
        // One wall in two halves: its corners lie inside the edges of floor and ceiling.
        let mut faces = cube(DVec3::ZERO, 1.0);
        let wall = faces.remove(2);
        let half = |k: usize| wall[k].midpoint(wall[(k + 1) % 4]);
        faces.push(vec![wall[0], half(0), half(2), wall[3]]);
        faces.push(vec![half(0), wall[1], wall[2], half(2)]);
        let skin = Skin::of(&stage(&faces));
        assert!(skin.free.is_empty());
        // Both halves have a corner at each of the two places.
        assert_eq!(skin.junctions.len(), 4);
        assert!(skin.links.iter().all(|l| l.agree));
        assert_eq!(skin.links.len(), 10 + 1 + 4);
    }

    #[test]
    fn a_wall_on_a_floor_is_no_gap_and_a_lamp_under_a_ceiling_no_crack() {
        let mut faces = cube(DVec3::ZERO, 1.0);
        let at = |points: [[f64; 3]; 4]| points.map(DVec3::from_array).to_vec();
        faces.push(at([[0.5, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, 1.0, 0.5], [0.5, 0.0, 0.5]]));
        faces.push(at([[0.4, 0.4, 0.999], [0.4, 0.6, 0.999], [0.6, 0.6, 0.999], [0.6, 0.4, 0.999]]));
        let skin = Skin::of(&stage(&faces));
        assert_eq!(skin.free.len(), 1 + 4);
        assert!(skin.free.iter().all(|e| e.crack.is_none()));
    }
}
