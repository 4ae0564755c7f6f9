//! What is seen where nothing stands.

use super::lamp::Lamp;
use super::texel::{Outside, Texels, apart, band, place};
use crate::math::DVec3;
use crate::scene::{Appearance, Texture};
use crate::view::Camera;

/// Background, skies and clouds.
pub(super) struct Backdrop<'a> {
    pub appearance: &'a Appearance,
    pub pictures: &'a [Texels],
    /// Mean of the background's picture: what mirrors see of it, since only the eye has a place in the view.
    pub mean: [f64; 4],
    pub eye: DVec3,
    pub up: DVec3,
    pub in_rgb: bool,
}

impl<'a> Backdrop<'a> {
    pub fn new(appearance: &'a Appearance, pictures: &'a [Texels], camera: &Camera, in_rgb: bool) -> Self {
        let picture = appearance.background.picture.and_then(|k| pictures.get(k));
        let mean = picture.map_or([0.0; 4], Texels::mean);
        let up = appearance.zenith();
        Self { appearance, pictures, mean, eye: camera.eye, up, in_rgb }
    }

    /// Radiance along a ray that meets nothing, W/(m^2 sr) per band; `at` is the place in the view, 0 to 1 from the left
    /// and from the top, of rays from the eye.
    pub fn radiance(&self, lamps: &[Lamp], origin: DVec3, direction: DVec3, at: Option<[f64; 2]>, out: &mut [f64]) {
        let background = &self.appearance.background;
        let picture = background.picture.and_then(|k| self.pictures.get(k)).map(|texels| match at {
            Some([x, y]) => texels.at(x, 1.0 - y, Outside::Edge),
            None => self.mean,
        });
        for (b, o) in out.iter_mut().enumerate() {
            let white = background.radiance.get(b).copied().unwrap_or(0.0);
            *o = white * picture.map_or(1.0, |c| band([c[0], c[1], c[2]], self.in_rgb, b));
        }
        let climb = direction.dot(self.up);
        if climb.is_nan() || climb <= 0.0 {
            return;
        }
        if background.sky {
            for (lamp, light) in lamps.iter().zip(&self.appearance.lights) {
                let share = lamp.sky(direction);
                out.iter_mut().zip(&light.strength).for_each(|(o, s)| *o += share * s);
            }
        }
        if let Some(clouds) = &background.clouds
            && let Some(texels) = self.pictures.get(clouds.picture)
        {
            let plane = self.eye.dot(self.up) + clouds.height;
            let way = (plane - origin.dot(self.up)) / climb;
            if way > 0.0 {
                let texture = Texture { picture: clouds.picture, origin: DVec3::ZERO, tile: clouds.tile };
                let [s, t] = place(&texture, origin + direction * way, self.up);
                let texel = texels.at(s, t, Outside::Repeat);
                let (rgb, opacity) = (apart(texel), texel[3]);
                for (b, o) in out.iter_mut().enumerate() {
                    let white = clouds.radiance.get(b).copied().unwrap_or(0.0);
                    *o = *o * (1.0 - opacity) + opacity * white * band(rgb, self.in_rgb, b);
                }
            }
        }
    }
}
