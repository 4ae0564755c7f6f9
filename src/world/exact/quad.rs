//! Solid angles of the parts of texels between the sides of a convex cone.

use super::super::cone::{Part, triangle};
use super::super::layout::{Layout, Shape};
use super::{Block, Cell};
use crate::math::DVec3;
use std::f64::consts::{PI, TAU};

/// Weights of the texels of a block.
pub fn walk(shape: Shape, part: &Part, block: Block, each: &mut dyn FnMut(usize, f64)) {
    let (middle, reach) = block.cell().middle(shape);
    let heights = part.normals.map(|n| if n == DVec3::ZERO { f64::INFINITY } else { n.dot(middle) });
    if heights.iter().any(|h| *h < -reach) {
        return;
    }
    if heights.iter().all(|h| *h > reach) {
        for y in block.y[0]..block.y[1] {
            for x in block.x[0]..block.x[1] {
                let index = shape.index(block.panel, x, y);
                let solid = shape.solid_angle(index);
                if solid > 0.0 {
                    each(index, solid);
                }
            }
        }
    } else if let Some((x, y)) = block.texel() {
        let weight = cut(shape, part, block.cell());
        if weight > 0.0 {
            each(shape.index(block.panel, x, y), weight);
        }
    } else {
        block.halves().iter().for_each(|half| walk(shape, part, *half, each));
    }
}

/// Solid angle of the part of a texel inside. Of a cube the texel's sides are great circles; elsewhere it is cut up
/// until its parts' sides nearly are.
fn cut(shape: Shape, part: &Part, texel: Cell) -> f64 {
    let pieces = |angle: f64, step: f64| ((angle / step).ceil() as usize).clamp(1, 64);
    let counts = match shape.layout {
        Layout::Cube => [1, 1],
        Layout::LatLong => [pieces(TAU / shape.width() as f64, 0.004), pieces(PI / shape.height() as f64, 0.5)],
        // Rows next to the poles are high.
        Layout::SineLatLong => [pieces(TAU / shape.width() as f64, 0.004), pieces(8.0 / shape.height() as f64, 0.5)],
        Layout::Fisheye { field } => [pieces(field.to_radians() / shape.width() as f64, 0.01).clamp(4, 16); 2],
    };
    let mut sum = 0.0;
    for j in 0..counts[1] {
        for i in 0..counts[0] {
            let piece = texel.part([i, j], counts);
            if piece.is_drawn(shape) {
                sum += clipped(part, &piece.corners(shape));
            }
        }
    }
    sum
}

/// Solid angle of what lies inside of a quadrilateral of great circles.
fn clipped(part: &Part, corners: &[DVec3; 4]) -> f64 {
    let (mut n, mut at) = (4, [DVec3::ZERO; 12]);
    at[..4].copy_from_slice(corners);
    for normal in part.normals.iter().filter(|n| **n != DVec3::ZERO) {
        let (mut m, mut kept) = (0, [DVec3::ZERO; 12]);
        for i in 0..n {
            let (p, q) = (at[i], at[(i + 1) % n]);
            let (hp, hq) = (normal.dot(p), normal.dot(q));
            if hp >= 0.0 {
                kept[m] = p;
                m += 1;
            }
            if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                kept[m] = p.lerp(q, hp / (hp - hq)).normalize_or(p);
                m += 1;
            }
        }
        (n, at) = (m, kept);
        if n < 3 {
            return 0.0;
        }
    }
    (2..n).map(|i| triangle([at[0], at[i - 1], at[i]])).sum::<f64>().abs()
}
