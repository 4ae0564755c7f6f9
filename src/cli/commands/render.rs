//! `etalon render`: pictures of a solution or a reference.

mod layers;
mod natural;
mod picture;
mod series;
mod subject;
mod target;

use super::inputs;
use crate::cli::args::{OnOff, RenderArgs, RenderStyle, ToneChoice};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::image::png;
use crate::raycast::KernelKind;
use crate::render::{Raster, Visibility};
use crate::view::Operator;
use natural::Shown;
use picture::Painter;
use serde_json::{Value, json};
use series::series;
use subject::Subject;
use target::{Target, cameras};

/// Most samples of one picture: half a gigabyte of them.
const MOST_SAMPLES: u64 = 1 << 27;

/// The options of a picture, checked against each other.
struct Look<'a> {
    style: RenderStyle,
    tone: ToneChoice,
    caption: bool,
    args: &'a RenderArgs,
}

pub fn run(args: &RenderArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let target = Target::of(&args.output)?;
    let look = Look::of(args, &target)?;
    let subject = Subject::read(args, look.style == RenderStyle::Items, console)?;
    let painter = Painter::new(&subject, &look)?;
    let session = inputs::session(&subject.stage, kernel, console)?;
    let cameras = cameras(&session.tracer(), args, &target, console)?;
    for (camera, _) in &cameras {
        check_samples(camera.size, args.samples)?;
    }
    let stems = target::stems(&cameras);
    // All pictures are made before the first is written.
    let (mut files, mut shown, mut words) = (Vec::new(), Vec::new(), Vec::new());
    for ((camera, fitted), stem) in cameras.iter().zip(stems) {
        let visibility = Visibility::cast(&session.tracer(), camera, look.samples());
        let path = target.path(&stem);
        let made = Made::of(&visibility, &painter, &subject, &target, &look)?;
        let mut json = json!({
            "camera": camera.name, "fitted": fitted, "file": path, "width": made.size[0], "height": made.size[1],
        });
        json[if args.lamp.len() > 1 { "lamps" } else { "tone" }] = made.json;
        shown.push(json);
        words.extend(made.words.into_iter().filter(|w| !words.contains(w)).collect::<Vec<_>>());
        files.push((path, made.bytes));
    }
    target.write(&files)?;
    let json = summary(&subject, &look, &painter, shown);
    words.extend(Some(painter.words(None)).filter(|w| !w.is_empty()));
    console.result(&text(&json, &words), &json);
    Ok(exit::DONE)
}

/// A picture as a file.
struct Made {
    bytes: Vec<u8>,
    size: [u32; 2],
    /// What the colours mean.
    words: Vec<String>,
    json: Value,
}

impl Made {
    fn of(
        seen: &Visibility,
        painter: &Painter,
        subject: &Subject,
        target: &Target,
        look: &Look,
    ) -> Result<Self, Failure> {
        let bug = |e: crate::io::image::ImageError| Failure::input(e.to_string());
        let encoded = |r: &Raster| png(r.width, r.height, &r.rgba).map_err(bug);
        let args = look.args;
        if args.lamp.len() > 1 {
            let lamps: Vec<f64> = args.lamp.iter().map(|l| l.0).collect();
            let made = series(subject, look, seen, &lamps)?;
            let size = [made.raster.width, made.raster.height];
            return Ok(Self { bytes: encoded(&made.raster)?, size, words: made.words, json: Value::Array(made.json) });
        }
        let shown = painter.look(seen);
        let (words, json) = (shown.iter().map(Shown::words).collect(), json!(shown.as_ref().map(Shown::json)));
        if let Target::Exr(_) = target {
            let bytes = layers::exr_picture(subject, painter, seen, args.viewing.efficacy.0).map_err(bug)?;
            return Ok(Self { bytes, size: seen.size(), words: Vec::new(), json });
        }
        let raster = painter.paint(seen, shown.as_ref());
        Ok(Self { bytes: encoded(&raster)?, size: [raster.width, raster.height], words, json })
    }
}

