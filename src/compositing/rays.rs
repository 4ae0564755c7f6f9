//! Rays for mirrors and glass: the closest face in double precision, mirrored and refracted directions.

use super::image::SpanFace;
use crate::math::{Bounds, BoxTree, DVec3, unit_normal};

/// How far, as a share of the scene's diagonal, a ray must go before it meets anything.
const LEAVING: f64 = 1e-9;

/// Distances that differ by less than this share are one place.
const SAME: f64 = 1e-11;

/// How far, as a share of the scene's diagonal, faces reach over their edges, so that no ray slips between two.
const RIM: f64 = 1e-11;

/// A face that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Index into [`super::SpanImage::faces`].
    pub face: u32,
    /// How far along the ray, in lengths of its direction.
    pub distance: f64,
    /// It meets the front.
    pub front: bool,
}

/// The faces of a scene, to be met by rays.
pub struct LocalRays {
    tree: BoxTree,
    faces: Vec<Plate>,
    /// Planes through the edges, for all faces: normal in the face's plane, inward, and offset.
    edges: Vec<(DVec3, f64)>,
    leaving: f64,
    rim: f64,
}

/// A face's plane, its own number, and where its edges are.
struct Plate {
    normal: DVec3,
    offset: f64,
    face: u32,
    first: u32,
    count: u32,
}

