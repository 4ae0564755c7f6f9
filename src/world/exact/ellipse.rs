//! Gaussian weights of texels under an elliptical cone.

use super::super::cone::{Cone, Ellipse, Part, SHARPNESS, triangle};
use super::super::layout::Shape;
use super::{Block, Cell};
use crate::math::DVec3;
use std::f64::consts::TAU;

/// Inside, parts of texels are no wider than this share of the radius, and hold four points.
const INSIDE: f64 = 0.25;

/// At the rim, no wider than this.
const RIM: f64 = 1.0 / 40.0;

/// Parts of texels are not halved more often than this: narrower cones are taken where they are.
const DEEPEST: u32 = 48;

/// Rings of the points that stand for a cone in a fish-eye, and how many there are on each.
const RINGS: [usize; 2] = [96, 192];

/// An elliptical cone, for asking.
pub struct Seen {
    ellipse: Ellipse,
    /// s = (s . d) / (axis . d), and t likewise.
    s: DVec3,
    t: DVec3,
    /// Half-spaces about it.
    pub around: Part,
}

impl Seen {
    /// `None` where it has no width.
    pub fn new(cone: &Cone) -> Option<Self> {
        let mut ellipse = cone.ellipse()?;
        let long = ellipse.a.length();
        // Perpendicular to both, where the ellipse has no width of its own.
        let across = ellipse.axis.cross(ellipse.a).normalize_or_zero();
        if long < 1e-12 || across == DVec3::ZERO {
            return None;
        }
        let wide = ellipse.b.length().max(long / 64.0);
        ellipse.b = across * wide;
        let (s, t) = (ellipse.a / (long * long), ellipse.b / (wide * wide));
        let sides = [ellipse.axis - s, ellipse.axis + s, ellipse.axis - t, ellipse.axis + t];
        Some(Self { ellipse, s, t, around: Part { normals: sides.map(DVec3::normalize_or_zero) } })
    }

    /// Weights of the texels of a block.
    pub fn walk(&self, shape: Shape, block: Block, each: &mut dyn FnMut(usize, f64)) {
        let (middle, reach) = block.cell().middle(shape);
        if self.around.normals.iter().any(|n| n.dot(middle) < -reach) {
            return;
        }
        if let Some((x, y)) = block.texel() {
            let weight = self.weight(shape, block.cell(), DEEPEST);
            if weight > 0.0 {
                each(shape.index(block.panel, x, y), weight);
            }
        } else {
            block.halves().iter().for_each(|half| self.walk(shape, *half, each));
        }
    }

    /// The same of a fish-eye, by points evenly over the ellipse: about its back a narrow cone is drawn as a ring all
    /// round, and texels across its circle are cut.
    pub fn points(&self, shape: Shape, each: &mut dyn FnMut(usize, f64)) {
        let Ellipse { axis, a, b } = self.ellipse;
        let [rings, around] = RINGS;
        for k in 0..rings * around {
            let r = ((k / around) as f64 + 0.5) / rings as f64;
            let (sine, cosine) = (TAU * ((k % around) as f64 + 0.5) / around as f64).sin_cos();
            let d = axis + a * (r * cosine) + b * (r * sine);
            let area = a.length() * b.length() * TAU * r / (rings * around) as f64;
            let Some(spot) = shape.place(d) else { continue };
            let last = |v: f64| (v as usize).min(shape.width() - 1);
            let weight = (-SHARPNESS * r * r).exp() * area * d.length().powi(-3);
            each(shape.index(0, last(spot.x), last(spot.y)), weight);
        }
    }

    /// Where a direction goes through the ellipse's plane: (s, t); `None` behind or nearly so.
    fn at(&self, d: DVec3) -> Option<(f64, f64)> {
        let along = self.ellipse.axis.dot(d);
        (along > 1e-3).then(|| (self.s.dot(d) / along, self.t.dot(d) / along))
    }

