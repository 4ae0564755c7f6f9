//! `etalon setup embree`: finds an Embree 4, or fetches the pinned one into the user's data folder.

use crate::raycast::{EMBREE_VARIABLE, embree_folder, find_embree, use_embree};
use embree4_sys::{Library, Written};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::fmt;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A Python wheel that carries Embree and TBB, and what `pip` must be asked to get it.
struct Pin {
    os: &'static str,
    arch: &'static str,
    platform: &'static str,
    sha256: &'static str,
}

const PACKAGE: &str = "embreex==4.4.0";
const EMBREE_VERSION: &str = "4.4.0";
const PINS: [Pin; 4] = [
    Pin {
        os: "linux",
        arch: "x86_64",
        platform: "manylinux_2_28_x86_64",
        sha256: "8415d14c8956afec7eb05749f1e0bf396bb51efd566054ca169e10e4089e7bb7",
    },
    // Hashes of the same release for other systems; laid out alike, but not tried there by us.
    Pin {
        os: "macos",
        arch: "aarch64",
        platform: "macosx_13_0_arm64",
        sha256: "b2e69b777c0b7878e13ad8c31f4fecaddb5cd8633a5814c1ac11da2efe1065dc",
    },
    Pin {
        os: "macos",
        arch: "x86_64",
        platform: "macosx_13_0_x86_64",
        sha256: "96a187753f578cb685051f8fd679dc7986f887fcb922bb81a9924f5b89e941d8",
    },
    Pin {
        os: "windows",
        arch: "x86_64",
        platform: "win_amd64",
        sha256: "bfa54fb71cbb3a41c2366cabd09bb2dbbc8700843872f2c8655a3215a73459a7",
    },
];

/// What setup did.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SetupReport {
    /// True if a library was fetched, false if one was there.
    pub installed: bool,
    /// The library.
    pub path: PathBuf,
    /// Its version.
    pub version: String,
    /// What it writes behind a hit, in words.
    pub layout: String,
    /// The folder that was made, and with which it goes again.
    pub folder: Option<PathBuf>,
    /// SHA-256 of the wheel it came from.
    pub sha256: Option<String>,
    /// Libraries that were found before but cannot be used, and why.
    pub refused: Vec<String>,
}

/// Why there is still no Embree.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The user's own setting stands in the way.
    #[error("{EMBREE_VARIABLE} is set, so no other library would be used ({why}); unset it and run this again")]
    Overruled {
        /// What is wrong with the setting.
        why: String,
    },
    /// No pinned wheel.
    #[error(
        "no Embree is pinned for {platform}; install Embree 4 with the system's package manager, or from its releases \
         with EMBREE_DIR naming the folder"
    )]
    NoPin {
        /// Operating system and processor.
        platform: String,
    },
    /// The user has no data folder.
    #[error("there is no user data folder (is HOME set?)")]
    NoDataFolder,
    /// Neither `python3` nor `python` has pip.
    #[error("fetching Embree takes Python with pip, and there is none: {why}")]
    NoPip {
        /// What happened on trying.
        why: String,
    },
    /// Pip could not get the wheel.
    #[error("pip could not fetch {PACKAGE} (no network?): {why}")]
    NotFetched {
        /// The end of what pip says.
        why: String,
    },
    /// Not the file that was pinned.
    #[error("{file} is not the pinned file: its SHA-256 is {found}, not {expected}")]
    WrongHash {
        /// File name.
        file: String,
        /// What was pinned.
        expected: &'static str,
        /// What came.
        found: String,
    },
    /// The wheel cannot be unpacked.
    #[error("{file} cannot be unpacked: {why}")]
    NotUnpacked {
        /// File name.
        file: String,
        /// What is wrong.
        why: String,
    },
    /// The fetched library does not run here.
    #[error("the fetched library does not work on this machine: {why}")]
    NotWorking {
        /// What the loader or the probe says.
        why: String,
    },
    /// A file operation failed.
    #[error("cannot {doing} {path}: {source}")]
    File {
        /// What was tried.
        doing: &'static str,
        /// On what.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl SetupError {
    /// What still works.
    pub fn consolation() -> &'static str {
        "everything still works on the built-in kernel, several times slower and without a second kernel as witness"
    }
}

/// Finds an Embree 4, or fetches, checks and unpacks the pinned one.
///
/// # Errors
/// Every [`SetupError`].
pub fn setup_embree() -> Result<SetupReport, SetupError> {
    let search = find_embree();
    let refused: Vec<String> = search.refused.iter().map(|r| format!("{}: {}", r.path.display(), r.why)).collect();
    if let Some(library) = search.library {
        return Ok(report(library, refused, None));
    }
    if std::env::var_os(EMBREE_VARIABLE).is_some_and(|v| !v.is_empty()) {
        let why = if refused.is_empty() { format!("searched {}", search.looked_in) } else { refused.join("; ") };
        return Err(SetupError::Overruled { why });
    }
    let pin = pin_of_this_machine()?;
    let store = embree_folder().ok_or(SetupError::NoDataFolder)?;
    let folder = fetch(pin, &store)?;
    match use_embree(&library_in(&folder)?) {
        Ok(library) => Ok(report(library, refused, Some((folder, pin)))),
        Err(e) => {
            // What does not work would only be refused again by every later search.
            let _ = fs::remove_dir_all(&folder);
            Err(SetupError::NotWorking { why: e.to_string() })
        }
    }
}

