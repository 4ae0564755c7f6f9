//! `etalon shade`: a picture from a span file.

use super::drawn::{Drawn, Kind};
use super::{inputs, lit, spans};
use crate::cli::args::{ShadeArgs, ToneChoice};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::StateChoice;
use crate::compositing::{DeepPicture, Diffuse, ShadeOptions, Shaded, SpanImage, deep, shade};
use crate::io::{DeepPixel, DeepSample, deep_exr};
use crate::math::{DVec3, centroid};
use crate::scene::{Appearance, Light, LightShape, Stage};
use crate::solution::Radiosity;
use crate::study::Receivers;
use crate::study::compositing::Solved;
use crate::view::Photometry;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;
use std::time::Instant;

/// Stands for all surfaces that emit, in `--light`.
const EMITTERS: &str = "emitters";

pub fn run(args: &ShadeArgs, console: &Console) -> Result<u8, Failure> {
    let as_picture = ending(args)?;
    inputs::check_writable(&args.output)?;
    let mut image = spans::read(&args.file)?;
    let solved = solution(args, &image, console)?;
    let appearance = inputs::lighting(args.lighting.as_deref(), image.appearance.clone(), &image)?;
    let (appearance, notes) = lights(args, &image, appearance, solved.as_ref().map(|s| &s.0))?;
    notes.iter().for_each(|n| console.notice(n));
    let begin = Instant::now();
    image.relight(appearance);
    let diffuse = match &solved {
        Some((stage, radiosity)) => Some(diffuse(stage, radiosity, &image)?),
        None => None,
    };
    let options = ShadeOptions {
        scale: [args.scale_x, args.scale_y],
        diffuse: diffuse.as_ref().map(|d| d as &dyn Diffuse),
        trace: !args.no_trace,
        shadows: !args.no_shadows,
        shadow_memory: (args.shadow_memory as usize) << 20,
        ..ShadeOptions::default()
    };
    if args.deep {
        return write_deep(args, &image, &deep(&image, &options)?, begin, console);
    }
    let shaded = shade(&image, &options)?;
    let seconds = begin.elapsed().as_secs_f64();
    let drawn = drawn(&image, &shaded);
    let (bytes, more) = if as_picture { drawn.png(args.tone, &args.viewing)? } else { (drawn.exr()?, Vec::new()) };
    inputs::write(&args.output, &bytes)?;
    let mut words = told(args, &image, &shaded);
    words.extend(more);
    console.result(&words.join("\n"), &summary(args, &image, &shaded, seconds));
    Ok(exit::DONE)
}

fn ending(args: &ShadeArgs) -> Result<bool, Failure> {
    let ending = args.output.extension().map(|e| e.to_string_lossy().to_lowercase());
    if matches!(args.tone, ToneChoice::Linear) && ending.as_deref() != Some("exr") {
        return Err(Failure::input("--tone linear: write an .exr, which holds the numbers themselves"));
    }
    match ending.as_deref() {
        Some("png") if args.deep => Err(Failure::input(format!("{}: --deep writes an .exr", args.output.display()))),
        Some("exr") => Ok(false),
        Some("png") => Ok(true),
        _ => {
            let message = format!("{}: name a .exr (numbers) or a .png (a picture)", args.output.display());
            Err(Failure::input(message).at(args.output.display().to_string()))
        }
    }
}

/// The scene of a solution, and its radiosities.
fn solution(args: &ShadeArgs, image: &SpanImage, console: &Console) -> Result<Option<(Stage, Radiosity)>, Failure> {
    let (Some(file), Some(scene)) = (&args.solution, &args.scene) else { return Ok(None) };
    let (scene, _) = inputs::scene_with_look(scene, args.max_edge, console)?;
    let stage = inputs::stage_of(&scene, args.state.unwrap_or(StateChoice::Final))?;
    if stage.photometry != image.photometry {
        return Err(Failure::input(format!(
            "{}: its bands are not those of the scene that --solution belongs to",
            args.file.display()
        )));
    }
    let radiosity = lit::solution(file, &stage, &Receivers::patches(&stage), false)?;
    Ok(Some((stage, radiosity)))
}

fn diffuse<'a>(stage: &'a Stage, radiosity: &Radiosity, image: &SpanImage) -> Result<Solved<'a>, Failure> {
    let solved = Solved::new(stage, radiosity);
    match solved.missing(image) {
        None => Ok(solved),
        Some(surface) => Err(Failure::input(format!(
            "surface \"{surface}\" of the span file is not the same in the scene of the solution: name the scene (and the \
             --state) that was scanned"
        ))
        .at(surface)),
    }
}

