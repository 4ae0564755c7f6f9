//! A picture against one cast by rays.

use super::{PictureFault, RayPicture};
use crate::stats::two_sided_t;
use crate::view::Photometry;

/// Deviations below this share of the mean luminance are rounding, not standard errors.
const ROUNDING: f64 = 1e-6;

/// How far a picture is from the judge's, in luminance over the judge's mean luminance.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureError {
    /// Pixels compared.
    pub pixels: usize,
    /// Mean luminance of the judge, W/(m^2 sr) in the bands' weights.
    pub mean: f64,
    /// Root mean square of the differences as they are: the judge's noise is in it.
    pub rms_with_noise: f64,
    /// Mean square with the judge's own noise taken off; it may be below 0 where there is little else.
    pub squared: f64,
    /// Its standard error, by the jackknife over the judge's randomisations.
    pub squared_std_err: f64,
    /// Root of `squared`, 0 where that is below 0.
    pub rms: f64,
    /// Interval of `rms` at 95 % confidence.
    pub rms_interval: [f64; 2],
    /// Mean difference, picture less judge.
    pub bias: f64,
    /// The greatest difference of a pixel in standard errors of the judge, which have few degrees of freedom.
    pub worst: f64,
    /// That pixel: x, y.
    pub worst_at: [u32; 2],
    /// Share of pixels whose mean is off by more than a step of an 8-bit sRGB display.
    pub off_by_a_step: f64,
    /// The same less three standard errors of the judge.
    pub surely_off: f64,
}

/// Compares a picture (radiances: rows from the top, pixels, bands) with the judge's of the same camera and scale, over
/// the upper left part that both have. `white` is the luminance that a display shows as its white.
///
/// The squared error of a pixel is the mean of products of differences to two different randomisations, whose noises are
/// independent: their mean is the square of the true difference, whatever the noise.
///
/// # Errors
/// [`PictureFault::Length`] if values, sizes and bands do not fit.
pub fn compare(
    size: [u32; 2],
    bands: usize,
    values: &[f64],
    judge: &RayPicture,
    photometry: &Photometry,
    white: f64,
) -> Result<PictureError, PictureFault> {
    let expected = size[0] as usize * size[1] as usize * bands;
    let fit = values.len() == expected && bands == photometry.weights.len() && bands == judge.bands;
    let both = [size[0].min(judge.size[0]), size[1].min(judge.size[1])];
    if !fit || both[0] == 0 || both[1] == 0 {
        return Err(PictureFault::Length { what: "picture", found: values.len(), expected });
    }
    let n = judge.randomisations as usize;
    let pixels = both[0] as usize * both[1] as usize;
    let mut sums = Sums { left_out: vec![0.0; n], ..Sums::default() };
    let places = || (0..both[1]).flat_map(|y| (0..both[0]).map(move |x| [x, y]));
    let of = |[x, y]: [u32; 2]| {
        let own = (x as usize + y as usize * size[0] as usize) * bands;
        let at = (x as usize + y as usize * judge.size[0] as usize) * n;
        (photometry.luminance(&values[own..own + bands]), &judge.luminance[at..at + n])
    };
    let mean = places().map(|p| of(p).1.iter().map(|v| f64::from(*v)).sum::<f64>()).sum::<f64>() / (pixels * n) as f64;
    let unit = if mean > 0.0 { mean } else { 1.0 };
    for place in places() {
        let (value, replicates) = of(place);
        sums.add(place, value, replicates, ROUNDING * unit, white);
    }
    Ok(sums.finished(pixels, mean, unit))
}

#[derive(Default)]
struct Sums {
    squared: f64,
    with_noise: f64,
    difference: f64,
    /// The squared error with one randomisation left out.
    left_out: Vec<f64>,
    worst: f64,
    worst_at: [u32; 2],
    off: usize,
    surely: usize,
}

impl Sums {
    fn add(&mut self, at: [u32; 2], value: f64, replicates: &[f32], rounding: f64, white: f64) {
        let n = replicates.len() as f64;
        let off = |v: &f32| value - f64::from(*v);
        let (sum, squares) = replicates.iter().map(off).fold((0.0, 0.0), |(s, q), d| (s + d, q + d * d));
        // Pairs of different randomisations alone.
        self.squared += (sum * sum - squares) / (n * (n - 1.0));
        for (out, d) in self.left_out.iter_mut().zip(replicates.iter().map(off)) {
            // Two randomisations leave no pair when one is out; the jackknife then knows nothing.
            let pairs = ((n - 1.0) * (n - 2.0)).max(1.0);
            *out += ((sum - d).powi(2) - (squares - d * d)) / pairs;
        }
        let difference = sum / n;
        let std_err = ((squares - sum * sum / n).max(0.0) / (n * (n - 1.0))).sqrt();
        self.with_noise += difference * difference;
        self.difference += difference;
        let far = difference.abs() / std_err.max(rounding);
        if far > self.worst {
            (self.worst, self.worst_at) = (far, at);
        }
        let judge = value - difference;
        let step = |v: f64| (shown(value, white) - shown(v, white)).abs() > 1.0 / 255.0;
        self.off += usize::from(step(judge));
        let nearer = judge + difference.clamp(-3.0 * std_err, 3.0 * std_err);
        self.surely += usize::from(step(nearer));
    }

    fn finished(self, pixels: usize, mean: f64, unit: f64) -> PictureError {
        let count = pixels as f64;
        let square = unit * unit * count;
        let squared = self.squared / square;
        let n = self.left_out.len() as f64;
        let middle = self.left_out.iter().sum::<f64>() / n;
        let spread: f64 = self.left_out.iter().map(|v| (v - middle).powi(2)).sum();
        let squared_std_err = ((n - 1.0) / n * spread).sqrt() / square;
        let reach = two_sided_t(0.95, n - 1.0) * squared_std_err;
        PictureError {
            pixels,
            mean,
            rms_with_noise: (self.with_noise / square).sqrt(),
            squared,
            squared_std_err,
            rms: squared.max(0.0).sqrt(),
            rms_interval: [squared - reach, squared + reach].map(|v| v.max(0.0).sqrt()),
            bias: self.difference / (unit * count),
            worst: self.worst,
            worst_at: self.worst_at,
            off_by_a_step: self.off as f64 / count,
            surely_off: self.surely as f64 / count,
        }
    }
}

/// What a display is driven with for a luminance, 0 to 1: the curve of sRGB.
fn shown(luminance: f64, white: f64) -> f64 {
    let v = (luminance / white).clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}
