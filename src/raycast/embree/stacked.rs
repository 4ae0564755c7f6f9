//! Facets that lie so close over one another that single precision cannot tell which comes first.

use super::near::{distance, single};
use crate::math::{DVec3, area, clip_to_half_space, diameter};
use crate::raycast::builtin::BuiltinKernel;
use crate::scene::Stage;

/// An overlap narrower than this many reaches is a line where two facets meet, not a stack.
const WIDTH: f64 = 5.0;

/// More facets than this over one, and its hits are no longer told apart.
const FEW: usize = 16;

/// Which facets have others, not in their own plane, less than a reach before or behind them.
pub(super) struct Stacks {
    /// Where the planes of each facet's neighbours begin; one more at the end.
    first: Vec<u32>,
    planes: Vec<[f32; 4]>,
}

impl Stacks {
    /// `reach` in metres.
    pub(super) fn new(stage: &Stage, exact: &BuiltinKernel, reach: f64) -> Self {
        let mut stacks = Self { first: vec![0], planes: Vec::new() };
        let mut found = Vec::new();
        for f in 0..stage.facets.len() {
            over(stage, exact, f, reach, &mut found);
            let close = found.iter().filter(|&&p| overlap(stage, f, exact.polygons().facet_of(p) as usize, reach));
            stacks.planes.extend(close.map(|&p| single(exact.polygons().plane(p))));
            stacks.first.push(stacks.planes.len() as u32);
        }
        stacks
    }

    /// True if anything is stacked on a facet.
    pub(super) fn any(&self, facet: u32) -> bool {
        !self.planes_of(facet).is_empty()
    }

    /// True if something lies within reach of a point (from the scene's centre) of a facet, or may lie there.
    pub(super) fn near(&self, facet: u32, point: [f32; 3], reach: f32) -> bool {
        let planes = self.planes_of(facet);
        planes.len() > FEW || planes.iter().any(|row| distance(row, point).abs() < reach)
    }

    fn planes_of(&self, facet: u32) -> &[[f32; 4]] {
        &self.planes[self.first[facet as usize] as usize..self.first[facet as usize + 1] as usize]
    }
}

/// Polygons near facet `f` and over it, in another plane.
fn over(stage: &Stage, exact: &BuiltinKernel, f: usize, reach: f64, found: &mut Vec<u32>) {
    let polygons = exact.polygons();
    let corners = &stage.facets[f].vertices;
    let (lo, hi) = corners.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |b, v| (b.0.min(*v), b.1.max(*v)));
    exact.polygons_in_box(lo - reach, hi + reach, found);
    let (own, outline) = (polygons.own_group(f as u32), polygons.outline(f as u32));
    found.retain(|&p| {
        let corners = &stage.facets[polygons.facet_of(p) as usize].vertices;
        polygons.group_of(p) != own && !outline.iter().any(|e| polygons.is_beyond(e, corners))
    });
}

/// True if a part of `g` worth the name lies over `f` within reach of its plane.
fn overlap(stage: &Stage, f: usize, g: usize, reach: f64) -> bool {
    let (f, g) = (&stage.facets[f], &stage.facets[g]);
    let (n, level) = (f.normal, f.normal.dot(f.vertices[0]));
    let mut part = clip_to_half_space(&g.vertices, n, level - reach);
    part = clip_to_half_space(&part, -n, -level - reach);
    for (k, a) in f.vertices.iter().enumerate() {
        let inward = n.cross(f.vertices[(k + 1) % f.vertices.len()] - *a);
        part = clip_to_half_space(&part, inward, inward.dot(*a));
    }
    part.len() >= 3 && area(&part) > WIDTH * reach * diameter(&part)
}
