//! `etalon converge diff`: two runs overlaid.

use super::converge::{check_confidence, tell, unreadable};
use super::told::quoted;
use crate::cli::args::ConvergeDiffArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{FileError, atomic};
use crate::report::curves::{
    About, CURVES_NAME, DifferenceReport, difference_files, difference_json, difference_text, read_curves,
};
use crate::report::save;
use crate::study::converge::{Curve, diff};
use std::path::Path;

pub fn run(args: &ConvergeDiffArgs, console: &Console) -> Result<u8, Failure> {
    check_confidence(args.confidence.0)?;
    atomic::check_folder(&args.output)?;
    let curves = [read(&args.first)?, read(&args.second)?];
    let differences = diff(&curves[0], &curves[1]);
    if differences.is_empty() {
        let list = |run: &[Curve]| {
            let mut names: Vec<&str> = run.iter().map(|c| c.method.as_str()).collect();
            names.dedup();
            names.join("; ")
        };
        return Err(Failure::input(format!(
            "{} and {} have no curve in common that can be compared: the first has {}, the second {}; run both with \
             a method and a state of the same name",
            args.first.display(),
            args.second.display(),
            list(&curves[0]),
            list(&curves[1])
        )));
    }
    let names = [&args.first, &args.second].map(|p| p.display().to_string());
    let paths = [&args.first, &args.second, &args.output].map(|p| quoted(&p.display().to_string()));
    let about = About {
        scene: names.join(" and "),
        confidence: args.confidence.0,
        settings: vec![("--confidence".into(), args.confidence.0.to_string())],
        replay: format!("etalon converge diff {} {} -o {}", paths[0], paths[1], paths[2]),
        ..About::default()
    };
    let report = DifferenceReport { about, names, curves, differences };
    save(&args.output, &difference_files(&report)?)?;
    tell(&args.output, &difference_text(&report), difference_json(&report), console);
    Ok(exit::DONE)
}

fn read(folder: &Path) -> Result<Vec<Curve>, Failure> {
    let path = folder.join(CURVES_NAME);
    let bytes = std::fs::read(&path).map_err(|e| {
        FileError::system(&path, "read", &e).mend("DIR is a folder that `etalon converge SCENE -o DIR` wrote")
    })?;
    read_curves(&bytes).map_err(|(place, problem)| unreadable(&path, place, problem).into())
}