impl LocalRays {
    /// Faces in their order. Trees are left out: where they stand depends on who looks; so is what has no area.
    pub fn new(faces: &[SpanFace]) -> Self {
        let all = faces.iter().fold(Bounds::NOTHING, |b, f| b.joined(Bounds::of(&f.vertices)));
        let diagonal = if faces.is_empty() { 0.0 } else { (all.hi - all.lo).length() };
        let (mut plates, mut edges, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for (face, f) in faces.iter().enumerate().filter(|(_, f)| f.tree.is_none() && f.vertices.len() >= 3) {
            let normal = unit_normal(&f.vertices);
            if normal == DVec3::ZERO || !normal.is_finite() {
                continue;
            }
            let first = edges.len();
            for (i, a) in f.vertices.iter().enumerate() {
                let inward = normal.cross(f.vertices[(i + 1) % f.vertices.len()] - *a).normalize_or_zero();
                if inward != DVec3::ZERO {
                    edges.push((inward, inward.dot(*a)));
                }
            }
            let middle = f.vertices.iter().sum::<DVec3>() / f.vertices.len() as f64;
            plates.push(Plate {
                normal,
                offset: normal.dot(middle),
                face: face as u32,
                first: first as u32,
                count: (edges.len() - first) as u32,
            });
            // Thick, so that rays within the plane of an axis-parallel face pass through its box without 0 times infinity.
            boxes.push(Bounds::of(&f.vertices).grown(2.0 * LEAVING * diagonal));
        }
        Self { tree: BoxTree::new(boxes), faces: plates, edges, leaving: LEAVING * diagonal, rim: RIM * diagonal }
    }

    /// The closest face on a ray whose `direction` may have any length, leaving out face `own` and all that `wanted`
    /// refuses, which is given the face and whether its front is met. Equally close faces: the lowest number.
    pub fn closest(
        &self,
        origin: DVec3,
        direction: DVec3,
        own: Option<u32>,
        wanted: impl Fn(u32, bool) -> bool,
    ) -> Option<RayHit> {
        let least = self.leaving / direction.length();
        if !least.is_finite() {
            return None;
        }
        let mut best = RayHit { face: u32::MAX, distance: f64::INFINITY, front: false };
        self.tree.along(origin, direction, |i| {
            let plate = &self.faces[i as usize];
            let slope = plate.normal.dot(direction);
            let distance = (plate.offset - plate.normal.dot(origin)) / slope;
            // Written so that a ray within the plane (a distance that is not a number, or infinite) fails.
            let (front, slack) = (slope < 0.0, SAME * distance.abs());
            // Of two in one place the front is seen, then the lower number, as by the eye.
            let together = (distance - best.distance).abs() <= slack;
            let first = (!front, plate.face) < (!best.front, best.face);
            let nearer = if together { first } else { distance < best.distance };
            if distance > least && distance < f64::INFINITY && nearer && own != Some(plate.face) {
                let p = origin + direction * distance;
                let edges = &self.edges[plate.first as usize..][..plate.count as usize];
                if edges.iter().all(|(n, d)| n.dot(p) - d >= -self.rim) && wanted(plate.face, front) {
                    best = RayHit { face: plate.face, distance, front };
                }
            }
            // What lies in the same place must still be looked at.
            best.distance * (1.0 + SAME)
        });
        best.distance.is_finite().then_some(best)
    }
}

/// The direction of a ray after a mirror with the unit normal `normal`, of the same length.
pub fn reflected(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// The direction (unit) of a ray behind a face of refractive index `index`: by Snell's law with 1/index where it enters
/// at the front, with index where it leaves at the back. `None` where it is totally reflected. An index of 1, or none
/// that makes sense, goes straight on.
pub fn refracted(direction: DVec3, normal: DVec3, index: f64) -> Option<DVec3> {
    let direction = direction.normalize_or_zero();
    if index == 1.0 || !(index > 0.0 && index.is_finite()) {
        return Some(direction);
    }
    let cosine = -direction.dot(normal);
    let (ratio, n) = if cosine >= 0.0 { (1.0 / index, normal) } else { (index, -normal) };
    let cosine = cosine.abs();
    let rest = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (rest >= 0.0).then(|| (direction * ratio + n * (ratio * cosine - rest.sqrt())).normalize_or_zero())
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Random, outset, triangles};
    use super::*;

    /// Every face, one after the other, by Möller's way: another test than the shipped one.
    fn brute(faces: &[SpanFace], origin: DVec3, direction: DVec3) -> Option<(u32, f64, bool)> {
        let mut best: Option<(u32, f64, bool)> = None;
        for (k, f) in faces.iter().enumerate() {
            for w in f.vertices[1..].windows(2) {
                let (a, e1, e2) = (f.vertices[0], w[0] - f.vertices[0], w[1] - f.vertices[0]);
                let p = direction.cross(e2);
                let det = e1.dot(p);
                let q = (origin - a).cross(e1);
                let (u, v, t) = ((origin - a).dot(p) / det, direction.dot(q) / det, e2.dot(q) / det);
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-8 && best.is_none_or(|b| t < b.1) {
                    best = Some((k as u32, t, det > 0.0));
                }
            }
        }
        best
    }

    #[test]
    fn finds_what_all_faces_one_by_one_give() {
        let faces = outset(triangles(300, 3), 1, [8, 8], 1).faces;
        let rays = LocalRays::new(&faces);
        let mut random = Random::new(11);
        let (low, high) = (DVec3::new(-4.0, 2.0, -4.0), DVec3::new(4.0, 11.0, 4.0));
        let (mut met, mut missed) = (0, 0);
        for _ in 0..20_000 {
            let (origin, direction) = (random.point(low, high), random.point(DVec3::splat(-1.0), DVec3::ONE));
            let (a, b) = (rays.closest(origin, direction, None, |_, _| true), brute(&faces, origin, direction));
            match (a, b) {
                (Some(a), Some(b)) => {
                    assert_eq!((a.face, a.front), (b.0, b.2));
                    assert!((a.distance - b.1).abs() < 1e-9 * (1.0 + b.1));
                    met += 1;
                }
                (None, None) => missed += 1,
                other => panic!("{other:?}"),
            }
        }
        assert!(met > 2000 && missed > 2000, "{met} {missed}");
    }

    /// Squares that share edges and corners: aimed at these, no ray slips through; axis-parallel rays within planes too.
    #[test]
    fn nothing_slips_between_faces_and_nothing_meets_where_it_starts() {
        let at = |i: u32, j: u32| DVec3::new(f64::from(i) * 0.1, f64::from(j) * 0.3, 0.7);
        let square = |k: u32| {
            let (i, j) = (k % 10, k / 10);
            vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
        };
        let faces = outset((0..100).map(square).collect(), 1, [8, 8], 1).faces;
        let rays = LocalRays::new(&faces);
        let mut random = Random::new(5);
        for k in 0..10_000 {
            let (i, j) = (k % 9 + 1, k / 9 % 9 + 1);
            let edge = at(i, j).lerp(at(i + 1, j), if k % 3 == 0 { 0.0 } else { random.next() });
            let origin = random.point(DVec3::new(-3.0, -3.0, 2.0), DVec3::new(3.0, 3.0, 4.0));
            let hit = rays.closest(origin, edge - origin, None, |_, _| true).expect("no gap");
            assert!((hit.distance - 1.0).abs() < 1e-12 && hit.front);
            // From there on nothing, whoever the neighbour is.
            let p = origin + (edge - origin) * hit.distance;
            assert_eq!(rays.closest(p, reflected(edge - origin, DVec3::Z), Some(hit.face), |_, _| true), None);
        }
        assert_eq!(rays.closest(DVec3::new(-1.0, 0.05, 0.7), DVec3::X, None, |_, _| true), None);
        let up = rays.closest(DVec3::new(0.1, 0.3, 0.0), DVec3::Z, None, |_, _| true).expect("a corner");
        assert_eq!((up.face, up.front), (0, false), "four faces there: the first");
        assert_eq!(rays.closest(DVec3::ZERO, DVec3::ZERO, None, |_, _| true), None);
        let fronts = rays.closest(DVec3::new(0.1, 0.3, 0.0), DVec3::Z, None, |_, front| front);
        assert_eq!(fronts, None);
        assert_eq!(LocalRays::new(&[]).closest(DVec3::ZERO, DVec3::Z, None, |_, _| true), None);
    }

    #[test]
    fn mirrors_and_snell() {
        let n = DVec3::new(1.0, -2.0, 0.5).normalize();
        let mut random = Random::new(7);
        for _ in 0..1000 {
            let d = random.point(DVec3::splat(-1.0), DVec3::ONE).normalize();
            let r = reflected(d, n);
            assert!((r.dot(n) + d.dot(n)).abs() < 1e-14 && (r.cross(n) - d.cross(n)).length() < 1e-14);
            let index = random.within(0.5, 2.5);
            let sine = |v: DVec3| v.cross(n).length();
            let ratio = if d.dot(n) < 0.0 { 1.0 / index } else { index };
            match refracted(d, n, index) {
                Some(out) => {
                    assert!((sine(out) - ratio * sine(d)).abs() < 1e-13, "Snell");
                    assert!((out.length() - 1.0).abs() < 1e-14 && out.dot(n) * d.dot(n) >= 0.0);
                    assert!(out.cross(d).dot(n).abs() < 1e-14, "in the plane of incidence");
                    // Back the same way.
                    let back = refracted(-out, n, index).expect("it came from there");
                    assert!((back + d).length() < 1e-7);
                }
                None => assert!(ratio * sine(d) > 1.0),
            }
            assert_eq!(refracted(d, n, 1.0).map(|o| (o - d).length() < 1e-15), Some(true));
            assert_eq!(refracted(d, n, 0.0), refracted(d, n, 1.0));
        }
    }

    /// `cargo test --release -- --ignored --nocapture rays_per_second`.
    #[test]
    #[ignore = "a measurement"]
    fn rays_per_second() {
        let small = |t: Vec<DVec3>| t.iter().map(|v| t[0] + (*v - t[0]) * 0.3).collect();
        let faces = outset(triangles(2000, 9).into_iter().map(small).collect(), 1, [8, 8], 1).faces;
        let rays = LocalRays::new(&faces);
        let mut random = Random::new(2);
        let (low, high) = (DVec3::new(-4.0, 2.0, -4.0), DVec3::new(4.0, 11.0, 4.0));
        let asked: Vec<_> =
            (0..1_000_000).map(|_| (random.point(low, high), random.point(DVec3::splat(-1.0), DVec3::ONE))).collect();
        let start = std::time::Instant::now();
        let met = asked.iter().filter(|(o, d)| rays.closest(*o, *d, None, |_, _| true).is_some()).count();
        println!("{:.2} Mrays/s, {met} met", 1.0 / start.elapsed().as_secs_f64());
    }
}
