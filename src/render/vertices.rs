//! From patches to their corners, so that shading can run smoothly: [CG85 fig. 8].
//!
//! Inside a surface a vertex has the mean of the patches around it. On the rim it is extrapolated from the nearest
//! inner vertex through the mean of the patches at the rim. Both are the same thing said once: the plane of least
//! squares through what is known around the vertex, taken at the vertex. On the regular grids of the paper this
//! gives its weights exactly; on uneven and triangular grids it still returns every linear field.

use super::{Mesh, Vertex};
use crate::math::DVec3;
use std::collections::BTreeMap;

/// Directions in which the data would be stretched further than this (squared, in their own spread) are left out:
/// a strip one cell wide stays constant across.
const MOST_LEVERAGE: f64 = 25.0;
/// Spread below this share of the other direction's is none.
const NO_SPREAD: f64 = 1e-12;
/// Extrapolation may leave the range of the patches it comes from by so many widths of it: more than the rule ever
/// needs on a linear field, less than a crooked mesh could make of it.
const MOST_WIDTHS: f64 = 3.0;
/// Two vertices are equally near if their distances differ by less than this share.
const EQUALLY_NEAR: f64 = 1e-6;

/// What each vertex takes of which cells: geometry only, one for all bands.
#[derive(Debug, Clone)]
pub struct Stencils {
    stencils: Vec<Stencil>,
}

/// Weights of cells, by number; they add to 1.
#[derive(Debug, Clone, Default)]
struct Stencil {
    weights: Vec<(u32, f64)>,
}

/// Something with a value in a place: a cell, or a vertex that is done.
struct Known {
    place: DVec3,
    weights: Vec<(u32, f64)>,
}

impl Stencils {
    /// Works out the vertices of a mesh: inner ones first, then the rim, where most cells meet first.
    pub fn of(mesh: &Mesh) -> Self {
        let all = mesh.vertices();
        let mut done: Vec<Option<Stencil>> = vec![None; all.len()];
        for rank in [Rank::Inner, Rank::Bend, Rank::Rim, Rank::Corner] {
            let fresh: Vec<(usize, Stencil)> = (0..all.len())
                .filter(|v| Rank::of(&all[*v]) == rank)
                .map(|v| (v, stencil(mesh, &all[v], rank, &done)))
                .collect();
            fresh.into_iter().for_each(|(v, s)| done[v] = Some(s));
        }
        Self { stencils: done.into_iter().map(Option::unwrap_or_default).collect() }
    }

    /// Values at the vertices, of one value per cell. Where the cells around are nowhere negative, nor is the vertex.
    pub fn values(&self, cells: &[f64]) -> Vec<f64> {
        self.stencils.iter().map(|s| s.value(cells)).collect()
    }
}

impl Stencil {
    fn value(&self, cells: &[f64]) -> f64 {
        let values = || self.weights.iter().map(|(c, _)| cells[*c as usize]);
        let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        // Constants stay constant to the last bit.
        if low >= high {
            return if low == high { low } else { 0.0 };
        }
        let sum: f64 = self.weights.iter().map(|(c, w)| w * cells[*c as usize]).sum();
        let slack = MOST_WIDTHS * (high - low);
        let least = if low >= 0.0 { (low - slack).max(0.0) } else { low - slack };
        sum.clamp(least, high + slack)
    }
}

/// Order in which vertices are worked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rank {
    /// Surrounded by cells.
    Inner,
    /// Three cells and more: they span a plane by themselves.
    Bend,
    /// Two cells.
    Rim,
    /// One cell.
    Corner,
}

impl Rank {
    fn of(vertex: &Vertex) -> Self {
        match vertex.cells.len() {
            _ if vertex.is_inner() => Self::Inner,
            0 | 1 => Self::Corner,
            2 => Self::Rim,
            _ => Self::Bend,
        }
    }
}

fn stencil(mesh: &Mesh, vertex: &Vertex, rank: Rank, done: &[Option<Stencil>]) -> Stencil {
    let cell = |c: &u32| Known { place: mesh.centre(*c as usize), weights: vec![(*c, 1.0)] };
    let mut known: Vec<Known> = vertex.cells.iter().map(cell).collect();
    if rank != Rank::Inner {
        known.extend(vertices_to_lean_on(mesh, vertex, done));
    }
    let weights = weights_at(vertex.point, vertex.normal, &known);
    let mut sum: BTreeMap<u32, f64> = BTreeMap::new();
    for (k, w) in known.iter().zip(weights) {
        for (c, part) in &k.weights {
            *sum.entry(*c).or_insert(0.0) += w * part;
        }
    }
    Stencil { weights: sum.into_iter().collect() }
}

/// The nearest inner vertices of the cells around; where there are none, all that are done.
fn vertices_to_lean_on(mesh: &Mesh, vertex: &Vertex, done: &[Option<Stencil>]) -> Vec<Known> {
    let around = vertex.cells.iter().flat_map(|c| mesh.vertices_of(*c as usize)).map(|v| *v as usize);
    let mut candidates: Vec<usize> = around.filter(|v| done[*v].is_some()).collect();
    candidates.sort_unstable();
    candidates.dedup();
    let place = |v: usize| mesh.vertices()[v].point;
    let inner: Vec<usize> = candidates.iter().copied().filter(|v| mesh.vertices()[*v].is_inner()).collect();
    if !inner.is_empty() {
        let nearest = inner.iter().map(|v| place(*v).distance(vertex.point)).fold(f64::INFINITY, f64::min);
        candidates = inner;
        candidates.retain(|v| place(*v).distance(vertex.point) <= nearest * (1.0 + EQUALLY_NEAR));
    }
    let known = |v: &usize| Some(Known { place: place(*v), weights: done[*v].as_ref()?.weights.clone() });
    candidates.iter().filter_map(known).collect()
}

/// Weights of the known values in the plane of least squares through them, taken at `point`. Where they lie on a
/// line the plane is level across it, where there is one it is level.
fn weights_at(point: DVec3, normal: DVec3, known: &[Known]) -> Vec<f64> {
    let n = known.len() as f64;
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| [(p - point).dot(x), (p - point).dot(y)];
    let places: Vec<[f64; 2]> = known.iter().map(|k| flat(k.place)).collect();
    let mean = [0, 1].map(|c| places.iter().map(|p| p[c]).sum::<f64>() / n);
    let spread = |a: usize, b: usize| places.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>();
    let axes = principal_axes(spread(0, 0), spread(0, 1), spread(1, 1));
    let largest = axes[0].0;
    let mut weights = vec![1.0 / n; known.len()];
    for (variance, axis) in axes {
        let along = |p: [f64; 2]| p[0] * axis[0] + p[1] * axis[1];
        // The vertex is the origin.
        let reach = -along(mean);
        if variance <= NO_SPREAD * largest || reach * reach > MOST_LEVERAGE * variance {
            continue;
        }
        for (w, p) in weights.iter_mut().zip(&places) {
            *w += reach * (along(*p) - along(mean)) / variance;
        }
    }
    weights
}

/// Eigenvalues and unit eigenvectors of the symmetric matrix (a b; b c), the larger first.
fn principal_axes(a: f64, b: f64, c: f64) -> [(f64, [f64; 2]); 2] {
    let (middle, half) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
    let angle = 0.5 * (2.0 * b).atan2(a - c);
    let (sine, cosine) = angle.sin_cos();
    [(middle + half, [cosine, sine]), ((middle - half).max(0.0), [-sine, cosine])]
}

#[cfg(test)]
mod tests;
