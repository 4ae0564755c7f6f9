//! `etalon scene check` and `etalon scene patches`.

use super::inputs;
use crate::cli::args::{SceneArgs, SceneCommand};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{PatchFormat, write_patches};
use crate::scene::Stage;
use serde_json::json;
use std::path::Path;

pub fn run(command: &SceneCommand, console: &Console) -> Result<u8, Failure> {
    match command {
        SceneCommand::Check { scene, strict } => check(scene, *strict, console),
        SceneCommand::Patches { scene, output } => patches(scene, output, console),
    }
}

fn check(args: &SceneArgs, strict: bool, console: &Console) -> Result<u8, Failure> {
    let scene = inputs::scene(&args.scene, args.max_edge, console)?;
    // Every state has to be sound, not only the one asked for.
    for state in 0..=scene.edits.len() {
        scene.at(state)?;
    }
    let stage = inputs::stage_of(&scene, args.state)?;
    let present = stage.patches.iter().filter(|p| p.is_present()).count();
    let area: f64 = stage.areas().iter().sum();
    let text = format!(
        "{}: sound. {} surfaces, {} patches ({present} present in state {}), {} elements, {area:.6} m^2, bands {}",
        scene.name,
        stage.surfaces.len(),
        stage.patch_count(),
        stage.state,
        stage.elements.len(),
        stage.photometry.bands.join(", "),
    );
    let json = json!({
        "scene": scene.name, "scene_hash": stage.hash(), "state": stage.state, "states": scene.edits.len() + 1,
        "surfaces": stage.surfaces.len(), "patches": stage.patch_count(), "patches_present": present,
        "elements": stage.elements.len(), "area": area, "bands": stage.photometry.bands, "findings": scene.notices,
    });
    console.result(&text, &json);
    Ok(if strict && !scene.notices.is_empty() { exit::FAIL } else { exit::DONE })
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