/// The lights that shine, and what is to be said of those that do not.
fn lights(
    args: &ShadeArgs,
    image: &SpanImage,
    mut appearance: Appearance,
    stage: Option<&Stage>,
) -> Result<(Appearance, Vec<String>), Failure> {
    let mut notes = Vec::new();
    let told = SpanImage { appearance: appearance.clone(), lines: Vec::new(), ..image.clone() };
    let emitters = if stage.is_some() { Vec::new() } else { told.emitters() };
    let mut names: Vec<&str> = appearance.lights.iter().chain(&emitters).map(|l| l.name.as_str()).collect();
    names.push(EMITTERS);
    if let Some(unknown) = args.light.iter().find(|l| !names.contains(&l.as_str())) {
        return Err(Failure::input(format!("there is no light \"{unknown}\"; there are: {}", names.join(", "))));
    }
    let asked = |name: &str| args.light.is_empty() || args.light.iter().any(|l| l == name);
    let emitters: Vec<Light> = emitters.into_iter().filter(|l| asked(EMITTERS) || asked(&l.name)).collect();
    appearance.lights.retain(|l| asked(&l.name));
    if let Some(stage) = stage {
        // The solution holds them: once is enough.
        let held: Vec<String> =
            appearance.lights.iter().filter(|l| solved_already(stage, l)).map(|l| l.name.clone()).collect();
        appearance.lights.retain(|l| !solved_already(stage, l));
        if !held.is_empty() {
            notes.push(format!("in the solution already, and not added again: {}", held.join(", ")));
        }
    }
    appearance.lights.extend(emitters);
    let dark = appearance.lights.is_empty() && stage.is_none();
    if dark && image.materials.iter().all(|m| m.emission.iter().all(|e| *e <= 0.0)) {
        notes.push("there is no light: give --lighting FILE, or --solution and --scene".into());
    }
    Ok((appearance, notes))
}

/// True if radiosities of a stage hold a light: one of its point lights, or faces of it that emit.
fn solved_already(stage: &Stage, light: &Light) -> bool {
    let near = |a: DVec3, b: DVec3| a.distance(b) <= 1e-9 * (1.0 + b.length());
    let emits = |polygon: &Vec<DVec3>| {
        let middle = centroid(polygon);
        let of = |f: &crate::scene::Facet| {
            near(centroid(&f.vertices), middle) && stage.emission(f.first_patch as usize).iter().any(|e| *e > 0.0)
        };
        stage.facets.iter().any(of)
    };
    match &light.shape {
        LightShape::Point { position, curve: None, .. } => {
            stage.lights.iter().any(|l| near(l.position, *position) && l.intensity == light.strength)
        }
        LightShape::Area { polygon } => emits(polygon),
        LightShape::Polyhedron { faces } => faces.iter().any(emits),
        _ => false,
    }
}

/// A deep picture: three bands as red, green and blue, else the luminance in all three.
fn write_deep(
    args: &ShadeArgs,
    image: &SpanImage,
    picture: &DeepPicture,
    begin: Instant,
    console: &Console,
) -> Result<u8, Failure> {
    let rgb = |radiance: &[f64]| match radiance {
        [r, g, b] => [*r as f32, *g as f32, *b as f32],
        other => [image.photometry.luminance(other) as f32; 3],
    };
    let sample = |s: &crate::compositing::DeepSample| DeepSample {
        z: s.depth[0] as f32,
        z_back: s.depth[1] as f32,
        alpha: s.alpha as f32,
        rgb: rgb(&s.radiance),
    };
    let pixels: Vec<DeepPixel> =
        picture.pixels.iter().map(|p| DeepPixel { samples: p.iter().map(sample).collect() }).collect();
    let [width, height] = picture.size;
    let bytes =
        deep_exr(width, height, &pixels, "radiance times opacity, W/(m^2 sr); Z in metres along the viewing direction")
            .map_err(|e| Failure::input(e.to_string()))?;
    inputs::write(&args.output, &bytes)?;
    let samples: usize = picture.pixels.iter().map(Vec::len).sum();
    let seconds = begin.elapsed().as_secs_f64();
    let words = format!("{}: {width} x {height} pixels, {samples} samples", args.output.display());
    let json = json!({ "file": args.output, "width": width, "height": height, "samples": samples, "seconds": seconds });
    console.result(&words, &json);
    Ok(exit::DONE)
}

fn drawn(image: &SpanImage, shaded: &Shaded) -> Drawn {
    let share = 1.0 / shaded.covered.len() as f64;
    let luminance = |l: &[f64]| PI * image.photometry.luminance(l);
    Drawn {
        kind: Kind::Flat(shaded.radiance.size, shaded.radiance.values.iter().map(|v| *v as f32).collect()),
        photometry: Photometry::clone(&image.photometry),
        adapts_to: shaded.radiance.values.chunks(shaded.radiance.bands).map(|l| (luminance(l), share, false)).collect(),
        comments: "radiance, W/(m^2 sr) per band".into(),
        is_irradiance: false,
        more: Vec::new(),
    }
}

fn told(args: &ShadeArgs, image: &SpanImage, shaded: &Shaded) -> Vec<String> {
    let [width, height] = shaded.radiance.size;
    let lights: Vec<&str> = image.appearance.lights.iter().map(|l| l.name.as_str()).collect();
    let lights = if lights.is_empty() { "no lights".into() } else { format!("under {}", lights.join(", ")) };
    vec![
        format!("{}: {width} x {height} pixels, {lights}", args.output.display()),
        format!(
            "traced: {:.1} % of the pixels; shadow volumes: {:.1} MiB at most, {} passes",
            100.0 * shaded.traced,
            shaded.shadow_bytes as f64 / f64::from(1 << 20),
            shaded.passes
        ),
    ]
}

fn summary(args: &ShadeArgs, image: &SpanImage, shaded: &Shaded, seconds: f64) -> Value {
    let [width, height] = shaded.radiance.size;
    let lights: Vec<&str> = image.appearance.lights.iter().map(|l| l.name.as_str()).collect();
    json!({
        "file": args.output, "width": width, "height": height, "lights": lights,
        "traced_share": shaded.traced, "shadow_bytes": shaded.shadow_bytes, "passes": shaded.passes,
        "solution": args.solution.as_deref().map(Path::display).map(|d| d.to_string()), "seconds": seconds,
    })
}
