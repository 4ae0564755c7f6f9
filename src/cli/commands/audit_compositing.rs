//! `etalon audit compositing`: the audit, its tables, its pictures and its page.

use super::check::exit_code;
use super::{inputs, standpoint};
use crate::cli::args::CompositingArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::StateChoice;
use crate::io::atomic;
use crate::raycast::KernelKind;
use crate::render::{ColourMap, Exposure, Raster, Seen, ToneMap, paint_radiances, resized, to_srgb8};
use crate::report::compositing::{COMPOSITING_PAGE, CompositingExtras, CompositingPicture, compositing_files};
use crate::report::{Artifact, Phase, save};
use crate::scene::Stage;
use crate::study::compositing::{Audited, CompositingRecord, CompositingRequest, compositing};
use crate::view::Operator;
use std::f64::consts::PI;
use std::time::Instant;

/// Pixels across the pictures if no size is asked for.
const WIDEST: u32 = 320;

pub fn run(args: &CompositingArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let (counts, scales) = check(args)?;
    atomic::check_folder(&args.output)?;
    let (scene, look) = inputs::scene_with_look(&args.scene, None, console)?;
    let stage = inputs::stage_of(&scene, args.state.unwrap_or(StateChoice::Final))?;
    let appearance = inputs::lighting(args.lighting.as_deref(), look.on(&stage)?, &stage)?;
    let session = inputs::session(&stage, kernel, console)?;
    let tracer = session.tracer();
    let camera = standpoint::camera(&tracer, args.camera.as_deref())?;
    let [w, h] = camera.size;
    let small = args.size.as_ref().map_or([w.min(WIDEST), (h * w.min(WIDEST)).div_ceil(w)], |s| s.0);
    let request = CompositingRequest {
        scene: stage.name.clone(),
        camera: resized(&camera, stage.cameras.is_empty(), small),
        counts,
        scales,
        samples: args.samples.into(),
        points: args.points as usize,
        rays: args.rays,
        seed: args.seed,
        limit: args.max_error.map(|f| f.0),
    };
    let audited = compositing(&stage, &appearance, &tracer, &request, &|doing| console.detail(doing))?;
    let computed = Phase { name: "audit".into(), seconds: begin.elapsed().as_secs_f64() };
    let begin = Instant::now();
    let shown = pictures(&stage, &audited, args);
    let drawn = Phase { name: "pictures".into(), seconds: begin.elapsed().as_secs_f64() };
    let extras = CompositingExtras { pictures: &shown, timing: &[computed, drawn] };
    let mut files = compositing_files(&audited.record, &extras)?;
    let json = serde_json::to_value(&audited.record).map_err(|e| Failure::input(e.to_string()))?;
    let text = serde_json::to_vec_pretty(&json).map_err(|e| Failure::input(e.to_string()))?;
    files.push(Artifact { name: "audit.json".into(), bytes: text });
    files.push(Artifact { name: "edges.csv".into(), bytes: edges(&audited.record).into_bytes() });
    files.push(Artifact { name: "lights.csv".into(), bytes: lights(&audited.record).into_bytes() });
    save(&args.output, &files)?;
    let findings: String = audited.record.findings.iter().map(|f| format!("- {f}\n")).collect();
    let mut said = json;
    said["output"] = serde_json::json!(args.output);
    let verdict = match (audited.record.verdict, audited.record.limit) {
        (Some(verdict), Some(limit)) => {
            format!("{}: limit {limit} on the edges\n", format!("{verdict:?}").to_uppercase())
        }
        _ => String::new(),
    };
    let page = args.output.join(COMPOSITING_PAGE);
    console.result(&format!("{verdict}{findings}\nthe page: {}", page.display()), &said);
    Ok(audited.record.verdict.map_or(exit::DONE, |v| exit_code(v, args.on_inconclusive)))
}

/// Numbers of sub-scanlines in order, and scales, where they make sense.
fn check(args: &CompositingArgs) -> Result<(Vec<u32>, Vec<f64>), Failure> {
    let mut counts = args.sub_scanlines.clone();
    counts.sort_unstable();
    counts.dedup();
    if let Some(bad) = args.scales.iter().find(|s| !(s.is_finite() && **s > 0.0 && **s <= 8.0)) {
        return Err(Failure::input(format!("--scales {bad}: give scales above 0 and at most 8")));
    }
    let mut scales = args.scales.clone();
    scales.sort_by(f64::total_cmp);
    scales.dedup();
    Ok((counts, scales))
}

