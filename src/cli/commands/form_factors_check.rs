//! `etalon form-factors check`

use super::{form_factors_told as told, inputs};
use crate::cli::args::{FormFactorsCheckArgs, MatrixArgs, SceneArgs};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::formfactor::{Rule, Surroundings, attach_errors, examine};
use crate::io::{MatrixFormat, read_form_factors_of};
use crate::raycast::KernelKind;
use crate::scene::Stage;
use crate::solution::FormFactors;
use serde_json::json;

pub fn run(args: &FormFactorsCheckArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let stage = stage(&args.matrix, console)?;
    let f = matrix(&args.matrix, &stage, console)?;
    let closed = inputs::session(&stage, kernel, console)?.is_enclosure();
    let usual = Rule::usual(&f);
    let rule = Rule {
        tolerance: args.tolerance.map_or(usual.tolerance, |t| t.0),
        degrees_of_freedom: f64::from(args.randomisations - 1),
        ..usual
    };
    let physics = examine(&f, &Surroundings::of(&stage, closed), rule);
    let json = json!({
        "file": args.matrix.file, "scene": stage.name, "scene_hash": stage.hash(), "patches": f.n, "physics": physics,
    });
    console.result(&told::physics(&args.matrix.file, &stage, &physics), &json);
    Ok(if physics.broken { exit::FAIL } else { exit::DONE })
}

/// The scene a matrix belongs to.
pub fn stage(args: &MatrixArgs, console: &Console) -> Result<Stage, Failure> {
    let scene = SceneArgs { scene: args.scene.clone(), state: args.state, max_edge: args.max_edge };
    inputs::stage(&scene, console)
}

/// The matrix, with the standard errors of a second file where one is given.
pub fn matrix(args: &MatrixArgs, stage: &Stage, console: &Console) -> Result<FormFactors, Failure> {
    let f = read_form_factors_of(&args.file, stage)?;
    let Some(path) = &args.std_err else { return Ok(f) };
    if MatrixFormat::of(path)? == MatrixFormat::Csv {
        let message = "a .csv matrix has its standard errors in its own column std_err; --std-err takes .npz or .mtx";
        return Err(Failure::input(format!("{}: {message}", path.display())).at(path.display().to_string()));
    }
    let errors = read_form_factors_of(path, stage)?;
    let (with_errors, missing) = attach_errors(f, &errors, &stage.areas());
    let stored = with_errors.stored();
    if 2 * missing > stored {
        let message = format!("states no error for {missing} of the {stored} entries of {}", args.file.display());
        let message = format!("{}: {message}; do the two files belong together?", path.display());
        return Err(Failure::input(message).at(path.display().to_string()));
    }
    if missing > 0 {
        console.notice(&format!("{missing} of {stored} entries have no standard error: that of their row is taken"));
    }
    Ok(with_errors)
}
