//! Pictures to look up: linear light, bilinear, with mip-maps for what lies far away.

use crate::scene::Picture;
use crate::view::Photometry;

/// Luminance of linear red, green and blue.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Most look-ups along the longer axis of a footprint; a longer one is blurred instead.
const PROBES: f64 = 16.0;

/// Texels of the level to look up in, as a share of the distance between look-ups. Bilinear look-ups in texels of breadth
/// q spread by a variance of q^2/4; points that are d apart lack d^2/12 of a box.
const REACH: f64 = 0.577_350_269_189_626;

/// A picture that cannot be looked up.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("picture `{name}`: {bytes} bytes for {} x {} pixels of 4 bytes", size[0], size[1])]
pub struct PictureError {
    /// Name of the picture.
    pub name: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Bytes it came with.
    pub bytes: usize,
}

/// What lies beyond the edge of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// The picture again: textures, clouds.
    Again,
    /// Nothing, transparent: trees.
    Nothing,
    /// What is at the edge: backgrounds.
    Edge,
}

/// Pictures decoded to linear light, each with its mip-map.
#[derive(Debug, Clone, Default)]
pub struct Sampler {
    pictures: Vec<Vec<Level>>,
}

/// A picture in one resolution. Texels are red, green, blue times opacity, and opacity.
#[derive(Debug, Clone)]
struct Level {
    size: [usize; 2],
    texels: Vec<[f32; 4]>,
}

impl Sampler {
    /// Decodes pictures, in their order.
    ///
    /// # Errors
    /// A picture without pixels, or with more or fewer bytes than its size asks for.
    pub fn new(pictures: &[Picture]) -> Result<Self, PictureError> {
        // Bytes above 8 bits are never met, so the curve is a table.
        let linear: Vec<f32> = (0..=255).map(|v| from_srgb(f64::from(v) / 255.0) as f32).collect();
        let decode = |p: &Picture| {
            let size = p.size.map(|s| s as usize);
            let texels = size[0].checked_mul(size[1]).filter(|n| *n > 0 && n.checked_mul(4) == Some(p.rgba.len()));
            if texels.is_none() {
                return Err(PictureError { name: p.name.clone(), size: p.size, bytes: p.rgba.len() });
            }
            let texel = |c: &[u8]| {
                let alpha = f32::from(c[3]) / 255.0;
                [0, 1, 2].map(|k| linear[usize::from(c[k])] * alpha).into_iter().chain([alpha])
            };
            let texels = p.rgba.chunks_exact(4).map(|c| {
                let mut out = [0.0; 4];
                out.iter_mut().zip(texel(c)).for_each(|(o, v)| *o = v);
                out
            });
            let mut levels = vec![Level { size, texels: texels.collect() }];
            while let Some(next) = levels.last().and_then(Level::halved) {
                levels.push(next);
            }
            Ok(levels)
        };
        Ok(Self { pictures: pictures.iter().map(decode).collect::<Result<_, _>>()? })
    }

    /// Colour and opacity at (s, t), bilinear between texel centres. The picture covers 0 to 1 both ways, t grows upward.
    /// A picture that is not there is transparent black.
    pub fn sample(&self, picture: usize, s: f64, t: f64, beyond: Beyond) -> ([f32; 3], f32) {
        apart(self.pictures.get(picture).map_or([0.0; 4], |levels| levels[0].at(s, t, beyond)))
    }

    /// Mean colour and opacity over a parallelogram about (s, t) that is spanned by `along` and `across`, all in repeats
    /// of the picture: what a pixel far away sees of it.
    ///
    /// Look-ups in the mip-map are spread over it, 32 at most. A parallelogram that is more than 16 times longer than wide
    /// is blurred across.
    pub fn mean(&self, picture: usize, [s, t]: [f64; 2], sides: [[f64; 2]; 2], beyond: Beyond) -> ([f32; 3], f32) {
        let Some(levels) = self.pictures.get(picture) else { return ([0.0; 3], 0.0) };
        let texels = levels[0].size.map(|n| n as f64);
        let length = |v: [f64; 2]| (v[0] * texels[0]).hypot(v[1] * texels[1]);
        let [mut long, mut short] = sides.map(length);
        let mut axes = sides;
        if short > long {
            (long, short, axes) = (short, long, [sides[1], sides[0]]);
        }
        if !(long.is_finite() && short.is_finite() && s.is_finite() && t.is_finite()) {
            return apart(levels[levels.len() - 1].texels[0]);
        }
        if long <= 1.0 {
            return apart(levels[0].at(s, t, beyond));
        }
        // Two look-ups along the shorter side, as far apart along the longer; level 0 needs no more than one a texel.
        let apart_by = (0.5 * short).max(1.0).max(long / PROBES);
        let [n, m] = [long, short].map(|side| (side / apart_by).ceil().max(1.0));
        let mut sum = [0.0; 4];
        for k in 0..(n * m) as u32 {
            let shift = |i: u32, n: f64| (f64::from(i) + 0.5) / n - 0.5;
            let (a, b) = (shift(k % n as u32, n), shift(k / n as u32, m));
            let at = [s + a * axes[0][0] + b * axes[1][0], t + a * axes[0][1] + b * axes[1][1]];
            let one = between(levels, at[0], at[1], apart_by * REACH, beyond);
            sum.iter_mut().zip(one).for_each(|(a, b)| *a += b);
        }
        let probes = n * m;
        apart(sum.map(|v| v / probes as f32))
    }

