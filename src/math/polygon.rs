//! Planar convex polygons in space: measures, clipping, intersection and difference.
//!
//! Polygons are vertex loops, counter-clockwise seen from the front; metres, square metres.

use super::DVec3;

/// Twice-halved Newell sum: direction = normal, length = area (exact for planar loops).
pub fn area_vector(polygon: &[DVec3]) -> DVec3 {
    let o = polygon[0];
    polygon[1..].windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum::<DVec3>() * 0.5
}

/// Area of a planar polygon.
pub fn area(polygon: &[DVec3]) -> f64 {
    area_vector(polygon).length()
}

/// Unit normal on the front side; zero vector for a degenerate polygon.
pub fn unit_normal(polygon: &[DVec3]) -> DVec3 {
    let total = area_vector(polygon);
    let length = total.length();
    // Divided, not multiplied by the reciprocal: normals along an axis come out exact.
    if length > 0.0 { total / length } else { DVec3::ZERO }
}

/// Centre of area. For a degenerate polygon, the mean of its vertices.
pub fn centroid(polygon: &[DVec3]) -> DVec3 {
    let o = polygon[0];
    let total = area_vector(polygon);
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for w in polygon[1..].windows(2) {
        let a = (w[0] - o).cross(w[1] - o).dot(total);
        sum += (w[0] + w[1] - o - o) / 3.0 * a;
        weight += a;
    }
    if weight == 0.0 { polygon.iter().sum::<DVec3>() / polygon.len() as f64 } else { o + sum / weight }
}

/// Largest distance between two vertices.
pub fn diameter(polygon: &[DVec3]) -> f64 {
    let pairs = polygon.iter().enumerate().flat_map(|(i, a)| polygon[i + 1..].iter().map(move |b| a.distance(*b)));
    pairs.fold(0.0, f64::max)
}

/// Largest distance of a vertex from the mean plane, as a fraction of the diameter.
pub fn plane_defect(polygon: &[DVec3]) -> f64 {
    let n = unit_normal(polygon);
    let c = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    polygon.iter().map(|v| (*v - c).dot(n).abs()).fold(0.0, f64::max) / diameter(polygon)
}

/// How far a loop is from convex: the most negative turn at a vertex (sine of the angle), 0 if convex.
/// A loop that winds more than once around is reported as -1.
pub fn convex_defect(polygon: &[DVec3]) -> f64 {
    let n = unit_normal(polygon);
    let k = polygon.len();
    let (mut worst, mut turning): (f64, f64) = (0.0, 0.0);
    for i in 0..k {
        let e = (polygon[(i + 1) % k] - polygon[i]).normalize_or_zero();
        let f = (polygon[(i + 2) % k] - polygon[(i + 1) % k]).normalize_or_zero();
        let sine = e.cross(f).dot(n);
        worst = worst.min(sine);
        turning += sine.atan2(e.dot(f));
    }
    if turning > 3.0 * std::f64::consts::PI { -1.0 } else { worst }
}

/// The part of a convex polygon where `normal . p >= offset` (Sutherland-Hodgman, one plane).
/// Fewer than three vertices mean that nothing is left.
pub fn clip_to_half_space(polygon: &[DVec3], normal: DVec3, offset: f64) -> Vec<DVec3> {
    let side: Vec<f64> = polygon.iter().map(|p| normal.dot(*p) - offset).collect();
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if side[i] >= 0.0 {
            out.push(polygon[i]);
        }
        if (side[i] > 0.0 && side[j] < 0.0) || (side[i] < 0.0 && side[j] > 0.0) {
            out.push(polygon[i].lerp(polygon[j], side[i] / (side[i] - side[j])));
        }
    }
    out
}

/// Half-spaces (inward normal, offset) through the edges of a convex polygon, perpendicular to its plane.
fn edge_half_spaces(polygon: &[DVec3]) -> impl Iterator<Item = (DVec3, f64)> + '_ {
    let n = unit_normal(polygon);
    (0..polygon.len()).filter_map(move |i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let inward = n.cross(b - a).normalize_or_zero();
        (inward != DVec3::ZERO).then(|| (inward, inward.dot(a)))
    })
}

