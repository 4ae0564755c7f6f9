//! Vectors, planes and convex polygons in three dimensions.

/// A point or a direction, metres.
pub type Vector = [f64; 3];

/// Points closer than this to a plane lie on it, metres.
pub const ON_PLANE: f64 = 1e-12;

pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a + t b
pub fn along(a: Vector, t: f64, b: Vector) -> Vector {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: Vector) -> Vector {
    let l = length(a);
    [a[0] / l, a[1] / l, a[2] / l]
}

/// An oriented plane; heights are positive on the side of its normal.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub normal: Vector,
    pub offset: f64,
}

impl Plane {
    pub fn height(&self, x: Vector) -> f64 {
        dot(self.normal, x) - self.offset
    }

    pub fn turned(&self) -> Self {
        let n = self.normal;
        Self { normal: [-n[0], -n[1], -n[2]], offset: -self.offset }
    }
}

/// The plane of a convex polygon, normal on the side from which it runs counter-clockwise.
pub fn plane_of(corners: &[Vector]) -> Plane {
    let normal = unit(twice_area_vector(corners));
    let mean = corners.iter().map(|&c| dot(normal, c)).sum::<f64>() / corners.len() as f64;
    Plane { normal, offset: mean }
}

pub fn area(corners: &[Vector]) -> f64 {
    0.5 * length(twice_area_vector(corners))
}

fn twice_area_vector(corners: &[Vector]) -> Vector {
    let mut sum = [0.0; 3];
    for k in 1..corners.len() - 1 {
        sum = along(sum, 1.0, cross(sub(corners[k], corners[0]), sub(corners[k + 1], corners[0])));
    }
    sum
}

/// The part of a convex polygon on the front side of a plane; empty if less than three corners are left.
pub fn in_front(corners: &[Vector], plane: &Plane) -> Vec<Vector> {
    let heights: Vec<f64> = corners.iter().map(|&c| plane.height(c)).collect();
    if heights.iter().all(|&h| h <= ON_PLANE) {
        return Vec::new();
    }
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for k in 0..corners.len() {
        let next = (k + 1) % corners.len();
        if heights[k] >= -ON_PLANE {
            kept.push(corners[k]);
        }
        let crosses = heights[k].min(heights[next]) < -ON_PLANE && heights[k].max(heights[next]) > ON_PLANE;
        if crosses {
            let t = heights[k] / (heights[k] - heights[next]);
            kept.push(along(corners[k], t, sub(corners[next], corners[k])));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_cut_through_its_middle_leaves_half() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let half = in_front(&square, &Plane { normal: [1.0, 0.0, 0.0], offset: 0.5 });
        assert!((area(&half) - 0.5).abs() < 1e-15);
        assert!((plane_of(&half).normal[2] - 1.0).abs() < 1e-15);
    }
}
