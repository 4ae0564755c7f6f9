//! The method as a whole: rows of all patches, then the patch system.

use super::delta::DeltaTable;
use super::row::Hemicube;
use super::stand::{Stand, drawn, stand, stands};
use super::world::World;
use super::{HemicubeError, Params};
use crate::methods::{MethodInfo, PatchVectors, RowSums};
use crate::scene::{Element, Patch, Stage};
use crate::solution::{FormFactors, Radiosity};
use crate::solver::gauss_seidel;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Rows computed between two reports of progress; also bounds what is held twice while the matrix is put together.
const ROWS_PER_BLOCK: usize = 64;

/// Form factors of all patches by hemi-cubes at their centres; zero entries not stored, no standard errors
/// [CG85 eq. 7]. Calls `progress` with the number of rows done.
pub fn form_factors(stage: &Stage, params: &Params, progress: &dyn Fn(usize)) -> Result<FormFactors, HemicubeError> {
    rows_of(stage, &stands(stage, params), params, progress)
}

/// Form factors from all elements to all patches, by hemi-cubes at the elements' centres: elements x patches.
/// Random turns and shifts are drawn by number of element.
pub fn element_form_factors(stage: &Stage, params: &Params) -> Result<FormFactors, HemicubeError> {
    let of = |(number, e): (usize, &Element)| {
        let patch = &stage.patches[e.patch as usize];
        let (corners, region) = (e.corners.clone(), e.region.clone());
        let one = stand(&Patch { corners, region, area: e.area, ..patch.clone() }, params);
        drawn(one.map(|(eye, frame)| Stand::at(eye, frame)).into_iter().collect(), number, params)
    };
    let stands: Vec<_> = stage.elements.iter().enumerate().map(of).collect();
    rows_of(stage, &stands, params, &|_| ())
}

/// Form factors from anywhere to all patches: row i is the mean of what the hemi-cubes `stands[i]` see, by their
/// weights as given; without any, it is empty. As many rows as `stands` has, whatever they stand for. Calls
/// `progress` with the number of rows done.
pub fn rows_of(
    stage: &Stage,
    stands: &[Vec<Stand>],
    params: &Params,
    progress: &dyn Fn(usize),
) -> Result<FormFactors, HemicubeError> {
    let params = params.validated()?;
    let each = stands.iter().enumerate();
    each.flat_map(|(row, list)| list.iter().map(move |s| (row, s))).try_for_each(|(row, s)| s.validated(row))?;
    let world = World::new(stage);
    let table = DeltaTable::new(params.resolution, params.delta);
    let idle = Pool::default();
    let look = |s: &Stand| idle.lend(|| Hemicube::new(&world, &table), |cube| cube.row_at(s).0);
    let mut f = FormFactors::from_exact_rows(Vec::new());
    f.n = stage.patch_count();
    for block in stands.chunks(ROWS_PER_BLOCK) {
        let rows: Vec<Vec<(u32, f64)>> = block.par_iter().map(|list| mean_row(list, look)).collect();
        rows.into_iter().for_each(|row| append(&mut f, row));
        progress(f.row_starts.len() - 1);
    }
    Ok(f)
}

/// The weighted mean of the rows of some hemi-cubes, by patch number.
fn mean_row(stands: &[Stand], look: impl Fn(&Stand) -> Vec<(u32, f64)> + Sync) -> Vec<(u32, f64)> {
    if let [one] = stands
        && one.weight == 1.0
    {
        return look(one);
    }
    let weighted = |s: &Stand| look(s).into_iter().map(|(j, f)| (j, s.weight * f)).collect::<Vec<_>>();
    let rows: Vec<Vec<(u32, f64)>> = stands.par_iter().map(weighted).collect();
    let mut mean = BTreeMap::new();
    rows.into_iter().flatten().for_each(|(j, f)| *mean.entry(j).or_insert(0.0) += f);
    mean.into_iter().filter(|(_, f)| *f != 0.0).collect()
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
