//! The method as a whole: rows of all patches, then the patch system.

use super::delta::DeltaTable;
use super::row::Hemicube;
use super::world::{World, centre};
use super::{HemicubeError, Params};
use crate::math::{DVec3, Frame};
use crate::methods::{MethodInfo, PatchVectors, RowSums};
use crate::scene::{Element, Patch, Stage};
use crate::solution::{FormFactors, Radiosity};
use crate::solver::gauss_seidel;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Rows computed between two reports of progress; also bounds what is held twice while the matrix is put together.
const ROWS_PER_BLOCK: usize = 64;

/// Where the hemi-cube of a patch stands and how it is turned: its centre, and a frame whose z axis is the normal
/// and whose x axis lies along the first edge, turned by the rotation of `params`. `None` for a patch that takes
/// no part.
pub fn stand(patch: &Patch, params: &Params) -> Option<(DVec3, Frame)> {
    let eye = centre(patch)?;
    let frame = Frame::with_x_axis(patch.normal, patch.corners[1] - patch.corners[0]);
    Some((eye, frame.turned(params.rotation.to_radians())))
}

/// Form factors of all patches by hemi-cubes at their centres; zero entries not stored, no standard errors
/// [CG85 eq. 7]. Calls `progress` with the number of rows done.
pub fn form_factors(stage: &Stage, params: &Params, progress: &dyn Fn(usize)) -> Result<FormFactors, HemicubeError> {
    let stands: Vec<_> = stage.patches.iter().map(|p| stand(p, params)).collect();
    rows(stage, &stands, params, progress)
}

/// Form factors from all elements to all patches, by hemi-cubes at the elements' centres: elements x patches.
pub fn element_form_factors(stage: &Stage, params: &Params) -> Result<FormFactors, HemicubeError> {
    let of = |e: &Element| {
        let patch = &stage.patches[e.patch as usize];
        let (corners, region) = (e.corners.clone(), e.region.clone());
        stand(&Patch { corners, region, area: e.area, ..patch.clone() }, params)
    };
    let stands: Vec<_> = stage.elements.iter().map(of).collect();
    rows(stage, &stands, params, &|_| ())
}

/// One row per stand; empty where nothing stands.
fn rows(
    stage: &Stage,
    stands: &[Option<(DVec3, Frame)>],
    params: &Params,
    progress: &dyn Fn(usize),
) -> Result<FormFactors, HemicubeError> {
    let params = params.validated()?;
    let world = World::new(stage);
    let table = DeltaTable::new(params.resolution, params.delta);
    let idle = Pool::default();
    let mut f = FormFactors::from_exact_rows(Vec::new());
    f.n = stage.patch_count();
    for block in stands.chunks(ROWS_PER_BLOCK) {
        let row = |stand: &Option<(DVec3, Frame)>| match stand {
            None => Vec::new(),
            Some((eye, frame)) => idle.lend(|| Hemicube::new(&world, &table), |cube| cube.row(*eye, frame).0),
        };
        let rows: Vec<Vec<(u32, f64)>> = block.par_iter().map(row).collect();
        rows.into_iter().for_each(|row| append(&mut f, row));
        progress(f.row_starts.len() - 1);
    }
    Ok(f)
}

fn append(f: &mut FormFactors, row: Vec<(u32, f64)>) {
    for (j, value) in row {
        f.columns.push(j);
        f.values.push(value);
    }
    f.row_starts.push(f.columns.len());
}

/// Hemi-cubes that wait for work: as many as threads, with their buffers.
struct Pool<T>(Mutex<Vec<T>>);

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

impl<T> Pool<T> {
    fn lend<R>(&self, make: impl Fn() -> T, work: impl Fn(&mut T) -> R) -> R {
        let waiting = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut item = waiting.unwrap_or_else(make);
        let result = work(&mut item);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(item);
        result
    }
}

/// Solves a scene: form factors by hemi-cube, radiosities by Gauss-Seidel. Calls `progress` with the number of
/// rows done.
pub fn solve(
    stage: &Stage,
    params: &Params,
    progress: &dyn Fn(usize),
) -> Result<(Radiosity, MethodInfo), HemicubeError> {
    solve_with(stage, &form_factors(stage, params, progress)?, params)
}

/// Solves a scene with form factors that are there already: after a change of lights or reflectances, or from
/// another program.
pub fn solve_with(
    stage: &Stage,
    form_factors: &FormFactors,
    params: &Params,
) -> Result<(Radiosity, MethodInfo), HemicubeError> {
    let params = params.validated()?;
    if form_factors.n != stage.patch_count() {
        return Err(HemicubeError::ForeignMatrix { got: form_factors.n, expected: stage.patch_count() });
    }
    let vectors = PatchVectors::of(stage);
    let stop = gauss_seidel::Params { tolerance: params.tolerance, ..gauss_seidel::Params::default() };
    let (values, info) = gauss_seidel::solve(&vectors.system(), form_factors, &stop, |_| ())?;
    let row_sums = Some(RowSums::of(stage, form_factors));
    let radiosity = Radiosity { bands: vectors.bands, values, std_err: None };
    Ok((radiosity, MethodInfo { iterations: info.iterations, residual: info.residual, row_sums }))
}
