//! Point lights.

use crate::math::DVec3;
use crate::scene::{Distribution, IntensityCurve};

/// A point light without its strength.
pub(super) struct Bulb {
    pub position: DVec3,
    pub distribution: Distribution,
    pub curve: Option<IntensityCurve>,
}

impl Bulb {
    /// Relative intensity towards the point, cosine, and distance squared.
    pub fn factor(&self, point: DVec3, normal: DVec3) -> f64 {
        let way = self.position - point;
        let square = way.length_squared();
        let cosine = way.dot(normal);
        if !(cosine > 0.0 && square > 0.0) {
            return 0.0;
        }
        let distance = square.sqrt();
        let leaving = -way / distance;
        let share = match self.distribution {
            Distribution::Isotropic => 1.0,
            Distribution::Lambert(axis) => leaving.dot(axis).max(0.0),
        };
        let curve = self.curve.as_ref().map_or(1.0, |c| relative(c, leaving));
        share * curve * cosine / (square * distance)
    }
}

/// The curve's value in a direction: linear between samples, as the first before them, nothing beyond the last.
fn relative(curve: &IntensityCurve, direction: DVec3) -> f64 {
    let angle = curve.axis.cross(direction).length().atan2(curve.axis.dot(direction)).to_degrees();
    let samples = &curve.samples;
    let next = samples.partition_point(|s| s.0 < angle);
    match (next.checked_sub(1).map(|k| samples[k]), samples.get(next)) {
        (Some((a, low)), Some((b, high))) => low + (high - low) * (angle - a) / (b - a),
        (None, Some((_, first))) => *first,
        // Straight back the angle may come out a rounding beyond 180 degrees.
        (Some((last, value)), None) if angle - last <= 1e-9 => value,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_linear_between_samples_and_nothing_beyond() {
        let curve = IntensityCurve { axis: DVec3::Z, samples: vec![(0.0, 1.0), (30.0, 0.5), (60.0, 0.1)] };
        let at =
            |degrees: f64| relative(&curve, DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()));
        for (angle, value) in [(0.0, 1.0), (15.0, 0.75), (30.0, 0.5), (45.0, 0.3), (59.999, 0.100_013_33), (61.0, 0.0)]
        {
            assert!((at(angle) - value).abs() < 1e-7, "{angle}: {}", at(angle));
        }
        let back = IntensityCurve { axis: DVec3::Z, samples: vec![(0.0, 0.0), (180.0, 2.0)] };
        assert!((relative(&back, -DVec3::Z) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_law_of_squares_and_of_the_cosine() {
        let bulb =
            Bulb { position: DVec3::new(0.0, 0.0, 2.0), distribution: Distribution::Lambert(-DVec3::Z), curve: None };
        // 2 m to the side: both cosines are 1/sqrt(2), the square of the distance 8.
        assert!((bulb.factor(DVec3::new(2.0, 0.0, 0.0), DVec3::Z) - 0.5 / 8.0).abs() < 1e-15);
        assert_eq!(bulb.factor(DVec3::new(2.0, 0.0, 0.0), -DVec3::Z), 0.0);
        assert_eq!(bulb.factor(bulb.position, DVec3::Z), 0.0);
    }
}
