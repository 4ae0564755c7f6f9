//! Rasters: colours of patches through a visibility pass.

use super::{LinearRgb, Mesh, Visibility, to_byte};
use crate::raycast::{BACK, ESCAPED};
use crate::view::Response;
use rayon::prelude::*;

/// An eight-bit picture, rows from the top, four bytes a pixel: colours as the screen is driven with them (sRGB unless
/// said otherwise) and straight alpha.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Raster {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// `4 * width * height` bytes.
    pub rgba: Vec<u8>,
}

/// Linear greys of the hatching that says "a black back": it radiates nothing.
const BACK_GREYS: [f64; 2] = [0.045, 0.075];
/// Linear greys of the hatching that says "no value here".
const BLANK_GREYS: [f64; 2] = [0.42, 0.30];

/// Paints each patch in its colour (linear, by patch number); `None` is hatched. Backs are hatched dark, the
/// background is left transparent, and the samples of a pixel are mixed in linear light.
pub fn paint(visibility: &Visibility, palette: &[Option<LinearRgb>]) -> Raster {
    paint_samples(visibility, Response::Srgb, |_, _, patch| palette.get(patch).copied().flatten())
}

/// The same with one colour per cell of a mesh, its patches or its elements, for a screen of this response.
pub fn paint_cells(visibility: &Visibility, mesh: &Mesh, palette: &[Option<LinearRgb>], response: Response) -> Raster {
    paint_samples(visibility, response, |pixel, k, patch| {
        let point = visibility.point(mesh.stage(), pixel, k)?;
        palette.get(mesh.cell_at(patch, point)).copied().flatten()
    })
}

/// Shades smoothly between `colours` at the vertices of a mesh (linear, not yet clamped), for a screen of this response.
pub fn paint_smooth(visibility: &Visibility, mesh: &Mesh, colours: &[LinearRgb], response: Response) -> Raster {
    paint_samples(visibility, response, |pixel, k, patch| {
        let point = visibility.point(mesh.stage(), pixel, k)?;
        let cell = mesh.cell_at(patch, point);
        let mut sum = [0.0; 3];
        mesh.blend(cell, point, |v, w| (0..3).for_each(|c| sum[c] += w * colours[v][c]));
        (!mesh.vertices_of(cell).is_empty()).then(|| sum.map(|c| c.clamp(0.0, 1.0)))
    })
}

/// Shades smoothly between one value per vertex, each value in its `colour`.
pub fn paint_field(
    visibility: &Visibility,
    mesh: &Mesh,
    vertices: &[f64],
    colour: impl Fn(f64) -> LinearRgb + Sync,
) -> Raster {
    paint_samples(visibility, Response::Srgb, |pixel, k, patch| {
        let point = visibility.point(mesh.stage(), pixel, k)?;
        let cell = mesh.cell_at(patch, point);
        (!mesh.vertices_of(cell).is_empty()).then(|| colour(mesh.value_at(cell, point, vertices)))
    })
}

/// Paints with the colour of each sample, asked as (pixel, sample, patch).
fn paint_samples(
    visibility: &Visibility,
    response: Response,
    colour: impl Fn(usize, usize, usize) -> Option<LinearRgb> + Sync,
) -> Raster {
    let [width, height] = visibility.size();
    let pixel = |p: usize| mix(visibility, response, &colour, p, width as usize);
    let rgba = (0..visibility.pixel_count()).into_par_iter().flat_map_iter(pixel).collect();
    Raster { width, height, rgba }
}

fn mix(
    visibility: &Visibility,
    response: Response,
    colour: &impl Fn(usize, usize, usize) -> Option<LinearRgb>,
    pixel: usize,
    width: usize,
) -> [u8; 4] {
    let samples = visibility.samples(pixel);
    let (x, y) = (pixel % width, pixel / width);
    let (mut sum, mut covered) = ([0.0; 3], 0u32);
    for (k, landing) in samples.iter().enumerate().filter(|(_, l)| **l != ESCAPED) {
        let painted = if *landing == BACK { None } else { colour(pixel, k, *landing as usize) };
        let rgb = painted.unwrap_or([hatch(*landing == BACK, x, y); 3]);
        for c in 0..3 {
            sum[c] += rgb[c];
        }
        covered += 1;
    }
    if covered == 0 {
        return [0; 4];
    }
    let [r, g, b] = sum.map(|s| to_byte(response, s / f64::from(covered)));
    [r, g, b, (255.0 * f64::from(covered) / samples.len() as f64).round() as u8]
}

/// Diagonal stripes, those of backs leaning the other way.
fn hatch(back: bool, x: usize, y: usize) -> f64 {
    let greys = if back { BACK_GREYS } else { BLANK_GREYS };
    let along = if back { x + y } else { x + 7 * y };
    greys[usize::from(along % 8 < 3)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{plate, room, tracer};
    use crate::render::{SUPERSAMPLING, fit_camera, to_srgb8};

    #[test]
    fn background_is_clear_edges_are_soft_and_insides_are_exact() {
        let stage = plate(false);
        let tracer = tracer(&stage);
        let seen = Visibility::cast(&tracer, &fit_camera(&tracer), SUPERSAMPLING);
        let raster = paint(&seen, &[Some([0.5; 3]), Some([0.5; 3]), None, Some([0.5; 3])]);
        let alphas: Vec<u8> = raster.rgba.chunks(4).map(|p| p[3]).collect();
        assert_eq!(alphas[0], 0);
        assert!([64, 128, 191].iter().any(|a| alphas.contains(a)));
        let inside = (0..seen.pixel_count()).find(|p| seen.coverage(*p) == [(0, 1.0)]).expect("in sight");
        assert_eq!(raster.rgba[4 * inside..4 * inside + 4], [188, 188, 188, 255]);
        let blank: Vec<u8> =
            (0..seen.pixel_count()).filter(|p| seen.coverage(*p) == [(2, 1.0)]).map(|p| raster.rgba[4 * p]).collect();
        assert!(blank.contains(&to_srgb8(BLANK_GREYS[0])) && blank.contains(&to_srgb8(BLANK_GREYS[1])));
    }

    #[test]
    fn the_thread_count_does_not_matter() {
        let stage = room();
        let tracer = tracer(&stage);
        let palette: Vec<_> = (0..stage.patch_count()).map(|i| Some([i as f64 / 900.0, 0.3, 0.1])).collect();
        let picture = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| paint(&Visibility::cast(&tracer, &stage.cameras[0], SUPERSAMPLING), &palette))
        };
        assert_eq!(picture(1), picture(3));
    }
}
