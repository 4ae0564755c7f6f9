//! A solution as the layers of an EXR picture: numbers, not colours.

use super::picture::{Painter, band};
use super::subject::Subject;
use crate::cli::args::RenderStyle;
use crate::io::image::{Channel, ImageError, Samples, channel_names, exr};
use crate::raycast::BACK;
use crate::render::{Mesh, Visibility, item_colour, luminance};
use crate::view::Viewer;
use rayon::prelude::*;

const COMMENTS: &str = "Radiosities in W/m^2 per band, linear, not tone-mapped; premultiplied by coverage (A). Layers: \
smooth (interpolated between vertices), constant (as solved), std_err where there are any; the main layer is the style \
asked for. luminance.Y is the luminance of the main layer, cd/m^2, by the efficacy said when it was made. patch.number is the patch in the upper left sample of the pixel, 4294967295 where there is none.";

/// The picture of one camera: every band smooth and constant, standard errors, coverage, patch numbers.
pub(super) fn exr_picture(
    subject: &Subject,
    painter: &Painter,
    visibility: &Visibility,
    efficacy: f64,
) -> Result<Vec<u8>, ImageError> {
    let in_candela = |y: f64| Viewer::luminance_of(efficacy, y);
    let seen = Seen { visibility, mesh: painter.mesh() };
    let mut channels = Vec::new();
    let mut add = |name: String, samples: Samples| channels.push(Channel { name, samples });
    match &subject.radiosity {
        Some(b) if !painter.is(RenderStyle::Items) => {
            for (c, name) in channel_names(&subject.receivers.photometry.bands).iter().enumerate() {
                let cells = band(b, c);
                let (smooth, constant) = (seen.smooth(&painter.at_vertices(&cells)), seen.constant(&cells));
                let main = if painter.is(RenderStyle::Constant) { &constant } else { &smooth };
                add(name.clone(), Samples::F32(main.clone()));
                add(format!("smooth.{name}"), Samples::F32(smooth));
                add(format!("constant.{name}"), Samples::F32(constant));
                if let Some(errors) = &b.std_err {
                    let errors: Vec<f64> = errors.iter().skip(c).step_by(b.bands).copied().collect();
                    add(format!("std_err.{name}"), Samples::F32(seen.constant(&errors)));
                }
            }
            let y: Vec<f64> = luminance(&subject.receivers.photometry, b).into_iter().map(in_candela).collect();
            let seen_so = if painter.is(RenderStyle::Constant) {
                seen.constant(&y)
            } else {
                seen.smooth(&painter.at_vertices(&y))
            };
            add("luminance.Y".into(), Samples::F32(seen_so));
        }
        _ => {
            for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
                let colour = |patch: u32| f32::from(item_colour(patch)[c]) / 255.0;
                add(name.into(), Samples::F32(seen.numbers().map(|n| n.map_or(0.0, colour)).collect()));
            }
        }
    }
    add("A".into(), Samples::F32(seen.constant(&vec![1.0; seen.mesh.cell_count()])));
    add("patch.number".into(), Samples::U32(seen.numbers().map(|n| n.unwrap_or(u32::MAX)).collect()));
    let [width, height] = visibility.size();
    exr(width, height, &channels, COMMENTS)
}

/// A visibility pass over a mesh.
struct Seen<'a> {
    visibility: &'a Visibility,
    mesh: &'a Mesh<'a>,
}

impl Seen<'_> {
    /// Patch in the first sample of each pixel.
    fn numbers(&self) -> impl Iterator<Item = Option<u32>> + '_ {
        (0..self.visibility.pixel_count()).map(|p| Some(self.visibility.samples(p)[0]).filter(|n| *n < BACK))
    }

    fn constant(&self, cells: &[f64]) -> Vec<f32> {
        self.resolve(|cell, _| cells[cell])
    }

    fn smooth(&self, vertices: &[f64]) -> Vec<f32> {
        self.resolve(|cell, point| self.mesh.value_at(cell, point, vertices))
    }

    /// Means over the samples of each pixel; what is no patch counts as 0.
    fn resolve(&self, value: impl Fn(usize, crate::math::DVec3) -> f64 + Sync) -> Vec<f32> {
        let pixel = |p: usize| {
            let samples = self.visibility.samples(p);
            let at = |(k, patch): (usize, &u32)| {
                let point = self.visibility.point(self.mesh.stage(), p, k)?;
                Some(value(self.mesh.cell_at(*patch as usize, point), point))
            };
            let seen: Vec<f64> = samples.iter().enumerate().filter_map(at).collect();
            // A pixel inside one patch holds its value exactly.
            if seen.len() == samples.len() && seen.iter().all(|v| *v == seen[0]) {
                return seen[0] as f32;
            }
            (seen.iter().sum::<f64>() / samples.len() as f64) as f32
        };
        (0..self.visibility.pixel_count()).into_par_iter().map(pixel).collect()
    }
}
