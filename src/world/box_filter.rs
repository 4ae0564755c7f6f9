//! Reflection cones filtered by squares from a pyramid of images: the fast way, and a rough one Greene (1986).

use super::cone::{Cone, Part, triangle};
use super::layout::{Face, Layout, Shape, Spot};
use super::pyramid::Pyramid;
use crate::math::DVec3;

impl Pyramid {
    /// Mean over a cone, one value a band: the polygon that its quadrilateral cuts out of each face [G86 fig. 4] is taken
    /// for a square of the same area about the same middle, and polygons weigh as their solid angles. In
    /// latitude-longitude maps one square stands for the whole region as drawn there; where a pole lies in the cone, the
    /// region goes all round. In a fish-eye too; a cone about a direction beyond its field is 0.
    pub fn box_filter(&self, cone: &Cone) -> Vec<f64> {
        let mut mean = vec![0.0; self.bands()];
        self.box_filter_into(cone, &mut mean);
        mean
    }

    /// [`Pyramid::box_filter`] into `mean`, one place a band.
    pub fn box_filter_into(&self, cone: &Cone, mean: &mut [f64]) {
        mean.fill(0.0);
        let shape = self.base().shape();
        let Some(axis) = cone.axis() else { return };
        if shape.layout != Layout::Cube {
            if let Some((spot, edge)) = square(shape, axis, &cone.quad()) {
                self.add_square(spot, edge, 1.0, mean);
            }
            return;
        }
        let mut total = 0.0;
        let half = 0.5 * shape.width() as f64;
        let mut add = |face: Face, polygon: &Polygon| {
            let (area, (u, v)) = polygon.area_and_middle();
            let weight = polygon.solid_angle(face);
            if weight > 0.0 {
                let spot = Spot { panel: face as usize, x: (u + 1.0) * half, y: (v + 1.0) * half };
                self.add_square(spot, area.sqrt() * half, weight, mean);
                total += weight;
            }
        };
        for part in cone.parts() {
            match on_one_face(&cone.quad(), &part) {
                Some((face, polygon)) => add(face, &polygon),
                None => Face::ALL.iter().for_each(|face| add(*face, &Polygon::cut_out(*face, &part))),
            }
        }
        if total > 0.0 {
            mean.iter_mut().for_each(|m| *m /= total);
        } else if let Some(spot) = shape.place(axis) {
            self.add_square(spot, 0.0, 1.0, mean);
        }
    }
}

/// The polygon of a convex quadrilateral that lies in one face with all corners: no clipping then.
fn on_one_face(corners: &[DVec3; 4], part: &Part) -> Option<(Face, Polygon)> {
    let face = Face::through(corners[0]);
    let whole = part.normals.iter().all(|n| corners.iter().all(|c| n.dot(*c) > -1e-15));
    if !whole || corners.iter().any(|c| Face::through(*c) != face) {
        return None;
    }
    let mut polygon = Polygon { n: 4, at: [(0.0, 0.0); 12] };
    for (at, c) in polygon.at.iter_mut().zip(corners) {
        *at = face.on_plane(*c)?;
    }
    Some((face, polygon))
}

/// A convex polygon in the plane of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    n: usize,
    at: [(f64, f64); 12],
}

