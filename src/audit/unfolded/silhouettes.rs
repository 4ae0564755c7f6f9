//! Silhouettes on the faces of a hemi-cube: borders between items, and the edges of sources.

use crate::math::{DVec3, Frame};
use crate::methods::hemicube::{Face, Item};
use crate::render::{Outline, Silhouette};
use crate::scene::{Patch, Stage};
use std::collections::BTreeSet;

/// Lines between pixels of a face that show different items, neighbouring pieces of one kind joined.
pub(super) fn borders<'a>(stage: &'a Stage, items: &'a [Item], n: usize) -> impl Iterator<Item = Silhouette> + 'a {
    let rows = items.len() / n;
    let start = if rows == n { -1.0 } else { 0.0 };
    let edge = 2.0 / n as f64;
    let parted = |a: Item, b: Item| match (a.as_patch(), b.as_patch()) {
        _ if a == b => None,
        (Some(i), Some(j)) if stage.patches[i as usize].surface == stage.patches[j as usize].surface => {
            Some(Outline::Patches)
        }
        _ => Some(Outline::Surfaces),
    };
    let below = (1..rows).flat_map(move |row| {
        let kind = move |c: usize| parted(items[(row - 1) * n + c], items[row * n + c]);
        let v = start + row as f64 * edge;
        runs(n, kind).into_iter().map(move |(o, a, b)| (o, [[a, v], [b, v]].map(|[k, v]| [-1.0 + k * edge, v])))
    });
    let left = (1..n).flat_map(move |column| {
        let kind = move |r: usize| parted(items[r * n + column - 1], items[r * n + column]);
        let u = -1.0 + column as f64 * edge;
        runs(rows, kind).into_iter().map(move |(o, a, b)| (o, [a, b].map(|k| [u, start + k * edge])))
    });
    below.chain(left).map(|(outline, ends)| Silhouette { outline, ends })
}

/// Runs of one kind among `count` places: (kind, from, to).
fn runs(count: usize, kind: impl Fn(usize) -> Option<Outline>) -> Vec<(Outline, f64, f64)> {
    let mut found: Vec<(Outline, f64, f64)> = Vec::new();
    for k in 0..count {
        let Some(outline) = kind(k) else { continue };
        match found.last_mut() {
            Some((last, _, to)) if *last == outline && *to == k as f64 => *to += 1.0,
            _ => found.push((outline, k as f64, k as f64 + 1.0)),
        }
    }
    found
}

/// Edges of the sources as they project onto a face of `n` columns with these items, where the source is seen beside
/// them; edges between two sources are left out.
pub(super) fn projected(
    stage: &Stage,
    sources: &BTreeSet<u32>,
    stand: (DVec3, Frame),
    face: Face,
    (items, n): (&[Item], usize),
) -> Vec<Silhouette> {
    let (eye, frame) = stand;
    let standing = sources.iter().filter_map(|j| stage.patches.get(*j as usize)).filter(|p| p.is_present());
    let before: Vec<&Patch> = standing.filter(|p| p.normal.dot(eye - p.corners[0]) > 0.0).collect();
    let edges = |p: &Patch| {
        let corners = p.corners.clone();
        (0..corners.len()).map(move |k| [corners[k], corners[(k + 1) % corners.len()]]).collect::<Vec<_>>()
    };
    let all: Vec<[DVec3; 2]> = before.iter().flat_map(|p| edges(p)).collect();
    let outer = all.iter().filter(|[a, b]| !all.contains(&[*b, *a]));
    let on_face = outer.filter_map(|ends| clipped(ends.map(|p| frame.to_local(p - eye)), face));
    let seen = |[u, v]: [f64; 2]| beside_source([u, v], (items, n), sources);
    on_face.flat_map(|ends| visible_parts(ends, n, seen)).collect()
}

/// The part of a segment of the patch frame that projects onto a face, in its coordinates.
fn clipped(mut ends: [DVec3; 2], face: Face) -> Option<[[f64; 2]; 2]> {
    let [depth, u, v] = [DVec3::X, DVec3::Y, DVec3::Z].map(|q| face.to_frame(q));
    let floor = if face == Face::Top { depth + v } else { v };
    for plane in [depth - u, depth + u, depth - v, floor] {
        let side = ends.map(|p| plane.dot(p));
        let cut = || ends[0] + (ends[1] - ends[0]) * (side[0] / (side[0] - side[1]));
        match side.map(|s| s >= 0.0) {
            [false, false] => return None,
            [true, false] => ends[1] = cut(),
            [false, true] => ends[0] = cut(),
            [true, true] => {}
        }
    }
    let flat = ends.map(|p| [u.dot(p) / depth.dot(p), v.dot(p) / depth.dot(p)]);
    flat.iter().flatten().all(|c| c.is_finite()).then_some(flat)
}

/// True if one of the pixels around a point of a face shows the source.
fn beside_source([u, v]: [f64; 2], (items, n): (&[Item], usize), sources: &BTreeSet<u32>) -> bool {
    let rows = items.len() / n;
    let start = if rows == n { -1.0 } else { 0.0 };
    let [column, row] = [u + 1.0, v - start].map(|c| (c * n as f64 / 2.0).floor() as i64);
    (-1..=1).flat_map(|y| (-1..=1).map(move |x| (column + x, row + y))).any(|(c, r)| {
        let inside = (0..n as i64).contains(&c) && (0..rows as i64).contains(&r);
        inside && items[r as usize * n + c as usize].as_patch().is_some_and(|j| sources.contains(&j))
    })
}

/// The pieces of a line, each about a pixel long at first, where its middle is seen; neighbours joined.
fn visible_parts(ends: [[f64; 2]; 2], n: usize, seen: impl Fn([f64; 2]) -> bool) -> Vec<Silhouette> {
    let [a, b] = ends;
    let at = |t: f64| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
    let pieces = ((b[0] - a[0]).hypot(b[1] - a[1]) * n as f64 / 2.0).ceil().max(1.0);
    let kind = |k: usize| seen(at((k as f64 + 0.5) / pieces)).then_some(Outline::Source);
    let parts = runs(pieces as usize, kind).into_iter();
    parts.map(|(outline, from, to)| Silhouette { outline, ends: [from, to].map(|k| at(k / pieces)) }).collect()
}
