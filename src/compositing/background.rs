//! What is seen where nothing stands: a radiance, a picture, the sky, clouds.

use super::mapping::Mapping;
use super::texture::{Beyond, Sampler, to_bands};
use crate::math::DVec3;
use crate::scene::{Background, Texture};
use crate::view::{Camera, Photometry};

/// A background as one camera sees it.
#[derive(Debug, Clone)]
pub struct Backdrop<'a> {
    background: &'a Background,
    sampler: &'a Sampler,
    photometry: &'a Photometry,
    eye: DVec3,
    up: DVec3,
}

impl<'a> Backdrop<'a> {
    /// The background behind what `camera` sees, under a zenith.
    pub fn new(
        background: &'a Background,
        sampler: &'a Sampler,
        photometry: &'a Photometry,
        camera: &Camera,
        up: DVec3,
    ) -> Self {
        Self { background, sampler, photometry, eye: camera.eye, up }
    }

    /// Radiance from a direction (unit vector), W/(m^2 sr) per band, into `out`.
    ///
    /// `at`: place in the picture, 0 to 1 from the left and from the top; a ray that has been mirrored has none, and sees
    /// the picture's mean; `pixel`: what of it a pixel covers, across and down. `width`: angle that a pixel spans, radians, 0 for a point of it. `sky` adds the radiance of
    /// the lights that are skies, for directions above the horizon.
    pub fn radiance(
        &self,
        direction: DVec3,
        at: Option<[f64; 2]>,
        pixel: [f64; 2],
        width: f64,
        sky: impl FnOnce(DVec3, &mut [f64]),
        out: &mut [f64],
    ) {
        for (band, l) in out.iter_mut().enumerate() {
            *l = self.background.radiance.get(band).copied().unwrap_or(0.0);
        }
        if let Some(picture) = self.background.picture {
            let whole = [[f64::INFINITY, 0.0], [0.0, f64::INFINITY]];
            let (colour, alpha) = match at {
                Some([x, y]) => {
                    let sides = [[pixel[0], 0.0], [0.0, pixel[1]]];
                    self.sampler.mean(picture, [x, 1.0 - y], sides, Beyond::Edge)
                }
                None => self.sampler.mean(picture, [0.5; 2], whole, Beyond::Edge),
            };
            self.each(colour, out, |l, c| l * c * f64::from(alpha));
        }
        let climb = direction.dot(self.up);
        if climb <= 0.0 {
            return;
        }
        if self.background.sky {
            sky(direction, out);
        }
        if let Some(clouds) = &self.background.clouds {
            let distance = clouds.height / climb;
            let texture = Texture { picture: clouds.picture, origin: DVec3::ZERO, tile: clouds.tile };
            let mapping = Mapping::of(self.up);
            let place = mapping.place(&texture, self.eye + direction * distance);
            // A pixel near the horizon covers a long strip of the plane.
            let away = (direction - self.up * climb).normalize_or_zero();
            let sides = [away * (distance * width / climb), self.up.cross(away) * (distance * width)];
            let sides = sides.map(|v| mapping.step(&texture, v));
            let (colour, alpha) = self.sampler.mean(clouds.picture, place, sides, Beyond::Again);
            let alpha = f64::from(alpha);
            let mut band = 0;
            self.each(colour, out, |l, c| {
                band += 1;
                l * (1.0 - alpha) + alpha * c * clouds.radiance.get(band - 1).copied().unwrap_or(0.0)
            });
        }
    }

    /// Puts together every band of `out` with the colour's.
    fn each(&self, colour: [f32; 3], out: &mut [f64], mut with: impl FnMut(f64, f64) -> f64) {
        let (mut buffer, mut heap) = ([0.0; 4], Vec::new());
        // Scenes have three bands or one; more of them need not be fast.
        let bands = match buffer.get_mut(..out.len()) {
            Some(bands) => bands,
            None => {
                heap.resize(out.len(), 0.0);
                &mut heap[..]
            }
        };
        to_bands(colour, self.photometry, bands);
        out.iter_mut().zip(&*bands).for_each(|(l, c)| *l = with(*l, *c));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Clouds, Picture};

