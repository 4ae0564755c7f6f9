//! Shading after visibility: the picture of an image under any lights, cluster by cluster.

use super::image::SpanImage;
use super::light::Volumes;
use super::painter::{Layer, Painter};
use super::regenerate::{Pixels, Row, ScaleError, Scaling, regenerate};
use super::scan::see_through;
use super::shader::{Diffuse, Grown, Shader};
use super::sunlit::{light_up, parallel};
use super::texture::PictureError;
use crate::scene::Appearance;
use rayon::prelude::*;

/// Columns after the bands: share of a pixel that was traced, share where something stands.
const EXTRA: usize = 2;

/// Batches whose shadow volumes are made side by side before the memory is looked at.
const TOGETHER: usize = 4;

/// How an image is shaded.
#[derive(Clone, Copy)]
pub struct ShadeOptions<'a> {
    /// [T_x, T_y].
    pub scale: [f64; 2],
    /// Radiosities that take the place of what surfaces emit, and of light that they hold already.
    pub diffuse: Option<&'a dyn Diffuse>,
    /// Mirrors and glass are traced; else they are as their diffuse part alone.
    pub trace: bool,
    /// Shadows; else nothing hides a lamp.
    pub shadows: bool,
    /// Bytes that shadow volumes may hold at a time.
    pub shadow_memory: usize,
    /// Deviation from a straight line along a segment, as a share, from which gentle light is evaluated in between.
    pub tolerance: f64,
}

impl Default for ShadeOptions<'_> {
    fn default() -> Self {
        Self { scale: [1.0; 2], diffuse: None, trace: true, shadows: true, shadow_memory: 256 << 20, tolerance: 5e-3 }
    }
}

/// A shaded picture, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaded {
    /// Radiance, W/(m^2 sr) per band.
    pub radiance: Pixels,
    /// Share of each pixel in which something stands.
    pub covered: Vec<f64>,
    /// Share of pixels with a part that was traced.
    pub traced: f64,
    /// Most bytes that shadow volumes held at a time.
    pub shadow_bytes: usize,
    /// Passes over the image: groups of faces whose shadow volumes were held together.
    pub passes: usize,
}

impl SpanImage {
    /// Changes the lights, the fog and all else of the display stage. Shadow edges of the parallel light are found again
    /// where it is not the same.
    pub fn relight(&mut self, appearance: Appearance) {
        let direction = |a: &Appearance| parallel(&a.lights).map(|l| l.shape.clone());
        let same = direction(&appearance) == direction(&self.appearance);
        let clear = see_through(self);
        self.appearance = appearance;
        // Panes that are clear now, or no longer, change what throws shadows.
        if !same || clear != see_through(self) {
            light_up(self);
        }
    }
}

/// Why an image cannot be shaded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShadeError {
    /// Not at this scale.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// A picture is not whole.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// Shades an image. Its `lit` marks are those of the first parallel light of its appearance; see [`SpanImage::relight`].
pub fn shade(image: &SpanImage, options: &ShadeOptions) -> Result<Shaded, ShadeError> {
    let scaling = Scaling::new(image.per_line, image.camera.size, options.scale)?;
    let grown = Grown::new(image)?;
    let shader = Shader::new(image, &grown, options);
    let painter = Painter::new(image, &shader, options);
    let bands = image.photometry.bands.len();
    let columns = bands + EXTRA;
    let mut sum = Pixels { size: scaling.size(), bands: columns, values: Vec::new() };
    let (shadow_bytes, passes) = in_groups(&shader, options.shadow_memory, |group| {
        let picture = regenerate(&scaling, columns, |j, row| {
            let (scale, width) = (row.scale(), row.width());
            painter.draw(j, scale, width, group, &mut |pixel, length, layer| add(row, pixel, length, bands, layer));
        });
        match sum.values.is_empty() {
            true => sum.values = picture.values,
            false => sum.values.iter_mut().zip(picture.values).for_each(|(s, v)| *s += v),
        }
    });
    Ok(finish(sum, bands, shadow_bytes + shader.traced_bytes(), passes))
}

/// Adds what one layer shows of itself to a pixel of a row.
fn add(row: &mut Row, pixel: usize, length: f64, bands: usize, layer: &Layer) {
    row.add_to(pixel, length * layer.share, layer.colour);
    let extra = [f64::from(u8::from(layer.traced)), f64::from(u8::from(layer.face.is_some()))];
    row.add_after(pixel, bands, length * layer.share, &extra);
}