fn report(library: &Library, refused: Vec<String>, installed: Option<(PathBuf, &Pin)>) -> SetupReport {
    SetupReport {
        installed: installed.is_some(),
        path: library.path().to_owned(),
        version: library.version().to_string(),
        layout: layout_in_words(library),
        sha256: installed.as_ref().map(|(_, pin)| pin.sha256.to_owned()),
        folder: installed.map(|(folder, _)| folder),
        refused,
    }
}

/// What the probe has seen, for people.
pub(super) fn layout_in_words(library: &Library) -> String {
    let words = |w: &Written| {
        let runs: Vec<String> = w.beyond.iter().map(|(a, b)| format!("{a}..{b}")).collect();
        let seen = if runs.is_empty() { "nothing".to_owned() } else { format!("bytes {}", runs.join(", ")) };
        format!("{seen} behind the {} known (room for {})", w.known, w.room)
    };
    let layout = library.layout();
    format!("a hit writes {}; eight hits {}", words(&layout.single), words(&layout.packet8))
}

impl fmt::Display for SetupReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for r in &self.refused {
            writeln!(f, "Not usable: {r}")?;
        }
        let what = if self.installed { "Installed" } else { "Found" };
        writeln!(f, "{what} Embree {}: {}", self.version, self.path.display())?;
        write!(f, "Checked: {}", self.layout)?;
        if let (Some(folder), Some(sha256)) = (&self.folder, &self.sha256) {
            write!(f, "\nFrom the Python wheel {PACKAGE}, SHA-256 {sha256}")?;
            write!(f, "\nTo remove it, delete the folder {}", folder.display())?;
        }
        Ok(())
    }
}

fn pin_of_this_machine() -> Result<&'static Pin, SetupError> {
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let pin = PINS.iter().find(|p| p.os == os && p.arch == arch);
    pin.ok_or_else(|| SetupError::NoPin { platform: format!("{os} on {arch}") })
}

/// Fetches the wheel and unpacks it into a folder of its own below `store`, which appears complete or not at all.
fn fetch(pin: &Pin, store: &Path) -> Result<PathBuf, SetupError> {
    fs::create_dir_all(store).map_err(at("make the folder", store))?;
    let work = tempfile::Builder::new().prefix(".fetch-").tempdir_in(store).map_err(at("make a folder in", store))?;
    let (wheels, contents) = (work.path().join("wheel"), work.path().join("contents"));
    download(pin, &wheels)?;
    let wheel = the_only_file(&wheels)?;
    check_hash(&wheel, pin)?;
    fs::create_dir(&contents).map_err(at("make the folder", &contents))?;
    unpack(&wheel, &contents)?;
    let folder = store.join(format!("embree-{EMBREE_VERSION}-{}", &pin.sha256[..8]));
    if folder.exists() {
        // Left from before and not usable, or it would have been found.
        fs::rename(&folder, work.path().join("old")).map_err(at("replace", &folder))?;
    }
    fs::rename(&contents, &folder).map_err(at("make the folder", &folder))?;
    Ok(folder)
}

/// An error maker for file operations.
fn at(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> SetupError {
    move |source| SetupError::File { doing, path: path.to_owned(), source }
}

/// Asks the first Python that has pip. Its own settings (index, proxy) apply.
fn download(pin: &Pin, to: &Path) -> Result<(), SetupError> {
    let mut why = Vec::new();
    for python in ["python3", "python"] {
        match Command::new(python).args(["-m", "pip", "--version"]).output() {
            Ok(o) if o.status.success() => return pip_download(python, pin, to),
            Ok(o) => why.push(format!("{python}: {}", last_lines(&o))),
            Err(e) => why.push(format!("{python}: {e}")),
        }
    }
    Err(SetupError::NoPip { why: why.join("; ") })
}

fn pip_download(python: &str, pin: &Pin, to: &Path) -> Result<(), SetupError> {
    let options = ["--no-deps", "--only-binary=:all:", "--python-version", "3.11", "--implementation", "cp"];
    let output = Command::new(python)
        .args(["-m", "pip", "--disable-pip-version-check", "download"])
        .args(options)
        .args(["--abi", "cp311", "--platform", pin.platform, "--dest"])
        .arg(to)
        .arg(PACKAGE)
        .output()
        .map_err(|e| SetupError::NoPip { why: format!("{python}: {e}") })?;
    if output.status.success() { Ok(()) } else { Err(SetupError::NotFetched { why: last_lines(&output) }) }
}

/// The end of what a program says: errors come last.
fn last_lines(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|l| !l.is_empty()).collect();
    lines[lines.len().saturating_sub(3)..].join(" / ")
}

