//! What is written: a map in a layout, or a flat picture; as numbers or as an eye would see it.

use crate::cli::args::{ToneChoice, ViewingArgs};
use crate::cli::exit::Failure;
use crate::io::image::{Channel, ImageError, Samples, channel_names, exr, png};
use crate::io::world_map::world_map_exr;
use crate::render::{Raster, Seen, ToneMap, paint_radiances, paint_world};
use crate::view::{Operator, Photometry};
use crate::world::{WorldMap, unfolded};
use std::f64::consts::PI;

/// Radiances, or irradiances, in a layout.
pub struct Drawn {
    pub kind: Kind,
    pub photometry: Photometry,
    /// Luminances (weighted by band, of B) that the eye adapts to, each with its share of what is seen and whether it is
    /// a lamp.
    pub adapts_to: Vec<(f64, f64, bool)>,
    /// What the numbers are, for whoever opens the file.
    pub comments: String,
    /// True where the numbers are irradiances.
    pub is_irradiance: bool,
    /// Further channels, texel by texel as `kind` is, named.
    pub more: Vec<(String, Vec<f32>)>,
}

/// The form of it.
pub enum Kind {
    /// A layout.
    Map(WorldMap),
    /// A plane picture: width, height, bands side by side.
    Flat([u32; 2], Vec<f32>),
}

impl Drawn {
    /// Irradiances are shown as a white matt surface is seen under them, of radiance E / pi; numbers stay as they are.
    pub fn shown_as_white_matt(&mut self) {
        self.is_irradiance = true;
        if let Some(map) = self.as_radiance() {
            self.adapts_to = texels(&map, &self.photometry);
        }
    }

    /// A map of radiances, whatever it holds; `None` of a flat picture.
    fn as_radiance(&self) -> Option<WorldMap> {
        let Kind::Map(map) = &self.kind else { return None };
        let factor = if self.is_irradiance { (1.0 / PI) as f32 } else { 1.0 };
        let values = map.values().iter().map(|v| v * factor).collect();
        Some(WorldMap::new(map.shape(), map.bands(), values))
    }

    /// Pixels across and down.
    pub fn size(&self) -> [u32; 2] {
        match &self.kind {
            Kind::Map(map) => {
                let sheet = unfolded(map.shape());
                [sheet.width, sheet.height]
            }
            Kind::Flat(size, _) => *size,
        }
    }

    /// Numbers.
    pub fn exr(&self) -> Result<Vec<u8>, Failure> {
        let bug = |e: ImageError| Failure::input(e.to_string());
        let bands = &self.photometry.bands;
        match &self.kind {
            Kind::Map(map) => world_map_exr(map, bands, &self.comments, &self.more).map_err(bug),
            Kind::Flat([width, height], values) => {
                let band = |c: usize| values.iter().skip(c).step_by(bands.len()).copied().collect();
                let channels: Vec<Channel> = channel_names(bands)
                    .into_iter()
                    .enumerate()
                    .map(|(c, name)| Channel { name, samples: Samples::F32(band(c)) })
                    .collect();
                exr(*width, *height, &channels, &self.comments).map_err(bug)
            }
        }
    }

    /// A picture, with what its colours mean.
    pub fn png(&self, tone: ToneChoice, viewing: &ViewingArgs) -> Result<(Vec<u8>, Vec<String>), Failure> {
        let operator = match tone {
            ToneChoice::Operator(operator) => operator,
            ToneChoice::Linear => Operator::default(),
        };
        let seen = Seen { shares: self.adapts_to.iter().map(|a| a.1).collect() };
        let luminances: Vec<f64> = self.adapts_to.iter().map(|a| a.0).collect();
        let lamps: Vec<bool> = self.adapts_to.iter().map(|a| a.2).collect();
        let viewer = viewing.onlooker(operator).look(&seen, &luminances, &lamps);
        let shade = ToneMap::new(viewer, &self.photometry);
        let clipped = shade.clipped(self.adapts_to.iter().map(|a| (a.0, a.1)));
        let raster: Raster = match (&self.kind, self.as_radiance()) {
            (Kind::Flat([w, h], values), _) => paint_radiances(*w, *h, self.photometry.bands.len(), values, &shade),
            (Kind::Map(map), None) => paint_world(map, &shade),
            (Kind::Map(_), Some(map)) => paint_world(&map, &shade),
        };
        let bytes = png(raster.width, raster.height, &raster.rgba).map_err(|e| Failure::input(e.to_string()))?;
        Ok((bytes, vec![crate::report::tone_words(&shade.viewer, clipped)]))
    }
}

/// Every texel of a map with its share of the world; none is known to be a lamp.
pub fn texels(map: &WorldMap, photometry: &Photometry) -> Vec<(f64, f64, bool)> {
    let shape = map.shape();
    let of = |k: usize| {
        let b: Vec<f64> = map.texel(k).iter().map(|l| PI * f64::from(*l)).collect();
        (photometry.luminance(&b), shape.solid_angle(k) / (4.0 * PI), false)
    };
    (0..shape.texels()).map(of).collect()
}