impl Polygon {
    /// What a convex cone cuts out of a face.
    pub fn cut_out(face: Face, part: &Part) -> Self {
        let [forward, right, down] = face.axes();
        let mut polygon = Self { n: 4, at: [(0.0, 0.0); 12] };
        polygon.at[..4].copy_from_slice(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]);
        for n in part.normals {
            polygon = polygon.clipped([n.dot(forward), n.dot(right), n.dot(down)]);
        }
        polygon
    }

    /// The part with c + a u + b v >= 0.
    fn clipped(&self, [c, a, b]: [f64; 3]) -> Self {
        let mut out = Self { n: 0, at: [(0.0, 0.0); 12] };
        let height = |(u, v): (f64, f64)| c + a * u + b * v;
        let mut push = |p| {
            out.at[out.n] = p;
            out.n += 1;
        };
        for i in 0..self.n {
            let (p, q) = (self.at[i], self.at[(i + 1) % self.n]);
            let (hp, hq) = (height(p), height(q));
            if hp >= 0.0 {
                push(p);
            }
            if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                let t = hp / (hp - hq);
                push((p.0 + (q.0 - p.0) * t, p.1 + (q.1 - p.1) * t));
            }
        }
        out
    }

    /// Its corners.
    pub fn corners(&self) -> &[(f64, f64)] {
        &self.at[..self.n]
    }

    /// Area, (u, v) squared, and centre of area.
    fn area_and_middle(&self) -> (f64, (f64, f64)) {
        let (mut twice, mut x, mut y) = (0.0, 0.0, 0.0);
        let Some(&o) = self.corners().first() else { return (0.0, (0.0, 0.0)) };
        for w in self.corners()[1..].windows(2) {
            let (p, q) = ((w[0].0 - o.0, w[0].1 - o.1), (w[1].0 - o.0, w[1].1 - o.1));
            let cross = p.0 * q.1 - p.1 * q.0;
            twice += cross;
            x += cross * (p.0 + q.0) / 3.0;
            y += cross * (p.1 + q.1) / 3.0;
        }
        if twice == 0.0 { (0.0, o) } else { (0.5 * twice.abs(), (o.0 + x / twice, o.1 + y / twice)) }
    }

    /// Solid angle, sr.
    fn solid_angle(&self, face: Face) -> f64 {
        if self.n < 3 {
            return 0.0;
        }
        let at = |i: usize| face.towards(self.at[i].0, self.at[i].1).normalize();
        let first = at(0);
        (2..self.n).map(|i| triangle([first, at(i - 1), at(i)])).sum::<f64>().abs()
    }
}

/// The square for a cone on a map of one panel: its middle, and its edge in texels; `None` beyond a fish-eye's field.
fn square(shape: Shape, axis: DVec3, corners: &[DVec3; 4]) -> Option<(Spot, f64)> {
    let (w, h) = (shape.width() as f64, shape.height() as f64);
    let spot = shape.place(axis)?;
    let mut at = Vec::with_capacity(4);
    at.extend(corners.iter().filter_map(|c| shape.place(*c)).map(|s| (s.x, s.y)));
    if let Layout::Fisheye { field } = shape.layout {
        if at.len() < 4 {
            // Partly beyond the field: from the solid angle, as in the middle of the circle.
            let texel = field.to_radians() / w;
            return Some((spot, Cone::Quad(*corners).solid_angle().sqrt() / texel));
        }
        return Some((middle_of(&at, spot), shoelace(&at).abs().sqrt()));
    }
    // Around the loop, each step the shorter way round: what is left over says whether a pole is inside.
    let mut turned = 0.0;
    for i in 0..at.len() {
        let (here, next) = (at[i].0, if i + 1 < at.len() { at[i + 1].0 } else { at[0].0 });
        let step = (next - here + 0.5 * w).rem_euclid(w) - 0.5 * w;
        if i + 1 < at.len() {
            at[i + 1].0 = here + step;
        } else {
            turned = here + step - at[0].0;
        }
    }
    if turned.abs() > 0.5 * w {
        let down = at.iter().map(|p| p.1).sum::<f64>() / at.len() as f64;
        let depth = if spot.y < 0.5 * h { down } else { h - down };
        return Some((spot, (w * depth).sqrt()));
    }
    Some((middle_of(&at, spot), shoelace(&at).abs().sqrt()))
}

/// Mean of the corners as drawn.
fn middle_of(at: &[(f64, f64)], spot: Spot) -> Spot {
    let n = at.len() as f64;
    Spot { panel: spot.panel, x: at.iter().map(|p| p.0).sum::<f64>() / n, y: at.iter().map(|p| p.1).sum::<f64>() / n }
}

/// Area of a loop, signed.
fn shoelace(at: &[(f64, f64)]) -> f64 {
    let n = at.len();
    (0..n).map(|i| 0.5 * (at[i].0 * at[(i + 1) % n].1 - at[(i + 1) % n].0 * at[i].1)).sum()
}
