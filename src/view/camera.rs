//! Pin-hole cameras.

use crate::math::DVec3;
use serde::{Deserialize, Serialize};

/// A pin-hole camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Name given in the file.
    pub name: String,
    /// Eye point, metres.
    pub eye: DVec3,
    /// Point in the middle of the picture.
    pub target: DVec3,
    /// Direction that is up in the picture.
    pub up: DVec3,
    /// Vertical field of view, degrees.
    pub fov: f64,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

impl Camera {
    /// Direction (unit) through the picture point (x, y), in pixels from the upper left corner.
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.ray(x, y).normalize()
    }

    /// The same with length 1 along the viewing direction: depth times this leads from the eye to the point.
    pub fn ray(&self, x: f64, y: f64) -> DVec3 {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        let down = forward.cross(right);
        let half = (0.5 * self.fov.to_radians()).tan();
        let [w, h] = self.size.map(f64::from);
        let (sx, sy) = ((2.0 * x - w) / h * half, (2.0 * y / h - 1.0) * half);
        forward + right * sx + down * sy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_looks_at_the_target_and_up_is_up() {
        let c = Camera {
            name: "c".into(),
            eye: DVec3::new(1.0, -3.0, 2.0),
            target: DVec3::new(1.0, 5.0, 2.0),
            up: DVec3::Z,
            fov: 60.0,
            size: [640, 480],
        };
        assert!((c.direction(320.0, 240.0) - DVec3::Y).length() < 1e-15);
        let top = c.direction(320.0, 0.0);
        assert!((top.z / top.y - 30f64.to_radians().tan()).abs() < 1e-12);
        assert!(c.direction(640.0, 240.0).x > 0.0);
    }
}
