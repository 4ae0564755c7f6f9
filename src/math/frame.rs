//! Orthonormal frames on a surface.

use super::DVec3;

/// A right-handed orthonormal frame: `x` and `y` span the surface, `z` is its normal.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// First tangent.
    pub x: DVec3,
    /// Second tangent.
    pub y: DVec3,
    /// Normal.
    pub z: DVec3,
}

impl Frame {
    /// The frame whose normal is `z` and whose x axis lies along `along`, made perpendicular to `z`.
    /// `along` must not be parallel to `z`.
    pub fn with_x_axis(z: DVec3, along: DVec3) -> Self {
        let x = (along - z * along.dot(z)).normalize();
        Self { x, y: z.cross(x), z }
    }

    /// Turned about its normal by `angle` radians, counter-clockwise seen from the front.
    pub fn turned(self, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let x = self.x * c + self.y * s;
        Self { x, y: self.z.cross(x), z: self.z }
    }

    /// World direction of a local one.
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        self.x * local.x + self.y * local.y + self.z * local.z
    }

    /// Local coordinates of a world direction.
    pub fn to_local(&self, world: DVec3) -> DVec3 {
        DVec3::new(world.dot(self.x), world.dot(self.y), world.dot(self.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_again() {
        let f = Frame::with_x_axis(DVec3::new(1.0, 2.0, 3.0).normalize(), DVec3::X).turned(0.7);
        let v = DVec3::new(0.3, -0.2, 0.9);
        assert!((f.to_world(f.to_local(v)) - v).length() < 1e-15);
        assert!((f.x.cross(f.y) - f.z).length() < 1e-15);
    }
}
