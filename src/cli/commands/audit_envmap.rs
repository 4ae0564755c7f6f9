//! `etalon audit envmap`: the audit, its tables, its pictures and its page.

use super::audit_envmap_pictures::pictures;
use super::check::exit_code;
use super::{inputs, lit::Lit, standpoint};
use crate::cli::args::EnvmapArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::atomic;
use crate::raycast::KernelKind;
use crate::render::resized;
use crate::report::envmap::{ENVMAP_PAGE, EnvmapExtras, envmap_files};
use crate::report::{Artifact, Phase, save};
use crate::study::envmap::{Audited, EnvmapError, EnvmapRecord, EnvmapRequest, PointRow, envmap, object};
use serde_json::{Value, json};
use std::time::Instant;

/// Pixels across the object's picture at most.
const WIDEST: u32 = 320;

impl From<EnvmapError> for Failure {
    fn from(e: EnvmapError) -> Self {
        Self::input(e.to_string())
    }
}

pub fn run(args: &EnvmapArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let shading = check(args)?;
    atomic::check_folder(&args.output)?;
    let Lit { stage, light } = Lit::read(&args.scene, args.solution.as_deref(), args.state, args.max_edge, console)?;
    // Asked before the kernel is opened: a wrong name is told at once.
    object(&stage, &args.object)?;
    let session = inputs::session(&stage, kernel, console)?;
    let tracer = session.tracer();
    let camera = standpoint::camera(&tracer, args.camera.as_deref())?;
    let [w, h] = camera.size;
    let (small, fitted) = ([w.min(WIDEST), (h * w.min(WIDEST)).div_ceil(w)], stage.cameras.is_empty());
    let request = EnvmapRequest {
        scene: stage.name.clone(),
        object: args.object.clone(),
        centres: args.at.iter().map(|p| p.0).collect(),
        axes: standpoint::centre(&camera, camera.eye, None, None)?,
        camera: resized(&camera, fitted, small),
        shading,
        size: args.size,
        samples: args.samples,
        table: args.table.0,
        points: args.points as usize,
        directions: args.directions.into(),
        rays: args.rays,
        seed: args.seed,
        stated: args.stated_error.0,
        limit: args.max_error.map(|f| f.0),
        confidence: args.confidence.0,
    };
    let audited = envmap(&stage, kernel, &request, &light, &|doing| console.detail(doing))?;
    let computed = Phase { name: "audit".into(), seconds: begin.elapsed().as_secs_f64() };
    let begin = Instant::now();
    let shown = pictures(&stage, kernel, &request, &light, &audited, args)?;
    let drawn = Phase { name: "pictures".into(), seconds: begin.elapsed().as_secs_f64() };
    let timing = [computed, drawn];
    let mut files = envmap_files(&audited.record, &EnvmapExtras { pictures: &shown, timing: &timing })?;
    files.push(Artifact { name: "audit.json".into(), bytes: encoded(&audited.record)? });
    files.push(Artifact { name: "points.csv".into(), bytes: points(&audited.record.points).into_bytes() });
    save(&args.output, &files)?;
    console.result(&text(args, &audited), &summary(args, &audited.record)?);
    Ok(audited.record.verdict.map_or(exit::DONE, |v| exit_code(v, args.on_inconclusive)))
}

/// The weights of the shading, where all options make sense.
fn check(args: &EnvmapArgs) -> Result<[f64; 2], Failure> {
    let confidence = args.confidence.0;
    if confidence <= 0.0 || confidence >= 1.0 {
        return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
    }
    if args.stated_error.0 <= 0.0 {
        return Err(Failure::input("--stated-error must be above 0: 5% for example"));
    }
    if args.table.0[0] > 512 || args.table.0[1] > 256 {
        return Err(Failure::input("--table: light by normal has nothing fine in it; 512x256 is the largest"));
    }
    match args.shading.as_slice() {
        [dc, sc] if [dc, sc].iter().all(|x| x.is_finite() && **x >= 0.0) => Ok([*dc, *sc]),
        _ => Err(Failure::input("--shading: write two numbers that are not below 0, DC,SC (0.5,0.5)")),
    }
}

fn encoded(record: &EnvmapRecord) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(record).map_err(|e| Failure::input(e.to_string()))
}

/// Point by point: irradiances are luminance-weighted, W/m^2.
fn points(rows: &[PointRow]) -> String {
    let mut out = String::from(
        "patch,x,y,z,nx,ny,nz,centre,distance,map,at_centre,at_centre_std_err,without_object,without_object_std_err,\
         truth,truth_std_err\n",
    );
    for p in rows {
        let three = |v: [f64; 3]| format!("{},{},{}", v[0], v[1], v[2]);
        out += &format!(
            "{},{},{},{},{},{},{},{},{},{},{},{}\n",
            p.patch,
            three(p.place),
            three(p.normal),
            p.centre,
            p.distance,
            p.map,
            p.at_centre,
            p.std_err[0],
            p.without,
            p.std_err[1],
            p.truth,
            p.std_err[2]
        );
    }
    out
}

fn text(args: &EnvmapArgs, audited: &Audited) -> String {
    let findings: String = audited.record.findings.iter().map(|f| format!("- {f}\n")).collect();
    format!("{findings}\nthe page: {}", args.output.join(ENVMAP_PAGE).display())
}

fn summary(args: &EnvmapArgs, record: &EnvmapRecord) -> Result<Value, Failure> {
    let mut json = serde_json::to_value(record).map_err(|e| Failure::input(e.to_string()))?;
    if let Some(object) = json.as_object_mut() {
        // The long list is in the files.
        object.remove("points");
        object.insert("output".into(), json!(args.output));
    }
    Ok(json)
}
