//! The pinned Python wheel: fetched by pip, checked, unpacked.

use super::SetupError;
use sha2::{Digest, Sha256};
use std::fmt;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A Python wheel that carries Embree and TBB, and what `pip` must be asked to get it.
pub(super) struct Pin {
    os: &'static str,
    arch: &'static str,
    platform: &'static str,
    pub(super) sha256: &'static str,
}

/// What pip is asked for.
pub(super) const PACKAGE: &str = "embreex==4.4.0";
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

/// The pin for this system and processor.
pub(super) fn pin_of_this_machine() -> Result<&'static Pin, SetupError> {
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let pin = PINS.iter().find(|p| p.os == os && p.arch == arch);
    pin.ok_or_else(|| SetupError::NoPin { platform: format!("{os} on {arch}") })
}

/// Fetches the wheel and unpacks it into a folder of its own below `store`, which appears complete or not at all.
pub(super) fn fetch(pin: &Pin, store: &Path) -> Result<PathBuf, SetupError> {
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

/// The Embree library in an unpacked folder.
pub(super) fn library_in(folder: &Path) -> Result<PathBuf, SetupError> {
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
