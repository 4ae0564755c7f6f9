//! Layouts of world projections: where on which panel a direction is drawn, and how much of the world a texel holds.
//!
//! Directions are those of the observer: x to the right, y to the front, z up.

use crate::math::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// How the world is laid out on a plane [G86 fig. 2].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Six square views of 90 degrees: the faces of a cube about the world centre, in the order of [`Face`].
    Cube,
    /// Longitude across, latitude down: the front in the middle, up at the top.
    LatLong,
    /// Longitude across, sine of the latitude down: texels of equal solid angle.
    SineLatLong,
    /// Equidistant fish-eye about the front: angles from the axis are lengths in the picture.
    Fisheye {
        /// Angle across the circle, degrees: 180 for half a world, at most 360.
        field: f64,
    },
}

/// A face of the cube, as seen from the world centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Face {
    /// To the front (+y).
    Front,
    /// To the right (+x).
    Right,
    /// To the back (-y).
    Back,
    /// To the left (-x).
    Left,
    /// Up (+z); the front lies at its lower edge.
    Up,
    /// Down (-z); the front lies at its upper edge.
    Down,
}

impl Face {
    /// In the order of the panels.
    pub const ALL: [Self; 6] = [Self::Front, Self::Right, Self::Back, Self::Left, Self::Up, Self::Down];

    /// Directions of its middle, to its right and downwards, each of unit length.
    pub fn axes(self) -> [DVec3; 3] {
        match self {
            Self::Front => [DVec3::Y, DVec3::X, -DVec3::Z],
            Self::Right => [DVec3::X, -DVec3::Y, -DVec3::Z],
            Self::Back => [-DVec3::Y, -DVec3::X, -DVec3::Z],
            Self::Left => [-DVec3::X, DVec3::Y, -DVec3::Z],
            Self::Up => [DVec3::Z, DVec3::X, DVec3::Y],
            Self::Down => [-DVec3::Z, DVec3::X, -DVec3::Y],
        }
    }

    /// The face that a direction goes through.
    pub fn through(d: DVec3) -> Self {
        let a = d.abs();
        match (a.x >= a.y && a.x >= a.z, a.y >= a.z) {
            (true, _) => [Self::Left, Self::Right][usize::from(d.x > 0.0)],
            (_, true) => [Self::Back, Self::Front][usize::from(d.y > 0.0)],
            _ => [Self::Down, Self::Up][usize::from(d.z > 0.0)],
        }
    }

    /// Where the ray along `d` meets the plane of the face: (u, v), -1 to 1 within it, to the right and downwards; `None`
    /// where it goes the other way.
    pub fn on_plane(self, d: DVec3) -> Option<(f64, f64)> {
        let [forward, right, down] = self.axes();
        let depth = d.dot(forward);
        (depth > 0.0).then(|| (d.dot(right) / depth, d.dot(down) / depth))
    }

    /// Direction, not of unit length, to the point (u, v) of its plane.
    pub fn towards(self, u: f64, v: f64) -> DVec3 {
        let [forward, right, down] = self.axes();
        forward + right * u + down * v
    }
}

/// A layout at a size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// How directions are laid out.
    pub layout: Layout,
    /// Texels: edge of a face of a cube, height of a latitude-longitude map (it is twice as wide), diameter of a
    /// fish-eye.
    pub size: u32,
}

/// A place on a panel, in texels from its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Which panel.
    pub panel: usize,
    /// To the right.
    pub x: f64,
    /// Downwards.
    pub y: f64,
}

impl Shape {
    /// Number of panels: six for a cube, else one.
    pub fn panels(self) -> usize {
        if self.layout == Layout::Cube { Face::ALL.len() } else { 1 }
    }

    /// Texels across a panel.
    pub fn width(self) -> usize {
        match self.layout {
            Layout::LatLong | Layout::SineLatLong => 2 * self.size as usize,
            _ => self.size as usize,
        }
    }

    /// Texels down a panel.
    pub fn height(self) -> usize {
        self.size as usize
    }

    /// Texels of all panels.
    pub fn texels(self) -> usize {
        self.panels() * self.width() * self.height()
    }

    /// Number of a texel: panels one after the other, rows from the top.
    pub fn index(self, panel: usize, x: usize, y: usize) -> usize {
        (panel * self.height() + y) * self.width() + x
    }

    /// Panel, column and row of a texel.
    pub fn texel(self, index: usize) -> (usize, usize, usize) {
        let (row, x) = (index / self.width(), index % self.width());
        (row / self.height(), x, row % self.height())
    }

