//! A part of the cross, painted at some scale: cells, marks, lines.

use super::layout::Layout;
use super::{Outline, Shown, UnfoldedHemicube, Wrong};
use crate::render::Raster;

/// sRGB colours. Hues of surfaces are pale and told apart by the colour-blind; what the picture is about is strong.
pub(super) const SOURCE: [u8; 3] = [255, 196, 0];
pub(super) const TOO_MUCH: [u8; 3] = [200, 16, 46];
pub(super) const TOO_LITTLE: [u8; 3] = [10, 60, 170];
pub(super) const BACK: [u8; 3] = [96, 96, 96];
pub(super) const NOTHING: [u8; 3] = [228, 228, 228];
pub(super) const MIXED: [u8; 3] = [70, 70, 70];
const HUES: [[u8; 3]; 7] = [
    [158, 190, 222],
    [219, 203, 160],
    [150, 208, 188],
    [238, 188, 200],
    [198, 184, 228],
    [200, 208, 136],
    [176, 222, 236],
];

/// Below this many pixels per cell, marks are a tint of the whole cell and patches are not outlined.
const LEAST_MARK: f64 = 4.0;
/// From this many pixels per cell on, cells are parted by hairlines.
const LEAST_GRID: f64 = 14.0;
/// A pixel that is wrong by less is not marked: the finer hemi-cube knows no better.
const LEAST_WRONG: f32 = 0.02;

/// A square part of the cross.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// Its upper left corner, cells.
    pub left: f64,
    pub top: f64,
    /// Pixels of the picture per cell.
    pub scale: f64,
    /// Its edge, pixels of the picture.
    pub size: u32,
}

impl Window {
    /// Paints it, on white.
    pub fn paint(&self, cube: &UnfoldedHemicube, layout: &Layout) -> Raster {
        let bytes = 4 * self.size as usize * self.size as usize;
        let mut raster = Raster { width: self.size, height: self.size, rgba: vec![255; bytes] };
        for (y, x) in (0..self.size).flat_map(|y| (0..self.size).map(move |x| (y, x))) {
            let rgb = if self.scale < 1.0 { self.mean(cube, layout, x, y) } else { self.within(cube, layout, x, y) };
            if let Some(rgb) = rgb {
                let at = 4 * (y as usize * self.size as usize + x as usize);
                raster.rgba[at..at + 3].copy_from_slice(&rgb);
            }
        }
        self.lines(&mut raster, cube, layout);
        raster
    }

    /// Colour of a pixel that lies within one cell.
    fn within(&self, cube: &UnfoldedHemicube, layout: &Layout, x: u32, y: u32) -> Option<[u8; 3]> {
        let place = [self.left + (f64::from(x) + 0.5) / self.scale, self.top + (f64::from(y) + 0.5) / self.scale];
        let (face, k) = layout.pixel(place[0] as usize, place[1] as usize)?;
        let (shown, wrong) = (cube.faces[face].shown[k], cube.faces[face].wrong[k]);
        if self.scale < LEAST_MARK {
            return Some(tinted(shown, wrong));
        }
        let rgb = marked(shown, wrong, place.map(f64::fract));
        let on_grid = self.scale >= LEAST_GRID && place.iter().any(|p| p.fract() * self.scale < 1.0);
        Some(if on_grid { mix(rgb, MIXED, 0.22) } else { rgb })
    }

    /// Mean colour of the cells in a pixel.
    fn mean(&self, cube: &UnfoldedHemicube, layout: &Layout, x: u32, y: u32) -> Option<[u8; 3]> {
        let across = (1.0 / self.scale).round() as usize;
        let (mut sum, mut cells) = ([0u32; 3], 0);
        for k in 0..across * across {
            let at = [x as usize * across + k % across, y as usize * across + k / across];
            let Some((face, pixel)) = layout.pixel(at[0], at[1]) else { continue };
            let rgb = tinted(cube.faces[face].shown[pixel], cube.faces[face].wrong[pixel]);
            (0..3).for_each(|c| sum[c] += u32::from(rgb[c]));
            cells += 1;
        }
        (cells > 0).then(|| sum.map(|s| (s / cells) as u8))
    }

    fn lines(&self, raster: &mut Raster, cube: &UnfoldedHemicube, layout: &Layout) {
        for outline in [Outline::Patches, Outline::Surfaces, Outline::Source] {
            // A white line under the dark one keeps the silhouette of the source clear of everything.
            let strokes: &[(f64, [u8; 3], f64)] = match outline {
                Outline::Patches if self.scale < LEAST_MARK => &[],
                Outline::Patches => &[(1.0, MIXED, 0.25)],
                Outline::Surfaces => &[(1.2, [40; 3], 0.7)],
                Outline::Source if self.scale < 1.0 => &[(1.2, [0; 3], 1.0)],
                Outline::Source => &[(4.4, [255; 3], 0.8), (2.2, [0; 3], 1.0)],
            };
            for (width, rgb, strength) in strokes {
                for (face, data) in cube.faces.iter().enumerate() {
                    for s in data.silhouettes.iter().filter(|s| s.outline == outline) {
                        let ends = s.ends.map(|p| self.place(layout.point(face, p)));
                        line(raster, ends, *width, *rgb, *strength);
                    }
                }
            }
        }
        for corners in faces(layout) {
            for k in 0..4 {
                line(raster, [corners[k], corners[(k + 1) % 4]].map(|p| self.place(p)), 1.0, [0; 3], 0.6);
            }
        }
    }

