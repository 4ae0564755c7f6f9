//! Where the six faces of a cube lie in a picture, and which way up.

use crate::math::DVec3;
use crate::world::{Face, Layout, Shape};

/// A face in a picture: its column and row, in faces, and its axes: middle, to its right in the picture, and downwards.
struct Placed {
    at: (usize, usize),
    axes: [DVec3; 3],
}

/// Pictures of six faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Faces {
    HorizontalCross,
    VerticalCross,
    VerticalStrip,
    HorizontalStrip,
}

impl Faces {
    /// Width and height, in faces.
    pub(super) fn extent(self) -> (usize, usize) {
        match self {
            Self::HorizontalCross => (4, 3),
            Self::VerticalCross => (3, 4),
            Self::VerticalStrip => (1, 6),
            Self::HorizontalStrip => (6, 1),
        }
    }

    fn placed(self) -> Vec<Placed> {
        let upright = |face: Face, at| Placed { at, axes: face.axes() };
        match self {
            Self::HorizontalCross => vec![
                upright(Face::Front, (1, 1)),
                upright(Face::Right, (2, 1)),
                upright(Face::Back, (3, 1)),
                upright(Face::Left, (0, 1)),
                upright(Face::Up, (1, 0)),
                upright(Face::Down, (1, 2)),
            ],
            Self::VerticalCross => vec![
                upright(Face::Front, (1, 1)),
                upright(Face::Right, (2, 1)),
                // The picture goes on from the face down: the back stands on its head.
                Placed { at: (1, 3), axes: [-DVec3::Y, DVec3::X, DVec3::Z] },
                upright(Face::Left, (0, 1)),
                upright(Face::Up, (1, 0)),
                upright(Face::Down, (1, 2)),
            ],
            Self::VerticalStrip | Self::HorizontalStrip => {
                // OpenEXR's cube: +X, -X, +Y, -Y, +Z, -Z with Y up, +Z in the middle of its latitude-longitude maps and
                // +X left of it.
                let (x, y, z) = (-DVec3::X, DVec3::Z, DVec3::Y);
                let axes = [[x, z, -y], [-x, -z, -y], [y, x, -z], [-y, x, z], [z, -x, -y], [-z, x, -y]];
                let at = |k: usize| if self == Self::VerticalStrip { (0, k) } else { (k, 0) };
                axes.into_iter().enumerate().map(|(k, axes)| Placed { at: at(k), axes }).collect()
            }
        }
    }

    /// For every texel of a cube whose faces have `size` texels along an edge: the pixel that shows it.
    pub(super) fn pixels(self, size: u32) -> Vec<usize> {
        let shape = Shape { layout: Layout::Cube, size };
        let (n, width) = (size as usize, self.extent().0 * size as usize);
        let mut pixels = vec![0; shape.texels()];
        for Placed { at: (column, row), axes: [forward, right, down] } in self.placed() {
            let face = Face::through(forward);
            let [_, across, below] = face.axes();
            // Texels of a face turned by quarters: both directions have whole steps, counted from the middle.
            let (rx, ry) = (right.dot(across) as i64, right.dot(below) as i64);
            let (dx, dy) = (down.dot(across) as i64, down.dot(below) as i64);
            let from_middle = |k: usize| 2 * k as i64 + 1 - n as i64;
            for y in 0..n {
                for x in 0..n {
                    let (u, v) = (from_middle(x), from_middle(y));
                    let back = |c: i64| ((c - 1 + n as i64) / 2) as usize;
                    let texel = shape.index(face as usize, back(u * rx + v * dx), back(u * ry + v * dy));
                    pixels[texel] = (row * n + y) * width + column * n + x;
                }
            }
        }
        pixels
    }
}
