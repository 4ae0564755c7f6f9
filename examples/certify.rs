//! Makes the references that come with the program, and the evidence for them: each is computed to a tight error with the
//! first kernel, must pass its self-check, and is held against a second computation that shares nothing with it but the
//! scene: hemisphere rays alone, the double-precision kernel, another seed.
//!
//! `cargo run --release --example certify [NAME...]` writes `references/certified/NAME.zip` and prints the table of
//! `references/certified/README.md`.

use etalon::estimate::{Estimator, Plan};
use etalon::io::StoredReference;
use etalon::io::scene::builtin;
use etalon::metrics::{Judged, Truth, compare};
use etalon::raycast::KernelKind;
use etalon::reference::{Options, Progress};
use etalon::scene::Stage;
use etalon::study::{Receivers, Session, reference};
use std::path::Path;

/// Scenes with the relative error asked for. What the exact shadows settle costs nothing more to have to many digits.
const SCENES: &[(&str, f64)] = &[
    ("cornell-box-coarse", 1e-4),
    ("cornell-box", 3e-4),
    ("furnace-l", 1e-9),
    ("opposed-squares", 1e-9),
    ("edge-squares", 1e-9),
    ("cube-one-emitter", 1e-9),
    ("l-room", 1e-5),
    ("dynamic-cube", 1e-4),
    ("cube-room", 1e-4),
    ("small-lamp", 1e-6),
    ("visibility-only", 1e-5),
    ("furnished-room", 3e-4),
];

/// Few replicates keep the files small: the first decimal of an interval is not what these references are for.
const RANDOMISATIONS: u16 = 8;

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("references/certified");
    println!(
        "| scene | patches | error (one sigma, eq. 7) | second computation: error, eq. 7 of the difference | size |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for (name, target) in SCENES {
        if !asked.is_empty() && !asked.iter().any(|a| a == name) {
            continue;
        }
        let scene = builtin(name).ok_or("no such scene")?;
        let stage = scene.at(scene.edits.len())?;
        let first = compute(&stage, KernelKind::Auto, Estimator::Auto, Some(*target), 4096, 1)?;
        let second = compute(&stage, KernelKind::Builtin, Estimator::Rays, None, 65_536, 2)?;
        let bytes = first.archive(0.0);
        println!(
            "| `{name}` | {} | {:.1e} | {:.1e}, {} | {} kB |",
            first.stage.patch_count(),
            first.provenance.relative_error,
            second.provenance.relative_error,
            difference(&first, &second)?,
            bytes.len().div_ceil(1000)
        );
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(format!("{name}.zip")), bytes)?;
    }
    Ok(())
}

fn compute(
    stage: &Stage,
    kernel: KernelKind,
    estimator: Estimator,
    target_error: Option<f64>,
    rays: u64,
    seed: u64,
) -> Result<StoredReference, Box<dyn std::error::Error>> {
    let session = Session::open(stage, kernel)?;
    let plan = Plan { rays, randomisations: RANDOMISATIONS, target_error, estimator, ..Plan::default() };
    let (stored, _) = reference(&session, &Options { plan, seed }, &Silent)?;
    let failed = stored.self_check.failures().next().map(|c| format!("{}: {}", c.name, c.finding));
    match failed {
        None => Ok(stored),
        Some(what) => Err(format!("{}: the self-check failed: {what}", stage.name).into()),
    }
}

/// Eq. 7 of the first reference's mean against the second, with its interval: it has to reach down to what the first
/// states of its own error. (In a furnace the second has none.)
fn difference(first: &StoredReference, second: &StoredReference) -> Result<String, Box<dyn std::error::Error>> {
    let receivers = Receivers::patches(&first.stage);
    let surfaces: Vec<&str> = receivers.surfaces.iter().map(String::as_str).collect();
    let judged = Judged {
        areas: &receivers.areas,
        emission: &receivers.emission,
        surfaces: &surfaces,
        bands: &receivers.photometry.bands,
        weights: &receivers.photometry.weights,
    };
    let truth = Truth::Sampled(second.patches.clone());
    let e = compare(&first.patches.mean(), &truth, None, &judged, 0.999, false)?.rms;
    if e.low > 4.0 * first.provenance.relative_error {
        return Err(format!("{}: the two computations differ: {e:?}", first.stage.name).into());
    }
    Ok(format!("{:.1e} to {:.1e}", e.low, e.high))
}
