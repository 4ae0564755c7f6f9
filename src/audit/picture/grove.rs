//! Trees: pictures on upright polygons that turn to whoever looks.

use super::PictureFault;
use super::texel::{Outside, Texels};
use crate::math::DVec3;
use crate::scene::Tree;

/// No tree.
pub(super) const NO_TREE: u32 = u32::MAX;

/// Trees with their pictures.
pub(super) struct Grove<'a> {
    trees: Vec<(&'a Tree, &'a Texels)>,
}

/// What a ray meets on a tree.
pub(super) struct Leaf {
    /// Distance along the ray, m.
    pub distance: f64,
    /// Number of the tree.
    pub tree: u32,
    /// Colour times opacity, and opacity.
    pub texel: [f64; 4],
    /// Level unit vector to the viewer.
    pub facing: DVec3,
}

impl<'a> Grove<'a> {
    pub fn new(trees: &'a [Tree], pictures: &'a [Texels]) -> Result<Self, PictureFault> {
        let with = |t: &'a Tree| pictures.get(t.picture).map(|p| (t, p)).ok_or(PictureFault::Missing(t.picture));
        Ok(Self { trees: trees.iter().map(with).collect::<Result<_, _>>()? })
    }

    /// The direction of a trunk.
    pub fn up(&self, tree: u32) -> DVec3 {
        self.trees[tree as usize].0.up
    }

    /// Trees, turned to the viewer's point, that a ray meets before `end`, the nearest first; what is wholly transparent
    /// is left out.
    pub fn met(&self, origin: DVec3, direction: DVec3, end: f64, viewer: DVec3) -> Vec<Leaf> {
        let mut leaves: Vec<Leaf> = Vec::new();
        for (k, (tree, picture)) in self.trees.iter().enumerate() {
            let met = meet(tree, viewer - tree.foot, origin, direction).filter(|m| m.distance < end);
            if let Some(m) = met {
                let texel = picture.at(m.s, m.t, Outside::Clear);
                if texel[3] > 0.0 {
                    leaves.push(Leaf { distance: m.distance, tree: k as u32, texel, facing: m.facing });
                }
            }
        }
        leaves.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        leaves
    }

    /// Share of light that comes through from a place of a lamp, past all trees but one, turned to that place.
    pub fn passed(&self, point: DVec3, direction: DVec3, distance: f64, but: u32) -> f64 {
        let mut share = 1.0;
        for (k, (tree, picture)) in self.trees.iter().enumerate() {
            if k as u32 == but || share <= 0.0 {
                continue;
            }
            let lamp = if distance.is_finite() { point + direction * distance - tree.foot } else { direction };
            if let Some(m) = meet(tree, lamp, point, direction).filter(|m| m.distance < distance) {
                share *= 1.0 - picture.at(m.s, m.t, Outside::Clear)[3];
            }
        }
        share
    }
}

struct Met {
    distance: f64,
    s: f64,
    t: f64,
    facing: DVec3,
}

/// Where a ray meets the polygon of a tree that is turned along the level part of `towards`.
fn meet(tree: &Tree, towards: DVec3, origin: DVec3, direction: DVec3) -> Option<Met> {
    let [breadth, height] = tree.size;
    let facing = (towards - tree.up * towards.dot(tree.up)).try_normalize()?;
    let distance = facing.dot(tree.foot - origin) / facing.dot(direction);
    // A ray that starts on the polygon leaves it.
    if !(distance.is_finite() && distance > 1e-9 * (breadth + height)) {
        return None;
    }
    let at = origin + direction * distance - tree.foot;
    let s = at.dot(tree.up.cross(facing)) / breadth + 0.5;
    let t = at.dot(tree.up) / height;
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some(Met { distance, s, t, facing })
}
