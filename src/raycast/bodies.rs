//! What can hide: the facets of a stage as convex bodies, closed solids in one piece.

use crate::math::{DVec3, Polytope, unit_normal};
use crate::scene::Stage;
use std::collections::{BTreeMap, HashMap};

/// Solids with more planes are taken face by face.
const MOST_PLANES: usize = 48;

/// Solids with more faces are not looked at.
const MOST_FACES: usize = 20_000;

/// Normals that differ by so little belong to one plane.
const SAME_NORMAL: f64 = 1e-9;

/// Corners closer than this share of the scene's extent are one.
const SAME: f64 = 1e-9;

/// All that can hide in a stage.
#[derive(Debug, Clone)]
pub struct Bodies {
    /// The bodies: every facet is part of just one, but for facets that coincide back to back.
    pub list: Vec<Polytope>,
    /// Number of the body that each facet is part of, `None` for degenerate facets. It hides nothing from the facet,
    /// nor the facet from anybody, though its corners may be rounded out of the facet's plane.
    pub of_facet: Vec<Option<u32>>,
}

/// All bodies of a stage.
pub fn bodies(stage: &Stage) -> Bodies {
    let loops = welded(stage);
    let mut list = Vec::new();
    let mut of_face = vec![None; loops.faces.len()];
    for part in connected(&loops.faces) {
        if let Some(body) = solid(&loops, &part) {
            part.iter().for_each(|f| of_face[*f] = Some(list.len() as u32));
            list.push(body);
            continue;
        }
        for f in part {
            if let Some(plate) = Polytope::flat(&loops.corners(f)) {
                of_face[f] = Some(list.len() as u32);
                list.push(plate);
            }
        }
    }
    Bodies { list, of_facet: loops.of_facet.iter().map(|f| f.and_then(|f| of_face[f])).collect() }
}

/// Facets as loops of shared vertices.
struct Loops {
    vertices: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    /// Face of each facet.
    of_facet: Vec<Option<usize>>,
}

impl Loops {
    fn corners(&self, face: usize) -> Vec<DVec3> {
        self.faces[face].iter().map(|v| self.vertices[*v as usize]).collect()
    }
}

/// Joins corners that coincide; of facets that are the same polygon, one is left.
fn welded(stage: &Stage) -> Loops {
    let (lo, hi) = stage.bounds();
    let cell = (SAME * (hi - lo).max_element()).max(f64::MIN_POSITIVE);
    let key = |p: DVec3| ((p - lo) / cell).round().to_array().map(|x| x as i64);
    let mut known: HashMap<[i64; 3], u32> = HashMap::new();
    let mut loops = Loops { vertices: Vec::new(), faces: Vec::new(), of_facet: Vec::new() };
    let mut sets: HashMap<Vec<u32>, usize> = HashMap::new();
    for facet in &stage.facets {
        let mut face: Vec<u32> = Vec::with_capacity(facet.vertices.len());
        for p in &facet.vertices {
            let next = loops.vertices.len() as u32;
            let v = *known.entry(key(*p)).or_insert(next);
            if v == next {
                loops.vertices.push(*p);
            }
            if face.last() != Some(&v) && face.first() != Some(&v) {
                face.push(v);
            }
        }
        let mut set = face.clone();
        set.sort_unstable();
        if face.len() < 3 {
            loops.of_facet.push(None);
            continue;
        }
        // The two sides of a plate hide alike.
        let next = loops.faces.len();
        let number = *sets.entry(set).or_insert(next);
        if number == next {
            loops.faces.push(face);
        }
        loops.of_facet.push(Some(number));
    }
    loops
}

