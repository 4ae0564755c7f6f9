//! Which patch each part of each pixel shows: cast once, painted many times.

use super::fit_camera;
use crate::math::DVec3;
use crate::raycast::{BACK, ESCAPED, RayBatch, Tracer};
use crate::scene::{NO_FACET, Stage};
use crate::view::Camera;
use rayon::prelude::*;

/// Samples along each edge of a pixel unless told otherwise: 2 x 2 a pixel.
pub const SUPERSAMPLING: u32 = 2;

/// What a camera sees: `side * side` samples on a regular grid in each pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    camera: Camera,
    side: u32,
    /// Pixel-major, rows from the top: patch number, `BACK` or `ESCAPED`.
    landings: Vec<u32>,
}

/// A camera with what it sees.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// What the camera sees.
    pub visibility: Visibility,
    /// True if the scene has no camera and this one was fitted.
    pub fitted: bool,
}

/// One view for each camera of the tracer's stage; one fitted view where it has none.
pub fn views(tracer: &Tracer) -> Vec<View> {
    let cast = |camera: &Camera, fitted| View { visibility: Visibility::cast(tracer, camera, SUPERSAMPLING), fitted };
    let cameras = &tracer.stage().cameras;
    if cameras.is_empty() {
        return vec![cast(&fit_camera(tracer), true)];
    }
    cameras.iter().map(|c| cast(c, false)).collect()
}

impl Visibility {
    /// Casts `side * side` rays through each pixel; `side` of at least 1.
    pub fn cast(tracer: &Tracer, camera: &Camera, side: u32) -> Self {
        let [width, height] = camera.size;
        let rows: Vec<Vec<u32>> =
            (0..height).into_par_iter().map(|y| cast_row(tracer, camera, side, y, width)).collect();
        Self { camera: camera.clone(), side, landings: rows.concat() }
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.camera.size
    }

    /// Number of pixels.
    pub fn pixel_count(&self) -> usize {
        self.camera.size[0] as usize * self.camera.size[1] as usize
    }

    /// What the samples of a pixel (row-major from the upper left corner) land on: a patch, [`BACK`] or [`ESCAPED`].
    pub fn samples(&self, pixel: usize) -> &[u32] {
        let n = (self.side * self.side) as usize;
        &self.landings[pixel * n..(pixel + 1) * n]
    }

    /// Patches in a pixel with the share of it that each covers; shares add to less than 1 where backs or the
    /// background show.
    pub fn coverage(&self, pixel: usize) -> Vec<(u32, f64)> {
        let samples = self.samples(pixel);
        let mut seen: Vec<u32> = samples.iter().copied().filter(|l| *l < BACK).collect();
        seen.sort_unstable();
        let share = |run: &[u32]| (run[0], run.len() as f64 / samples.len() as f64);
        seen.chunk_by(|a, b| a == b).map(share).collect()
    }

    /// Point in which sample k of a pixel meets the patch it shows, metres; `None` on backs and background.
    pub fn point(&self, stage: &Stage, pixel: usize, k: usize) -> Option<DVec3> {
        let patch = stage.patches.get(self.samples(pixel)[k] as usize)?;
        let width = self.camera.size[0] as usize;
        let (sx, sy) = (k % self.side as usize, k / self.side as usize);
        let at = |whole: usize, part: usize| whole as f64 + (part as f64 + 0.5) / f64::from(self.side);
        let direction = self.camera.direction(at(pixel % width, sx), at(pixel / width, sy));
        let along = patch.normal.dot(patch.corners[0] - self.camera.eye) / patch.normal.dot(direction);
        Some(self.camera.eye + direction * along)
    }

