//! What each pixel of one hemi-cube shows, kept for inspection.

use super::delta::DeltaTable;
use super::project::{FACES, Face};
use super::raster::Item;
use super::row::Hemicube;
use super::stand::{Stand, drawn, stand};
use super::world::World;
use super::{HemicubeError, Params};
use crate::math::{DVec3, Frame};
use crate::scene::Stage;

/// The item buffer of the hemi-cube on one patch.
#[derive(Debug, Clone)]
pub struct ItemBuffer {
    /// Pixels along an edge of the top.
    pub resolution: usize,
    /// Where the hemi-cube stands, metres.
    pub eye: DVec3,
    /// Its axes; z is the patch normal.
    pub frame: Frame,
    /// Where in its pixels it looks, from their centres, pixels.
    pub shift: [f64; 2],
    /// Items of the faces in the order of [`Face::ALL`], row by row, row 0 at the horizon (sides) or at y = -1.
    pub faces: [Vec<Item>; FACES],
}

/// The item buffer of the hemi-cube on a patch, as `params` has it turned and shifted; `None` if the patch takes no
/// part or does not exist.
pub fn item_buffer(stage: &Stage, patch: usize, params: &Params) -> Result<Option<ItemBuffer>, HemicubeError> {
    let params = params.validated()?;
    let one = stage.patches.get(patch).and_then(|p| stand(p, &params)).map(|(eye, frame)| Stand::at(eye, frame));
    let one = drawn(one.into_iter().collect(), patch, &params).first().copied();
    one.map(|stand| item_buffer_at(stage, &stand, &params)).transpose()
}

/// The item buffer of a hemi-cube anywhere.
pub fn item_buffer_at(stage: &Stage, stand: &Stand, params: &Params) -> Result<ItemBuffer, HemicubeError> {
    let params = params.validated()?;
    stand.validated(0)?;
    let (world, table) = (World::new(stage), DeltaTable::new(params.resolution, params.delta));
    let mut cube = Hemicube::new(&world, &table);
    cube.aim_at(stand);
    let faces = Face::ALL.map(|face| {
        cube.project(face);
        cube.scan(face);
        cube.items().to_vec()
    });
    let Stand { eye, frame, shift, .. } = *stand;
    Ok(ItemBuffer { resolution: params.resolution as usize, eye, frame, shift, faces })
}

impl ItemBuffer {
    /// Number of pixels that show an item, over all faces.
    pub fn count(&self, item: Item) -> usize {
        self.faces.iter().flatten().filter(|i| **i == item).count()
    }

    /// World direction (of no particular length) through the point of a pixel where it is sampled.
    pub fn direction(&self, face: Face, column: usize, row: usize) -> DVec3 {
        self.direction_at(face, column, row, self.shift)
    }

    /// The same through another point of the pixel.
    pub(super) fn direction_at(&self, face: Face, column: usize, row: usize, shift: [f64; 2]) -> DVec3 {
        let at = |k: usize, shift: f64, start: f64| start + (k as f64 + 0.5 + shift) * 2.0 / self.resolution as f64;
        let v = at(row, shift[1], if face == Face::Top { -1.0 } else { 0.0 });
        self.frame.to_world(face.to_frame(DVec3::new(1.0, at(column, shift[0], -1.0), v)))
    }
}
