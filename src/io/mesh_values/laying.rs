//! Faces on their way from a file into [`MeshValues`]: placed in metres, cut where they are no planar convex polygons.

use super::{MeshValuesOptions, file_name};
use crate::io::FileError;
use crate::io::scene::mesh::{Parts, parts};
use crate::math::DVec3;
use crate::solution::{MeshValues, ValuesPer};
use std::path::Path;

/// Coordinates beyond this are taken for mistakes, metres.
const LARGEST: f64 = 1e9;

/// Values under construction.
pub(super) struct Laying<'a> {
    path: &'a Path,
    scale: f64,
    y_up: bool,
    out: MeshValues,
    /// How many faces had no area, and where the first of them stands.
    dropped: Option<(usize, String)>,
    /// The same of faces that were cut, with the largest distance from a plane, metres.
    cut: Option<(usize, String, f64)>,
}

impl<'a> Laying<'a> {
    /// No faces yet; `path` is the file that messages name.
    pub(super) fn new(
        path: &'a Path,
        options: &MeshValuesOptions,
        y_up: bool,
        bands: Vec<String>,
        per: ValuesPer,
    ) -> Self {
        let y_up = options.y_up.unwrap_or(y_up);
        Self { path, scale: options.scale, y_up, out: MeshValues::new(bands, per), dropped: None, cut: None }
    }

    /// Corners in metres, z up.
    pub(super) fn placed(&self, corners: &[DVec3], place: impl Fn() -> String) -> Result<Vec<DVec3>, FileError> {
        let corners: Vec<DVec3> = corners.iter().map(|p| self.turned(*p * self.scale)).collect();
        match corners.iter().all(|p| p.is_finite() && p.abs().max_element() <= LARGEST) {
            true => Ok(corners),
            false => Err(FileError::new(self.path, format!("a corner is not finite or lies beyond {LARGEST:e} m"))
                .at(place())
                .mend("check the coordinates and the unit of length")),
        }
    }

    fn turned(&self, p: DVec3) -> DVec3 {
        if self.y_up { DVec3::new(p.x, -p.z, p.y) } else { p }
    }

    /// Adds a face in file units with its values: one set for the face, or one for each corner.
    pub(super) fn add(
        &mut self,
        corners: &[DVec3],
        values: &[f64],
        place: impl Fn() -> String,
    ) -> Result<(), FileError> {
        let corners = self.placed(corners, &place)?;
        match parts(&corners) {
            Parts::Whole => self.out.push(&corners, values),
            Parts::Triangles(triangles, off) => {
                let (count, first, most) = self.cut.take().unwrap_or_else(|| (0, place(), 0.0));
                self.cut = Some((count + 1, first, most.max(off)));
                for t in triangles {
                    self.out.push(&t.map(|i| corners[i]), &self.of_corners(values, t));
                }
            }
            Parts::Nothing => {
                let (count, first) = self.dropped.take().unwrap_or_else(|| (0, place()));
                self.dropped = Some((count + 1, first));
            }
            Parts::Crossed => {
                return Err(FileError::new(self.path, "the face crosses itself")
                    .at(place())
                    .mend("split it into triangles"));
            }
        }
        Ok(())
    }

    /// Adds a planar convex polygon in metres, as it is.
    pub(super) fn push(&mut self, corners: &[DVec3], values: &[f64]) {
        self.out.push(corners, values);
    }

    /// Number of polygons so far.
    pub(super) fn len(&self) -> usize {
        self.out.len()
    }

    fn of_corners(&self, values: &[f64], corners: [usize; 3]) -> Vec<f64> {
        let bands = self.out.bands.len();
        match self.out.per() {
            ValuesPer::Face => values.to_vec(),
            ValuesPer::Corner => corners.iter().flat_map(|i| &values[i * bands..(i + 1) * bands]).copied().collect(),
        }
    }

    /// The values with what a user should know of them.
    pub(super) fn finish(mut self, notices: impl IntoIterator<Item = String>) -> Result<MeshValues, FileError> {
        if self.out.is_empty() {
            return Err(FileError::new(self.path, "has no face with an area and a value")
                .mend("write faces of three or more corners, with values"));
        }
        let file = file_name(self.path);
        if let Some((count, first, off)) = self.cut {
            self.out.notices.push(format!(
                "{file}, {first}: {count} faces that are not planar or not convex were cut into triangles \
                 (up to {off:.1e} m off their planes)"
            ));
        }
        if let Some((count, first)) = self.dropped {
            self.out.notices.push(format!("{file}, {first}: {count} faces without area were left out"));
        }
        self.out.notices.extend(notices.into_iter().map(|n| format!("{file}: {n}")));
        Ok(self.out)
    }
}
