//! Whether a stored reference already answers what is asked.

use crate::io::StoredReference;
use crate::raycast::KernelInfo;
use crate::reference::Options;
use crate::scene::Stage;
use crate::solution::TruthLevel;
use sha2::{Digest, Sha256};

/// What a stored reference lacks to be the answer: a patch-system reference of this stage by this program, kernel,
/// seed and number of randomisations, sound, with at least as many rays or at most the error asked for.
/// `None` if nothing.
pub fn falls_short(
    stored: &StoredReference,
    stage: &Stage,
    options: &Options,
    kernel: &KernelInfo,
    truth: TruthLevel,
) -> Option<String> {
    let p = &stored.provenance;
    let differs = |what: &str, has: &str, asked: &str| Some(format!("{what} {has}, not {asked}"));
    if stored.scene_hash != stage.hash() {
        return Some("another scene, state or discretisation".into());
    }
    // Names, cameras and whether the author calls it closed are no part of the hash, but they are stored.
    if as_json(&stored.stage) != as_json(stage) {
        return Some("the same geometry with other names, cameras or marks".into());
    }
    if p.truth != truth {
        return differs("the truth", p.truth.name(), truth.name());
    }
    if p.version != env!("CARGO_PKG_VERSION") {
        return differs("the work of version", &p.version, env!("CARGO_PKG_VERSION"));
    }
    let of = |name: &str, version: &str, set: &Option<String>| {
        format!("{name} {version} {}", set.as_deref().unwrap_or_default()).trim_end().to_string()
    };
    let (has, asked) = (
        of(&p.kernel, &p.kernel_version, &p.instruction_set),
        of(&kernel.name, &kernel.version, &kernel.instruction_set),
    );
    if has != asked {
        return differs("the work of the ray kernel", &has, &asked);
    }
    if p.seed != options.seed {
        return differs("seed", &p.seed.to_string(), &options.seed.to_string());
    }
    let plan = &options.plan;
    if p.estimator != plan.estimator.name() {
        return differs("the estimator", &p.estimator, plan.estimator.name());
    }
    if p.randomisations != plan.randomisations {
        return differs("randomisations", &p.randomisations.to_string(), &plan.randomisations.to_string());
    }
    if !stored.self_check.passed() {
        return Some("a failed self-check".into());
    }
    let rays = plan.rays_per_randomisation() * u64::from(plan.randomisations);
    match plan.target_error {
        Some(target) if p.relative_error > target => {
            differs("relative error", &format!("{:.2e}", p.relative_error), &format!("{target:.2e}"))
        }
        None if p.rays_per_patch < rays => differs("rays per patch", &p.rays_per_patch.to_string(), &rays.to_string()),
        _ => None,
    }
}

/// A key that two runs share if the reference of one is the answer to the other: everything that [`falls_short`] looks at,
/// and the effort asked for. A time limit is no part of it.
pub fn reference_key(stage: &Stage, options: &Options, kernel: &KernelInfo, truth: TruthLevel) -> String {
    let plan = &options.plan;
    let effort = match plan.target_error {
        Some(target) => format!("error {target:?}"),
        None => format!("rays {}", plan.rays_per_randomisation() * u64::from(plan.randomisations)),
    };
    let mut hash = Sha256::new();
    hash.update(as_json(stage));
    for part in [
        env!("CARGO_PKG_VERSION"),
        truth.name(),
        plan.estimator.name(),
        &effort,
        &plan.randomisations.to_string(),
        &options.seed.to_string(),
        &kernel.name,
        &kernel.version,
        kernel.instruction_set.as_deref().unwrap_or_default(),
    ] {
        hash.update([0]);
        hash.update(part.as_bytes());
    }
    let hex: String = hash.finalize().iter().take(16).map(|b| format!("{b:02x}")).collect();
    format!("etalon-reference-{hex}")
}

fn as_json(stage: &Stage) -> Vec<u8> {
    serde_json::to_vec(stage).expect("finite data serialise")
}
