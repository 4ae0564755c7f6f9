//! Mesh faces that are not planar or not convex, cut into triangles.

use crate::math::{self, DVec3};

/// The triangles of [`math::ears`], by their corners.
pub(in crate::io::scene) fn ears(corners: &[DVec3]) -> Option<Vec<[DVec3; 3]>> {
    Some(math::ears(corners)?.into_iter().map(|t| t.map(|i| corners[i])).collect())
}