    /// From cells to pixels of this window.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.left) * self.scale, (y - self.top) * self.scale]
    }
}

/// Rims of the faces, cells.
fn faces(layout: &Layout) -> [[[f64; 2]; 4]; 5] {
    std::array::from_fn(|face| {
        let low = if face == 0 { -1.0 } else { 0.0 };
        [[-1.0, low], [1.0, low], [1.0, 1.0], [-1.0, 1.0]].map(|p| layout.point(face, p))
    })
}

/// Colour of what is shown: patches of a surface differ by a little light.
pub(super) fn colour(shown: Shown) -> [u8; 3] {
    match shown {
        Shown::Nothing => NOTHING,
        Shown::Back => BACK,
        Shown::Source => SOURCE,
        Shown::Patch { patch, surface } => {
            let hue = HUES[surface as usize % HUES.len()];
            // Surfaces of one hue differ in lightness, in three steps; patches by less than a step.
            let step = (surface as usize / HUES.len() % 3) as f64;
            let spread = f64::from(patch.wrapping_mul(0x9e37_79b1) >> 24) / 255.0;
            mix(hue, [255; 3], 0.45 - 0.16 * step + 0.12 * (spread - 0.5))
        }
    }
}

fn strong(excess: f32) -> [u8; 3] {
    if excess > 0.0 { TOO_MUCH } else { TOO_LITTLE }
}

/// Colour at a place in a cell, 0 to 1 both ways. Marks are discs whose area is the share that is wrong; the largest
/// leave a rim of the cell's own colour.
fn marked(shown: Shown, wrong: Wrong, place: [f64; 2]) -> [u8; 3] {
    let radius = (place[0] - 0.5).hypot(place[1] - 0.5);
    let disc = |share: f32, largest: f64| {
        share.abs() >= LEAST_WRONG && radius < largest * f64::from(share.abs()).min(1.0).sqrt()
    };
    match wrong.excess {
        e if disc(e, 0.44) => strong(e),
        e if e.abs() < LEAST_WRONG && disc(wrong.mixed, 0.16) => mix(colour(shown), MIXED, 0.45),
        _ => colour(shown),
    }
}

/// One cell, `edge` pixels each way, row by row.
pub(super) fn cell(shown: Shown, wrong: Wrong, edge: u32) -> Vec<[u8; 3]> {
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(edge);
    (0..edge * edge).map(|k| marked(shown, wrong, [at(k % edge), at(k / edge)])).collect()
}

/// Colour of a cell too small for marks.
fn tinted(shown: Shown, wrong: Wrong) -> [u8; 3] {
    match wrong.excess.abs() {
        e if e >= LEAST_WRONG => mix(colour(shown), strong(wrong.excess), 0.3 + 0.7 * f64::from(e)),
        _ if wrong.mixed >= LEAST_WRONG => mix(colour(shown), MIXED, 0.3 * f64::from(wrong.mixed)),
        _ => colour(shown),
    }
}

pub(super) fn mix(a: [u8; 3], b: [u8; 3], t: f64) -> [u8; 3] {
    std::array::from_fn(|c| (f64::from(a[c]) + (f64::from(b[c]) - f64::from(a[c])) * t.clamp(0.0, 1.0)).round() as u8)
}

/// Draws a line with soft edges; what lies outside the picture is cut off.
pub(super) fn line(raster: &mut Raster, [a, b]: [[f64; 2]; 2], width: f64, rgb: [u8; 3], strength: f64) {
    let reach = 0.5 * width + 1.0;
    let range = |c: usize, most: u32| {
        let (low, high) = (a[c].min(b[c]) - reach, a[c].max(b[c]) + reach);
        low.max(0.0) as u32..(high.max(0.0).ceil() as u32).min(most)
    };
    let along = [b[0] - a[0], b[1] - a[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    for (y, x) in range(1, raster.height).flat_map(|y| range(0, raster.width).map(move |x| (y, x))) {
        let p = [f64::from(x) + 0.5 - a[0], f64::from(y) + 0.5 - a[1]];
        let t = if length2 > 0.0 { ((p[0] * along[0] + p[1] * along[1]) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let distance = (p[0] - t * along[0]).hypot(p[1] - t * along[1]);
        let share = strength * (0.5 * width + 0.5 - distance).clamp(0.0, 1.0);
        let at = 4 * (y as usize * raster.width as usize + x as usize);
        let under = [raster.rgba[at], raster.rgba[at + 1], raster.rgba[at + 2]];
        raster.rgba[at..at + 3].copy_from_slice(&mix(under, rgb, share));
    }
}
