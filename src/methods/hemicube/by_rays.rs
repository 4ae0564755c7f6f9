//! The witness of the scan: the same item buffer by one ray per pixel, and where two buffers differ.

use super::item_buffer::ItemBuffer;
use super::project::Face;
use super::raster::Item;
use crate::raycast::{BACK, ESCAPED, RayBatch, TraceScratch, Tracer};
use rayon::prelude::*;

/// Rays cast in one batch.
const RAYS_PER_BATCH: usize = 4096;

/// What the hemi-cube `buffer` on `patch` shows if a ray is cast through the sampling point of every pixel: no
/// projection, no clipping, no depth buffer. `patch` says which plane the rays start on; nothing in it is hit. The
/// tracer's stage is that of the buffer, not divided in another way.
pub fn by_rays(tracer: &Tracer<'_>, patch: usize, buffer: &ItemBuffer) -> ItemBuffer {
    let from = tracer.stage().patches[patch].facet;
    let faces = std::array::from_fn(|k| face_by_rays(tracer, from, buffer, Face::ALL[k]));
    ItemBuffer { faces, ..buffer.clone() }
}

fn face_by_rays(tracer: &Tracer<'_>, from: u32, buffer: &ItemBuffer, face: Face) -> Vec<Item> {
    let (width, height) = face.size(buffer.resolution);
    let mut items = vec![Item::NOTHING; width * height];
    let start = || (RayBatch { from, ..RayBatch::default() }, TraceScratch::default(), vec![0; RAYS_PER_BATCH]);
    let blocks = items.par_chunks_mut(RAYS_PER_BATCH).enumerate();
    blocks.for_each_init(start, |(rays, scratch, landings), (block, items)| {
        rays.resize(items.len());
        for k in 0..items.len() {
            let pixel = block * RAYS_PER_BATCH + k;
            rays.set(k, buffer.eye, buffer.direction(face, pixel % width, pixel / width).normalize());
        }
        tracer.trace(rays, landings, scratch);
        items.iter_mut().zip(landings.iter()).for_each(|(item, landing)| *item = item_of(*landing));
    });
    items
}

fn item_of(landing: u32) -> Item {
    match landing {
        ESCAPED => Item::NOTHING,
        BACK => Item::BACK,
        patch => Item::patch(patch),
    }
}

/// How two item buffers of one hemi-cube differ.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Disagreement {
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels that show something else.
    pub differ: usize,
    /// Those among them that no edge explains.
    pub off_edge: usize,
}

/// Compares two item buffers by themselves. A differing pixel lies on an edge if in each buffer one of its eight
/// neighbours on the face shows what the other buffer has there. Where patches are smaller than pixels, no
/// neighbour need show them, and [`compare_closely`] must judge.
pub fn compare(a: &ItemBuffer, b: &ItemBuffer) -> Disagreement {
    judged(a, b, |face, k| {
        let (own, other) = (&a.faces[face], &b.faces[face]);
        let around = |items: &[Item], wanted: Item| {
            let (width, height) = Face::ALL[face].size(a.resolution);
            let near = |at: usize, size: usize| at.saturating_sub(1)..(at + 2).min(size);
            let mut places = near(k / width, height).flat_map(|r| near(k % width, width).map(move |c| r * width + c));
            places.any(|at| at != k && items[at] == wanted)
        };
        around(own, other[k]) && around(other, own[k])
    })
}

/// Compares the item buffer of a patch with that of [`by_rays`]. A differing pixel lies on an edge if of the ray
/// through its sampling point and 32 around it, 1/256 of a pixel away, some meet what the one buffer shows there
/// and some what the other does. A kernel of single precision can be off by more where surfaces nearly touch; the
/// built-in one is not.
pub fn compare_closely(tracer: &Tracer<'_>, patch: usize, buffer: &ItemBuffer, rays: &ItemBuffer) -> Disagreement {
    let from = tracer.stage().patches[patch].facet;
    judged(buffer, rays, |face, k| {
        let (shown, face) = ([buffer.faces[face][k], rays.faces[face][k]], Face::ALL[face]);
        let (width, _) = face.size(buffer.resolution);
        let mut batch = RayBatch { from, ..RayBatch::default() };
        batch.resize(AROUND + 1);
        for (slot, shift) in around(buffer.shift).enumerate() {
            let moved = buffer.direction_at(face, k % width, k / width, shift);
            batch.set(slot, buffer.eye, moved.normalize());
        }
        let mut landings = [0; AROUND + 1];
        tracer.trace(&batch, &mut landings, &mut TraceScratch::default());
        shown.iter().all(|item| landings.iter().any(|landing| item_of(*landing) == *item))
    })
}

/// How far from a sampling point an edge may pass and still explain a difference, pixels.
const HAIR: f64 = 1.0 / 256.0;

/// Rays around a sampling point. Where the point is a corner, a patch fills a wedge only: many directions, and none
/// along the axes and diagonals that edges like to follow.
const AROUND: usize = 32;

/// A sampling point and those around it: shifts in pixels.
fn around([x, y]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let turn = |k: usize| (k as f64 + 0.37) * std::f64::consts::TAU / AROUND as f64;
    let rim = (0..AROUND).map(turn).map(move |angle| [x + HAIR * angle.cos(), y + HAIR * angle.sin()]);
    std::iter::once([x, y]).chain(rim)
}

/// Counts what differs; `on_edge` judges a pixel of a face. Buffers of two resolutions differ throughout.
fn judged(a: &ItemBuffer, b: &ItemBuffer, on_edge: impl Fn(usize, usize) -> bool) -> Disagreement {
    let pixels = a.faces.iter().map(Vec::len).sum();
    if a.resolution != b.resolution {
        return Disagreement { pixels, differ: pixels, off_edge: pixels };
    }
    let mut found = Disagreement { pixels, ..Disagreement::default() };
    for (face, (own, other)) in a.faces.iter().zip(&b.faces).enumerate() {
        for k in (0..own.len()).filter(|k| own[*k] != other[*k]) {
            found.differ += 1;
            found.off_edge += usize::from(!on_edge(face, k));
        }
    }
    found
}
