//! `etalon composite`: span files of one view in one.

use super::{inputs, spans};
use crate::cli::args::CompositeArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::compositing::{SpanImage, composite};
use crate::scene::Background;
use std::time::Instant;

pub fn run(args: &CompositeArgs, console: &Console) -> Result<u8, Failure> {
    spans::check_name(&args.output)?;
    // All are read before any is worked on: what is wrong is told at once.
    let mut images = Vec::new();
    for path in &args.files {
        let mut image = spans::read(path)?;
        if args.lighting.is_some() {
            // What the lighting file speaks of in the end need not agree before.
            image.appearance.lights.clear();
            (image.appearance.fog, image.appearance.background) = (None, Background::default());
        }
        images.push((path, image));
    }
    let begin = Instant::now();
    let mut all: Option<SpanImage> = None;
    for (path, image) in images {
        all = Some(match all {
            None => image,
            Some(sum) => composite(&sum, &image)
                .map_err(|e| Failure::input(format!("{}: {e}", path.display())).at(path.display().to_string()))?,
        });
    }
    let Some(mut all) = all else { return Err(Failure::input("name span files")) };
    if args.lighting.is_some() {
        let appearance = inputs::lighting(args.lighting.as_deref(), all.appearance.clone(), &all)?;
        all.relight(appearance);
    }
    let seconds = begin.elapsed().as_secs_f64();
    let (words, mut json) = spans::write(&args.output, &all)?;
    json["seconds"] = seconds.into();
    console.result(&words, &json);
    Ok(exit::DONE)
}
