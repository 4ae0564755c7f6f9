//! Where to look for the texels under a cone: blocks that hold them all.

use super::super::box_filter::Polygon;
use super::super::cone::{Cone, Part};
use super::super::layout::{Face, Layout, Shape};
use super::super::pyramid::spread;
use super::Block;
use crate::math::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Gives `each` blocks that hold all of a convex part of a cone.
pub fn blocks(shape: Shape, cone: &Cone, part: &Part, each: &mut impl FnMut(Block)) {
    let (w, h) = (shape.width(), shape.height());
    match shape.layout {
        Layout::Cube => {
            let corners = cone.quad();
            let only = Face::through(corners[0]);
            // Sides are straight on a face: what has all its corners there lies there.
            let within = matches!(cone, Cone::Quad(_)) && corners.iter().all(|c| Face::through(*c) == only);
            for face in Face::ALL.into_iter().filter(|f| !within || *f == only) {
                let polygon = Polygon::cut_out(face, part);
                if polygon.corners().len() < 3 {
                    continue;
                }
                let half = 0.5 * w as f64;
                let range = |pick: fn(&(f64, f64)) -> f64| {
                    let all = polygon.corners().iter().map(pick);
                    let (lo, hi) = all.fold((f64::MAX, f64::MIN), |(lo, hi), v| (lo.min(v), hi.max(v)));
                    texels((lo + 1.0) * half, (hi + 1.0) * half, w)
                };
                each(Block { panel: face as usize, x: range(|p| p.0), y: range(|p| p.1) });
            }
        }
        Layout::LatLong | Layout::SineLatLong => {
            let whole = Block { panel: 0, x: [0, w], y: [0, h] };
            let Some(cap) = Cap::of(cone) else { return each(whole) };
            let Some([west, east]) = cap.longitudes() else {
                return each(Block { y: cap.rows(shape), ..whole });
            };
            let y = cap.rows(shape);
            let column = |longitude: f64| (0.5 + longitude / TAU) * w as f64;
            let (lo, hi, round) = (column(west), column(east), w as f64);
            // Longitudes go round.
            if lo < 0.0 {
                each(Block { x: texels(lo + round, round, w), y, ..whole });
            }
            if hi > round {
                each(Block { x: texels(0.0, hi - round, w), y, ..whole });
            }
            each(Block { x: texels(lo.max(0.0), hi.min(round), w), y, ..whole });
        }
        Layout::Fisheye { .. } => each(Block { panel: 0, x: [0, w], y: [0, h] }),
    }
}

/// Texels that a stretch touches, one at least and a hair more for rounding.
fn texels(lo: f64, hi: f64, n: usize) -> [usize; 2] {
    let first = ((lo - 1e-9).max(0.0) as usize).min(n - 1);
    let end = ((hi + 1e-9).max(0.0) as usize + 1).clamp(first + 1, n);
    [first, end]
}

/// A round cap about a cone.
struct Cap {
    axis: DVec3,
    radius: f64,
}

impl Cap {
    /// `None` where it would be more than a hemisphere.
    fn of(cone: &Cone) -> Option<Self> {
        let (axis, radius) = match *cone {
            Cone::Quad(_) => {
                let axis = cone.axis()?;
                (axis, spread(axis, &cone.quad()))
            }
            Cone::Ellipse { .. } => {
                let e = cone.ellipse()?;
                (e.axis, e.a.length().atan())
            }
        };
        // Less than a hemisphere: then a great circle's arc between two points of it stays within.
        (radius < 0.49 * PI).then_some(Self { axis, radius: radius + 1e-9 })
    }

    /// Latitude of its middle.
    fn latitude(&self) -> f64 {
        self.axis.z.atan2(self.axis.x.hypot(self.axis.y))
    }

    /// Longitudes that it spans; `None` for all.
    fn longitudes(&self) -> Option<[f64; 2]> {
        let latitude = self.latitude();
        if latitude.abs() + self.radius > FRAC_PI_2 - 1e-6 {
            return None;
        }
        let half = (self.radius.sin() / latitude.cos()).min(1.0).asin();
        let middle = self.axis.x.atan2(self.axis.y);
        Some([middle - half, middle + half])
    }

    /// Rows that it spans.
    fn rows(&self, shape: Shape) -> [usize; 2] {
        let h = shape.height() as f64;
        let row = |latitude: f64| {
            let latitude = latitude.clamp(-FRAC_PI_2, FRAC_PI_2);
            if shape.layout == Layout::LatLong { (0.5 - latitude / PI) * h } else { (0.5 - 0.5 * latitude.sin()) * h }
        };
        texels(row(self.latitude() + self.radius), row(self.latitude() - self.radius), shape.height())
    }
}
