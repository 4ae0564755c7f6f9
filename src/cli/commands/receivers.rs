//! `etalon receivers`

use super::inputs;
use crate::cli::args::ReceiversArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::estimate::Plan;
use crate::raycast::KernelKind;
use crate::reference::{Options, check_size};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study;
use serde_json::json;

pub fn run(args: &ReceiversArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    inputs::check_writable(&args.output)?;
    let stage = inputs::stage(&args.scene, console)?;
    if stage.receivers.is_empty() {
        return Err(Failure::input(
            "the scene has no receiver; add a [[receiver]] with a name, a position and a normal",
        )
        .at(args.scene.scene.clone()));
    }
    let plan = Plan { rays: args.suite.rays, randomisations: args.suite.randomisations, ..Plan::default() };
    check_size(&stage, &plan)?;
    let session = inputs::session(&stage, kernel, console)?;
    let options = Options { plan, seed: args.suite.seed };
    let irradiance = study::at_receivers(&session, &options, console)?.mean();
    console.end();
    inputs::write(&args.output, &table(&stage, &irradiance)?)?;
    let text = format!(
        "irradiance at {} receivers of {} written to {} ({} rays each)",
        stage.receivers.len(),
        stage.name,
        args.output.display(),
        inputs::thousands(plan.rays_per_randomisation() * u64::from(plan.randomisations)),
    );
    let values: Vec<_> = stage
        .receivers
        .iter()
        .enumerate()
        .map(|(k, r)| json!({ "name": r.name, "irradiance": irradiance.of(k), "std_err": irradiance.std_err_of(k) }))
        .collect();
    let json = json!({
        "scene": stage.name, "scene_hash": stage.hash(), "state": stage.state, "bands": stage.photometry.bands,
        "rays": plan.rays_per_randomisation() * u64::from(plan.randomisations), "receivers": values,
        "output": args.output,
    });
    console.result(&text, &json);
    Ok(exit::DONE)
}

/// One row per receiver: name, position, normal, irradiance and standard error per band.
fn table(stage: &Stage, irradiance: &Radiosity) -> Result<Vec<u8>, Failure> {
    let whole = |e: &dyn std::fmt::Display| Failure::input(format!("the table cannot be written: {e}"));
    let mut csv = csv::Writer::from_writer(Vec::new());
    let bands = &stage.photometry.bands;
    let fixed = ["receiver", "x", "y", "z", "normal_x", "normal_y", "normal_z"].map(String::from);
    let columns = bands.iter().flat_map(|b| [b.clone(), format!("{b}_std_err")]);
    csv.write_record(fixed.into_iter().chain(columns)).map_err(|e| whole(&e))?;
    for (k, r) in stage.receivers.iter().enumerate() {
        let errors = irradiance.std_err_of(k);
        let place = r.position.to_array().into_iter().chain(r.normal.to_array()).map(|x| x.to_string());
        let values = (0..bands.len())
            .flat_map(|c| [irradiance.of(k)[c].to_string(), errors.map_or(String::new(), |e| e[c].to_string())]);
        csv.write_record(std::iter::once(r.name.clone()).chain(place).chain(values)).map_err(|e| whole(&e))?;
    }
    csv.into_inner().map_err(|e| whole(&e))
}
