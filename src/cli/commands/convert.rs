//! `etalon convert`

use super::brought::{self, Brought};
use super::inputs;
use crate::carry::Carried;
use crate::cli::args::ConvertArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{BandNames, FileError, SolutionFormat, write_ply_values, write_solution, write_vtu};
use crate::math::compensated_sum;
use crate::scene::Stage;
use crate::study::Receivers;
use serde_json::{Value, json};
use std::path::Path;

/// What the result is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    /// A row or an entry for each patch.
    Solution(SolutionFormat),
    /// The patches with their radiosities, for a viewer.
    Vtu,
    /// The same as PLY.
    Ply,
}

impl Format {
    fn of(path: &Path) -> Result<Self, FileError> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("vtu") => Ok(Self::Vtu),
            Some("ply") => Ok(Self::Ply),
            Some("csv" | "json" | "npy" | "npz") => SolutionFormat::of(path).map(Self::Solution),
            _ => Err(FileError::new(path, "has no ending that names a solution format")
                .mend("use .csv, .json, .npy, .npz, .vtu or .ply")),
        }
    }
}

pub fn run(args: &ConvertArgs, console: &Console) -> Result<u8, Failure> {
    let format = Format::of(&args.output)?;
    inputs::check_writable(&args.output)?;
    let stage = inputs::stage_of(&inputs::scene(&args.scene, args.max_edge, console)?, args.state)?;
    let brought = brought::radiosity(&args.solution, &args.brought, &stage)?;
    brought.notices.iter().for_each(|n| console.notice(n));
    check_leaves_out(&brought, format, &args.output)?;
    inputs::write(&args.output, &bytes(&brought, &stage, format))?;
    let skipped = brought.matched.iter().filter(|m| !**m).count();
    let (from, to) = (args.solution.display(), args.output.display());
    let written = Receivers::patches(&stage).present().iter().filter(|p| **p).count() - skipped;
    let how = brought.carried.as_ref().map_or(String::new(), in_words);
    let text = format!("{from} on {written} patches of {}{how}; written to {to}", stage.name);
    let json = json!({
        "scene": stage.name, "scene_hash": stage.hash(), "patches": stage.patch_count(), "left_out": skipped,
        "carried": brought.carried.as_ref().map(in_numbers), "output": args.output,
    });
    console.result(&text, &json);
    Ok(exit::DONE)
}

/// Only tables of rows can leave a patch out: in an array it would read as 0.
fn check_leaves_out(brought: &Brought, format: Format, path: &Path) -> Result<(), FileError> {
    if brought.matched.iter().all(|m| *m) || format == Format::Solution(SolutionFormat::Csv) {
        return Ok(());
    }
    Err(FileError::new(path, "patches without a value cannot be left out of this format").mend("write .csv"))
}

fn bytes(brought: &Brought, stage: &Stage, format: Format) -> Vec<u8> {
    let b = &brought.radiosity;
    let format = match format {
        Format::Vtu => return write_vtu(stage, b),
        Format::Ply => return write_ply_values(stage, b),
        Format::Solution(format) => format,
    };
    let present = Receivers::patches(stage).present();
    let present: Vec<bool> = present.iter().zip(&brought.matched).map(|(p, m)| *p && *m).collect();
    let (hash, bands) = (stage.hash(), &stage.photometry.bands);
    write_solution(b, BandNames { scene: &stage.name, scene_hash: &hash, bands, present: &present }, format)
}

fn in_words(carried: &Carried) -> String {
    let shares = carried.of_scene();
    let spread = carried.relative_spread().filter(|s| *s > 0.0);
    let spread = spread.map_or(String::new(), |s| format!("; within patches they vary by {:.2} % (rms)", 100.0 * s));
    format!(
        ": {:.2} % of the area by faces of its plane, {:.2} % by the nearest, {:.2} % without a value{spread}",
        100.0 * shares.covered,
        100.0 * shares.near,
        100.0 * shares.unmatched,
    )
}

fn in_numbers(carried: &Carried) -> Value {
    let shares = carried.of_scene();
    let unmatched: Vec<Value> =
        carried.unmatched().iter().map(|u| json!({ "patch": u.patch, "share": u.share, "area": u.area })).collect();
    json!({
        "covered": shares.covered, "near": shares.near, "unmatched": shares.unmatched,
        "unmatched_patches": unmatched, "furthest": carried.furthest, "turned": carried.turned,
        "doubled_area": carried.doubled, "faces": carried.faces, "faces_unused": carried.idle.len(),
        "area_unused": compensated_sum(carried.idle.iter().map(|f| f.area)), "spread": carried.relative_spread(),
    })
}
