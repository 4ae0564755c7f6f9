//! `etalon form-factors`

use super::inputs;
use crate::cli::args::FormFactorsArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::estimate::{Casting, cast, patch_emitters};
use crate::io::{MatrixLayout, write_matrix};
use crate::raycast::KernelKind;
use crate::reference::{Progress, test_reciprocity};
use crate::sampling::{Role, Stream};
use crate::solution::FormFactors;
use crate::study::Session;
use serde_json::{Value, json};
use std::time::Instant;

pub fn run(args: &FormFactorsArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let layout = MatrixLayout::of(&args.output, args.format.as_ref())?;
    let error_layout = args.std_err.as_deref().map(|path| layout.of_errors(path)).transpose()?;
    inputs::check_writable(&args.output)?;
    args.std_err.as_deref().map(inputs::check_writable).transpose()?;
    let plan = inputs::plan(&args.rays)?;
    let stage = inputs::stage(&args.scene, console)?;
    crate::reference::check_size(&stage, &plan)?;
    let session = inputs::session(&stage, kernel, console)?;
    let emitters = patch_emitters(&stage);
    let rays =
        plan.rays_per_randomisation() * u64::from(plan.randomisations) * emitters.iter().flatten().count() as u64;
    console.begin("casting rays", plan.target_error.is_none().then_some(rays));
    let stream = Stream::new(Role::Judge, args.rays.seed);
    let casting =
        cast(&session.tracer(), &emitters, stream, &plan, &|c| c.relative_error(), &|rays| console.advance(rays));
    console.end();
    let f = casting.counts.form_factors();
    inputs::write(&args.output, &write_matrix(&args.output, &stage, &f, &layout, false)?)?;
    if let (Some(path), Some(layout)) = (&args.std_err, &error_layout) {
        inputs::write(path, &write_matrix(path, &stage, &f, layout, true)?)?;
    }
    if casting.reached.missed_target {
        console.notice(&format!("the target error was not reached: {:.2e}", casting.reached.relative_error));
    }
    let json = summary(&session, &casting, &f, begin.elapsed().as_secs_f64());
    console.result(&text(&session, &casting, &f, args), &json);
    Ok(exit::DONE)
}

/// Smallest, largest and mean row sum of the patches present.
fn row_sums(session: &Session, f: &FormFactors) -> [f64; 3] {
    let present = (0..f.n).filter(|i| session.stage().patches[*i].is_present());
    let sums: Vec<f64> = present.map(|i| f.row_sum(i)).collect();
    let min = sums.iter().copied().fold(f64::INFINITY, f64::min);
    let max = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [min, max, sums.iter().sum::<f64>() / sums.len() as f64]
}

fn max_std_err(f: &FormFactors) -> f64 {
    f.std_err.iter().flatten().copied().fold(0.0, f64::max)
}

fn summary(session: &Session, casting: &Casting, f: &FormFactors, seconds: f64) -> Value {
    let [min, max, mean] = row_sums(session, f);
    let tally = casting.counts.tally;
    json!({
        "patches": f.n,
        "rays_per_patch": casting.reached.rays_per_patch,
        "randomisations": casting.counts.randomisations,
        "rays": tally.rays,
        "kernel": session.kernel().name,
        "kernel_version": session.kernel().version,
        "instruction_set": session.kernel().instruction_set,
        "seconds": seconds,
        "stored": f.stored(),
        "relative_error": casting.reached.relative_error,
        "missed_target": casting.reached.missed_target,
        "waves": casting.waves,
        "max_std_err": max_std_err(f),
        "row_sums": { "min": min, "max": max, "mean": mean },
        "reciprocity": test_reciprocity(session.stage(), &casting.counts),
        "enclosure": session.is_enclosure(),
        "escapes": tally.escapes,
        "back_hits": tally.back_hits,
    })
}

fn text(session: &Session, casting: &Casting, f: &FormFactors, args: &FormFactorsArgs) -> String {
    let [min, max, _] = row_sums(session, f);
    format!(
        "{} x {} form factors, {} stored, written to {}\n\
         {} rays per patch in {} randomisations ({} kernel): relative error {:.2e}, largest standard error {:.2e}\n\
         row sums {min:.9} to {max:.9} ({} scene)",
        f.n,
        f.n,
        inputs::thousands(f.stored() as u64),
        args.output.display(),
        inputs::thousands(casting.reached.rays_per_patch),
        casting.counts.randomisations,
        session.kernel().name,
        casting.reached.relative_error,
        max_std_err(f),
        if session.is_enclosure() { "closed" } else { "open" },
    )
}