    /// Weight of a part of a texel, sr.
    fn weight(&self, shape: Shape, cell: Cell, depth: u32) -> f64 {
        let (middle, reach) = cell.middle(shape);
        if self.around.normals.iter().any(|n| n.dot(middle) < -reach) {
            return 0.0;
        }
        let halved = || -> f64 {
            if depth == 0 {
                // One point for all.
                let inside = self.at(middle).filter(|p| p.0.hypot(p.1) < 1.0);
                let (x, y) = (cell.x + 0.5 * cell.w, cell.y + 0.5 * cell.h);
                return inside.map_or(0.0, |(s, t)| {
                    (-SHARPNESS * (s * s + t * t)).exp() * shape.density(x, y) * cell.w * cell.h
                });
            }
            // Only across the longer side where one is much longer: at the poles cells are needles.
            let [a, b, c, d] = cell.corners(shape);
            let (across, down) = (a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c)));
            let counts = [1 + usize::from(across > 0.5 * down), 1 + usize::from(down > 0.5 * across)];
            let counts = if across.max(down) > 0.0 { counts } else { [2, 2] };
            let part = |k: usize| self.weight(shape, cell.part([k % counts[0], k / counts[0]], counts), depth - 1);
            (0..counts[0] * counts[1]).map(part).sum()
        };
        let corners = cell.corners(shape).map(|d| self.at(d));
        let ([Some(a), Some(b), Some(c), Some(d)], Some(m)) = (corners, self.at(middle)) else { return halved() };
        let corners = [a, b, c, d];
        // Drawn skewed or bent, it is the corner farthest from the middle that counts.
        let extent =
            corners.iter().map(|p| (p.0 - m.0).hypot(p.1 - m.1)).fold(0.0, f64::max) * std::f64::consts::SQRT_2;
        let radius = |p: (f64, f64)| p.0.hypot(p.1);
        if radius(m) > 1.0 + extent {
            return 0.0;
        }
        if extent > INSIDE || reach > 0.2 {
            return halved();
        }
        if radius(m) + extent < 1.0 {
            let near = 0.5 - 0.5 / 3f64.sqrt();
            let point = |k: usize| {
                let at = |bit: usize| if bit == 0 { near } else { 1.0 - near };
                let (s, t) = (at(k % 2), at(k / 2));
                let Some((p, q)) = self.at(cell.direction(shape, s, t)) else { return 0.0 };
                (-SHARPNESS * (p * p + q * q)).exp() * shape.density(cell.x + s * cell.w, cell.y + t * cell.h)
            };
            return 0.25 * cell.w * cell.h * (0..4).map(point).sum::<f64>();
        }
        if extent > RIM { halved() } else { self.at_rim(corners) }
    }

    /// Weight of a small part at the rim, which is straight there.
    fn at_rim(&self, corners: [(f64, f64); 4]) -> f64 {
        let mut inside = Vec::with_capacity(6);
        for i in 0..4 {
            let (p, q) = (corners[i], corners[(i + 1) % 4]);
            let (hp, hq) = (1.0 - p.0.hypot(p.1), 1.0 - q.0.hypot(q.1));
            if hp >= 0.0 {
                inside.push(p);
            }
            if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                let t = hp / (hp - hq);
                inside.push((p.0 + (q.0 - p.0) * t, p.1 + (q.1 - p.1) * t));
            }
        }
        if inside.len() < 3 {
            return 0.0;
        }
        let n = inside.len() as f64;
        let (s, t) = inside.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
        let e = &self.ellipse;
        let unit = |p: (f64, f64)| (e.axis + e.a * p.0 + e.b * p.1).normalize();
        let solid: f64 = (2..inside.len()).map(|i| triangle([inside[0], inside[i - 1], inside[i]].map(unit))).sum();
        solid.abs() * (-SHARPNESS * (s * s + t * t)).exp()
    }
}
