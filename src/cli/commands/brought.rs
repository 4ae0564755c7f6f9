//! Solutions as other programs write them, as radiosities of the patches.

use super::bench::{Input, fit};
use crate::carry::{Carried, CarryOptions, Quantity, Transfer, UnitsError, band_order, carry, select_bands};
use crate::cli::args::{BroughtArgs, Up};
use crate::cli::exit::Failure;
use crate::io::{FileError, MeshValuesOptions, is_mesh_values, is_reference, read_mesh_values};
use crate::math::{Bounds, DVec3};
use crate::scene::Stage;
use crate::solution::{MeshValues, Radiosity};
use crate::study::Receivers;
use std::path::Path;

/// Radiosities of the patches, and how they came about.
pub struct Brought {
    /// W/m^2 per patch and band; 0 where there is no value.
    pub radiosity: Radiosity,
    /// False for present patches without a value; only with `--skip-unmatched` there are any.
    pub matched: Vec<bool>,
    /// How values of a mesh were carried; `None` for a file with values per patch.
    pub carried: Option<Carried>,
    /// What the reader has to know of it.
    pub notices: Vec<String>,
}

/// Reads a solution and turns its numbers into radiosities of the patches of a stage.
pub fn radiosity(path: &Path, args: &BroughtArgs, stage: &Stage) -> Result<Brought, Failure> {
    check_numbers(args)?;
    if is_mesh_values(path) { on_its_mesh(path, args, stage) } else { per_patch(path, args, stage) }
}

fn check_numbers(args: &BroughtArgs) -> Result<(), Failure> {
    if !(args.factor.is_finite() && args.factor > 0.0) {
        return Err(Failure::input("--factor must be a number above 0"));
    }
    if args.reach.is_some_and(|r| !(r.is_finite() && r >= 0.0)) {
        return Err(Failure::input("--reach must be a length of 0 or more, in metres"));
    }
    Ok(())
}

/// A file with one value per patch.
fn per_patch(path: &Path, args: &BroughtArgs, stage: &Stage) -> Result<Brought, Failure> {
    if let Some(option) = option_for_meshes(args) {
        let message = format!("{}: {option} is for solutions on a mesh of their own; leave it out", path.display());
        return Err(Failure::input(message).at(path.display().to_string()));
    }
    let quantity = Quantity::from(args.quantity);
    let transfer = Transfer::from(args.transfer);
    let as_they_are = (quantity, transfer, args.factor) == (Quantity::Radiosity, Transfer::Linear, 1.0);
    if is_reference(path) && !as_they_are {
        let message =
            format!("{}: a reference holds radiosities; leave --quantity, --factor and --transfer out", path.display());
        return Err(Failure::input(message).at(path.display().to_string()));
    }
    let values = fit(path, Input::read(path)?, &Receivers::patches(stage), false, stage)?;
    let linear = transfer.decode(values).map_err(|e| units_failure(path, &e))?;
    let radiosity = quantity.to_radiosity(&linear, args.factor, stage);
    Ok(Brought { radiosity, matched: vec![true; stage.patch_count()], carried: None, notices: Vec::new() })
}

fn option_for_meshes(args: &BroughtArgs) -> Option<&'static str> {
    let given = [
        (args.values.is_some(), "--values"),
        (args.mesh.is_some(), "--mesh"),
        (!args.fields.is_empty(), "--fields"),
        (args.units.is_some(), "--units"),
        (args.up.is_some(), "--up"),
        (args.reach.is_some(), "--reach"),
        (args.skip_unmatched, "--skip-unmatched"),
    ];
    given.into_iter().find(|(is, _)| *is).map(|(_, name)| name)
}

fn units_failure(path: &Path, e: &UnitsError) -> Failure {
    FileError::new(path, format!("{} is no value of the sRGB curve: those are 0 to 1", e.value))
        .at(e.place.clone())
        .mend("leave --transfer srgb out if the values are linear")
        .into()
}

/// Values on a mesh.
fn on_its_mesh(path: &Path, args: &BroughtArgs, stage: &Stage) -> Result<Brought, Failure> {
    let values = in_bands(path, read_mesh_values(path, &reading(args))?, args, stage)?;
    let mut notices = values.notices.clone();
    let values = Transfer::from(args.transfer).decode_mesh(values).map_err(|e| units_failure(path, &e))?;
    let carried = carry(&values, stage, &CarryOptions { reach: args.reach });
    let told = carried.unmatched_told(stage);
    match told {
        Some(told) if !args.skip_unmatched => return Err(unmatched(path, &told, &values, &carried, stage)),
        Some(told) => notices.push(format!("{}: left out: {told}", path.display())),
        None => {}
    }
    notices.extend(carried.notices().iter().map(|n| format!("{}: {n}", path.display())));
    let matched: Vec<bool> = (0..stage.patch_count()).map(|i| carried.matched(i)).collect();
    let mut radiosity = Quantity::from(args.quantity).to_radiosity(&carried.values, args.factor, stage);
    for (b, matched) in radiosity.values.chunks_mut(radiosity.bands).zip(&matched) {
        if !matched {
            b.fill(0.0);
        }
    }
    Ok(Brought { radiosity, matched, carried: Some(carried), notices })
}

fn reading(args: &BroughtArgs) -> MeshValuesOptions {
    MeshValuesOptions {
        table: args.values.clone(),
        mesh: args.mesh.clone(),
        fields: (!args.fields.is_empty()).then(|| args.fields.clone()),
        scale: args.units.map_or(1.0, |u| u.0),
        y_up: args.up.map(|up| up == Up::Y),
    }
}

/// The bands of the file in the order of the scene's.
fn in_bands(path: &Path, values: MeshValues, args: &BroughtArgs, stage: &Stage) -> Result<MeshValues, Failure> {
    let bands = &stage.photometry.bands;
    let Some(order) = band_order(&values.bands, bands, !args.fields.is_empty()) else {
        let problem = format!("has bands {}, but the scene has {}", values.bands.join(", "), bands.join(", "));
        return Err(FileError::new(path, problem)
            .mend("name the field of each band of the scene with --fields")
            .into());
    };
    let as_it_is = order.iter().enumerate().all(|(k, from)| k == *from);
    Ok(if as_it_is { values } else { select_bands(&values, &order) })
}

/// Why patches have no value, as far as it can be told.
fn unmatched(path: &Path, told: &str, values: &MeshValues, carried: &Carried, stage: &Stage) -> Failure {
    let ((lo, hi), (low, high)) = (stage.bounds(), bounds(values));
    let times = low.distance(high) / lo.distance(hi);
    let mut mend = String::from("mend the mesh, or give --skip-unmatched to leave them out");
    if carried.would_match_turned > 0 {
        let n = carried.would_match_turned;
        mend = format!(
            "faces wound the other way would match {n} of them: a face radiates to the side from which its \
                        corners run counter-clockwise; {mend}"
        );
    } else if carried.of_scene().unmatched > 0.5 || !(0.5..2.0).contains(&times) {
        mend = format!(
            "the mesh reaches from {low:.3} to {high:.3}, the scene from {lo:.3} to {hi:.3} (metres): see --units and \
             --up; or {mend}"
        );
    } else {
        mend = format!("--reach METRES takes faces from further away; or {mend}");
    }
    FileError::new(path, told).mend(mend).into()
}

fn bounds(values: &MeshValues) -> (DVec3, DVec3) {
    let faces = (0..values.len()).map(|f| Bounds::of(values.corners(f)));
    let all = faces.fold(Bounds::NOTHING, Bounds::joined);
    (all.lo, all.hi)
}
