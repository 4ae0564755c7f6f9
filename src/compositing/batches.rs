//! Neighbouring faces that share their shadow volumes: what can stand before one of a row of windows can stand before all.

use super::image::SpanFace;
use crate::math::{Bounds, DVec3};

/// Most faces of a batch, and how large it may grow as a share of the scene's diagonal.
const MOST: usize = 64;
const BREADTH: f64 = 0.05;

/// Faces of one cluster in their order, cut where a batch would become too large.
pub(super) struct Batches {
    /// Batch of each face.
    pub(super) of: Vec<u32>,
    /// Box around the faces of each batch.
    pub(super) bounds: Vec<Bounds>,
}

impl Batches {
    pub(super) fn new(faces: &[SpanFace]) -> Self {
        // A tree turns to whoever looks: its box holds all it may turn to.
        let around = |f: &SpanFace| {
            let breadth = if f.tree.is_some() { f.vertices[0].distance(f.vertices[1]) } else { 0.0 };
            Bounds::of(&f.vertices).grown(0.5 * breadth)
        };
        let boxes: Vec<Bounds> = faces.iter().map(around).collect();
        let all = boxes.iter().fold(Bounds::NOTHING, |all, b| all.joined(*b));
        let size = |b: &Bounds| if b.lo.cmple(b.hi).all() { (b.hi - b.lo).length() } else { 0.0 };
        let limit = BREADTH * size(&all);
        let mut made = Self { of: Vec::with_capacity(faces.len()), bounds: Vec::new() };
        let mut count = 0;
        for (k, own) in boxes.iter().enumerate() {
            let joined = made.bounds.last().map(|b| b.joined(*own));
            match joined {
                Some(joined) if count < MOST && size(&joined) <= limit && faces[k].cluster == faces[k - 1].cluster => {
                    made.bounds.pop();
                    made.bounds.push(joined);
                    count += 1;
                }
                _ => {
                    made.bounds.push(*own);
                    count = 1;
                }
            }
            made.of.push(made.bounds.len() as u32 - 1);
        }
        debug_assert!(made.bounds.iter().all(|b| b.lo != DVec3::INFINITY));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{outset, triangles};
    use super::*;

    #[test]
    fn every_face_lies_in_the_box_of_its_batch() {
        let mut faces = outset(triangles(500, 9), 3, [8, 6], 1).faces;
        faces.sort_by_key(|f| f.cluster);
        let batches = Batches::new(&faces);
        for (face, batch) in faces.iter().zip(&batches.of) {
            let bounds = &batches.bounds[*batch as usize];
            assert!(face.vertices.iter().all(|v| v.cmpge(bounds.lo).all() && v.cmple(bounds.hi).all()));
        }
        // One cluster each, and one batch after the other.
        assert!(batches.of.windows(2).all(|w| w[1] == w[0] || w[1] == w[0] + 1));
        let crossing = |k: &usize| batches.of[*k] == batches.of[k - 1] && faces[*k].cluster != faces[k - 1].cluster;
        assert_eq!((1..faces.len()).find(crossing), None);
    }

    #[test]
    fn small_neighbours_are_together() {
        let tile = |x: f64| vec![DVec3::new(x, 0.0, 0.0), DVec3::new(x + 1.0, 0.0, 0.0), DVec3::new(x, 1.0, 0.0)];
        let faces = outset((0..1000).map(|k| tile(f64::from(k))).collect(), 1, [8, 6], 1).faces;
        let batches = Batches::new(&faces);
        assert!(batches.bounds.len() < 30, "{}", batches.bounds.len());
    }
}
