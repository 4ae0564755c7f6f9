//! Where the division of one facet meets another division of the same surface: vertices on the edges of cells
//! across the border.

use super::Vertex;
use super::weld::same_surface;
use crate::math::DVec3;
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

/// Points along an edge, to a length as long as a box, by which it is entered into boxes of space.
const POINTS_PER_BOX: f64 = 4.0;

/// An edge that no other cell shares, from one vertex to the next.
struct Edge {
    cell: u32,
    ends: [u32; 2],
}

/// Gives vertices that lie within an edge of a cell across the border that cell too: it fills half a turn. Without
/// it each side would be extrapolated on its own, and the border would show.
pub(super) fn connect(cells: &[Vec<u32>], vertices: &mut [Vertex], tolerance: f64) {
    let edges = border_edges(cells);
    let place = |v: u32| vertices[v as usize].point;
    let length: f64 = edges.iter().map(|e| place(e.ends[0]).distance(place(e.ends[1]))).sum();
    let size = length / edges.len().max(1) as f64;
    if size <= tolerance || !size.is_finite() {
        return;
    }
    let mut boxes: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (k, edge) in edges.iter().enumerate() {
        let (a, b) = (place(edge.ends[0]), place(edge.ends[1]));
        let points = (a.distance(b) / size * POINTS_PER_BOX).ceil().max(1.0);
        for j in 0..=points as u64 {
            let list = boxes.entry(box_of(a.lerp(b, j as f64 / points), size)).or_default();
            if list.last() != Some(&k) {
                list.push(k);
            }
        }
    }
    let rim: Vec<usize> = (0..vertices.len()).filter(|v| !vertices[*v].is_inner()).collect();
    for v in rim {
        let [x, y, z] = box_of(vertices[v].point, size);
        let around =
            (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).flat_map(move |y| (z - 1..=z + 1).map(move |z| [x, y, z])));
        let mut near: Vec<usize> = around.filter_map(|b| boxes.get(&b)).flatten().copied().collect();
        near.sort_unstable();
        near.dedup();
        for edge in near.into_iter().map(|k| &edges[k]) {
            let on = holds(vertices, edge, &vertices[v], tolerance);
            if on && !vertices[v].cells.contains(&edge.cell) {
                vertices[v].cells.push(edge.cell);
                vertices[v].angle += PI;
            }
        }
    }
}

fn border_edges(cells: &[Vec<u32>]) -> Vec<Edge> {
    let sides = |own: &[u32]| (0..own.len()).map(|k| [own[k], own[(k + 1) % own.len()]]).collect::<Vec<_>>();
    let all: HashSet<[u32; 2]> = cells.iter().flat_map(|own| sides(own)).collect();
    let mut edges = Vec::new();
    for (cell, own) in cells.iter().enumerate() {
        let lone = sides(own).into_iter().filter(|[a, b]| a != b && !all.contains(&[*b, *a]));
        edges.extend(lone.map(|ends| Edge { cell: cell as u32, ends }));
    }
    edges
}

/// True if a vertex lies on an edge, away from its ends.
fn holds(vertices: &[Vertex], edge: &Edge, vertex: &Vertex, tolerance: f64) -> bool {
    let [a, b] = edge.ends.map(|v| &vertices[v as usize]);
    if !same_surface(a, vertex.normal, vertex.material) {
        return false;
    }
    let (along, to) = (b.point - a.point, vertex.point - a.point);
    let length = along.length();
    let at = to.dot(along) / length;
    at > tolerance && at < length - tolerance && (to - along * (at / length)).length() <= tolerance
}

fn box_of(p: DVec3, size: f64) -> [i64; 3] {
    (p / size).floor().to_array().map(|x| x as i64)
}
