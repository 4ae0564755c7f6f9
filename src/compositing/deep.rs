//! Deep pictures: per pixel every face with its depth, for compositing elsewhere.

use super::image::SpanImage;
use super::painter::Painter;
use super::regenerate::Scaling;
use super::shade::{ShadeError, ShadeOptions, in_groups};
use super::shader::{Grown, Shader};
use rayon::prelude::*;

/// What one face shows in one pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct DeepSample {
    /// Nearest and farthest depth of it in the pixel, m, along the viewing direction.
    pub depth: [f64; 2],
    /// Its opacity behind all samples before it: laying all samples of the pixel over one another gives the flat picture.
    pub alpha: f64,
    /// Radiance times opacity, W/(m^2 sr) per band.
    pub radiance: Vec<f64>,
}

/// A picture with any number of samples a pixel, by depth, the nearest first. The background is none of them.
#[derive(Debug, Clone, PartialEq)]
pub struct DeepPicture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Pixels row by row from the top.
    pub pixels: Vec<Vec<DeepSample>>,
}

/// Sums of one face in one pixel.
struct Sum {
    face: u32,
    depth: [f64; 2],
    share: f64,
    radiance: Vec<f64>,
}

/// Shades an image without merging what lies at different depths.
pub fn deep(image: &SpanImage, options: &ShadeOptions) -> Result<DeepPicture, ShadeError> {
    let scaling = Scaling::new(image.per_line, image.camera.size, options.scale)?;
    let grown = Grown::new(image)?;
    let shader = Shader::new(image, &grown, options);
    let painter = Painter::new(image, &shader, options);
    let [width, height] = scaling.size().map(|s| s as usize);
    let mut sums: Vec<Vec<Sum>> = (0..width * height).map(|_| Vec::new()).collect();
    in_groups(&shader, options.shadow_memory, |group| {
        sums.par_chunks_mut(width).enumerate().for_each(|(i, row)| {
            let lines = scaling.sub_scanlines(i as u32);
            let (first, last) = (*lines.start(), *lines.end());
            let n = f64::from(last - first);
            for j in lines {
                let weight = if j == first || j == last { 0.5 / n } else { 1.0 / n };
                painter.draw(j, scaling.scale()[0], width, group, &mut |pixel, length, layer| {
                    let Some(face) = layer.face else { return };
                    add(&mut row[pixel], face, weight * length * layer.share, layer.depth, layer.colour);
                });
            }
        });
    });
    Ok(DeepPicture { size: scaling.size(), pixels: sums.into_par_iter().map(samples).collect() })
}

fn add(sums: &mut Vec<Sum>, face: u32, share: f64, depth: f64, colour: &[f64]) {
    let k = match sums.iter().position(|s| s.face == face) {
        Some(k) => k,
        None => {
            sums.push(Sum { face, depth: [depth; 2], share: 0.0, radiance: vec![0.0; colour.len()] });
            sums.len() - 1
        }
    };
    let sum = &mut sums[k];
    sum.depth = [sum.depth[0].min(depth), sum.depth[1].max(depth)];
    sum.share += share;
    sum.radiance.iter_mut().zip(colour).for_each(|(r, c)| *r += share * c);
}

/// Shares of the pixel become opacities behind what is nearer.
fn samples(mut sums: Vec<Sum>) -> Vec<DeepSample> {
    sums.sort_by(|a, b| a.depth[0].total_cmp(&b.depth[0]).then(a.face.cmp(&b.face)));
    let mut left = 1.0;
    let mut out = Vec::with_capacity(sums.len());
    for sum in sums {
        if left <= 1e-9 {
            break;
        }
        let alpha = (sum.share / left).min(1.0);
        out.push(DeepSample { depth: sum.depth, alpha, radiance: sum.radiance.iter().map(|r| r / left).collect() });
        left *= 1.0 - alpha;
    }
    out
}
