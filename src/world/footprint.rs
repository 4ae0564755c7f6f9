//! Outlines of cones on the panels of a layout, for pictures of what is filtered [G86 fig. 4] [G86 fig. 6].

use super::cone::Cone;
use super::layout::{Layout, Shape, Spot};
use crate::math::DVec3;
use std::f64::consts::TAU;

/// Points along an outline.
const POINTS: usize = 256;

/// A cone's outline as drawn: lines of points (texels) on panels, cut where they leave one for another and where a map
/// goes round. `scale` makes the cone as many times wider about its middle: concentric ones. What a fish-eye does not
/// show is left out.
pub fn outline(shape: Shape, cone: &Cone, scale: f64) -> Vec<(usize, Vec<[f64; 2]>)> {
    let Some(axis) = cone.axis() else { return Vec::new() };
    let around = |t: f64| -> DVec3 {
        let on_plane = match *cone {
            Cone::Quad(_) => {
                let corners = cone.quad();
                let (side, along) = ((4.0 * t).floor(), (4.0 * t).fract());
                let (from, to) = (corners[side as usize % 4], corners[(side as usize + 1) % 4]);
                from.lerp(to, along)
            }
            Cone::Ellipse { axis, a, b } => {
                let (sine, cosine) = (TAU * t).sin_cos();
                axis + a * cosine + b * sine
            }
        };
        // Wider in the plane at unit distance; beyond a hemisphere as it is.
        let depth = on_plane.dot(axis);
        if depth > 1e-9 { axis + (on_plane / depth - axis) * scale } else { on_plane }
    };
    let mut lines: Vec<(usize, Vec<[f64; 2]>)> = Vec::new();
    let mut open = false;
    let mut last: Option<(f64, Spot)> = None;
    for k in 0..=POINTS {
        let t = k as f64 / POINTS as f64;
        let here = shape.place(around(t));
        if let (Some((t0, spot)), Some(next)) = (last, here)
            && !joined(shape, spot, next)
        {
            // Up to the edge on this side, and on from it on the other.
            let (before, after) = edge(shape, &around, [t0, t], spot);
            push(&mut lines, open, before);
            push(&mut lines, false, after);
            open = true;
        }
        if let Some(spot) = here {
            push(&mut lines, open, spot);
        }
        open = here.is_some();
        last = here.map(|spot| (t, spot));
    }
    lines.retain(|(_, points)| points.len() > 1);
    lines
}

/// Adds a point to the last line, or begins another.
fn push(lines: &mut Vec<(usize, Vec<[f64; 2]>)>, open: bool, spot: Spot) {
    match lines.last_mut() {
        Some((panel, points)) if open && *panel == spot.panel => points.push([spot.x, spot.y]),
        _ => lines.push((spot.panel, vec![[spot.x, spot.y]])),
    }
}

/// Whether a line between two points stays on the panel.
fn joined(shape: Shape, a: Spot, b: Spot) -> bool {
    let round = matches!(shape.layout, Layout::LatLong | Layout::SineLatLong);
    a.panel == b.panel && !(round && (a.x - b.x).abs() > 0.5 * shape.width() as f64)
}

/// The last point joined to `from`, and the first that is not.
fn edge(shape: Shape, around: &impl Fn(f64) -> DVec3, [mut lo, mut hi]: [f64; 2], from: Spot) -> (Spot, Spot) {
    let (mut before, mut after) = (from, from);
    if let Some(spot) = shape.place(around(hi)) {
        after = spot;
    }
    for _ in 0..48 {
        let t = 0.5 * (lo + hi);
        match shape.place(around(t)) {
            Some(spot) if joined(shape, before, spot) => (lo, before) = (t, spot),
            Some(spot) => (hi, after) = (t, spot),
            None => break,
        }
    }
    (before, after)
}
