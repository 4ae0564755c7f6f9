//! `etalon scan`: what a camera sees, by segments on sub-scanlines; only what changed is scanned again.

use super::{inputs, spans, standpoint};
use crate::cli::args::ScanArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::StateChoice;
use crate::compositing::{ScanRequest, SpanImage};
use crate::io::atomic;
use crate::io::read_span;
use crate::raycast::KernelKind;
use crate::render::resized;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub fn run(args: &ScanArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    match args.each {
        true => atomic::check_folder(&args.output)?,
        false => spans::check_name(&args.output)?,
    }
    let (scene, look) = inputs::scene_with_look(&args.scene, None, console)?;
    let stage = inputs::stage_of(&scene, args.state.unwrap_or(StateChoice::Final))?;
    let appearance = inputs::lighting(args.lighting.as_deref(), look.on(&stage)?, &stage)?;
    let camera = match stage.cameras.is_empty() {
        // Only a scene that must be looked at from somewhere needs a kernel.
        true => standpoint::camera(&inputs::session(&stage, kernel, console)?.tracer(), args.camera.as_deref())?,
        false => standpoint::own_camera(&stage, args.camera.as_deref())?,
    };
    let camera = match &args.size {
        Some(size) => resized(&camera, stage.cameras.is_empty(), size.0),
        None => camera,
    };
    let whole = ScanRequest {
        stage: &stage,
        appearance: &appearance,
        camera: &camera,
        per_line: args.sub_scanlines,
        cluster: (!args.cluster.is_empty()).then_some(&args.cluster[..]),
    };
    if !args.each {
        let (words, json) = one(&whole, &args.output, args.force)?;
        console.result(&words, &json);
        return Ok(exit::DONE);
    }
    let objects: Vec<Vec<String>> = whole.outset()?.clusters.into_iter().map(|c| c.objects).collect();
    let targets = targets(&args.output, &objects);
    let (mut words, mut files) = (Vec::new(), Vec::new());
    for (cluster, path) in objects.iter().zip(&targets) {
        std::fs::create_dir_all(&args.output).map_err(|e| Failure::input(format!("{}: {e}", args.output.display())))?;
        let (said, json) = one(&ScanRequest { cluster: Some(cluster), ..whole.clone() }, path, args.force)?;
        words.push(said);
        files.push(json);
    }
    let strangers = strangers(&args.output, &targets);
    for path in &strangers {
        console.notice(&format!("{}: of no object of this state; leave it out, or delete it", path.display()));
    }
    console.result(&words.join("\n"), &json!({ "files": files, "not_of_this_state": strangers }));
    Ok(exit::DONE)
}

/// Scans into a file, unless that holds the same already.
fn one(request: &ScanRequest, path: &Path, force: bool) -> Result<(String, Value), Failure> {
    let outset = request.outset()?;
    // What cannot be read is not the same; it is replaced as any old result is.
    let kept = (!force).then(|| read_span(path).ok()).flatten().filter(|old| same(old, &outset));
    if kept.is_some() {
        let words = format!("{}: nothing changed, kept", path.display());
        return Ok((words, json!({ "file": path, "scanned": false })));
    }
    let begin = Instant::now();
    let image = request.scan()?;
    let seconds = begin.elapsed().as_secs_f64();
    let (words, mut json) = spans::write(path, &image)?;
    json["seconds"] = seconds.into();
    json["scanned"] = true.into();
    Ok((words, json))
}

/// True if an image is of all that stands in an outset, lights and pictures included.
fn same(old: &SpanImage, outset: &SpanImage) -> bool {
    old.clusters == outset.clusters
        && old.camera == outset.camera
        && old.per_line == outset.per_line
        && old.photometry == outset.photometry
        && old.materials == outset.materials
        && old.appearance == outset.appearance
        && old.faces == outset.faces
}

/// Span files of the folder that are of no object of this state: whoever composites all files of it would see ghosts.
fn strangers(folder: &Path, targets: &[PathBuf]) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    let mut found: Vec<PathBuf> =
        entries.filter(|p| p.extension().is_some_and(|e| e == "span") && !targets.contains(p)).collect();
    found.sort();
    found
}

/// A file for each object: its name, other characters than letters, digits, `-` and `_` replaced; numbered where two
/// come out alike.
fn targets(folder: &Path, objects: &[Vec<String>]) -> Vec<PathBuf> {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let mut target = |objects: &Vec<String>| {
        let stem: String = objects.join("+").chars().map(plain).collect();
        // Some file systems do not tell capitals from small letters.
        let free = |name: &String| !taken.contains(&name.to_lowercase());
        let numbered = (2..).map(|k| format!("{stem}-{k}"));
        let name = std::iter::once(stem.clone()).chain(numbered).find(free).unwrap_or(stem);
        taken.insert(name.to_lowercase());
        folder.join(format!("{name}.span"))
    };
    objects.iter().map(&mut target).collect()
}
