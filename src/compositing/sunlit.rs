//! Which parts of the segments the parallel light of the scene reaches: shadow edges as intersections, cluster by cluster.

use super::batches::Batches;
use super::image::{Line, Span, SpanFace, SpanImage};
use super::light::{Casters, Lamp, Volumes};
use super::merge::push;
use super::project::Projection;
use super::scan::{planes, see_through};
use crate::math::DVec3;
use crate::scene::{Light, LightShape};
use rayon::prelude::*;

/// The first parallel light: the one whose light is kept with the segments.
pub(super) fn parallel(lights: &[Light]) -> Option<&Light> {
    lights.iter().find(|l| matches!(l.shape, LightShape::Parallel { .. }))
}

/// What can cast shadows: all faces by number, those that let light through as nothing.
pub(super) fn casters(image: &SpanImage) -> Casters {
    let open = see_through(image);
    let polygon = |(f, open): (&SpanFace, &bool)| if *open { Vec::new() } else { f.vertices.clone() };
    Casters::new(image.faces.iter().zip(&open).map(polygon).collect())
}

/// Faces of a cluster that are seen.
pub(super) fn seen_faces(image: &SpanImage, cluster: u32) -> Vec<u32> {
    let mut seen = vec![false; image.faces.len()];
    image.lines.iter().flat_map(|l| &l.solid).for_each(|s| seen[s.face as usize] = true);
    (0..image.faces.len() as u32).filter(|f| seen[*f as usize] && image.faces[*f as usize].cluster == cluster).collect()
}

/// Marks every solid segment as lit or not, cutting it at shadow edges. Nothing is left of earlier marks.
pub(super) fn light_up(image: &mut SpanImage) {
    let mut lines = std::mem::take(&mut image.lines);
    lines.par_iter_mut().for_each(forget);
    let Some(light) = parallel(&image.appearance.lights) else {
        image.lines = lines;
        return;
    };
    image.lines = lines;
    let lamp = Lamp::new(light);
    let casters = casters(image);
    let projection = Projection::of(&image.camera);
    let (planes, _) = planes(image);
    let per_line = f64::from(image.per_line);
    let batches = Batches::new(&image.faces);
    let mut volumes: Vec<Option<Volumes>> = batches.bounds.iter().map(|_| None).collect();
    let mut done = std::mem::take(&mut image.lines);
    for cluster in 0..image.clusters.len() as u32 {
        image.lines = done;
        let seen = seen_faces(image, cluster);
        done = std::mem::take(&mut image.lines);
        let mut wanted: Vec<u32> = seen.iter().map(|f| batches.of[*f as usize]).collect();
        wanted.dedup();
        let of_batch = |b: &u32| Volumes::new(&lamp, &casters, &batches.bounds[*b as usize]);
        let made: Vec<Volumes> = wanted.par_iter().map(of_batch).collect();
        wanted.iter().zip(made).for_each(|(b, v)| volumes[*b as usize] = Some(v));
        let mark = |(j, line): (usize, &mut Line)| {
            let y = j as f64 / per_line;
            let mut out = Vec::with_capacity(line.solid.len());
            let mut hidden = Vec::new();
            for span in &line.solid {
                let Some(volumes) = &volumes[batches.of[span.face as usize] as usize] else {
                    push(&mut out, *span);
                    continue;
                };
                let face = &image.faces[span.face as usize];
                let [a, b] = [span.from, span.to].map(|x| (x, planes[span.face as usize].value(x, y)));
                let ends = [a, b].map(|(x, w)| projection.point(x, y, w));
                hidden.clear();
                match shines_on(face, image.camera.eye, &lamp, ends[0]) {
                    true => lamp.hidden(ends[0], ends[1], span.face, volumes, &mut hidden),
                    false => hidden.push((0.0, 1.0)),
                }
                cut(span, &hidden, |t| picture_place(a, b, t), &mut out);
            }
            line.solid = out;
        };
        done.par_iter_mut().enumerate().for_each(mark);
        volumes.iter_mut().for_each(|v| *v = None);
    }
    image.lines = done;
}

/// True if the light falls on the side of the face that is seen.
fn shines_on(face: &SpanFace, eye: DVec3, lamp: &Lamp, point: DVec3) -> bool {
    let front = face.normal();
    let seen = if front.dot(eye - point) >= 0.0 { front } else { -front };
    lamp.open(point, seen) > 0.0
}

/// Joins what shadow edges have cut.
fn forget(line: &mut Line) {
    let mut out = Vec::with_capacity(line.solid.len());
    line.solid.iter().for_each(|s| push(&mut out, Span { lit: true, ..*s }));
    line.solid = out;
}

/// Where the share `t` of a segment in space lies between its ends in the picture, each (x, reciprocal depth).
pub(super) fn picture_place(a: (f64, f64), b: (f64, f64), t: f64) -> f64 {
    match t {
        0.0 => a.0,
        1.0 => b.0,
        _ => {
            let (za, zb) = ((1.0 - t) / a.1, t / b.1);
            ((a.0 * za + b.0 * zb) / (za + zb)).clamp(a.0, b.0)
        }
    }
}

/// Cuts a segment at the ends of its hidden parts.
fn cut(span: &Span, hidden: &[(f64, f64)], place: impl Fn(f64) -> f64, out: &mut Vec<Span>) {
    let mut x = span.from;
    for (t0, t1) in hidden {
        let (h0, h1) = (place(*t0), place(*t1));
        push(out, Span { from: x, to: h0, lit: true, ..*span });
        push(out, Span { from: h0.max(x), to: h1, lit: false, ..*span });
        x = x.max(h1);
    }
    push(out, Span { from: x, lit: true, ..*span });
}