fn edges(record: &CompositingRecord) -> String {
    let mut out =
        String::from("sub_scanlines,scale,error,low,high,off_by_a_step,segments,bytes,scan_seconds,draw_seconds\n");
    for r in record.edges.iter().chain(&record.scaled) {
        let [low, high] = r.error.interval;
        out += &format!(
            "{},{},{},{low},{high},{},{},{},{},{}\n",
            r.sub_scanlines,
            r.scale,
            r.error.value,
            r.off_by_a_step,
            r.segments,
            r.bytes,
            r.scan_seconds,
            r.draw_seconds
        );
    }
    out
}

fn lights(record: &CompositingRecord) -> String {
    let mut out = String::from(
        "light,kind,points,lit,penumbra,dark,error,noise,with_error,mean_squared_t,worst_t,allowed_t,surely_off,within,\
         point_seconds,judge_point_seconds\n",
    );
    for r in &record.lights {
        let name = r.name.replace('"', "\"\"");
        out += &format!(
            "\"{name}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
            r.kind,
            r.points,
            r.lit,
            r.penumbra,
            r.dark,
            r.error,
            r.noise,
            r.with_error,
            r.mean_squared_t.map_or(String::new(), |t| t.to_string()),
            r.worst_t,
            r.allowed_t,
            r.surely_off,
            r.within,
            r.point_seconds,
            r.judge_point_seconds
        );
    }
    out
}

/// Pictures of radiances as one eye sees them, adapted to the judge's; edges on a linear scale.
fn pictures(stage: &Stage, audited: &Audited, args: &CompositingArgs) -> Vec<CompositingPicture> {
    let photometry = &stage.photometry;
    let bands = photometry.bands.len();
    let luminance =
        |values: &[f64]| -> Vec<f64> { values.chunks(bands).map(|l| PI * photometry.luminance(l)).collect() };
    let by_rays = luminance(&audited.rays.mean);
    let seen = Seen { shares: vec![1.0 / by_rays.len() as f64; by_rays.len()] };
    let viewer = args.viewing.onlooker(Operator::default()).look(&seen, &by_rays, &vec![false; by_rays.len()]);
    let eye = ToneMap::new(viewer, photometry);
    let of = |values: &[f64]| values.iter().map(|v| *v as f32).collect::<Vec<f32>>();
    let picture =
        |name: &str, title: &str, raster: Raster| CompositingPicture { name: name.into(), title: title.into(), raster };
    let ([w, h], [we, he]) = (audited.rays.size, audited.edges_by_rays.size);
    let mut all = vec![
        picture("shaded", "From sub-scanlines", paint_radiances(w, h, bands, &of(&audited.shaded.values), &eye)),
        picture("rays", "By rays alone", paint_radiances(w, h, bands, &of(&audited.rays.mean), &eye)),
        picture("off", "The difference in luminance: red too bright, blue too dark, full at half the mean", {
            off([w, h], &luminance(&audited.shaded.values), &by_rays)
        }),
    ];
    let flat = luminance(&audited.edges_by_rays.mean);
    let white = flat.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let linear = Exposure::fit(photometry, &[], &[], &[]).with_white(white);
    for (per_line, pixels) in &audited.edges {
        let title = format!("Edges at {per_line} sub-scanlines");
        let raster = paint_radiances(pixels.size[0], pixels.size[1], bands, &of(&pixels.values), &linear);
        all.push(picture(&format!("edges-{per_line}"), &title, raster));
    }
    let raster = paint_radiances(we, he, bands, &of(&audited.edges_by_rays.mean), &linear);
    all.push(picture("edges-rays", "Edges by rays", raster));
    all
}

/// Signed differences over half the judge's mean.
fn off([width, height]: [u32; 2], ours: &[f64], theirs: &[f64]) -> Raster {
    let mean = theirs.iter().sum::<f64>() / theirs.len() as f64;
    let unit = if mean > 0.0 { 0.5 * mean } else { 1.0 };
    let pixel = |(a, b): (&f64, &f64)| {
        let [r, g, b] = ColourMap::Diverging.colour((a - b) / unit).map(to_srgb8);
        [r, g, b, 255]
    };
    Raster { width, height, rgba: ours.iter().zip(theirs).flat_map(pixel).collect() }
}