    /// Luminance at (s, t), of what opacity leaves: what bump and share maps read.
    pub fn luminance(&self, picture: usize, s: f64, t: f64) -> f64 {
        let [r, g, b, _] = self.pictures.get(picture).map_or([0.0; 4], |levels| levels[0].at(s, t, Beyond::Again));
        luminance([r, g, b])
    }

    /// Width and height in texels; 1 x 1 for a picture that is not there.
    pub fn size(&self, picture: usize) -> [usize; 2] {
        self.pictures.get(picture).map_or([1, 1], |levels| levels[0].size)
    }
}

/// A colour as a scene with these bands knows it: `out` gets red, green and blue if the bands are these three, else its
/// luminance in every band.
pub fn to_bands(colour: [f32; 3], photometry: &Photometry, out: &mut [f64]) {
    if photometry.bands == ["r", "g", "b"] {
        out.iter_mut().zip(colour).for_each(|(o, c)| *o = f64::from(c));
    } else {
        out.fill(luminance(colour));
    }
}

/// Luminance of a linear colour.
pub fn luminance(colour: [f32; 3]) -> f64 {
    colour.iter().zip(LUMINANCE).map(|(c, w)| f64::from(*c) * f64::from(w)).sum()
}

/// Linear light of an sRGB value, both 0 to 1.
fn from_srgb(v: f64) -> f64 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Colour and opacity of a texel; what is transparent has no colour.
fn apart([r, g, b, alpha]: [f32; 4]) -> ([f32; 3], f32) {
    if alpha > 0.0 { ([r / alpha, g / alpha, b / alpha], alpha) } else { ([0.0; 3], 0.0) }
}

/// Between the two levels whose texels are nearest to `width` texels of the finest.
fn between(levels: &[Level], s: f64, t: f64, width: f64, beyond: Beyond) -> [f32; 4] {
    let level = width.log2().clamp(0.0, (levels.len() - 1) as f64);
    let (below, share) = (level as usize, level.fract() as f32);
    let fine = levels[below].at(s, t, beyond);
    if share == 0.0 {
        return fine;
    }
    let coarse = levels[below + 1].at(s, t, beyond);
    [0, 1, 2, 3].map(|k| fine[k] + share * (coarse[k] - fine[k]))
}

impl Level {
    fn at(&self, s: f64, t: f64, beyond: Beyond) -> [f32; 4] {
        let [w, h] = self.size;
        // Rows are stored from the top.
        let (x0, x1, fx) = neighbours(s, w, beyond);
        let (y0, y1, fy) = neighbours(1.0 - t, h, beyond);
        let texel = |x: usize, y: usize| if x < w && y < h { self.texels[y * w + x] } else { [0.0; 4] };
        let (a, b, c, d) = (texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1));
        [0, 1, 2, 3].map(|k| {
            let (top, bottom) = (a[k] + fx * (b[k] - a[k]), c[k] + fx * (d[k] - c[k]));
            top + fy * (bottom - top)
        })
    }

    /// Half as many texels each way, rounded down; the mean stays, whatever the size. `None` for a single texel.
    fn halved(&self) -> Option<Self> {
        let [w, h] = self.size;
        let size = [(w / 2).max(1), (h / 2).max(1)];
        if [w, h] == size {
            return None;
        }
        let (columns, rows) = (shares(w, size[0]), shares(h, size[1]));
        let mut texels = Vec::with_capacity(size[0] * size[1]);
        for (y0, ys) in &rows {
            for (x0, xs) in &columns {
                let mut sum = [0.0f64; 4];
                for (y, v) in ys.iter().enumerate() {
                    let row = &self.texels[(y0 + y) * w + x0..][..xs.len()];
                    for (texel, u) in row.iter().zip(xs) {
                        sum.iter_mut().zip(texel).for_each(|(s, c)| *s += u * v * f64::from(*c));
                    }
                }
                texels.push(sum.map(|s| s as f32));
            }
        }
        Some(Self { size, texels })
    }
}

