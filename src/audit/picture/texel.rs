//! Pictures looked up in linear light, and how they lie on faces.

use super::PictureFault;
use crate::math::DVec3;
use crate::scene::{Picture, Texture};

/// What is beyond a picture's edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outside {
    /// The picture again.
    Repeat,
    /// Nothing.
    Clear,
    /// The last texel.
    Edge,
}

/// A picture in linear light: red, green and blue times opacity, and opacity; rows from the top.
pub(super) struct Texels {
    width: i64,
    height: i64,
    values: Vec<[f64; 4]>,
}

impl Texels {
    pub fn new(picture: &Picture) -> Result<Self, PictureFault> {
        let [w, h] = picture.size;
        if w == 0 || h == 0 || picture.rgba.len() as u64 != 4 * u64::from(w) * u64::from(h) {
            return Err(PictureFault::Bytes { name: picture.name.clone(), bytes: picture.rgba.len(), size: [w, h] });
        }
        let values = picture.rgba.chunks_exact(4).map(|c| {
            let opacity = f64::from(c[3]) / 255.0;
            [linear(c[0]) * opacity, linear(c[1]) * opacity, linear(c[2]) * opacity, opacity]
        });
        Ok(Self { width: w.into(), height: h.into(), values: values.collect() })
    }

    /// Bilinear between texel centres; the picture covers 0 to 1 both ways, t grows upward.
    pub fn at(&self, s: f64, t: f64, outside: Outside) -> [f64; 4] {
        let (x, y) = (s * self.width as f64 - 0.5, (1.0 - t) * self.height as f64 - 0.5);
        if !(x.is_finite() && y.is_finite()) {
            return [0.0; 4];
        }
        let (i, j) = (x.floor(), y.floor());
        let (fx, fy) = (x - i, y - j);
        let corner = |di: i64, dj: i64| self.texel(i as i64 + di, j as i64 + dj, outside);
        let corners = [
            (corner(0, 0), (1.0 - fx) * (1.0 - fy)),
            (corner(1, 0), fx * (1.0 - fy)),
            (corner(0, 1), (1.0 - fx) * fy),
            (corner(1, 1), fx * fy),
        ];
        std::array::from_fn(|c| corners.iter().map(|(texel, weight)| texel[c] * weight).sum())
    }

    fn texel(&self, i: i64, j: i64, outside: Outside) -> [f64; 4] {
        let inside = (0..self.width).contains(&i) && (0..self.height).contains(&j);
        let (i, j) = match outside {
            Outside::Clear if !inside => return [0.0; 4],
            Outside::Repeat => (i.rem_euclid(self.width), j.rem_euclid(self.height)),
            _ => (i.clamp(0, self.width - 1), j.clamp(0, self.height - 1)),
        };
        self.values[(i + j * self.width) as usize]
    }

    /// Mean of all texels.
    pub fn mean(&self) -> [f64; 4] {
        let n = self.values.len() as f64;
        std::array::from_fn(|c| self.values.iter().map(|v| v[c]).sum::<f64>() / n)
    }

    /// Luminance of what lies at a point of a face.
    pub fn luminance_on(&self, texture: &Texture, point: DVec3, front: DVec3) -> f64 {
        let [s, t] = place(texture, point, front);
        luminance(self.at(s, t, Outside::Repeat))
    }

    /// The front normal tilted by the picture as a height field: central differences over half a texel to each side.
    pub fn tilted(&self, texture: &Texture, height: f64, point: DVec3, front: DVec3) -> DVec3 {
        let (right, above) = axes(front);
        let [s, t] = place(texture, point, front);
        let texels = [self.width as f64, self.height as f64];
        let level =
            |ds: f64, dt: f64| height * luminance(self.at(s + ds / texels[0], t + dt / texels[1], Outside::Repeat));
        let slope_s = (level(0.5, 0.0) - level(-0.5, 0.0)) * texels[0] / texture.tile[0];
        let slope_t = (level(0.0, 0.5) - level(0.0, -0.5)) * texels[1] / texture.tile[1];
        (front - right * slope_s - above * slope_t).normalize_or(front)
    }
}

/// Directions in which s and t grow on a face with this unit normal: along x and y on what lies flat, level and upward
/// on what stands.
fn axes(front: DVec3) -> (DVec3, DVec3) {
    if front.z.abs() > 0.9 {
        return (DVec3::X, DVec3::Y);
    }
    let right = DVec3::Z.cross(front).normalize_or_zero();
    (right, front.cross(right))
}

/// Where on a texture a point lies, in repeats.
pub(super) fn place(texture: &Texture, point: DVec3, front: DVec3) -> [f64; 2] {
    let (right, above) = axes(front);
    let from = point - texture.origin;
    [from.dot(right) / texture.tile[0], from.dot(above) / texture.tile[1]]
}

/// Colour without its opacity; black where there is none.
pub(super) fn apart([r, g, b, opacity]: [f64; 4]) -> [f64; 3] {
    if opacity > 0.0 { [r / opacity, g / opacity, b / opacity] } else { [0.0; 3] }
}

/// Luminance of the first three.
fn luminance(c: [f64; 4]) -> f64 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

/// Red, green and blue as a scene with bands r, g, b has them; in any other scene their luminance in every band.
pub(super) fn band(rgb: [f64; 3], in_rgb: bool, band: usize) -> f64 {
    if in_rgb { rgb[band] } else { luminance([rgb[0], rgb[1], rgb[2], 1.0]) }
}

/// Light of an sRGB byte.
fn linear(byte: u8) -> f64 {
    let v = f64::from(byte) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}
