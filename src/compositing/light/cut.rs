//! Convex polygons in space cut by planes, and Lambert's formula for them. All are relative to the point that looks.

use crate::math::{DVec3, Plane};

/// Convex polygons one after the other.
#[derive(Default)]
pub(super) struct Loops {
    points: Vec<DVec3>,
    ends: Vec<usize>,
}

impl Loops {
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    pub fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    pub fn push(&mut self, polygon: &[DVec3]) {
        self.points.extend_from_slice(polygon);
        self.ends.push(self.points.len());
    }

    pub fn get(&self, k: usize) -> &[DVec3] {
        &self.points[if k == 0 { 0 } else { self.ends[k - 1] }..self.ends[k]]
    }
}

/// How a polygon lies to a half-space.
#[derive(PartialEq, Eq)]
pub(super) enum Lies {
    Outside,
    Across,
    Inside,
}

pub(super) fn lies(polygon: &[DVec3], side: &Plane) -> Lies {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in polygon {
        let h = side.height(*p);
        low = low.min(h);
        high = high.max(h);
    }
    if high <= 0.0 {
        Lies::Outside
    } else if low >= 0.0 {
        Lies::Inside
    } else {
        Lies::Across
    }
}

/// The part of a polygon where `sign * height >= 0`.
pub(super) fn cut(polygon: &[DVec3], side: &Plane, sign: f64, out: &mut Vec<DVec3>) {
    out.clear();
    let Some(mut a) = polygon.last().copied() else { return };
    let mut ha = sign * side.height(a);
    for b in polygon {
        let hb = sign * side.height(*b);
        if ha * hb < 0.0 {
            // From the inner end, so that both sides of a cut get the same point.
            let (inner, outer, hi, ho) = if ha > 0.0 { (a, *b, ha, hb) } else { (*b, a, hb, ha) };
            out.push(if sign > 0.0 { inner.lerp(outer, hi / (hi - ho)) } else { outer.lerp(inner, ho / (ho - hi)) });
        }
        if hb >= 0.0 {
            out.push(*b);
        }
        (a, ha) = (*b, hb);
    }
}

/// Lambert's sum, 2 pi times the form factor, of a polygon seen from its front, wholly above the horizon.
pub(super) fn lambert(polygon: &[DVec3], normal: DVec3) -> f64 {
    let mut sum = 0.0;
    let mut a = polygon[polygon.len() - 1];
    for b in polygon {
        let cross = a.cross(*b);
        let sine = cross.length();
        if sine > 0.0 {
            sum -= sine.atan2(a.dot(*b)) * cross.dot(normal) / sine;
        }
        a = *b;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_parts_of_a_cut_share_its_points_to_the_last_bit() {
        let polygon = [DVec3::new(0.1, 0.2, 3.0), DVec3::new(1.3, 0.1, 3.0), DVec3::new(0.9, 1.7, 3.0)];
        let side = Plane { normal: DVec3::new(0.37, -0.61, 0.1), offset: 0.2 };
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        cut(&polygon, &side, 1.0, &mut kept);
        cut(&polygon, &side, -1.0, &mut lost);
        assert_eq!(kept.iter().filter(|p| lost.contains(p)).count(), 2);
        let (whole, parts) = (lambert(&polygon, DVec3::Z), lambert(&kept, DVec3::Z) + lambert(&lost, DVec3::Z));
        assert!((whole - parts).abs() < 1e-15 && whole.abs() > 0.05, "{whole} {parts}");
    }
}
