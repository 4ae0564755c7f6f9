//! One colour a face: the picture at once, without any shading.

use super::image::SpanImage;
use super::regenerate::{Pixels, Scaling, regenerate};

/// The picture of an image with one value per face and band (row-major, faces x bands), nothing behind. Trees and faces
/// that can be seen through are left out.
pub fn flat(image: &SpanImage, scaling: &Scaling, bands: usize, colours: &[f64]) -> Pixels {
    regenerate(scaling, bands, |j, row| {
        for span in &image.lines[j as usize].solid {
            row.add(span.from, span.to, &colours[span.face as usize * bands..][..bands]);
        }
    })
}
