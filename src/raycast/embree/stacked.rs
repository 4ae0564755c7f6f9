//! Facets that lie so close over one another that single precision cannot tell which comes first.

use crate::math::{DVec3, area, clip_to_half_space, diameter};
use crate::raycast::builtin::BuiltinKernel;
use crate::scene::Stage;

/// An overlap narrower than this many reaches is an edge where two facets meet, not a stack.
const WIDTH: f64 = 5.0;

/// Which facets have another one, not in their own plane, less than `reach` metres before or behind them.
pub(super) fn closely_stacked(stage: &Stage, exact: &BuiltinKernel, reach: f64) -> Vec<bool> {
    let mut stacked = vec![false; stage.facets.len()];
    let mut found = Vec::new();
    for f in 0..stage.facets.len() {
        over(stage, exact, f, reach, &mut found);
        for &p in &found {
            let g = exact.polygons().facet_of(p) as usize;
            if !(stacked[f] && stacked[g]) && overlap(stage, f, g, reach) {
                (stacked[f], stacked[g]) = (true, true);
            }
        }
    }
    stacked
}

/// Polygons of later facets near facet `f`, over it, in another plane.
fn over(stage: &Stage, exact: &BuiltinKernel, f: usize, reach: f64, found: &mut Vec<u32>) {
    let polygons = exact.polygons();
    let corners = &stage.facets[f].vertices;
    let (lo, hi) = corners.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |b, v| (b.0.min(*v), b.1.max(*v)));
    exact.polygons_in_box(lo - reach, hi + reach, found);
    let (own, outline) = (polygons.own_group(f as u32), polygons.outline(f as u32));
    found.retain(|&p| {
        let g = polygons.facet_of(p) as usize;
        let corners = &stage.facets[g].vertices;
        g > f && polygons.group_of(p) != own && !outline.iter().any(|e| polygons.is_beyond(e, corners))
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