/// Common part of two coplanar convex polygons, wound like `subject`; empty if they do not overlap.
pub fn intersect_convex(subject: &[DVec3], other: &[DVec3]) -> Vec<DVec3> {
    let mut part = subject.to_vec();
    for (n, d) in edge_half_spaces(other) {
        part = clip_to_half_space(&part, n, d);
        if part.len() < 3 {
            return Vec::new();
        }
    }
    part
}

/// `subject` without `other` (coplanar, convex): disjoint convex pieces, wound like `subject`.
/// Pieces below `1e-12` of the subject's area are dropped as rounding dust.
pub fn subtract_convex(subject: &[DVec3], other: &[DVec3]) -> Vec<Vec<DVec3>> {
    let dust = 1e-12 * area(subject);
    if area_of(&intersect_convex(subject, other)) <= dust {
        return vec![subject.to_vec()];
    }
    let mut rest = subject.to_vec();
    let mut pieces = Vec::new();
    for (n, d) in edge_half_spaces(other) {
        let outside = clip_to_half_space(&rest, -n, -d);
        if area_of(&outside) > dust {
            pieces.push(outside);
        }
        rest = clip_to_half_space(&rest, n, d);
        if area_of(&rest) <= dust {
            break;
        }
    }
    pieces
}

fn area_of(polygon: &[DVec3]) -> f64 {
    if polygon.len() < 3 { 0.0 } else { area(polygon) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::compensated_sum;

    fn square(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<DVec3> {
        [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| DVec3::new(x, y, 0.5)).to_vec()
    }

    #[test]
    fn measures_of_a_rectangle() {
        let r = square(1.0, 1.0, 3.0, 2.0);
        assert_eq!(area(&r), 2.0);
        assert_eq!(unit_normal(&r), DVec3::Z);
        assert_eq!(centroid(&r), DVec3::new(2.0, 1.5, 0.5));
        assert_eq!(convex_defect(&r), 0.0);
        assert!((diameter(&r) - 5f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_hole_leaves_the_rest() {
        let pieces = subtract_convex(&square(0.0, 0.0, 3.0, 3.0), &square(1.0, 1.0, 2.0, 2.0));
        assert_eq!(pieces.len(), 4);
        assert!((compensated_sum(pieces.iter().map(|p| area(p))) - 8.0).abs() < 1e-14);
        assert!(pieces.iter().all(|p| unit_normal(p) == DVec3::Z));
    }

    #[test]
    fn what_only_touches_takes_nothing() {
        let pieces = subtract_convex(&square(0.0, 0.0, 1.0, 1.0), &square(1.0, 0.0, 2.0, 1.0));
        assert_eq!(pieces, vec![square(0.0, 0.0, 1.0, 1.0)]);
        let mut reversed = square(0.5, 0.5, 2.0, 2.0);
        reversed.reverse();
        let part = intersect_convex(&square(0.0, 0.0, 1.0, 1.0), &reversed);
        assert!((area(&part) - 0.25).abs() < 1e-15);
    }

    #[test]
    fn loops_that_are_not_convex_are_found() {
        let dart = [(0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert!(convex_defect(&dart) < -0.1);
        let star: Vec<DVec3> =
            (0..5).map(|k| DVec3::from_angle_on_plane(4.0 * std::f64::consts::PI * k as f64 / 5.0)).collect();
        assert_eq!(convex_defect(&star), -1.0);
    }

    trait OnPlane {
        fn from_angle_on_plane(a: f64) -> DVec3;
    }
    impl OnPlane for DVec3 {
        fn from_angle_on_plane(a: f64) -> DVec3 {
            DVec3::new(a.cos(), a.sin(), 0.0)
        }
    }
}
