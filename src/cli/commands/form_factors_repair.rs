//! `etalon form-factors repair`

use super::{form_factors_check as check, form_factors_told as told, inputs};
use crate::cli::args::FormFactorsRepairArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::formfactor::{Rule, Surroundings, enforce, examine, undo};
use crate::io::{MatrixFormat, write_form_factors};
use crate::raycast::KernelKind;
use serde_json::json;

pub fn run(args: &FormFactorsRepairArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let format = MatrixFormat::of(&args.output)?;
    let error_format = args.save_std_err.as_deref().map(MatrixFormat::of).transpose()?;
    inputs::check_writable(&args.output)?;
    args.save_std_err.as_deref().map(inputs::check_writable).transpose()?;
    let stage = check::stage(&args.matrix, console)?;
    let given = check::matrix(&args.matrix, &stage, console)?;
    let closed = inputs::session(&stage, kernel, console)?.is_enclosure();
    let around = Surroundings::of(&stage, closed);
    let mistake = examine(&given, &around, Rule::usual(&given)).mistake;
    if let Some(m) = &mistake {
        console.notice(&format!("{}: {}; undone before the repair", args.matrix.file.display(), told::mistake(m)));
    }
    let meant = mistake.as_ref().map_or_else(|| given.clone(), |m| undo(&given, &around, m));
    let done = enforce(&meant, &around);
    let f = &done.form_factors;
    if args.save_std_err.is_some() && f.std_err.is_none() {
        let message = "--save-std-err needs standard errors, and none are known: give --std-err FILE";
        return Err(Failure::input(message).at(args.matrix.file.display().to_string()));
    }
    inputs::write(&args.output, &write_form_factors(f, format, false))?;
    if let (Some(path), Some(format)) = (&args.save_std_err, error_format) {
        inputs::write(path, &write_form_factors(f, format, true))?;
    }
    let json = json!({
        "file": args.matrix.file, "scene": stage.name, "scene_hash": stage.hash(), "patches": f.n,
        "stored": f.stored(), "closed": closed, "undone": mistake, "enforcement": done.info, "output": args.output,
    });
    let text = told::enforcement(&stage, &done.info);
    console.result(&format!("{text}\nwritten to {}", args.output.display()), &json);
    Ok(if done.info.unmet.is_empty() { exit::DONE } else { exit::FAIL })
}
