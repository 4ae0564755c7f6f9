//! Pictures from sub-scanlines: coverage by trapezoids, at any scale [NINT89 fig. 1], [NINT89 fig. 3].

use rayon::prelude::*;
use std::ops::RangeInclusive;

/// What rounding may take from a count of sub-scanlines: 3 * 2 / 1.2 must be 5.
const ROUNDING: f64 = 1e-9;

/// Scanlines that are made by one thread at a stretch: a sub-scanline between two of them is made once.
const STRETCH: usize = 16;

/// Why a picture cannot be made at a scale.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ScaleError {
    /// Not a usable number.
    #[error("a scale of {0}: give a number above 0, such as 1.2")]
    Number(f64),
    /// Some scanlines would have no sub-scanline of their own.
    #[error(
        "at --scale-y {scale} some scanlines have no sub-scanline: {per_line} a scanline reach to a scale of {per_line}; scan with --sub-scanlines {needed} or more"
    )]
    TooLarge {
        /// T_y.
        scale: f64,
        /// n0.
        per_line: u32,
        /// n0 that would do.
        needed: u32,
    },
    /// Nothing is left, or more than can be held.
    #[error("the scaled picture is {0} x {1} pixels: from 1 to 16384 a side can be made")]
    Size(f64, f64),
}

/// How the sub-scanlines of an image make the scanlines of a scaled picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling {
    per_line: f64,
    scale: [f64; 2],
    size: [u32; 2],
}

impl Scaling {
    /// `per_line` is n0, `size` that of the picture at scale 1, `scale` [T_x, T_y].
    pub fn new(per_line: u32, size: [u32; 2], scale: [f64; 2]) -> Result<Self, ScaleError> {
        if let Some(bad) = scale.into_iter().find(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(ScaleError::Number(bad));
        }
        if scale[1] > f64::from(per_line) + ROUNDING {
            let needed = scale[1].ceil().min(f64::from(u32::MAX)) as u32;
            return Err(ScaleError::TooLarge { scale: scale[1], per_line, needed });
        }
        let [w, h] = [0, 1].map(|k| (f64::from(size[k]) * scale[k] + ROUNDING).floor());
        if !(1.0..=16384.0).contains(&w) || !(1.0..=16384.0).contains(&h) {
            return Err(ScaleError::Size(w, h));
        }
        Ok(Self { per_line: f64::from(per_line), scale, size: [w as u32, h as u32] })
    }

    /// Width and height of the scaled picture; what would be part of a pixel at its edges is left out.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// [T_x, T_y].
    pub fn scale(&self) -> [f64; 2] {
        self.scale
    }

    /// First and last sub-scanline of a scanline, counted from 0; neighbours share one. Its number of intervals is
    /// `floor(n0 I / T_y) - floor(n0 I / T_y - n0 / T_y)`, I = `scanline` + 1 [NINT89 eq. 7].
    pub fn sub_scanlines(&self, scanline: u32) -> RangeInclusive<u32> {
        let edge = |i: u32| (self.per_line * f64::from(i) / self.scale[1] + ROUNDING).floor() as u32;
        edge(scanline)..=edge(scanline + 1)
    }
}

/// One sub-scanline of a picture while its segments are added: C' of the paper.
pub struct Row {
    bands: usize,
    width: usize,
    scale: f64,
    values: Vec<f64>,
}

impl Row {
    fn new(width: usize, bands: usize, scale: f64) -> Self {
        Self { bands, width, scale, values: vec![0.0; width * bands] }
    }

    /// Pixels a unit of the image's x makes, T_x.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Adds a segment of one intensity, `from` to `to` in pixels of the image: its length within each pixel it meets
    /// [NINT89 eq. 3], [NINT89 eq. 4], [NINT89 eq. 5], [NINT89 eq. 6].
    pub fn add(&mut self, from: f64, to: f64, intensity: &[f64]) {
        for part in pixels(from, to, self.scale, self.width) {
            self.add_to(part.pixel, part.length, intensity);
        }
    }

    /// Adds an intensity over a length within one pixel.
    pub fn add_to(&mut self, pixel: usize, length: f64, intensity: &[f64]) {
        let sums = &mut self.values[pixel * self.bands..(pixel + 1) * self.bands];
        sums.iter_mut().zip(intensity).for_each(|(s, v)| *s += length * v);
    }

    /// Adds to the columns that stand after the first `skip`.
    pub(super) fn add_after(&mut self, pixel: usize, skip: usize, weight: f64, values: &[f64]) {
        let sums = &mut self.values[pixel * self.bands + skip..(pixel + 1) * self.bands];
        sums.iter_mut().zip(values).for_each(|(s, v)| *s += weight * v);
    }

    /// Pixels in the row.
    pub fn width(&self) -> usize {
        self.width
    }
}

/// The part of a segment within one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// Number of the pixel in its row.
    pub(super) pixel: usize,
    /// Its length, pixels of the scaled picture.
    pub(super) length: f64,
    /// Where it lies, pixels of the image.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// The pixels that a segment meets, from the left.
pub(super) fn pixels(from: f64, to: f64, scale: f64, width: usize) -> impl Iterator<Item = Part> {
    let (a, b) = (from * scale, (to * scale).min(width as f64));
    // The cast saturates: what is left of the picture is none of it.
    let (first, end) = (a.floor() as usize, if b > a { (b.ceil() as usize).min(width) } else { 0 });
    (first..end).filter_map(move |pixel| {
        let (l, r) = (a.max(pixel as f64), b.min(pixel as f64 + 1.0));
        (r > l).then(|| Part { pixel, length: r - l, from: l / scale, to: r / scale })
    })
}

