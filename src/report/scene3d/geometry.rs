//! The patches of a stage as loops of shared points.

use super::encode::{counts, numbers};
use crate::math::DVec3;
use crate::scene::Stage;
use serde::Serialize;
use std::collections::HashMap;

/// A loop that is filled and outlined, only filled, only outlined.
const WHOLE: u32 = 0;
const PIECE: u32 = 1;
const OUTLINE: u32 = 2;

/// One stage to be drawn. Patches that are not there have no loop.
#[derive(Debug, Serialize)]
pub(super) struct Geometry {
    /// Points, metres from `origin`: x, y, z of each (f32).
    points: String,
    /// For each loop: patch, kind, number of corners, corners as point numbers (u32). Loops that are filled are convex,
    /// counter-clockwise seen from the front. Kind 0 is filled and outlined, 1 filled, 2 outlined.
    loops: String,
    /// What the points are counted from, metres.
    origin: [f64; 3],
}

/// Points by their place, numbered as they come.
#[derive(Default)]
struct Points {
    numbers: HashMap<[u64; 3], u32>,
    places: Vec<DVec3>,
}

impl Points {
    fn number(&mut self, p: DVec3) -> u32 {
        let next = self.places.len() as u32;
        let number = *self.numbers.entry(p.to_array().map(f64::to_bits)).or_insert(next);
        if number == next {
            self.places.push(p);
        }
        number
    }

    fn add(&mut self, loops: &mut Vec<u32>, patch: usize, kind: u32, corners: &[DVec3]) {
        loops.extend([patch as u32, kind, corners.len() as u32]);
        loops.extend(corners.iter().map(|p| self.number(*p)));
    }
}

impl Geometry {
    /// The patches of a stage; points are counted from the middle of its box, where single precision is best.
    pub(super) fn of(stage: &Stage) -> Self {
        let (mut points, mut loops) = (Points::default(), Vec::new());
        for (i, patch) in stage.patches.iter().enumerate().filter(|(_, p)| p.is_present()) {
            match patch.region.pieces.as_slice() {
                [piece] => points.add(&mut loops, i, WHOLE, piece),
                pieces => {
                    pieces.iter().for_each(|piece| points.add(&mut loops, i, PIECE, piece));
                    points.add(&mut loops, i, OUTLINE, &patch.corners);
                }
            }
        }
        let (low, high) = stage.bounds();
        let origin = 0.5 * (low + high);
        let places = points.places.iter().flat_map(|p| (*p - origin).to_array().map(Some));
        Self { points: numbers(places), loops: counts(loops), origin: origin.to_array() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{area_vector, centroid};
    use crate::render::testing::room;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;

    fn words<T>(text: &str, read: fn([u8; 4]) -> T) -> Vec<T> {
        let bytes = STANDARD.decode(text).expect("base64");
        bytes.chunks_exact(4).map(|c| read(c.try_into().expect("four bytes"))).collect()
    }

    /// Area and centre of what a page would fill, by patch.
    fn filled(g: &Geometry, patches: usize) -> Vec<(DVec3, DVec3)> {
        let (xyz, loops) = (words(&g.points, f32::from_le_bytes), words(&g.loops, u32::from_le_bytes));
        let point = |k: u32| {
            let at = 3 * k as usize;
            DVec3::new(xyz[at].into(), xyz[at + 1].into(), xyz[at + 2].into()) + DVec3::from_array(g.origin)
        };
        let mut out = vec![(DVec3::ZERO, DVec3::ZERO); patches];
        let mut rest = loops.as_slice();
        while let [patch, kind, n, tail @ ..] = rest {
            let corners: Vec<DVec3> = tail[..*n as usize].iter().map(|k| point(*k)).collect();
            if *kind != OUTLINE {
                let (area, sums) = (area_vector(&corners), &mut out[*patch as usize]);
                sums.0 += area;
                sums.1 += centroid(&corners) * area.length();
            }
            rest = &tail[*n as usize..];
        }
        out
    }

    #[test]
    fn what_is_filled_is_what_radiates() {
        let stage = room();
        let drawn = filled(&Geometry::of(&stage), stage.patch_count());
        for (patch, (area, moment)) in stage.patches.iter().zip(drawn) {
            assert!((area - patch.normal * patch.area).length() < 1e-5, "{area} {}", patch.area);
            if let Some(centre) = patch.region.centroid() {
                assert!((moment / area.length() - centre).length() < 1e-5);
            }
        }
    }

    #[test]
    fn an_absent_patch_is_not_drawn_and_corners_are_shared() {
        let mut stage = room();
        stage.patches[3].area = 0.0;
        stage.patches[3].region.pieces.clear();
        let g = Geometry::of(&stage);
        assert_eq!(filled(&g, stage.patch_count())[3].0, DVec3::ZERO);
        let corners: usize = stage.patches.iter().map(|p| p.corners.len()).sum();
        assert!(words(&g.points, f32::from_le_bytes).len() / 3 < corners / 2);
    }
}
