//! `etalon reference`

use super::inputs;
use crate::cli::args::{ReferenceArgs, Truth};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{StoredReference, write_folder};
use crate::raycast::KernelKind;
use crate::reference::Options;
use crate::study;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

/// The file that marks a folder as a reference.
pub const MARKER: &str = "reference.json";

pub fn run(args: &ReferenceArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    if args.truth == Truth::Continuous {
        return Err(Failure::input(
            "--truth continuous is not in this version: only patch-system references can be computed",
        ));
    }
    let options = Options { plan: inputs::plan(&args.rays)?, seed: args.rays.seed };
    let stage = inputs::stage(&args.scene, console)?;
    let session = inputs::session(&stage, kernel, console)?;
    let begin = Instant::now();
    let (stored, reference) = study::reference(&session, &options, console)?;
    console.end();
    let seconds = begin.elapsed().as_secs_f64();
    write_folder(&args.output, &stored.files(seconds), MARKER)?;
    if reference.missed_target {
        console.notice(&format!("the target error was not reached: {:.2e}", stored.provenance.relative_error));
    }
    console.result(&text(&stored, &args.output), &summary(&stored, seconds));
    explain_failures(&stored, console);
    Ok(if stored.self_check.passed() { exit::DONE } else { exit::SELF_CHECK })
}

/// Says on stderr which self-checks failed.
pub fn explain_failures(stored: &StoredReference, console: &Console) {
    for c in stored.self_check.failures() {
        console.notice(&format!("the reference failed its self-check of {}: {}", c.name, c.finding));
    }
}

fn summary(r: &StoredReference, seconds: f64) -> Value {
    let mut json = serde_json::to_value(&r.provenance).expect("provenance serialises");
    let more = json!({
        "scene": r.stage.name, "scene_hash": r.scene_hash, "state": r.stage.state, "patches": r.stage.patch_count(),
        "waves": r.waves, "passed_self_check": r.self_check.passed(), "self_check": r.self_check.checks,
        "seconds": seconds,
    });
    if let (Value::Object(json), Value::Object(more)) = (&mut json, more) {
        json.extend(more);
    }
    json
}

fn text(r: &StoredReference, output: &Path) -> String {
    let p = &r.provenance;
    let mut text = format!(
        "reference of {} ({} patches, state {}) written to {}\n\
         {} rays per patch in {} randomisations ({} {}): relative error {:.2e} (one sigma, norm of eq. 7)",
        r.stage.name,
        r.stage.patch_count(),
        r.stage.state,
        output.display(),
        inputs::thousands(p.rays_per_patch),
        p.randomisations,
        p.kernel,
        p.kernel_version,
        p.relative_error,
    );
    for c in &r.self_check.checks {
        text += &format!("\n  {} {}: {}", if c.passed { "ok    " } else { "FAILED" }, c.name, c.finding);
    }
    text
}
