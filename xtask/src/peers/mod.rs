//! `cargo xtask peers`: whatever computes form factors on this machine, beside `etalon`, in one run.
//!
//! The programs are run and their matrices judged by `xtask/peers/run.py`, since most peers are Python packages. Here
//! is what surrounds it: scenes, exact values kept in the target folder, the table and the plot.

mod plot;
mod table;
mod urban;

use crate::{Stopped, cargo, etalon, run, target, workspace};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const HELP: &str = "\
cargo xtask peers [--scenes DIR] [--cases A,B] [--python PROGRAM] [--view3d PROGRAM] [--tools A,B]
                  [--repeats K] [--max-time SECONDS] [--quick] [-o DIR]
  --scenes     folder of scenes (default: ../shared/peers beside the project)
  --cases      scenes of it (default: cube-384,cube-1536,cube-box-480,cube-boxes-8)
  --python     a Python that has numpy, and the peers that are to run (default: python3)
  --view3d     the executable of View3D, where it is not on the PATH as view3d
  --tools      only these: etalon, View3D, pyviewfactor, raystrack, Mitsuba, embreex + numpy
  --repeats    runs of which the median time is taken (default: 3), fewer where --max-time (60) is over
  --quick      slow tools with few rays only
  -o           folder of table.csv, table.md and error-against-time.svg (default: reports/peers)
cargo xtask peers --urban [--facets N] [-o FILE]
  writes a block of houses of about N facets (default: 22000) as a scene to time, into the target folder";

/// What was asked for.
struct Plan {
    scenes: PathBuf,
    cases: Vec<String>,
    python: PathBuf,
    output: Option<PathBuf>,
    urban: bool,
    facets: usize,
    passed_on: Vec<String>,
}

impl Plan {
    fn read(arguments: &[String]) -> Result<Self, Stopped> {
        let mut plan = Self {
            scenes: workspace().join("../shared/peers"),
            cases: ["cube-384", "cube-1536", "cube-box-480", "cube-boxes-8"].map(String::from).to_vec(),
            python: "python3".into(),
            output: None,
            urban: false,
            facets: 22_000,
            passed_on: Vec::new(),
        };
        let mut rest = arguments.iter();
        while let Some(word) = rest.next() {
            let mut value = || rest.next().cloned().ok_or_else(|| Stopped(format!("{word} needs a value")));
            match word.as_str() {
                "--scenes" => plan.scenes = value()?.into(),
                "--cases" => plan.cases = value()?.split(',').map(String::from).collect(),
                "--python" => plan.python = value()?.into(),
                "-o" | "--output" => plan.output = Some(value()?.into()),
                "--urban" => plan.urban = true,
                "--facets" => plan.facets = number(word, &value()?)?,
                "--quick" => plan.passed_on.push(word.clone()),
                "--repeats" => plan.passed_on.extend([word.clone(), number(word, &value()?)?.to_string()]),
                "--max-time" | "--view3d" | "--tools" => plan.passed_on.extend([word.clone(), value()?]),
                _ => return Err(Stopped(format!("'{word}' is no option of peers\n{HELP}"))),
            }
        }
        Ok(plan)
    }
}

fn number(option: &str, text: &str) -> Result<usize, Stopped> {
    text.parse()
        .ok()
        .filter(|&n| n > 0)
        .ok_or_else(|| Stopped(format!("{option} takes a number above 0, not '{text}'")))
}

/// Runs the task.
///
/// # Errors
/// An option that is not known, a build or helper that fails, a file that cannot be written.
pub fn peers(arguments: &[String]) -> Result<(), Stopped> {
    if arguments.iter().any(|a| a == "--help" || a == "-h") {
        println!("{HELP}");
        return Ok(());
    }
    let plan = Plan::read(arguments)?;
    if plan.urban {
        return write_urban(&plan);
    }
    run(cargo().args(["build", "--release", "--locked", "--package", "etalon", "--package", "xtask"]))?;
    let folder = plan.output.clone().unwrap_or_else(|| workspace().join("reports/peers"));
    let cache = target().join("peers");
    for made in [&folder, &cache] {
        fs::create_dir_all(made).map_err(|e| at(made, e))?;
    }
    let csv = cache.join(format!("table-{}.csv", std::process::id()));
    for case in &plan.cases {
        let scene = plan.scenes.join(format!("{case}.toml"));
        if scene.is_file() {
            run(&mut helper(&plan, &scene, &csv, &cache))?;
        } else {
            eprintln!("xtask: {case} left out: there is no {}", scene.display());
        }
    }
    let text = fs::read_to_string(&csv).map_err(|_| Stopped("no scene was run; --scenes names their folder".into()))?;
    fs::remove_file(&csv).map_err(|e| at(&csv, e))?;
    publish(&folder, &text)
}

fn helper(plan: &Plan, scene: &Path, csv: &Path, cache: &Path) -> Command {
    let mut command = Command::new(&plan.python);
    command.arg(workspace().join("xtask/peers/run.py")).arg(scene);
    command.arg("--etalon").arg(etalon().get_program());
    command.arg("--xtask").arg(target().join("release").join("xtask"));
    command.arg("--cache").arg(cache).arg("--output").arg(csv).args(&plan.passed_on);
    command
}

/// Writes the table as CSV and Markdown, and the plot.
fn publish(folder: &Path, csv: &str) -> Result<(), Stopped> {
    let rows = table::read(csv).map_err(Stopped)?;
    let files = [
        ("table.csv", csv.to_owned()),
        ("table.md", table::markdown(&rows)),
        ("error-against-time.svg", plot::svg(&rows)),
    ];
    for (name, text) in files {
        let file = folder.join(name);
        fs::write(&file, text).map_err(|e| at(&file, e))?;
    }
    println!("{}", table::markdown(&rows));
    println!("{}", folder.join("error-against-time.svg").display());
    Ok(())
}

fn write_urban(plan: &Plan) -> Result<(), Stopped> {
    let file = plan.output.clone().unwrap_or_else(|| target().join("peers").join("urban-block.toml"));
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(|e| at(folder, e))?;
    }
    let (text, facets) = urban::scene(plan.facets);
    fs::write(&file, text).map_err(|e| at(&file, e))?;
    println!("{facets} facets: {}", file.display());
    println!("time it with: etalon form-factors {} --estimator rays -o factors.npz", file.display());
    Ok(())
}

fn at(path: &Path, e: std::io::Error) -> Stopped {
    Stopped(format!("{}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_are_not_known_or_lack_a_value_are_refused() {
        let told = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|w| (*w).to_owned()).collect();
            Plan::read(&words).err().map(|Stopped(m)| m).unwrap_or_default()
        };
        assert!(told(&["--fast"]).starts_with("'--fast' is no option of peers"));
        assert_eq!(told(&["--scenes"]), "--scenes needs a value");
        assert_eq!(told(&["--facets", "0"]), "--facets takes a number above 0, not '0'");
        assert_eq!(told(&["--quick", "--repeats", "5"]), "");
    }
}
