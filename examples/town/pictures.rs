//! Pictures made by rule: bricks, asphalt, slabs, clouds, and a broad-leaved tree cut free.

use super::solid::Dice;

/// A picture in the making: linear steps of sRGB bytes as they are written, and opacity; rows from the top.
pub struct Sheet {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Sheet {
    fn new(size: [usize; 2], mut pixel: impl FnMut(usize, usize) -> [f64; 4]) -> Self {
        let byte = |v: f64| v.clamp(0.0, 255.0).round() as u8;
        let rgba = (0..size[0] * size[1]).flat_map(|k| pixel(k % size[0], k / size[0]).map(byte)).collect();
        Self { size, rgba }
    }
}

/// Smooth noise that repeats after `n` cells, 0 to 1.
struct Noise {
    n: usize,
    values: Vec<f64>,
}

impl Noise {
    fn new(n: usize, dice: &mut Dice) -> Self {
        Self { n, values: (0..n * n).map(|_| dice.next()).collect() }
    }

    /// At a place from 0 to 1.
    fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x * self.n as f64, y * self.n as f64);
        let (i, j) = (x.floor() as usize, y.floor() as usize);
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let (fx, fy) = (ease(x.fract()), ease(y.fract()));
        let value = |i: usize, j: usize| self.values[j % self.n * self.n + i % self.n];
        let row = |j: usize| value(i, j) + fx * (value(i + 1, j) - value(i, j));
        row(j) + fy * (row(j + 1) - row(j))
    }
}

/// Two bricks by four courses, every other one shifted by half a brick.
pub fn bricks() -> Sheet {
    let mut dice = Dice::new(1);
    let tints: Vec<f64> = (0..16).map(|_| dice.within(-22.0, 22.0)).collect();
    let mut grain = Dice::new(2);
    Sheet::new([128, 128], |x, y| {
        let (course, shift) = (y / 16, if y / 16 % 2 == 0 { 0 } else { 32 });
        let along = (x + shift) % 128;
        let joint = y % 16 < 2 || along % 64 < 2;
        let g = grain.within(-9.0, 9.0);
        if joint {
            return [176.0 + g, 170.0 + g, 160.0 + g, 255.0];
        }
        let t = tints[course * 2 + along / 64] + g;
        [158.0 + t, 84.0 + 0.7 * t, 62.0 + 0.6 * t, 255.0]
    })
}

/// Dark grains, patches a little lighter.
pub fn asphalt() -> Sheet {
    let mut dice = Dice::new(3);
    let patches = Noise::new(6, &mut dice);
    Sheet::new([128, 128], |x, y| {
        let p = 40.0 * (patches.at(x as f64 / 128.0, y as f64 / 128.0) - 0.5);
        let g = 108.0 + p + dice.within(-24.0, 24.0);
        [g, g, g + 3.0, 255.0]
    })
}

/// Four by four slabs with joints.
pub fn slabs() -> Sheet {
    let mut dice = Dice::new(4);
    let tints: Vec<f64> = (0..16).map(|_| dice.within(-10.0, 10.0)).collect();
    Sheet::new([128, 128], |x, y| {
        let joint = x % 32 < 1 || y % 32 < 1;
        let g = dice.within(-6.0, 6.0) + if joint { 110.0 } else { 196.0 + tints[y / 32 * 4 + x / 32] };
        [g, g - 3.0, g - 10.0, 255.0]
    })
}

/// The heights of slabs: joints lie lower, edges are rounded.
pub fn slab_heights() -> Sheet {
    Sheet::new([128, 128], |x, y| {
        let edge = |k: usize| (k % 32).min(31 - k % 32) as f64;
        let h = (edge(x).min(edge(y)) / 3.0).min(1.0) * 255.0;
        [h, h, h, 255.0]
    })
}

/// Fleecy clouds: noise of several sizes, cut off below.
pub fn clouds() -> Sheet {
    let mut dice = Dice::new(5);
    let layers: Vec<Noise> = [4, 8, 16, 32, 64].map(|n| Noise::new(n, &mut dice)).into();
    Sheet::new([256, 256], |x, y| {
        let (x, y) = (x as f64 / 256.0, y as f64 / 256.0);
        let (mut sum, mut weight) = (0.0, 0.5);
        for layer in &layers {
            sum += weight * layer.at(x, y);
            weight *= 0.5;
        }
        let cover = ((sum - 0.47) / 0.22).clamp(0.0, 1.0);
        let white = 255.0 - 40.0 * cover * cover;
        [white, white, white + 4.0, 235.0 * cover]
    })
}