    fn camera() -> Camera {
        Camera {
            name: "c".into(),
            eye: DVec3::new(3.0, 4.0, 1.0),
            target: DVec3::new(3.0, 9.0, 1.0),
            up: DVec3::Z * 2.0,
            fov: 60.0,
            size: [64, 48],
        }
    }

    /// Half opaque white beside transparent; then a picture of black over white.
    fn pictures() -> Sampler {
        let clouds = [[255, 255, 255, 255], [0, 0, 0, 0]].concat();
        let view = [[0, 0, 0, 255], [255, 255, 255, 255]].concat();
        Sampler::new(&[
            Picture { name: "c".into(), size: [2, 1], rgba: clouds },
            Picture { name: "v".into(), size: [1, 2], rgba: view },
        ])
        .expect("pictures")
    }

    fn look(background: &Background, direction: DVec3, at: Option<[f64; 2]>, width: f64) -> [f64; 3] {
        let (sampler, photometry) = (pictures(), Photometry::rec709());
        let mut out = [9.0; 3];
        let sky = |_: DVec3, l: &mut [f64]| l.iter_mut().for_each(|v| *v += 10.0);
        let backdrop = Backdrop::new(background, &sampler, &photometry, &camera(), DVec3::Z);
        backdrop.radiance(direction.normalize(), at, [1e-9; 2], width, sky, &mut out);
        out
    }

    #[test]
    fn a_picture_is_stretched_over_the_view() {
        let background = Background { radiance: vec![1.0, 2.0, 3.0], picture: Some(1), ..Background::default() };
        assert_eq!(look(&background, DVec3::Y, Some([0.5, 0.1]), 0.0), [0.0; 3]);
        assert_eq!(look(&background, DVec3::Y, Some([0.5, 0.5]), 0.0), [0.5, 1.0, 1.5]);
        assert_eq!(look(&background, DVec3::Y, Some([0.0, 1.0]), 0.0), [1.0, 2.0, 3.0]);
        assert_eq!(look(&background, DVec3::Y, None, 0.0), [0.5, 1.0, 1.5]);
        assert_eq!(look(&Background::default(), DVec3::Y, None, 0.0), [0.0; 3]);
    }

    #[test]
    fn sky_and_clouds_above_the_horizon_only() {
        let clouds = Clouds { picture: 0, height: 10.0, tile: [4.0, 1.0], radiance: vec![2.0, 4.0, 6.0] };
        let background =
            Background { radiance: vec![1.0; 3], sky: true, clouds: Some(clouds), ..Background::default() };
        // Straight up the plane is met at x = 3, in the transparent half; 2 m west in the opaque one.
        assert_eq!(look(&background, DVec3::Z, None, 0.0), [11.0; 3]);
        assert_eq!(look(&background, DVec3::new(-2.0, 0.0, 10.0), None, 0.0), [2.0, 4.0, 6.0]);
        let half = look(&background, DVec3::new(-1.0, 0.0, 10.0), None, 0.0);
        assert!((half[0] - 6.5).abs() < 1e-5 && (half[2] - 8.5).abs() < 1e-5, "{half:?}");
        assert_eq!(look(&background, DVec3::new(-2.0, 0.0, -10.0), None, 0.0), [1.0; 3]);
        assert_eq!(look(&background, DVec3::Y, None, 0.0), [1.0; 3]);
        // Near the horizon a pixel covers many repeats: half of them are clouds.
        let far = look(&background, DVec3::new(1.0, 0.0, 1e-4), None, 1e-3);
        assert!((far[0] - 6.5).abs() < 1e-3, "{far:?}");
        assert!(look(&background, DVec3::new(1.0, 0.0, 1e-320), None, 1e-3).iter().all(|v| v.is_finite()));
    }
}