    /// Unit direction drawn at a point of a panel, texels from its upper left corner. A cube's panels go on beyond
    /// their edges, as planes; longitudes go round. `None` outside of a fish-eye's circle and beyond the poles.
    pub fn direction(self, spot: Spot) -> Option<DVec3> {
        let (s, t) = (spot.x / self.width() as f64, spot.y / self.height() as f64);
        match self.layout {
            Layout::Cube => Some(Face::ALL[spot.panel].towards(2.0 * s - 1.0, 2.0 * t - 1.0).normalize()),
            Layout::LatLong | Layout::SineLatLong => {
                let within = (0.0..=1.0).contains(&t);
                let (sine, cosine) = match self.layout {
                    Layout::LatLong => ((0.5 - t) * PI).sin_cos(),
                    _ => (1.0 - 2.0 * t, (4.0 * t * (1.0 - t)).max(0.0).sqrt()),
                };
                let (across, ahead) = ((s - 0.5) * TAU).sin_cos();
                within.then(|| DVec3::new(cosine * across, cosine * ahead, sine))
            }
            Layout::Fisheye { field } => {
                let (x, z) = (2.0 * s - 1.0, 1.0 - 2.0 * t);
                let r = x.hypot(z);
                let angle = r * 0.5 * field.to_radians();
                // sin(angle) / r, also in the middle.
                let slope = if r > 0.0 { angle.sin() / r } else { 0.0 };
                (r <= 1.0).then(|| DVec3::new(x * slope, angle.cos(), z * slope))
            }
        }
    }

    /// Direction in the middle of a texel; `None` outside of a fish-eye's circle.
    pub fn middle(self, index: usize) -> Option<DVec3> {
        let (panel, x, y) = self.texel(index);
        self.direction(Spot { panel, x: x as f64 + 0.5, y: y as f64 + 0.5 })
    }

    /// Where a direction, of any length but 0, is drawn; `None` beyond the field of a fish-eye.
    pub fn place(self, d: DVec3) -> Option<Spot> {
        let (w, h) = (self.width() as f64, self.height() as f64);
        match self.layout {
            Layout::Cube => {
                let face = Face::through(d);
                let (u, v) = face.on_plane(d)?;
                Some(Spot { panel: face as usize, x: 0.5 * (u + 1.0) * w, y: 0.5 * (v + 1.0) * h })
            }
            Layout::LatLong | Layout::SineLatLong => {
                let x = (0.5 + d.x.atan2(d.y) / TAU) * w;
                let t = match self.layout {
                    Layout::LatLong => 0.5 - d.z.atan2(d.x.hypot(d.y)) / PI,
                    _ => 0.5 - 0.5 * d.z / d.length(),
                };
                Some(Spot { panel: 0, x, y: t * h })
            }
            Layout::Fisheye { field } => {
                let aside = d.x.hypot(d.z);
                let angle = aside.atan2(d.y);
                let r = angle / (0.5 * field.to_radians());
                let (x, z) = if aside > 0.0 { (d.x / aside * r, d.z / aside * r) } else { (0.0, 0.0) };
                (r <= 1.0).then_some(Spot { panel: 0, x: 0.5 * (1.0 + x) * w, y: 0.5 * (1.0 - z) * h })
            }
        }
    }

    /// Solid angle of a texel, sr: exact for cubes and both latitude-longitude layouts; of a fish-eye from 8 x 8 points,
    /// those within its circle.
    pub fn solid_angle(self, index: usize) -> f64 {
        let (_, x, y) = self.texel(index);
        let (w, h) = (self.width() as f64, self.height() as f64);
        let (x, y) = (x as f64, y as f64);
        match self.layout {
            Layout::Cube => {
                let at = |x: f64, y: f64| solid_angle_to(2.0 * x / w - 1.0, 2.0 * y / h - 1.0);
                at(x + 1.0, y + 1.0) - at(x, y + 1.0) - at(x + 1.0, y) + at(x, y)
            }
            Layout::LatLong => {
                // sin a - sin b without cancellation.
                let (middle, half) = ((0.5 - (y + 0.5) / h) * PI, 0.5 * PI / h);
                TAU / w * 2.0 * middle.cos() * half.sin()
            }
            Layout::SineLatLong => TAU / w * 2.0 / h,
            Layout::Fisheye { field } => {
                let half = 0.5 * field.to_radians();
                let density = |k: usize| {
                    let at = |k: usize| (k as f64 + 0.5) / 8.0;
                    let (px, py) = (2.0 * (x + at(k % 8)) / w - 1.0, 2.0 * (y + at(k / 8)) / h - 1.0);
                    let r = px.hypot(py);
                    if r > 1.0 { 0.0 } else { half * (r * half).sin() / r }
                };
                (0..64).map(density).sum::<f64>() / 64.0 * 4.0 / (w * h)
            }
        }
    }

