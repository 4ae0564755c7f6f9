//! Where hemi-cubes stand: at the centre of a patch, or several over it, turned and shifted at random if asked.

use super::world::centre;
use super::{HemicubeError, Params};
use crate::math::{Bilinear, DVec3, Frame, area, centroid, compensated_sum, intersect_convex, triangle_cell_corners};
use crate::sampling::{Role, Stream};
use crate::scene::{Patch, Stage};

/// What a draw is for: a word of its own, so that the turn and the shift never share a number.
const TURN: u64 = 0x7475_726e;
const JITTER: u64 = 0x6a69_7474;

/// Parts smaller than this fraction of their cell are rounding dust.
const ROUNDING: f64 = 1e-9;

/// One hemi-cube: where it stands, how it is turned, where in its pixels it looks, and how much its row counts.
#[derive(Debug, Clone, Copy)]
pub struct Stand {
    /// Its centre, metres.
    pub eye: DVec3,
    /// Its axes; z is the normal.
    pub frame: Frame,
    /// Where in each pixel the sampling point lies, from the pixel's centre, in pixels along columns and rows of
    /// every face, each within -0.5 to 0.5. Closer than a millionth of a pixel to the pixel's rim it is moved in
    /// by that much: on a face's rim it would belong to two faces.
    pub shift: [f64; 2],
    /// Weight of its row in the mean. The weights of a patch add up to 1.
    pub weight: f64,
}

impl Stand {
    /// A hemi-cube that counts whole and looks through the centres of its pixels.
    pub fn at(eye: DVec3, frame: Frame) -> Self {
        Self { eye, frame, shift: [0.0; 2], weight: 1.0 }
    }

    /// Refuses what no hemi-cube can be; `row` is for the message.
    pub(super) fn validated(&self, row: usize) -> Result<(), HemicubeError> {
        let wrong = |what| Err(HemicubeError::BadStand { row, what });
        if !self.eye.is_finite() || ![self.frame.x, self.frame.y, self.frame.z].iter().all(|a| a.is_finite()) {
            return wrong("its place and its axes must be finite numbers");
        }
        if !self.shift.iter().all(|s| s.abs() <= 0.5) {
            return wrong("its shift must lie within half a pixel, -0.5 to 0.5");
        }
        if !(self.weight >= 0.0 && self.weight.is_finite()) {
            return wrong("its weight must be a finite number, not negative");
        }
        Ok(())
    }
}

/// Where the hemi-cube of a patch stands and how it is turned: its centre, and a frame whose z axis is the normal
/// and whose x axis lies along the first edge, turned by the rotation of `params`. `None` for a patch that takes
/// no part. Knows nothing of random turns and shifts: see [`drawn`].
pub fn stand(patch: &Patch, params: &Params) -> Option<(DVec3, Frame)> {
    Some((centre(patch)?, frame(patch, params)))
}

fn frame(patch: &Patch, params: &Params) -> Frame {
    let frame = Frame::with_x_axis(patch.normal, patch.corners[1] - patch.corners[0]);
    frame.turned(params.rotation.to_radians())
}

/// The hemi-cubes of all patches: one each, as `params` has them turned and shifted; none on a patch that takes no
/// part.
pub fn stands(stage: &Stage, params: &Params) -> Vec<Vec<Stand>> {
    let of = |(number, patch): (usize, &Patch)| {
        let one = stand(patch, params).map(|(eye, frame)| Stand::at(eye, frame));
        drawn(one.into_iter().collect(), number, params)
    };
    stage.patches.iter().enumerate().map(of).collect()
}

/// The hemi-cubes of a patch over its parts, about `cells` x `cells` of them: a quadrilateral divided bilinearly, a
/// triangle into similar triangles, any other polygon into triangles that are divided in turn. Each part has one at
/// its centre; one that contact cuts has one at the centre of area of each piece that takes part. Weights go by area
/// and add up to 1. With one cell, the hemi-cube of [`stand`]. Random turns and shifts are not drawn: see [`drawn`].
pub fn divided(patch: &Patch, cells: u32, params: &Params) -> Vec<Stand> {
    let Some(middle) = centre(patch) else { return Vec::new() };
    let frame = frame(patch, params);
    if cells <= 1 {
        return vec![Stand::at(middle, frame)];
    }
    let mut parts: Vec<(DVec3, f64)> = Vec::new();
    for cell in parts_of(&patch.corners, cells) {
        let whole = area(&cell);
        let common = patch.region.pieces.iter().map(|piece| intersect_convex(&cell, piece));
        let pieces: Vec<_> = common.filter(|p| p.len() >= 3).map(|p| (centroid(&p), area(&p))).collect();
        if pieces.iter().map(|(_, a)| a).sum::<f64>() >= whole * (1.0 - ROUNDING) {
            parts.push((cell.iter().sum::<DVec3>() / cell.len() as f64, whole));
        } else {
            parts.extend(pieces.into_iter().filter(|(_, a)| *a > whole * ROUNDING));
        }
    }
    let total = compensated_sum(parts.iter().map(|(_, a)| *a));
    parts.into_iter().map(|(eye, a)| Stand { weight: a / total, ..Stand::at(eye, frame) }).collect()
}

/// The polygon in about `cells` x `cells` parts, wound like it.
fn parts_of(corners: &[DVec3], cells: u32) -> Vec<Vec<DVec3>> {
    if let [a, b, c, d] = corners {
        let map = Bilinear::new([*a, *b, *c, *d]);
        let places = (0..cells).flat_map(|b| (0..cells).map(move |a| (a, b)));
        return places.map(|(a, b)| map.cell(a, b, cells, cells).to_vec()).collect();
    }
    let triangles = corners.len() - 2;
    let n = ((f64::from(cells) / (triangles as f64).sqrt()).round() as u32).max(1);
    let fan = (1..=triangles).map(|k| [corners[0], corners[k], corners[k + 1]]);
    let within = |t: [DVec3; 3]| {
        let places = (0..n).flat_map(move |b| (0..2 * (n - b) - 1).map(move |k| (k, b)));
        places.map(move |(k, b)| triangle_cell_corners(t, n, k, b).to_vec())
    };
    fan.flat_map(within).collect()
}

/// Turns and shifts the hemi-cubes of patch `number` at random, where `params` asks for it: each about its normal
/// by its own angle, even over [0, 90) degrees, and each by its own place in the pixel, even over the pixel. The
/// k-th hemi-cube of a patch always draws the same.
pub fn drawn(mut stands: Vec<Stand>, number: usize, params: &Params) -> Vec<Stand> {
    let stream = |seed, purpose| Stream::new(Role::Candidate, seed).child(purpose).child(number as u64);
    if let Some(turns) = params.turn.map(|seed| stream(seed, TURN)) {
        for (k, s) in stands.iter_mut().enumerate() {
            s.frame = s.frame.turned(turns.unit(k as u64) * std::f64::consts::FRAC_PI_2);
        }
    }
    if let Some(places) = params.jitter.map(|seed| stream(seed, JITTER)) {
        for (k, s) in stands.iter_mut().enumerate() {
            s.shift = [0, 1].map(|d| places.unit(2 * k as u64 + d) - 0.5);
        }
    }
    stands
}