impl<'a> Look<'a> {
    fn of(args: &'a RenderArgs, target: &Target) -> Result<Self, Failure> {
        let default = if args.quantity.is_some() { RenderStyle::Constant } else { RenderStyle::Smooth };
        let style = args.style.unwrap_or(default);
        let exr = matches!(target, Target::Exr(_));
        let refused = match (style, &args.quantity) {
            (RenderStyle::Items, Some(_)) => "--style items shows patches, not a quantity; leave one of the two out",
            (_, Some(_)) if exr => "an .exr holds the numbers themselves; leave --quantity out, or write a .png",
            _ if exr && args.caption == Some(OnOff::On) => "an .exr has no room for words; leave --caption out",
            _ if exr && args.lamp.len() > 1 => "an .exr holds one picture; give --lamp one luminance, or write a .png",
            (RenderStyle::Items, _) | (_, Some(_)) if args.lamp.len() > 1 => {
                "a series of lamps is shown in natural colours; leave --style items and --quantity out"
            }
            _ if args.exposure.is_some_and(|e| !e.is_finite() || e.abs() > 64.0) => {
                "--exposure must lie between -64 and 64 stops"
            }
            _ if args.white.is_some_and(|w| !(w > 0.0 && w.is_finite())) => {
                "--white must be a luminance above 0, in W/m^2"
            }
            _ => "",
        };
        if !refused.is_empty() {
            return Err(Failure::input(refused));
        }
        let linear = args.exposure.is_some() || args.white.is_some();
        let tone = match args.tone {
            Some(ToneChoice::Operator(o)) if linear => {
                return Err(Failure::input(format!(
                    "--tone {} sets its own exposure; leave --exposure and --white out, or use --tone linear",
                    o.name()
                )));
            }
            Some(tone) => tone,
            None if linear => ToneChoice::Linear,
            None => ToneChoice::Operator(Operator::default()),
        };
        let wordy = style == RenderStyle::Both || args.quantity.is_some();
        Ok(Self { style, tone, caption: args.caption.map_or(wordy, |c| c == OnOff::On), args })
    }

    /// The item buffer is exact: one sample in the middle of each pixel.
    fn samples(&self) -> u32 {
        if self.style == RenderStyle::Items { 1 } else { self.args.samples }
    }
}

fn check_samples([width, height]: [u32; 2], side: u32) -> Result<(), Failure> {
    let samples = u64::from(width) * u64::from(height) * u64::from(side * side);
    if samples <= MOST_SAMPLES {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{width} x {height} pixels of {} samples each are {} samples, more than {}; choose a smaller --size or fewer \
         --samples",
        side * side,
        inputs::thousands(samples),
        inputs::thousands(MOST_SAMPLES)
    )))
}

fn summary(subject: &Subject, look: &Look, painter: &Painter, pictures: Vec<Value>) -> Value {
    let style = match look.style {
        RenderStyle::Smooth => "smooth",
        RenderStyle::Constant => "constant",
        RenderStyle::Both => "both",
        RenderStyle::Items => "items",
    };
    let range = painter.scale().map(|s| json!({ "low": s.low(), "high": s.high, "beyond": s.beyond }));
    json!({
        "scene": subject.stage.name, "scene_hash": subject.stage.hash(), "shown": subject.name, "style": style,
        "quantity": look.args.quantity.as_ref().map(ToString::to_string),
        "per": if look.args.per == PerLevel::Element { "element" } else { "patch" },
        "samples_per_pixel": look.samples() * look.samples(), "range": range,
        "pictures": pictures,
    })
}

fn text(json: &Value, words: &[String]) -> String {
    let word = |v: &Value| v.as_str().unwrap_or_default().to_string();
    let lines = json["pictures"].as_array().into_iter().flatten().map(|p| {
        format!("{}: {} x {} pixels, written to {}", word(&p["camera"]), p["width"], p["height"], word(&p["file"]))
    });
    lines.chain(words.iter().cloned()).collect::<Vec<_>>().join("\n")
}