    /// Middle (x, y, pixels) of the visible part of each patch that is asked for; `None` for one out of sight.
    pub fn middles(&self, patches: &[usize]) -> Vec<Option<(f64, f64)>> {
        let mut sums = vec![(0.0, 0.0, 0u32); patches.len()];
        let per_pixel = (self.side * self.side) as usize;
        for (k, landing) in self.landings.iter().enumerate() {
            // The same patch may be asked for more than once.
            for (sum, _) in sums.iter_mut().zip(patches).filter(|(_, p)| **p as u64 == u64::from(*landing)) {
                let (pixel, width) = (k / per_pixel, self.camera.size[0] as usize);
                sum.0 += (pixel % width) as f64 + 0.5;
                sum.1 += (pixel / width) as f64 + 0.5;
                sum.2 += 1;
            }
        }
        let mean = |&(x, y, n): &(f64, f64, u32)| (n > 0).then(|| (x / f64::from(n), y / f64::from(n)));
        sums.iter().map(mean).collect()
    }

    /// Share of all samples that show a patch, a back, and the background.
    pub fn shares(&self) -> [f64; 3] {
        let mut counts = [0u64; 3];
        for landing in &self.landings {
            counts[match *landing {
                ESCAPED => 2,
                BACK => 1,
                _ => 0,
            }] += 1;
        }
        counts.map(|c| c as f64 / self.landings.len().max(1) as f64)
    }
}

/// Landings of one row of pixels, pixel-major.
fn cast_row(tracer: &Tracer, camera: &Camera, side: u32, y: u32, width: u32) -> Vec<u32> {
    let per_pixel = (side * side) as usize;
    let mut rays = RayBatch::zeroed(width as usize * per_pixel);
    rays.from = NO_FACET;
    let at = |whole: u32, part: u32| f64::from(whole) + (f64::from(part) + 0.5) / f64::from(side);
    let mut k = 0;
    for x in 0..width {
        for (sy, sx) in (0..side).flat_map(|sy| (0..side).map(move |sx| (sy, sx))) {
            rays.set(k, camera.eye, camera.direction(at(x, sx), at(y, sy)));
            k += 1;
        }
    }
    tracer.look(&rays).iter().map(|hit| hit.map_or(ESCAPED, |(_, _, landing)| landing)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{room, tracer};

    #[test]
    fn points_lie_in_the_patches_they_are_seen_in() {
        let stage = room();
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 2);
        let mut checked = 0;
        for pixel in (0..seen.pixel_count()).step_by(37) {
            for k in 0..4 {
                let landing = seen.samples(pixel)[k] as usize;
                let Some(p) = seen.point(&stage, pixel, k) else { continue };
                let patch = &stage.patches[landing];
                let corners = &patch.corners;
                for i in 0..corners.len() {
                    let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                    assert!(patch.normal.cross(b - a).dot(p - a) > -1e-9, "sample {k} of pixel {pixel}");
                }
                checked += 1;
            }
        }
        assert!(checked > 500, "{checked}");
    }

    #[test]
    fn a_pixel_on_a_seam_is_shared_by_its_patches() {
        let stage = room();
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 4);
        let shared = (0..seen.pixel_count()).map(|p| seen.coverage(p)).find(|c| c.len() == 2);
        let shares = shared.expect("some pixel shows two patches");
        assert!((shares[0].1 + shares[1].1 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_closed_room_shows_no_background_and_a_patch_is_found_where_it_is() {
        let stage = room();
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 1);
        assert_eq!(seen.shares()[2], 0.0);
        let middle = seen.pixel_count() / 2 + seen.size()[0] as usize / 2;
        let patch = seen.samples(middle)[0] as usize;
        let (x, y) = seen.middles(&[patch])[0].expect("in sight");
        let [w, h] = seen.size().map(f64::from);
        assert!((x - w / 2.0).abs() < w / 4.0 && (y - h / 2.0).abs() < h / 4.0);
        assert_eq!(seen.middles(&[stage.patch_count() + 7]), [None]);
        let twice = seen.middles(&[patch, patch]);
        assert!(twice[0].is_some() && twice[0] == twice[1]);
    }
}
