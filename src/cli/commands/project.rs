//! `etalon project`: the world from a point, laid out; one layout from another; Omnimax pictures [G86 fig. 11].

mod from_picture;
mod from_scene;
mod sky;
mod turning;

use super::{drawn, inputs};
use crate::cli::args::{LayoutChoice, ProjectArgs, ToneChoice};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::raycast::KernelKind;
use crate::world::{Layout, Shape};
use drawn::Drawn;
use serde_json::Value;
use std::path::Path;

/// Most texels of one map: three quarters of a gigabyte of numbers.
const MOST_TEXELS: u64 = 1 << 26;
/// Most samples where every texel shows more than one thing: two gigabytes of them.
const MOST_SAMPLES: u64 = 1 << 29;
/// Height of the largest diffuse map.
const LARGEST_TABLE: u32 = 256;

/// What comes of it, and what is said of it.
struct Made {
    drawn: Drawn,
    words: Vec<String>,
    json: Value,
}

pub fn run(args: &ProjectArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let ending = args.output.extension().map(|e| e.to_string_lossy().to_lowercase());
    let as_picture = match ending.as_deref() {
        Some("exr") => false,
        Some("png") => true,
        _ => {
            let message = format!("{}: name a .exr (numbers) or a .png (a picture)", args.output.display());
            return Err(Failure::input(message).at(args.output.display().to_string()));
        }
    };
    check(args)?;
    inputs::check_writable(&args.output)?;
    let source = Path::new(&args.source);
    let is_picture = source.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr") || e.eq_ignore_ascii_case("png"));
    let made = match is_picture {
        true => from_picture::made(args, source)?,
        false => from_scene::made(args, kernel, console)?,
    };
    let (bytes, more) =
        if as_picture { made.drawn.png(args.tone, &args.viewing)? } else { (made.drawn.exr()?, Vec::new()) };
    inputs::write(&args.output, &bytes)?;
    let [width, height] = made.drawn.size();
    let mut json = made.json;
    json["file"] = Value::String(args.output.display().to_string());
    json["width"] = width.into();
    json["height"] = height.into();
    let mut words = vec![format!("{}: {width} x {height} pixels", args.output.display())];
    words.extend(made.words);
    words.extend(more);
    console.result(&words.join("\n"), &json);
    Ok(exit::DONE)
}

/// The layout asked for; `None` for perspective.
fn shape(args: &ProjectArgs) -> Option<Shape> {
    let layout = match args.layout {
        LayoutChoice::Cube => Layout::Cube,
        LayoutChoice::Latlong => Layout::LatLong,
        LayoutChoice::SineLatlong => Layout::SineLatLong,
        LayoutChoice::Fisheye => Layout::Fisheye { field: args.field.unwrap_or(180.0) },
        LayoutChoice::Perspective => return None,
    };
    Some(Shape { layout, size: args.size })
}

fn check(args: &ProjectArgs) -> Result<(), Failure> {
    let field = args.field.unwrap_or(90.0);
    let allowed = match args.layout {
        LayoutChoice::Fisheye => field > 0.0 && field <= 360.0,
        LayoutChoice::Perspective => field > 0.0 && field < 175.0,
        _ if args.field.is_some() => {
            return Err(Failure::input("--field is for --layout fisheye and perspective: leave it out"));
        }
        _ => true,
    };
    if !allowed {
        return Err(Failure::input(
            "--field must lie above 0 and at 360 degrees at most for a fish-eye, below 175 for a perspective",
        ));
    }
    if args.turning_to.is_some() && args.layout != LayoutChoice::Perspective {
        return Err(Failure::input("--turning-to is for --layout perspective: leave it out"));
    }
    if args.diffuse && args.layout != LayoutChoice::Latlong {
        return Err(Failure::input("--diffuse is stored in latitude-longitude: add --layout latlong --size 20"));
    }
    if args.diffuse && args.size > LARGEST_TABLE {
        return Err(Failure::input(format!(
            "--diffuse: light by normal has nothing fine in it; choose a --size of at most {LARGEST_TABLE} (20 is usual)"
        )));
    }
    if matches!(args.tone, ToneChoice::Linear) {
        return Err(Failure::input("--tone linear: write an .exr, which holds the numbers themselves"));
    }
    let side = u64::from(args.samples) * u64::from(args.samples);
    let height = u64::from(args.size);
    let texels = shape(args).map_or((4 * height).div_ceil(3) * height, |s| s.texels() as u64);
    let cube = args.from_cube.map_or(0, |n| 6 * u64::from(n) * u64::from(n));
    for (option, n, texels) in [("--size", args.size, texels), ("--from-cube", args.from_cube.unwrap_or(0), cube)] {
        if texels > MOST_TEXELS || texels * side > MOST_SAMPLES {
            return Err(Failure::input(format!(
                "{option} {n}: {} texels of up to {side} samples each are more than {} or {} samples; choose a smaller \
                 size or fewer --samples",
                inputs::thousands(texels),
                inputs::thousands(MOST_TEXELS),
                inputs::thousands(MOST_SAMPLES)
            )));
        }
    }
    Ok(())
}
