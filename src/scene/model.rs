//! The scene as written: every object, every state.

use super::{PointLight, Receiver};
use crate::math::DVec3;
use crate::view::{Camera, Photometry};
use serde::{Deserialize, Serialize};

/// Object of what only blocks (View3D's `O`): form factors by surface leave it out.
pub const OBSTRUCTIONS: &str = "obstructions";

/// A scene file, read and validated.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Name given in the file.
    pub name: String,
    /// Bands and their luminance weights.
    pub photometry: Photometry,
    /// What the author says; `None` leaves it to the geometry.
    pub enclosure: Option<bool>,
    /// Materials by number.
    pub materials: Vec<Material>,
    /// Surfaces in file order; those that edits bring in (`replace` by another mesh) come last.
    pub surfaces: Vec<Surface>,
    /// Objects that are not there before the first edit.
    pub absent: Vec<String>,
    /// Changes in order; state k is the scene after the first k.
    pub edits: Vec<Edit>,
    /// Cameras in file order.
    pub cameras: Vec<Camera>,
    /// Point lights in file order; edits do not touch them.
    pub lights: Vec<PointLight>,
    /// Receivers in file order.
    pub receivers: Vec<Receiver>,
    /// What was mended or guessed while reading (a split quadrilateral, a default taken), for the user.
    pub notices: Vec<String>,
}

/// Diffuse reflection and self-emission, per band.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name given in the file.
    pub name: String,
    /// Reflectance rho, in [0, 1), per band.
    pub reflectance: Vec<f64>,
    /// Self-emitted radiosity E in W/m^2, per band.
    pub emission: Vec<f64>,
}

/// One `[[surface]]`: a polygon or the faces of a mesh.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Name given in the file.
    pub name: String,
    /// Object it belongs to.
    pub object: String,
    /// One face for a polygon; all faces of a mesh in file order.
    pub faces: Vec<Face>,
    /// Names of the mesh's groups, in order of their first face; patches of a group belong to `name/group`.
    pub groups: Vec<String>,
    /// True for meshes: overlaps are findings there, refusals in polygons.
    pub from_mesh: bool,
}

/// A planar convex polygon with its division.
#[derive(Debug, Clone)]
pub struct Face {
    /// Corners in metres, counter-clockwise seen from the radiating side.
    pub vertices: Vec<DVec3>,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// Division into patches.
    pub patches: Grid,
    /// Division of each patch into elements.
    pub elements: Grid,
    /// Radiates from both sides.
    pub two_sided: bool,
    /// Index into [`Surface::groups`]; `None` for polygons and for mesh faces outside of all groups.
    pub group: Option<u32>,
}

/// How a polygon is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grid {
    /// A quadrilateral, `na` along v0->v1 by `nb` along v0->v3; cell number `a + b * na`.
    Quad {
        /// Cells along v0->v1.
        na: u32,
        /// Cells along v0->v3.
        nb: u32,
    },
    /// A triangle, n rows; cell k of row b has number `b (2n - b) + k`.
    Triangle {
        /// Rows.
        n: u32,
    },
    /// One piece.
    Whole,
}

impl Grid {
    /// Number of cells.
    pub fn count(self) -> usize {
        match self {
            Grid::Quad { na, nb } => na as usize * nb as usize,
            Grid::Triangle { n } => n as usize * n as usize,
            Grid::Whole => 1,
        }
    }

    /// (a, b) of a cell: column and row; for triangles (k, row).
    pub fn place(self, number: usize) -> (u32, u32) {
        match self {
            Grid::Quad { na, .. } => ((number % na as usize) as u32, (number / na as usize) as u32),
            Grid::Triangle { n } => {
                // Row b starts at b (2n - b); n is small enough for a scan.
                let mut b = 0;
                while b + 1 < n && (b + 1) as usize * (2 * n - b - 1) as usize <= number {
                    b += 1;
                }
                ((number - b as usize * (2 * n - b) as usize) as u32, b)
            }
            Grid::Whole => (0, 0),
        }
    }
}

/// One change of a dynamic scene.
#[derive(Debug, Clone)]
pub enum Edit {
    /// The object appears.
    Add {
        /// Object name.
        object: String,
    },
    /// The object goes.
    Remove {
        /// Object name.
        object: String,
    },
    /// The object moves rigidly; patches keep their numbers.
    Move {
        /// Object name.
        object: String,
        /// Rotated first, then translated.
        transform: Transform,
    },
    /// The object is scaled about a point; patches keep their numbers.
    Reshape {
        /// Object name.
        object: String,
        /// Factors along x, y, z.
        scale: DVec3,
        /// Fixed point.
        about: DVec3,
    },
    /// The object's faces give way to those of surface `by` (last in [`Scene::surfaces`]), number for number
    /// where `same_numbers`, else under numbers of their own.
    Replace {
        /// Object name.
        object: String,
        /// Index of the surface that takes its place.
        by: usize,
        /// True if the new faces take over the patch numbers of the old.
        same_numbers: bool,
    },
    /// A material changes.
    Material {
        /// Index into [`Scene::materials`].
        material: u32,
        /// New reflectance, if it changes.
        reflectance: Option<Vec<f64>>,
        /// New emission, if it changes.
        emission: Option<Vec<f64>>,
    },
}

/// A rigid motion: rotation about an axis through a point, then a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Unit axis of rotation.
    pub axis: DVec3,
    /// Angle, radians, right-handed.
    pub angle: f64,
    /// A point on the axis.
    pub about: DVec3,
    /// Translation, metres.
    pub translate: DVec3,
}

impl Transform {
    /// Where a point goes.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        let r = glam::DQuat::from_axis_angle(self.axis, self.angle);
        self.about + r * (p - self.about) + self.translate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangle_numbers_follow_the_contract() {
        let g = Grid::Triangle { n: 4 };
        let mut number = 0;
        for b in 0..4 {
            for k in 0..2 * (4 - b) - 1 {
                assert_eq!(number, b * (8 - b) + k);
                assert_eq!(g.place(number), (k as u32, b as u32));
                number += 1;
            }
        }
        assert_eq!(number, g.count());
    }
}