/// Calls `draw` with the background and then with groups of faces, cluster by cluster, whose shadow volumes keep to the
/// memory. Returns the most bytes of a group and the number of groups.
pub(super) fn in_groups(shader: &Shader, memory: usize, mut draw: impl FnMut(&Group)) -> (usize, usize) {
    let image = shader.image();
    draw(&Group::empty(shader, true));
    let (mut most, mut passes) = (0, 1);
    for cluster in 0..image.clusters.len() as u32 {
        let mut batches = drawn_batches(shader, cluster);
        while !batches.is_empty() {
            let (group, rest) = shader.group(batches, memory);
            batches = rest;
            draw(&group);
            most = most.max(group.bytes);
            passes += 1;
        }
    }
    (most, passes)
}

fn finish(sum: Pixels, bands: usize, shadow_bytes: usize, passes: usize) -> Shaded {
    let pixels: Vec<&[f64]> = sum.values.chunks(sum.bands).collect();
    let traced = pixels.iter().filter(|p| p[bands] > 0.0).count() as f64 / pixels.len() as f64;
    Shaded {
        radiance: Pixels {
            size: sum.size,
            bands,
            values: pixels.iter().flat_map(|p| p[..bands].iter().copied()).collect(),
        },
        covered: pixels.iter().map(|p| p[bands + 1].min(1.0)).collect(),
        traced,
        shadow_bytes,
        passes,
    }
}

/// Faces that are drawn together, with the shadow volumes of every lamp on them.
pub(super) struct Group {
    /// Shadow volumes of all lamps by batch of faces; `None` is drawn by another group.
    made: Vec<Option<Vec<Volumes>>>,
    /// Batch of each face, where the group draws it.
    of: Vec<Option<u32>>,
    /// Draws the background.
    pub(super) open: bool,
    bytes: usize,
}

impl Group {
    fn empty(shader: &Shader, open: bool) -> Self {
        let made = (0..shader.batches().bounds.len()).map(|_| None).collect();
        Self { made, of: vec![None; shader.image().faces.len()], open, bytes: 0 }
    }

    /// Shadow volumes on a face, by lamp; `None` where the face is drawn by another group.
    pub(super) fn volumes(&self, face: u32) -> Option<&[Volumes]> {
        self.made[self.of[face as usize]? as usize].as_deref()
    }
}

/// Batches with a face of a cluster in any segment.
fn drawn_batches(shader: &Shader, cluster: u32) -> Vec<u32> {
    let image = shader.image();
    let mut seen = vec![false; shader.batches().bounds.len()];
    let spans = image.lines.iter().flat_map(|l| l.solid.iter().chain(&l.over));
    for span in spans.filter(|s| image.faces[s.face as usize].cluster == cluster) {
        seen[shader.batches().of[span.face as usize] as usize] = true;
    }
    (0..seen.len() as u32).filter(|b| seen[*b as usize]).collect()
}

impl Shader<'_> {
    /// As many of the batches as the memory allows (at least a few), and the rest.
    fn group(&self, batches: Vec<u32>, memory: usize) -> (Group, Vec<u32>) {
        let mut group = Group::empty(self, false);
        let mut at = 0;
        while at < batches.len() && (at == 0 || group.bytes < memory) {
            let some = &batches[at..(at + TOGETHER).min(batches.len())];
            let made: Vec<Vec<Volumes>> = some.par_iter().map(|b| self.volumes(*b)).collect();
            for (batch, volumes) in some.iter().zip(made) {
                group.bytes += volumes.iter().map(Volumes::bytes).sum::<usize>();
                group.made[*batch as usize] = Some(volumes);
            }
            at += some.len();
        }
        for (of, batch) in group.of.iter_mut().zip(&self.batches().of) {
            *of = group.made[*batch as usize].is_some().then_some(*batch);
        }
        (group, batches[at..].to_vec())
    }

    /// Shadow volumes of all lamps that can matter on the faces of a batch.
    pub(super) fn volumes(&self, batch: u32) -> Vec<Volumes> {
        let around = &self.batches().bounds[batch as usize];
        self.lamps().iter().map(|l| Volumes::new(l, self.casters(), around)).collect()
    }
}