fn the_only_file(folder: &Path) -> Result<PathBuf, SetupError> {
    let mut files = fs::read_dir(folder).map_err(at("read", folder))?.flatten().map(|e| e.path());
    match (files.next(), files.next()) {
        (Some(file), None) => Ok(file),
        _ => Err(SetupError::NotFetched { why: "pip did not leave exactly one file".to_owned() }),
    }
}

fn check_hash(wheel: &Path, pin: &Pin) -> Result<(), SetupError> {
    let bytes = fs::read(wheel).map_err(at("read", wheel))?;
    let found: String = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
    let right = found == pin.sha256;
    right.then_some(()).ok_or_else(|| SetupError::WrongHash { file: name_of(wheel), expected: pin.sha256, found })
}

/// Unpacks the libraries and the licence, without their folders.
fn unpack(wheel: &Path, to: &Path) -> Result<(), SetupError> {
    let bad = |e: &dyn fmt::Display| SetupError::NotUnpacked { file: name_of(wheel), why: e.to_string() };
    let file = File::open(wheel).map_err(at("open", wheel))?;
    let mut archive = zip::ZipArchive::new(file).map_err(|e| bad(&e))?;
    for i in 0..archive.len() {
        let mut entry = archive.by_index(i).map_err(|e| bad(&e))?;
        let Some(inside) = entry.enclosed_name().filter(|p| entry.is_file() && is_wanted(p)) else { continue };
        if let Some(name) = inside.file_name() {
            let path = to.join(name);
            let mut out = File::create(&path).map_err(at("write", &path))?;
            io::copy(&mut entry, &mut out).map_err(|e| bad(&e))?;
        }
    }
    let origin = to.join("ORIGIN.txt");
    fs::write(&origin, origin_text(wheel)).map_err(at("write", &origin))
}

/// The folder into which wheel makers put libraries, and the licence.
fn is_wanted(inside: &Path) -> bool {
    let folder = inside.parent().map(name_of).unwrap_or_default();
    folder.ends_with(".libs") || folder == ".dylibs" || name_of(inside).starts_with("LICENSE")
}

fn origin_text(wheel: &Path) -> String {
    format!(
        "Unpacked by `etalon setup embree` from the Python wheel {}.\n\
         Embree and oneTBB are Intel's, under the Apache License 2.0; LICENSE is that of the wheel.\n\
         Delete this folder to remove them.\n",
        name_of(wheel)
    )
}

fn name_of(path: &Path) -> String {
    path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
}

fn library_in(folder: &Path) -> Result<PathBuf, SetupError> {
    let files = fs::read_dir(folder).map_err(at("read", folder))?.flatten().map(|e| e.path());
    let mut libraries: Vec<PathBuf> = files.filter(|p| name_of(p).contains("embree4")).collect();
    libraries.sort();
    let none = || SetupError::NotWorking { why: "the wheel holds no libembree4".to_owned() };
    libraries.into_iter().next().ok_or_else(none)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn wheel_with(folder: &Path, names: &[&str]) -> PathBuf {
        let path = folder.join("some.whl");
        let mut zip = zip::ZipWriter::new(File::create(&path).unwrap());
        for name in names {
            zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            zip.write_all(name.as_bytes()).unwrap();
        }
        zip.finish().unwrap();
        path
    }

    #[test]
    fn libraries_and_licence_are_unpacked_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let names = [
            "x.libs/libembree4-4aef.so.4",
            "x.libs/libtbb-dc.so.12",
            "x/rtcore.so",
            "x.dist-info/licenses/LICENSE",
            "../y.libs/libtbb-escape.so",
        ];
        let wheel = wheel_with(folder.path(), &names);
        let to = folder.path().join("to");
        fs::create_dir(&to).unwrap();
        unpack(&wheel, &to).unwrap();
        let mut found: Vec<String> = fs::read_dir(&to).unwrap().map(|e| name_of(&e.unwrap().path())).collect();
        found.sort();
        assert_eq!(found, ["LICENSE", "ORIGIN.txt", "libembree4-4aef.so.4", "libtbb-dc.so.12"]);
        assert!(library_in(&to).unwrap().ends_with("libembree4-4aef.so.4"));
    }

    #[test]
    fn another_file_than_the_pinned_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let wheel = wheel_with(folder.path(), &["libembree4.so.4"]);
        let error = check_hash(&wheel, &PINS[0]).unwrap_err().to_string();
        assert!(error.contains("some.whl is not the pinned file") && error.contains("not 8415d14c"), "{error}");
    }
}
