//! Error against the size of the mesh: the same scene, its grids finer by whole factors.

use crate::metrics::{Point, Rate, fit_rate};
use crate::scene::{Face, Grid, Scene, Stage};
use crate::stats::Estimate;

/// Why a mesh cannot be made finer.
#[derive(Debug, thiserror::Error)]
pub enum RefineError {
    /// No factor.
    #[error("--refine {factor} divides nothing: give factors of 1 or more, as 1,2,4,8")]
    Factor {
        /// As given.
        factor: u32,
    },
    /// A face that grids do not divide.
    #[error(
        "surface \"{surface}\": a face of {corners} corners cannot be divided, so the mesh has no finer version; \
         split it into quadrilaterals and triangles"
    )]
    Whole {
        /// Name of the surface.
        surface: String,
        /// Corners of the face.
        corners: usize,
    },
    /// More rows than can be counted.
    #[error(
        "--refine {factor}: surface \"{surface}\" would have more patches than fit into memory; use a smaller factor"
    )]
    TooMany {
        /// As given.
        factor: u32,
        /// Name of the surface.
        surface: String,
    },
}

/// The scene with `factor` times as many patches along each edge; the division of patches into elements stays.
///
/// # Errors
/// [`RefineError`]; the total number of patches is checked where the scene is laid out.
pub fn refined(scene: &Scene, factor: u32) -> Result<Scene, RefineError> {
    if factor == 0 {
        return Err(RefineError::Factor { factor });
    }
    let mut scene = scene.clone();
    for surface in &mut scene.surfaces {
        for face in &mut surface.faces {
            let too_many = || RefineError::TooMany { factor, surface: surface.name.clone() };
            let whole = |f: &Face| RefineError::Whole { surface: surface.name.clone(), corners: f.vertices.len() };
            // Counts stay far from where their product leaves 64 bits.
            let times = |n: u32| n.checked_mul(factor).filter(|n| *n <= 1 << 20).ok_or_else(too_many);
            face.patches = match face.patches {
                Grid::Quad { na, nb } => Grid::Quad { na: times(na)?, nb: times(nb)? },
                Grid::Triangle { n } => Grid::Triangle { n: times(n)? },
                Grid::Whole if factor == 1 => Grid::Whole,
                Grid::Whole => return Err(whole(face)),
            };
        }
    }
    Ok(scene)
}

/// How fine a mesh is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshSize {
    /// Times the patches along each edge.
    pub factor: u32,
    /// Patches present.
    pub patches: usize,
    /// Longest edge of a patch, m.
    pub longest_edge: f64,
    /// Mean square root of a patch's area, m: what the order is fitted against.
    pub mean_size: f64,
}

impl MeshSize {
    /// Of a stage.
    pub fn of(stage: &Stage, factor: u32) -> Self {
        let present: Vec<_> = stage.patches.iter().filter(|p| p.is_present()).collect();
        let edges = present.iter().flat_map(|p| {
            let k = p.corners.len();
            (0..k).map(move |i| p.corners[i].distance(p.corners[(i + 1) % k]))
        });
        let mean_size = present.iter().map(|p| p.area.sqrt()).sum::<f64>() / present.len().max(1) as f64;
        Self { factor, patches: present.len(), longest_edge: edges.fold(0.0, f64::max), mean_size }
    }
}

/// One mesh, judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshPoint {
    /// How fine.
    pub size: MeshSize,
    /// Eq. 7 against the true mean radiosities of the patches; `None` where these are dark.
    pub rms: Option<Estimate>,
    /// What a perfect solution would read.
    pub noise_floor: Option<f64>,
}

/// One method over all meshes.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshCurve {
    /// What the method is called.
    pub method: String,
    /// In the order of the factors.
    pub points: Vec<MeshPoint>,
}

impl MeshCurve {
    /// Error against mean size.
    pub fn against_size(&self) -> Vec<Point> {
        let point = |p: &MeshPoint| p.rms.map(|error| Point { x: p.size.mean_size, error, floor: p.noise_floor });
        self.points.iter().filter_map(point).collect()
    }
}

/// The order: the power of the mesh size that the error follows. `None` with fewer than three meshes clear of the
/// noise.
pub fn mesh_rate(curve: &MeshCurve, confidence: f64) -> Option<Rate> {
    fit_rate(&curve.against_size(), confidence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::scene::{SceneOptions, open_scene};

    #[test]
    fn sizes_shrink_as_the_factor_says() {
        let scene = open_scene("builtin:dynamic-cube", &SceneOptions::default()).expect("a scene");
        let size = |k: u32| MeshSize::of(&refined(&scene, k).expect("finer").at(0).expect("a state"), k);
        let (one, three) = (size(1), size(3));
        assert_eq!(three.patches, 9 * one.patches);
        assert!((one.longest_edge / three.longest_edge - 3.0).abs() < 1e-9);
        assert!((one.mean_size / three.mean_size - 3.0).abs() < 1e-9);
        assert_eq!(size(1), MeshSize::of(&scene.at(0).expect("a state"), 1));
    }

    #[test]
    fn what_has_no_finer_version_is_refused() {
        let mut scene = open_scene("builtin:dynamic-cube", &SceneOptions::default()).expect("a scene");
        assert!(refined(&scene, 0).is_err() && refined(&scene, u32::MAX).is_err());
        assert!(refined(&scene, 2000).expect("a scene").at(0).is_err(), "more patches than fit");
        scene.surfaces[0].faces[0].patches = Grid::Whole;
        assert!(refined(&scene, 1).is_ok());
        let said = refined(&scene, 2).expect_err("a whole face").to_string();
        assert!(said.contains(&scene.surfaces[0].name), "{said}");
    }
}
