//! Small scenes for the doctor's tests.

use crate::math::DVec3;
use crate::scene::Stage;

/// Six faces of a cube seen from inside: floor, ceiling, then the walls y = 0, x = 1, y = 1, x = 0.
pub(super) fn cube(corner: DVec3, edge: f64) -> Vec<Vec<DVec3>> {
    let faces = [
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]],
        [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]],
        [[1, 0, 0], [1, 0, 1], [1, 1, 1], [1, 1, 0]],
        [[1, 1, 0], [1, 1, 1], [0, 1, 1], [0, 1, 0]],
        [[0, 1, 0], [0, 1, 1], [0, 0, 1], [0, 0, 0]],
    ];
    let at = |p: [i32; 3]| corner + DVec3::from_array(p.map(f64::from)) * edge;
    faces.map(|f| f.map(at).to_vec()).to_vec()
}

pub(super) fn stage(faces: &[Vec<DVec3>]) -> Stage {
    Stage::from_polygons(faces)
}
