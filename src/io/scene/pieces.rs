//! Polygons of foreign scenes made fit: planar convex ones stay whole, others fall into triangles.

use super::mesh::ears;
use super::polygon::{Flaw, MAX_CORNERS, flaw};
use crate::math::DVec3;

/// What becomes of a polygon.
pub(super) enum Cut {
    /// Planar and convex as it is.
    Whole(Vec<DVec3>),
    /// Bent or not convex: triangles.
    Split(Vec<Vec<DVec3>>),
    /// Nothing to see.
    NoArea,
    /// It crosses itself, or has more corners than can be looked at.
    Hopeless(&'static str),
}

/// Makes a polygon of finite corners fit for a scene.
pub(super) fn cut(corners: Vec<DVec3>) -> Cut {
    if corners.len() > MAX_CORNERS {
        return Cut::Hopeless("has too many corners");
    }
    match flaw(&corners) {
        None => Cut::Whole(corners),
        Some(Flaw::NoArea) => Cut::NoArea,
        Some(_) => match ears(&corners) {
            Some(triangles) => {
                let sound: Vec<Vec<DVec3>> =
                    triangles.into_iter().map(|t| t.to_vec()).filter(|t| flaw(t).is_none()).collect();
                if sound.is_empty() { Cut::NoArea } else { Cut::Split(sound) }
            }
            None => Cut::Hopeless("crosses itself"),
        },
    }
}

/// Names of surfaces, each one once.
#[derive(Default)]
pub(super) struct SurfaceNames {
    taken: std::collections::HashSet<String>,
    /// How many had to be changed.
    pub renamed: usize,
}

impl SurfaceNames {
    /// The wanted name, or with `#NUMBER` behind it where it is taken.
    pub(super) fn give(&mut self, wanted: &str, number: usize) -> String {
        let wanted: String = wanted.chars().take(120).map(|c| if c.is_control() { '_' } else { c }).collect();
        let wanted = if wanted.trim().is_empty() { "surface".into() } else { wanted };
        if self.taken.insert(wanted.clone()) {
            return wanted;
        }
        self.renamed += 1;
        // A file may use such names itself.
        let mut name = format!("{wanted}#{number}");
        while !self.taken.insert(name.clone()) {
            name.push('\'');
        }
        name
    }
}

/// Name of a scene after its file.
pub(super) fn scene_name(path: &std::path::Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.chars().take(60).map(|c| if c.is_control() { '_' } else { c }).collect()
}