/// A picture of values per pixel and band, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    /// Width and height.
    pub size: [u32; 2],
    /// Values of a pixel.
    pub bands: usize,
    /// Row-major, pixel by pixel.
    pub values: Vec<f64>,
}

/// Makes the picture: `draw` adds the segments of sub-scanline j to the row it is given.
///
/// A pixel is the sum of its sub-scanlines, the first and the last weighted 1/2n and the others 1/n [NINT89 eq. 2], which
/// makes areas by trapezoids [NINT89 eq. 1].
pub fn regenerate(scaling: &Scaling, bands: usize, draw: impl Fn(u32, &mut Row) + Sync) -> Pixels {
    let [width, height] = scaling.size.map(|s| s as usize);
    let mut values = vec![0.0; width * height * bands];
    let stretch = |(k, out): (usize, &mut [f64])| {
        let mut row = Row::new(width, bands, scaling.scale[0]);
        let mut held = None;
        for (i, pixels) in out.chunks_mut(width * bands).enumerate() {
            let range = scaling.sub_scanlines((k * STRETCH + i) as u32);
            let (first, last) = (*range.start(), *range.end());
            let n = f64::from(last - first);
            for j in range {
                if held != Some(j) {
                    row.values.fill(0.0);
                    draw(j, &mut row);
                    held = Some(j);
                }
                let weight = if j == first || j == last { 0.5 / n } else { 1.0 / n };
                pixels.iter_mut().zip(&row.values).for_each(|(p, v)| *p += weight * v);
            }
        }
    };
    values.par_chunks_mut(STRETCH * width * bands).enumerate().for_each(stretch);
    Pixels { size: scaling.size, bands, values }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(per_line: u32, scale: f64, lines: u32) -> Vec<u32> {
        let scaling = Scaling::new(per_line, [10, 100], [1.0, scale]).expect("usable");
        (0..lines).map(|i| scaling.sub_scanlines(i)).map(|r| r.end() - r.start()).collect()
    }

    #[test]
    fn sub_scanlines_follow_the_papers_sequences() {
        assert_eq!(counts(3, 1.2, 8), [2, 3, 2, 3, 2, 3, 2, 3]);
        assert_eq!(counts(3, 0.8, 8), [3, 4, 4, 4, 3, 4, 4, 4]);
        assert_eq!(counts(3, 1.0, 4), [3; 4]);
        assert_eq!(counts(3, 3.0, 4), [1; 4]);
        assert_eq!(counts(1, 1.0, 4), [1; 4]);
    }

    #[test]
    fn the_mean_number_is_what_the_scale_asks_for() {
        for scale in [0.3, 0.8, 0.9, 1.2, 1.7, 2.9] {
            let lines = (100.0 * scale) as u32;
            let total: u32 = counts(3, scale, lines).iter().sum();
            assert!((f64::from(total) - f64::from(lines) * 3.0 / scale).abs() < 1.0, "{scale}");
        }
    }

    #[test]
    fn neighbours_share_a_sub_scanline_and_none_is_left_out() {
        let scaling = Scaling::new(5, [10, 90], [1.0, 1.37]).expect("usable");
        for i in 1..scaling.size()[1] {
            assert_eq!(scaling.sub_scanlines(i - 1).end(), scaling.sub_scanlines(i).start());
        }
    }

    #[test]
    fn scales_that_cannot_be_are_refused_with_the_mend() {
        let said = |s: [f64; 2]| Scaling::new(3, [10, 10], s).expect_err("refused").to_string();
        assert!(said([1.0, 4.0]).contains("--sub-scanlines 4"));
        assert!(said([0.0, 1.0]).contains("above 0"));
        assert!(said([1.0, f64::NAN]).contains("above 0"));
        assert!(said([0.01, 1.0]).contains("0 x 10"));
        assert!(said([1e9, 1.0]).contains("16384"));
    }

    #[test]
    fn a_segment_gives_each_pixel_its_length() {
        let scaling = Scaling::new(1, [6, 1], [1.0, 1.0]).expect("usable");
        let picture = regenerate(&scaling, 2, |_, row| {
            row.add(0.25, 0.5, &[1.0, 10.0]);
            row.add(1.75, 4.5, &[2.0, 20.0]);
        });
        let first: Vec<f64> = picture.values.iter().step_by(2).copied().collect();
        assert_eq!(first, [0.25, 0.5, 2.0, 2.0, 1.0, 0.0]);
        assert_eq!(picture.values[1], 2.5);
    }

    #[test]
    fn a_trapezium_is_exact_and_a_triangle_is_what_trapezoids_make_of_it() {
        // The left edge runs from x = 1 at the top of the pixel to x = 2 at its foot: half of pixel 1 is covered.
        let scaling = Scaling::new(3, [3, 1], [1.0, 1.0]).expect("usable");
        let picture = regenerate(&scaling, 1, |j, row| row.add(1.0 + f64::from(j) / 3.0, 3.0, &[1.0]));
        assert!((picture.values[1] - 0.5).abs() < 1e-15 && (picture.values[2] - 1.0).abs() < 1e-15);
        // An edge that leaves the pixel half way down: lengths 1, 1/3, 0, 0 at n = 3 give 1/6 + 1/9 of the true 1/4.
        let steep = regenerate(&scaling, 1, |j, row| row.add(2.0 * f64::from(j) / 3.0, 1.0, &[1.0]));
        assert!((steep.values[0] - (1.0 / 6.0 + 1.0 / 9.0)).abs() < 1e-15);
    }
}