/// The two texels around a place (0 to 1) among `n`, and the share of the second; `n` stands for nothing.
fn neighbours(place: f64, n: usize, beyond: Beyond) -> (usize, usize, f32) {
    let place = if place.is_nan() || (beyond == Beyond::Again && place.is_infinite()) { 0.0 } else { place };
    let place = if beyond == Beyond::Again { place - place.floor() } else { place };
    // Two texels of margin are as good as a mile, and keep the conversion below exact.
    let x = (place * n as f64 - 0.5).clamp(-2.0, n as f64 + 1.0);
    let below = x.floor();
    let index = |k: f64| match beyond {
        Beyond::Again if k < 0.0 => n - 1,
        Beyond::Again => k as usize % n,
        Beyond::Nothing if k < 0.0 => n,
        Beyond::Nothing => (k as usize).min(n),
        Beyond::Edge => (k as usize).min(n - 1),
    };
    (index(below), index(below + 1.0), (x - below) as f32)
}

/// For each of `m` equal parts of `n` texels: its first texel, and the shares of that and those after it.
fn shares(n: usize, m: usize) -> Vec<(usize, Vec<f64>)> {
    // In units of 1/m texel all edges are whole numbers.
    let part = |k: usize| {
        let (from, to) = (k * n, (k + 1) * n);
        let first = from / m;
        let share = |x: usize| (((x + 1) * m).min(to) - (x * m).max(from)) as f64 / n as f64;
        (first, (first..to.div_ceil(m)).map(share).collect())
    };
    (0..m).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [u32; 2], rgba: Vec<u8>) -> Picture {
        Picture { name: "p".into(), size, rgba }
    }

    /// Grey texels, opaque.
    fn grey(size: [u32; 2], value: impl Fn(u32, u32) -> u8) -> Picture {
        let texel = |k: u32| {
            let v = value(k % size[0], k / size[0]);
            [v, v, v, 255]
        };
        picture(size, (0..size[0] * size[1]).flat_map(texel).collect())
    }

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} instead of {b}");
    }

    #[test]
    fn bytes_become_linear_light() {
        // 188 is the byte nearest to half: 0.5 linear is 0.7354 in sRGB; of the straight part, 10/255/12.92.
        let s = Sampler::new(&[picture([1, 1], vec![188, 10, 255, 255])]).expect("a picture");
        let ([r, g, b], a) = s.sample(0, 0.3, 0.9, Beyond::Again);
        close(f64::from(r), 0.502_886_458, 1e-7);
        close(f64::from(g), 10.0 / 255.0 / 12.92, 1e-9);
        assert_eq!((b, a), (1.0, 1.0));
    }

    #[test]
    fn a_checker_between_its_centres() {
        // Upper left and lower right are white.
        let s = Sampler::new(&[grey([2, 2], |x, y| if x == y { 255 } else { 0 })]).expect("a picture");
        let at = |u: f64, v: f64| f64::from(s.sample(0, u, v, Beyond::Again).0[0]);
        for (u, v, wanted) in [
            (0.25, 0.75, 1.0),
            (0.75, 0.75, 0.0),
            (0.25, 0.25, 0.0),
            (0.75, 0.25, 1.0),
            (0.5, 0.5, 0.5),
            (0.5, 0.75, 0.5),
            // Over the edge it is the first column again.
            (0.0, 0.75, 0.5),
            (0.375, 0.75, 0.75),
            (0.375, 0.625, 0.625),
            (-3.75, 12.75, 1.0),
        ] {
            close(at(u, v), wanted, 1e-6);
        }
    }

    #[test]
    fn beyond_the_edge() {
        let s = Sampler::new(&[grey([2, 1], |x, _| if x == 0 { 255 } else { 0 })]).expect("a picture");
        let look = |u: f64, v: f64, beyond| s.sample(0, u, v, beyond);
        // Half of a texel's breadth before the edge nothing begins, where there is nothing.
        assert_eq!(look(0.0, 0.5, Beyond::Nothing), ([1.0; 3], 0.5));
        assert_eq!(look(-0.3, 0.5, Beyond::Nothing), ([0.0; 3], 0.0));
        assert_eq!(look(0.25, 1.0, Beyond::Nothing).1, 0.5);
        assert_eq!(look(1e300, 0.5, Beyond::Nothing).1, 0.0);
        assert_eq!(look(0.0, 0.0, Beyond::Edge), ([1.0; 3], 1.0));
        assert_eq!(look(-7.0, 9.0, Beyond::Edge), ([1.0; 3], 1.0));
        assert_eq!(look(7.0, 0.0, Beyond::Edge).0, [0.0; 3]);
        assert_eq!(look(f64::NAN, f64::INFINITY, Beyond::Again).1, 1.0);
        assert_eq!(s.sample(5, 0.5, 0.5, Beyond::Again), ([0.0; 3], 0.0));
    }

    #[test]
    fn what_is_transparent_lends_no_colour() {
        // Green beside a red that is not there: the colour stays green, only its opacity fades.
        let s = Sampler::new(&[picture([2, 1], vec![0, 255, 0, 255, 255, 0, 0, 0])]).expect("a picture");
        let (colour, alpha) = s.sample(0, 0.5, 0.5, Beyond::Again);
        assert_eq!((colour, alpha), ([0.0, 1.0, 0.0], 0.5));
    }

    /// Odd sizes too.
    #[test]
    fn every_level_has_the_mean_of_the_picture_and_so_has_one_repeat() {
        for size in [[8, 8], [13, 7], [1, 9], [100, 3]] {
            let p = grey(size, |x, y| (x * 71 + y * 37 + x * y) as u8);
            let mean = p.rgba.chunks(4).map(|c| from_srgb(f64::from(c[0]) / 255.0)).sum::<f64>()
                / f64::from(size[0] * size[1]);
            let s = Sampler::new(&[p]).expect("a picture");
            for level in &s.pictures[0] {
                let sum = level.texels.iter().map(|t| f64::from(t[0])).sum::<f64>();
                close(sum / level.texels.len() as f64, mean, 1e-6);
            }
            assert_eq!(s.pictures[0].last().map(|l| l.size), Some([1, 1]));
            // Bilinear between centres over one repeat: the mean of 4 x 4 points a texel is exact.
            let [n, m] = size.map(|k| 4 * k);
            let at = |k: u32| (f64::from(k % n) + 0.5, f64::from(k / n) + 0.5);
            let one = |(x, y): (f64, f64)| s.sample(0, x / f64::from(n), y / f64::from(m), Beyond::Again).0[0];
            let sum = (0..n * m).map(|k| f64::from(one(at(k)))).sum::<f64>();
            close(sum / f64::from(n * m), mean, 1e-6);
            close(f64::from(s.mean(0, [0.3, 0.1], [[40.0, 3.0], [-2.0, 37.0]], Beyond::Again).0[0]), mean, 1e-6);
        }
    }

    /// Against many points of the parallelogram; a picture without sharp edges, so that only the filter differs.
    #[test]
    fn the_mean_over_a_pixel_is_near_that_of_many_points() {
        let wave = |k: u32| (std::f64::consts::TAU * f64::from(k) / 64.0).sin();
        let s = Sampler::new(&[grey([64, 64], |x, y| (128.0 + 60.0 * wave(x) + 50.0 * wave(2 * y + x)) as u8)]);
        let s = s.expect("a picture");
        let sides = [[[0.05, 0.01], [-0.02, 0.3]], [[0.1, 0.0], [0.0, 0.1]], [[0.6, 0.3], [0.01, 0.02]]];
        for (sides, k) in sides.into_iter().zip(0..) {
            let (mut worst, mut spread) = (0f64, 0f64);
            for i in 0..25 {
                let place = [f64::from(i % 5) * 0.19 + 0.01 * f64::from(k), f64::from(i / 5) * 0.17];
                let mut sum = 0.0;
                for j in 0..2500 {
                    let (a, b) = ((f64::from(j % 50) + 0.5) / 50.0 - 0.5, (f64::from(j / 50) + 0.5) / 50.0 - 0.5);
                    let [s0, t0] = [0, 1].map(|c| place[c] + a * sides[0][c] + b * sides[1][c]);
                    sum += f64::from(s.sample(0, s0, t0, Beyond::Again).0[1]);
                }
                let truth = sum / 2500.0;
                worst = worst.max((f64::from(s.mean(0, place, sides, Beyond::Again).0[1]) - truth).abs());
                spread = spread.max((f64::from(s.sample(0, place[0], place[1], Beyond::Again).0[1]) - truth).abs());
            }
            assert!(worst < 0.02, "{k}: {worst}, without a filter {spread}");
        }
    }

    #[test]
    fn other_bands_get_the_luminance() {
        let mut out = [0.0; 3];
        to_bands([0.5, 0.25, 1.0], &Photometry::rec709(), &mut out);
        assert_eq!(out, [0.5, 0.25, 1.0]);
        let one = Photometry { bands: vec!["y".into()], weights: vec![1.0] };
        to_bands([0.5, 0.25, 1.0], &one, &mut out[..1]);
        close(out[0], 0.1063 + 0.1788 + 0.0722, 1e-7);
    }

    #[test]
    fn pictures_that_lack_bytes_are_refused() {
        for (size, bytes) in [([2, 2], 15), ([0, 3], 0), ([1, 1], 0), ([u32::MAX, u32::MAX], 4)] {
            let error = Sampler::new(&[picture(size, vec![0; bytes])]).expect_err("too few bytes");
            assert!(error.to_string().starts_with("picture `p`: "), "{error}");
        }
    }
}
