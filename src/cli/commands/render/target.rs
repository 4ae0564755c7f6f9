//! Where pictures go, and through which cameras they are taken.

use crate::cli::args::RenderArgs;
use crate::cli::commands::inputs;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::io::atomic;
use crate::raycast::Tracer;
use crate::render::{fit_camera, resized};
use crate::view::Camera;
use std::path::{Path, PathBuf};

/// Where pictures go.
#[derive(Debug, PartialEq)]
pub(super) enum Target {
    /// One picture.
    Png(PathBuf),
    /// One picture, as numbers.
    Exr(PathBuf),
    /// A picture for each camera.
    Folder(PathBuf),
}

impl Target {
    /// Told by the ending; what exists as a folder, or has no ending, is a folder.
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            _ if path.is_dir() => Ok(Self::Folder(path.into())),
            Some("png") => inputs::check_writable(path).map(|()| Self::Png(path.into())),
            Some("exr") => inputs::check_writable(path).map(|()| Self::Exr(path.into())),
            None if !path.exists() => Ok(Self::Folder(path.into())),
            _ => {
                let message = format!("{}: name a .png, an .exr, or a folder", path.display());
                Err(Failure::input(message).at(path.display().to_string()))
            }
        }
    }

    /// The file for a camera.
    pub(super) fn path(&self, stem: &str) -> PathBuf {
        match self {
            Self::Png(path) | Self::Exr(path) => path.clone(),
            Self::Folder(folder) => folder.join(format!("{stem}.png")),
        }
    }

    /// Writes the files, making the folder where there is none.
    pub(super) fn write(&self, files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
        if let Self::Folder(folder) = self {
            atomic::create_folder(folder).map_err(|e| Failure::from(e).at(folder.display().to_string()))?;
        }
        files.iter().try_for_each(|(path, bytes)| inputs::write(path, bytes))
    }
}

/// The cameras asked for, each with whether it was fitted, at the size asked for.
pub(super) fn cameras(
    tracer: &Tracer,
    args: &RenderArgs,
    target: &Target,
    console: &Console,
) -> Result<Vec<(Camera, bool)>, Failure> {
    let own = &tracer.stage().cameras;
    let names = || own.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
    let chosen: Vec<(Camera, bool)> = match &args.camera {
        Some(name) => match own.iter().find(|c| c.name == *name) {
            Some(camera) => vec![(camera.clone(), false)],
            None if own.is_empty() => {
                return Err(Failure::input(format!(
                    "there is no camera \"{name}\": the scene has none; leave --camera out and one is fitted"
                )));
            }
            None => return Err(Failure::input(format!("there is no camera \"{name}\"; the scene has {}", names()))),
        },
        None if own.is_empty() => {
            console.notice("the scene has no camera; one was fitted");
            vec![(fit_camera(tracer), true)]
        }
        None if matches!(target, Target::Folder(_)) => own.iter().map(|c| (c.clone(), false)).collect(),
        None => {
            if own.len() > 1 {
                console.notice(&format!(
                    "through camera \"{}\", the first of {}; --camera chooses, -o FOLDER takes them all",
                    own[0].name,
                    names()
                ));
            }
            vec![(own[0].clone(), false)]
        }
    };
    let sized = |(camera, fitted): (Camera, bool)| match args.size {
        Some(size) => (resized(&camera, fitted, size.0), fitted),
        None => (camera, fitted),
    };
    Ok(chosen.into_iter().map(sized).collect())
}

/// File-name stems: the camera's name where it is safe, made different where two are alike.
pub(super) fn stems(cameras: &[(Camera, bool)]) -> Vec<String> {
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let mut stems: Vec<String> = Vec::new();
    for (k, (camera, _)) in cameras.iter().enumerate() {
        let plain: String = camera.name.chars().take(60).map(safe).collect();
        let mut stem = if plain.is_empty() { "view".to_string() } else { plain };
        // File systems that ignore case must not merge two cameras.
        while stems.iter().any(|s| s.eq_ignore_ascii_case(&stem)) {
            stem = format!("{stem}-{}", k + 1);
        }
        stems.push(stem);
    }
    stems
}
