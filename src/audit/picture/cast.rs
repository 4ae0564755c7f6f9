//! A picture by rays: every pixel the mean over its square, with a standard error.

use super::PictureFault;
use super::net::{Net, Pair};
use super::setting::{Setting, decoded};
use super::shadow::Beams;
use super::wave::{Look, Wave};
use crate::math::DVec3;
use crate::raycast::Tracer;
use crate::sampling::Stream;
use crate::scene::{Appearance, NO_FACET};
use crate::stats::Moments;
use crate::view::Camera;
use rayon::prelude::*;

/// Looks that are followed at a time.
const AT_ONCE: usize = 1 << 15;

/// What rounding may take from the size of a scaled picture.
const ROUNDING: f64 = 1e-9;

/// Writes the radiosity (W/m^2 per band) of a patch at a point of it; false where it has none.
pub type Diffuse<'a> = dyn Fn(u32, DVec3, &mut [f64]) -> bool + Sync + 'a;

/// What picture is cast, and how well.
#[derive(Clone, Copy)]
pub struct PictureOptions<'a> {
    /// Scale along x and y, [T_x, T_y].
    pub scale: [f64; 2],
    /// Samples per pixel, rounded up to a multiple of the randomisations.
    pub samples: u64,
    /// Independent randomisations of every pixel, at least 2; their spread is the standard error.
    pub randomisations: u32,
    /// Radiance per facet and band of surfaces that need no light, seen from both sides: for the edges alone. Finishes
    /// then have no effect.
    pub flat: Option<&'a [f64]>,
    /// Radiosities to show beside the lights: what is above a patch's emission, times its colour texture, is added.
    pub diffuse: Option<&'a Diffuse<'a>>,
}

impl Default for PictureOptions<'_> {
    fn default() -> Self {
        Self { scale: [1.0; 2], samples: 64, randomisations: 16, flat: None, diffuse: None }
    }
}

/// A picture cast by rays.
#[derive(Debug, Clone, PartialEq)]
pub struct RayPicture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Bands per pixel.
    pub bands: usize,
    /// Radiance, W/(m^2 sr): rows from the top, pixels from the left, bands.
    pub mean: Vec<f64>,
    /// Standard errors, in the same order.
    pub std_err: Vec<f64>,
    /// Randomisations.
    pub randomisations: u32,
    /// Luminance by each randomisation, randomisations of a pixel side by side.
    pub luminance: Vec<f32>,
    /// Rays cast, those to lamps included.
    pub rays: u64,
}

/// One row of pixels.
struct Row {
    mean: Vec<f64>,
    std_err: Vec<f64>,
    luminance: Vec<f32>,
    rays: u64,
}

/// What a camera sees by rays alone: first hits, one place on every light per sample, mirrors and panes up to 8 deep.
///
/// Pixel (i, j) of the scaled picture is the mean over x in [i, i + 1] / T_x, y in [j, j + 1] / T_y of the original; what
/// would be part of a pixel at its right and lower edge is left out. Thread counts change nothing.
///
/// # Errors
/// [`PictureFault`]: a scale without pixels, pictures that are broken or missing, flat radiances of another number.
pub fn cast_picture(
    tracer: &Tracer,
    appearance: &Appearance,
    camera: &Camera,
    options: &PictureOptions,
    stream: Stream,
) -> Result<RayPicture, PictureFault> {
    let stage = tracer.stage();
    let bands = stage.band_count();
    let scaled = [0, 1].map(|k| (f64::from(camera.size[k]) * options.scale[k] + ROUNDING).floor());
    if !scaled.iter().all(|s| (1.0..=65536.0).contains(s)) {
        return Err(PictureFault::Scale(options.scale));
    }
    let expected = stage.facets.len() * bands;
    if let Some(found) = options.flat.map(<[f64]>::len).filter(|n| *n != expected) {
        return Err(PictureFault::Length { what: "flat radiances", found, expected });
    }
    for light in &appearance.lights {
        if light.strength.len() != bands {
            let found = light.strength.len();
            return Err(PictureFault::Length { what: "strength of a light", found, expected: bands });
        }
    }
    let pictures = decoded(appearance)?;
    let setting = Setting::new(tracer, appearance, camera, options, &pictures)?;
    let randomisations = options.randomisations.max(2);
    let net = Net::new(stream, options.samples.div_ceil(u64::from(randomisations)));
    let size = scaled.map(|s| s as u32);
    let one = |y: u32| row(&setting, camera, &net, randomisations, size[0], y);
    let rows: Vec<Row> = (0..size[1]).into_par_iter().map(one).collect();
    Ok(RayPicture {
        size,
        bands,
        mean: rows.iter().flat_map(|r| &r.mean).copied().collect(),
        std_err: rows.iter().flat_map(|r| &r.std_err).copied().collect(),
        randomisations,
        luminance: rows.iter().flat_map(|r| &r.luminance).copied().collect(),
        rays: rows.iter().map(|r| r.rays).sum(),
    })
}

fn row(setting: &Setting, camera: &Camera, net: &Net, randomisations: u32, width: u32, y: u32) -> Row {
    let bands = setting.bands;
    let first_pixel = u64::from(y) * u64::from(width);
    let slots = width as usize * randomisations as usize;
    let mut wave = Wave {
        setting,
        net,
        first_pixel,
        randomisations,
        sums: vec![0.0; slots * bands],
        rays: 0,
        beams: Beams::default(),
        buffer: vec![0.0; bands],
    };
    let [tx, ty] = setting.options.scale;
    let [w, h] = camera.size.map(f64::from);
    let look = |slot: u32, k: usize, shift: [u64; 2]| {
        let [u, v] = net.at(k, Pair::First, shift);
        let (x, y) = ((f64::from(slot / randomisations) + u) / tx, (f64::from(y) + v) / ty);
        Look {
            slot,
            sample: k as u32,
            weight: 1.0,
            origin: camera.eye,
            direction: camera.direction(x, y),
            from: NO_FACET,
            viewer: camera.eye,
            at: Some([x / w, y / h]),
            depth: 0,
        }
    };
    let together = (AT_ONCE / net.len()).max(1);
    for first in (0..slots).step_by(together) {
        let mut looks = Vec::with_capacity(together * net.len());
        for slot in first as u32..(first + together).min(slots) as u32 {
            let (pixel, r) = (slot / randomisations, slot % randomisations);
            let shift = net.shift(first_pixel + u64::from(pixel), u64::from(r), 0);
            looks.extend((0..net.len()).map(|k| look(slot, k, shift)));
        }
        wave.follow(looks);
    }
    finished(&wave, width as usize, randomisations as usize)
}

/// Means and spreads of a row's slots.
fn finished(wave: &Wave, width: usize, randomisations: usize) -> Row {
    let bands = wave.setting.bands;
    let scale = 1.0 / wave.net.len() as f64;
    let (mut mean, mut std_err) = (Vec::with_capacity(width * bands), Vec::with_capacity(width * bands));
    for pixel in wave.sums.chunks_exact(randomisations * bands) {
        for b in 0..bands {
            let values: Moments = pixel.iter().skip(b).step_by(bands).map(|v| v * scale).collect();
            mean.push(values.mean);
            std_err.push(values.std_err().unwrap_or(0.0));
        }
    }
    let photometry = &wave.setting.stage.photometry;
    let luminance = wave.sums.chunks_exact(bands).map(|v| (photometry.luminance(v) * scale) as f32).collect();
    Row { mean, std_err, luminance, rays: wave.rays }
}
