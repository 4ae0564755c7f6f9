//! `etalon scene check` and `etalon scene patches`.

use super::inputs;
use crate::cli::args::{SceneArgs, SceneCommand};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::doctor;
use crate::io::{PatchFormat, write_patches};
use crate::scene::{Finding, Severity, Stage};
use serde_json::json;
use std::path::Path;

pub fn run(command: &SceneCommand, console: &Console) -> Result<u8, Failure> {
    match command {
        SceneCommand::Check { scene, strict } => check(scene, *strict, console),
        SceneCommand::Patches { scene, output } => patches(scene, output, console),
    }
}

fn check(args: &SceneArgs, strict: bool, console: &Console) -> Result<u8, Failure> {
    let scene = inputs::open(&args.scene, args.max_edge)?;
    let stage = inputs::stage_of(&scene, args.state)?;
    // Every state has to be sound, not only the one asked for.
    (0..=scene.edits.len()).filter(|k| *k != stage.state).try_for_each(|k| scene.at(k).map(drop))?;
    let findings = doctor::examine(&scene, &stage)?;
    let grave = findings.iter().filter(|f| f.severity > Severity::Note).count();
    let present = stage.patches.iter().filter(|p| p.is_present()).count();
    let area: f64 = stage.areas().iter().sum();
    let text = format!(
        "{}: {}. {} surfaces, {} patches ({present} present in state {}), {} elements, {area:.6} m^2, bands {}{}{}",
        scene.name,
        if grave == 0 { "sound" } else { "readable, but see the findings" },
        stage.surfaces.len(),
        stage.patch_count(),
        stage.state,
        stage.elements.len(),
        stage.photometry.bands.join(", "),
        besides(&stage),
        told(&findings),
    );
    let json = json!({
        "scene": scene.name, "scene_hash": stage.hash(), "state": stage.state, "states": scene.edits.len() + 1,
        "surfaces": stage.surfaces.len(), "patches": stage.patch_count(), "patches_present": present,
        "elements": stage.elements.len(), "area": area, "bands": stage.photometry.bands,
        "lights": stage.lights.iter().map(|l| &l.name).collect::<Vec<_>>(),
        "receivers": stage.receivers.iter().map(|r| &r.name).collect::<Vec<_>>(), "findings": findings,
    });
    console.result(&text, &json);
    Ok(if strict && grave > 0 { exit::FAIL } else { exit::DONE })
}

/// Lights and receivers, where there are any.
fn besides(stage: &Stage) -> String {
    let counted = |n: usize, what: &str| match n {
        0 => String::new(),
        1 => format!(", 1 {what}"),
        _ => format!(", {n} {what}s"),
    };
    counted(stage.lights.len(), "point light") + &counted(stage.receivers.len(), "receiver")
}

/// The findings as paragraphs, those of one kind together with the mend told once.
fn told(findings: &[Finding]) -> String {
    let mut text = String::new();
    for alike in findings.chunk_by(|a, b| (a.kind, a.severity, &a.mend) == (b.kind, b.severity, &b.mend)) {
        for f in alike {
            text += &format!("\n{:>7}: {}: {}", f.severity.name(), f.kind.name(), f.what);
            text += &f.consequence.as_ref().map_or(String::new(), |c| format!("\n         {}", c.text));
        }
        text += &format!("\n   mend: {}", alike[0].mend);
    }
    text
}

fn patches(args: &SceneArgs, output: &Path, console: &Console) -> Result<u8, Failure> {
    let format = PatchFormat::of(output)?;
    inputs::check_writable(output)?;
    let stage: Stage = inputs::stage(args, console)?;
    inputs::write(output, &write_patches(&stage, format))?;
    let text = format!("{} patches of {} written to {}", stage.patch_count(), stage.name, output.display());
    console.result(&text, &json!({ "patches": stage.patch_count(), "output": output, "scene_hash": stage.hash() }));
    Ok(exit::DONE)
}
