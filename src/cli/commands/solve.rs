//! `etalon solve`

use super::{inputs, solve_by_shots};
use crate::cli::args::SolveArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::{BandNames, MatrixLayout, SolutionFormat, read_form_factors_of, write_matrix, write_solution};
use crate::methods::shooting::Factors;
use crate::methods::{Method, RowSums};
use crate::raycast::KernelKind;
use crate::reference::check_size;
use crate::study::{self, Receivers, SolveRequest};
use serde_json::json;

pub fn run(args: &SolveArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let format = SolutionFormat::of(&args.output)?;
    inputs::check_writable(&args.output)?;
    let layout = args.save_form_factors.as_deref().map(MatrixLayout::for_reuse).transpose()?;
    args.save_form_factors.as_deref().map(inputs::check_writable).transpose()?;
    let method = method(args)?;
    if let Method::Progressive(params) | Method::Redistribution(params) = method {
        return solve_by_shots::run(args, &method, params, format, kernel, console);
    }
    if args.snapshots.is_some() || args.resume.is_some() {
        return Err(Failure::input(
            "--snapshots and --resume are for methods that shoot: progressive and redistribution",
        ));
    }
    let stage = inputs::stage(&args.scene, console)?;
    let given = args.form_factors.as_deref().map(|f| read_form_factors_of(f, &stage)).transpose()?;
    if let (Method::Gather(p), None) = (&method, &given) {
        check_size(&stage, &p.plan())?;
    }
    let session = inputs::session(&stage, kernel, console)?;
    let per_element = args.per == PerLevel::Element;
    let request = SolveRequest { method, form_factors: given.as_ref(), seed: args.seed, per_element };
    let outcome = study::solve(&session, &request, console)?;
    console.end();
    let receivers = if per_element { Receivers::elements(&stage) } else { Receivers::patches(&stage) };
    let (hash, present) = (stage.hash(), receivers.present());
    let names = BandNames { scene: &stage.name, scene_hash: &hash, bands: &stage.photometry.bands, present: &present };
    inputs::write(&args.output, &write_solution(&outcome.radiosity, names, format))?;
    if let (Some(path), Some(layout), Some(f)) = (&args.save_form_factors, &layout, &outcome.form_factors) {
        inputs::write(path, &write_matrix(path, &stage, f, layout, false)?)?;
    }
    let sums = outcome.info.row_sums.unwrap_or(RowSums { min: 0.0, max: 0.0, mean: 0.0 });
    let text = format!(
        "{method} on {} ({} patches): {} iterations, residual {:.1e}, row sums {:.6} to {:.6}; written to {}",
        stage.name,
        stage.patch_count(),
        outcome.info.iterations.iter().max().unwrap_or(&0),
        outcome.info.residual.iter().copied().fold(0.0, f64::max),
        sums.min,
        sums.max,
        args.output.display(),
    );
    let json = json!({
        "scene": stage.name, "scene_hash": hash, "method": method.to_string(), "patches": stage.patch_count(),
        "iterations": outcome.info.iterations, "residual": outcome.info.residual,
        "row_sums": { "min": sums.min, "max": sums.max, "mean": sums.mean }, "output": args.output,
    });
    console.result(&text, &json);
    Ok(exit::DONE)
}

/// The method with `--rays` filled in where `--method` leaves it open.
fn method(args: &SolveArgs) -> Result<Method, Failure> {
    let mut method: Method = args.method.parse()?;
    if let Method::Gather(p) = &mut method
        && !args.method.contains("estimator=")
    {
        p.estimator = inputs::estimator(args.estimator);
    }
    if let (Method::Progressive(p) | Method::Redistribution(p), Some(n)) = (&mut method, args.rays)
        && !args.method.contains("rays=")
    {
        let Factors::Rays { rays, .. } = &mut p.factors else {
            return Err(Failure::input("--rays is for form factors by rays; hemi-cubes take resolution=N"));
        };
        *rays = n;
    }
    match (&mut method, args.rays) {
        (Method::Gather(p), Some(rays)) if !args.method.contains("rays=") => p.rays = rays,
        (Method::Hemicube(_), Some(_)) => {
            return Err(Failure::input("--rays is for ray-cast methods; hemicube takes hemicube:resolution=N"));
        }
        _ => {}
    }
    Ok(method)
}
