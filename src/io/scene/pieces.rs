//! Polygons of foreign scenes made fit: planar convex ones stay whole, others fall into triangles.

use super::mesh::ears;
use super::photometry::Materials;
use super::polygon::{Flaw, MAX_CORNERS, flaw};
use crate::math::{DVec3, area};
use crate::scene::Material;
use std::collections::{HashMap, HashSet};
use std::path::Path;

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
        Some(flaw_of_it) => match ears(&corners) {
            Some(triangles) => {
                let sum: f64 = triangles.iter().map(|t| area(t)).sum();
                // A seam in the wrong place would be counted twice; bent polygons have no one area to compare with.
                if flaw_of_it == Flaw::NotConvex && (sum / area(&corners) - 1.0).abs() > 1e-6 {
                    return Cut::Hopeless("crosses itself");
                }
                let sound: Vec<Vec<DVec3>> =
                    triangles.into_iter().map(|t| t.to_vec()).filter(|t| flaw(t).is_none()).collect();
                if sound.is_empty() { Cut::NoArea } else { Cut::Split(sound) }
            }
            None => Cut::Hopeless("crosses itself"),
        },
    }
}

/// Materials of a foreign scene: one for each name with its values. Where a name stands for several, `#NUMBER` is added.
#[derive(Default)]
pub(super) struct Palette {
    pub materials: Materials,
    known: HashMap<(String, Vec<u64>), u32>,
}

impl Palette {
    /// The number of a material.
    pub(super) fn number(&mut self, wanted: &str, reflectance: [f64; 3], emission: [f64; 3]) -> u32 {
        let wanted: String = wanted.chars().take(150).map(|c| if c.is_control() { '_' } else { c }).collect();
        let bits = reflectance.iter().chain(&emission).map(|v| v.to_bits()).collect();
        let materials = &mut self.materials;
        *self.known.entry((wanted.clone(), bits)).or_insert_with(|| {
            let values = |name: &str| {
                let (reflectance, emission) = (reflectance.to_vec(), emission.to_vec());
                Material { name: name.into(), reflectance, emission }
            };
            let mut name = wanted.clone();
            if !materials.add(values(&name)) {
                name = format!("{wanted}#{}", materials.list.len() + 1);
                while !materials.add(values(&name)) {
                    name.push('\'');
                }
            }
            materials.number(&name).unwrap_or_default()
        })
    }
}

/// Names of surfaces, each one once.
#[derive(Default)]
pub(super) struct SurfaceNames {
    taken: HashSet<String>,
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
pub(super) fn scene_name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.chars().take(60).map(|c| if c.is_control() { '_' } else { c }).collect()
}