/// A tree seen from the side: a forked trunk, and leaves as discs along its twigs, light ones last.
pub fn tree() -> Sheet {
    let size = [256, 288];
    let mut dice = Dice::new(6);
    let mut sheet = Sheet::new(size, |_, _| [40.0, 60.0, 25.0, 0.0]);
    let mut tips = Vec::new();
    branch(&mut sheet, &mut dice, [128.0, 287.0], -std::f64::consts::FRAC_PI_2, 82.0, 9.0, &mut tips);
    for layer in 0..3 {
        let shade = 0.62 + 0.2 * f64::from(layer);
        for tip in &tips {
            for _ in 0..8 {
                let spread = 24.0 - 4.0 * f64::from(layer);
                let (dx, dy) = (dice.within(-spread, spread), dice.within(-spread, spread) - 3.0 * f64::from(layer));
                let tint = dice.within(0.8, 1.2) * shade;
                let colour = [98.0 * tint, 136.0 * tint, 52.0 * tint];
                let radius = dice.within(1.8, 3.9);
                let at = [tip[0] + dx, tip[1] + dy];
                // Nothing is cut off at the rim of the picture.
                if at[0] > 6.0 && at[0] < 250.0 && at[1] > 6.0 {
                    disc(&mut sheet, at, radius, colour);
                }
            }
        }
    }
    sheet
}

/// A branch from a point along an angle, and those that grow out of it.
fn branch(
    sheet: &mut Sheet,
    dice: &mut Dice,
    from: [f64; 2],
    angle: f64,
    length: f64,
    width: f64,
    tips: &mut Vec<[f64; 2]>,
) {
    let steps = length as usize + 1;
    let to = [from[0] + angle.cos() * length, from[1] + angle.sin() * length];
    for k in 0..=steps {
        let t = k as f64 / steps as f64;
        let at = [0, 1].map(|c| from[c] + t * (to[c] - from[c]));
        disc(sheet, at, 0.5 * width * (1.0 - 0.35 * t), [92.0, 74.0, 58.0]);
    }
    if length < 44.0 {
        tips.push(to);
    }
    if length < 16.0 {
        return;
    }
    for side in [-1.0, 0.0, 1.0] {
        let turn = side * dice.within(0.35, 0.62) + dice.within(-0.1, 0.1);
        // Twigs strive upward.
        let angle = angle + 0.25 * (-std::f64::consts::FRAC_PI_2 - angle);
        let shorter = length * dice.within(0.64, 0.76);
        branch(sheet, dice, to, angle + turn, shorter, width * 0.62, tips);
    }
}

/// A disc with a soft rim.
fn disc(sheet: &mut Sheet, [cx, cy]: [f64; 2], radius: f64, colour: [f64; 3]) {
    let [w, h] = sheet.size;
    let range =
        |c: f64, n: usize| ((c - radius - 1.0).max(0.0) as usize, ((c + radius + 2.0).max(0.0) as usize).min(n));
    let ((x0, x1), (y0, y1)) = (range(cx, w), range(cy, h));
    for y in y0..y1 {
        for x in x0..x1 {
            let away = (x as f64 + 0.5 - cx).hypot(y as f64 + 0.5 - cy);
            let cover = (radius + 0.5 - away).clamp(0.0, 1.0);
            let pixel = &mut sheet.rgba[4 * (y * w + x)..][..4];
            // What lies under a rim keeps its colour as far as it is there.
            let below = f64::from(pixel[3]) / 255.0 * (1.0 - cover);
            let alpha = cover + below;
            if alpha > 0.0 {
                for (p, c) in pixel.iter_mut().zip(colour) {
                    *p = ((c * cover + f64::from(*p) * below) / alpha).clamp(0.0, 255.0).round() as u8;
                }
                pixel[3] = (alpha * 255.0).round() as u8;
            }
        }
    }
}