/// Groups of faces that hang together by edges.
fn connected(faces: &[Vec<u32>]) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..faces.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    let mut along: HashMap<[u32; 2], usize> = HashMap::new();
    for (f, face) in faces.iter().enumerate() {
        for k in 0..face.len() {
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            let other = *along.entry([a.min(b), a.max(b)]).or_insert(f);
            let (r, s) = (root(&mut parent, f), root(&mut parent, other));
            parent[r.max(s)] = r.min(s);
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for f in 0..faces.len() {
        groups.entry(root(&mut parent, f)).or_default().push(f);
    }
    groups.into_values().collect()
}

/// The convex solid that some faces close around, also where its base is missing because it stands on another face.
fn solid(all: &Loops, part: &[usize]) -> Option<Polytope> {
    if part.len() < 4 || part.len() > MOST_FACES {
        return None;
    }
    let mut loops: Vec<Vec<u32>> = part.iter().map(|f| all.faces[*f].clone()).collect();
    if let Some(base) = open_rim(&loops) {
        if !stands_on(all, part, &base) {
            return None;
        }
        loops.push(base);
    }
    let loops = merged(all, loops)?;
    let mut number: BTreeMap<u32, u32> = BTreeMap::new();
    for v in loops.iter().flatten() {
        let next = number.len() as u32;
        number.entry(*v).or_insert(next);
    }
    let mut vertices = vec![DVec3::ZERO; number.len()];
    number.iter().for_each(|(v, k)| vertices[*k as usize] = all.vertices[*v as usize]);
    let renamed = loops.iter().map(|l| l.iter().map(|v| number[v]).collect()).collect();
    Polytope::closed(vertices, renamed)
}

/// The one loop of edges that only one face has, turned to close the body.
fn open_rim(loops: &[Vec<u32>]) -> Option<Vec<u32>> {
    let mut rim = outline(loops)?;
    rim.reverse();
    Some(rim)
}

/// The one loop of edges that are not shared by two of the faces.
fn outline(loops: &[Vec<u32>]) -> Option<Vec<u32>> {
    let mut half = std::collections::BTreeSet::new();
    for l in loops {
        (0..l.len()).for_each(|k| {
            half.insert((l[k], l[(k + 1) % l.len()]));
        });
    }
    let open: BTreeMap<u32, u32> = half.iter().filter(|(a, b)| !half.contains(&(*b, *a))).copied().collect();
    let start = *open.keys().next()?;
    let mut rim = vec![start];
    let mut at = open[&start];
    while at != start && rim.len() <= open.len() {
        rim.push(at);
        at = *open.get(&at)?;
    }
    (rim.len() == open.len()).then_some(rim)
}

/// Faces in one plane as one face, without the corners in the middle of its sides; `None` for more planes than solids
/// may have, or where the faces of a plane do not hang together.
fn merged(all: &Loops, loops: Vec<Vec<u32>>) -> Option<Vec<Vec<u32>>> {
    let corner = |v: u32| all.vertices[v as usize];
    let mut planes: Vec<(DVec3, Vec<Vec<u32>>)> = Vec::new();
    for l in loops {
        let normal = unit_normal(&l.iter().map(|v| corner(*v)).collect::<Vec<_>>());
        // Of a convex body, no two planes have one normal.
        match planes.iter().position(|(n, _)| n.distance(normal) <= SAME_NORMAL) {
            Some(k) => planes[k].1.push(l),
            None if planes.len() == MOST_PLANES => return None,
            None => planes.push((normal, vec![l])),
        }
    }
    let face = |faces: &Vec<Vec<u32>>| {
        let rim = if let [one] = faces.as_slice() { one.clone() } else { outline(faces)? };
        let n = rim.len();
        let turns = |k: &usize| {
            let [a, b, c] = [rim[(k + n - 1) % n], rim[*k], rim[(k + 1) % n]].map(corner);
            (b - a).cross(c - b).length() > SAME_NORMAL * (b - a).length() * (c - b).length()
        };
        let corners: Vec<u32> = (0..n).filter(turns).map(|k| rim[k]).collect();
        (corners.len() >= 3).then_some(corners)
    };
    planes.iter().map(|(_, faces)| face(faces)).collect()
}

/// Whether the rim lies in one plane and on one face of another part: whatever passes through it meets that face.
fn stands_on(all: &Loops, part: &[usize], rim: &[u32]) -> bool {
    let rim: Vec<DVec3> = rim.iter().map(|v| all.vertices[*v as usize]).collect();
    let size = rim.iter().map(|p| p.distance(rim[0])).fold(0.0, f64::max);
    let slack = SAME * size;
    let carries = |f: usize| {
        let corners = all.corners(f);
        let normal = unit_normal(&corners);
        rim.iter().all(|p| {
            (*p - corners[0]).dot(normal).abs() <= slack
                && (0..corners.len()).all(|k| {
                    let edge = corners[(k + 1) % corners.len()] - corners[k];
                    normal.cross(edge).dot(*p - corners[k]) >= -slack * edge.length()
                })
        })
    };
    (0..all.faces.len()).any(|f| !part.contains(&f) && carries(f))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces of a box in `n` x `n` cells each, wound outwards; `open`: without its bottom.
    fn block(lo: DVec3, hi: DVec3, n: usize, open: bool) -> Vec<Vec<DVec3>> {
        let mut out = Vec::new();
        for axis in 0..3 {
            for high in [false, true] {
                if open && axis == 2 && !high {
                    continue;
                }
                let at = |u: f64, v: f64| {
                    let mut t = DVec3::ZERO;
                    t[axis] = f64::from(u8::from(high));
                    t[(axis + 1) % 3] = u;
                    t[(axis + 2) % 3] = v;
                    lo + t * (hi - lo)
                };
                let step = |k: usize| k as f64 / n as f64;
                for (a, b) in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
                    let mut cell = vec![
                        at(step(a), step(b)),
                        at(step(a + 1), step(b)),
                        at(step(a + 1), step(b + 1)),
                        at(step(a), step(b + 1)),
                    ];
                    if !high {
                        cell.reverse();
                    }
                    out.push(cell);
                }
            }
        }
        out
    }

    #[test]
    fn a_box_of_many_faces_is_one_body_of_six_planes() {
        let found = bodies(&Stage::from_polygons(&block(DVec3::ZERO, DVec3::ONE, 3, false))).list;
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].planes().len(), found[0].vertices().len(), found[0].edges().len()), (6, 8, 12));
    }

    #[test]
    fn a_box_without_bottom_is_a_body_only_where_it_stands_on_something() {
        let open = || block(DVec3::new(0.2, 0.2, 0.0), DVec3::new(0.4, 0.5, 0.3), 1, true);
        assert_eq!(bodies(&Stage::from_polygons(&open())).list.len(), 5);
        let mut standing = open();
        standing.push([(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec());
        let found = bodies(&Stage::from_polygons(&standing)).list;
        assert_eq!(found.iter().map(|b| b.planes().len()).collect::<Vec<_>>(), [6, 2]);
    }

    #[test]
    fn rooms_and_plates_are_taken_face_by_face() {
        let mut room = block(DVec3::ZERO, DVec3::ONE, 1, false);
        room.iter_mut().for_each(|f| f.reverse());
        assert_eq!(bodies(&Stage::from_polygons(&room)).list.len(), 6);
        let plate: Vec<DVec3> = [(0., 0.), (1., 0.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let back = plate.iter().rev().copied().collect();
        assert_eq!(bodies(&Stage::from_polygons(&[plate, back])).list.len(), 1);
    }
}