    /// Solid angle per square texel at a point of a panel.
    pub(super) fn density(self, x: f64, y: f64) -> f64 {
        let (w, h) = (self.width() as f64, self.height() as f64);
        match self.layout {
            Layout::Cube => {
                let (u, v) = (2.0 * x / w - 1.0, 2.0 * y / h - 1.0);
                4.0 / (w * h) * (1.0 + u * u + v * v).powf(-1.5)
            }
            Layout::LatLong => TAU / w * PI / h * ((0.5 - y / h) * PI).cos(),
            Layout::SineLatLong => TAU / w * 2.0 / h,
            Layout::Fisheye { field } => {
                let half = 0.5 * field.to_radians();
                let r = (2.0 * x / w - 1.0).hypot(2.0 * y / h - 1.0).max(1e-12);
                half * (r * half).sin() / r * 4.0 / (w * h)
            }
        }
    }
}

/// Solid angle of the rectangle from the middle of a face to (u, v), signed.
fn solid_angle_to(u: f64, v: f64) -> f64 {
    (u * v).atan2((1.0 + u * u + v * v).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::compensated_sum;

    const WHOLE: [Layout; 3] = [Layout::Cube, Layout::LatLong, Layout::SineLatLong];

    #[test]
    fn there_and_back_again_in_every_layout() {
        let layouts =
            [WHOLE.as_slice(), &[Layout::Fisheye { field: 180.0 }, Layout::Fisheye { field: 360.0 }]].concat();
        for layout in layouts {
            let shape = Shape { layout, size: 12 };
            let mut checked = 0;
            for index in 0..shape.texels() {
                let (panel, x, y) = shape.texel(index);
                assert_eq!(shape.index(panel, x, y), index);
                let spot = Spot { panel, x: x as f64 + 0.3, y: y as f64 + 0.6 };
                let Some(d) = shape.direction(spot) else { continue };
                assert!((d.length() - 1.0).abs() < 1e-14, "{layout:?} {spot:?}");
                let back = shape.place(d * 3.0).expect("drawn");
                let off = (back.x - spot.x).abs().max((back.y - spot.y).abs());
                assert!(back.panel == panel && off < 1e-12, "{layout:?} {spot:?} {back:?}");
                checked += 1;
            }
            assert!(checked > 100, "{layout:?}");
        }
    }

    #[test]
    fn the_observer_sees_right_to_the_right_and_up_at_the_top() {
        for layout in [Layout::LatLong, Layout::SineLatLong, Layout::Fisheye { field: 360.0 }] {
            let shape = Shape { layout, size: 64 };
            let (w, h) = (shape.width() as f64, 64.0);
            let at = |d: DVec3| shape.place(d).expect("drawn");
            let middle = at(DVec3::Y);
            assert!((middle.x - w / 2.0).abs() < 1e-12 && (middle.y - h / 2.0).abs() < 1e-12);
            assert!(at(DVec3::new(1.0, 1.0, 0.0)).x > w / 2.0 && at(DVec3::new(0.0, 1.0, 1.0)).y < h / 2.0);
        }
        let shape = Shape { layout: Layout::Cube, size: 8 };
        let right = shape.place(DVec3::new(0.9, 1.0, 0.0)).expect("drawn");
        assert!(right.panel == Face::Front as usize && right.x > 7.0);
        // Across the edges of the unfolded picture the world goes on.
        let across = |a: Spot, b: Spot| shape.direction(a).expect("drawn").distance(shape.direction(b).expect("drawn"));
        let spot = |face: Face, x: f64, y: f64| Spot { panel: face as usize, x, y };
        for (left, right) in [(Face::Left, Face::Front), (Face::Front, Face::Right), (Face::Right, Face::Back)] {
            assert!(across(spot(left, 8.0, 3.0), spot(right, 0.0, 3.0)) < 1e-15);
        }
        assert!(across(spot(Face::Up, 3.0, 8.0), spot(Face::Front, 3.0, 0.0)) < 1e-15);
        assert!(across(spot(Face::Front, 3.0, 8.0), spot(Face::Down, 3.0, 0.0)) < 1e-15);
    }

    #[test]
    fn texels_share_the_whole_world() {
        for layout in WHOLE {
            for size in [1, 7, 256] {
                let shape = Shape { layout, size };
                let sum = compensated_sum((0..shape.texels()).map(|k| shape.solid_angle(k)));
                assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-12, "{layout:?} {size}: {sum}");
            }
        }
        let half = Shape { layout: Layout::Fisheye { field: 180.0 }, size: 256 };
        let sum: f64 = (0..half.texels()).map(|k| half.solid_angle(k)).sum();
        // Which of its points are within the circle is decided point by point: 2048 across, 2.1e-5 off.
        assert!((sum / TAU - 1.0).abs() < 5e-5, "{sum}");
    }
}
