//! `cargo xtask dist`: an archive that installs without a checkout, and the proof that it does.
//!
//! Its folders are those of a prefix: unpacked into /usr/local or ~/.local, everything is where shells and `man` look.
//! Names sorted, one time stamp, one owner: the same program makes the same bytes.

use crate::{Stopped, cargo, etalon, run, target, workspace};
use flate2::{Compression, GzBuilder, read::GzDecoder};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

const HELP: &str = "\
cargo xtask dist [--program FILE] [-o DIR]
  --program    this program instead of a fresh release build (then nothing is built)
  -o           folder of etalon-VERSION-TARGET.tar.gz and its .sha256 (default: dist in the target folder)
SOURCE_DATE_EPOCH sets the time stamp of the files in it (default: the first second of 2000)";

const DOCUMENTS: &str = "share/doc/etalon";
const COMPLETIONS: [(&str, &str); 5] = [
    ("bash", "share/bash-completion/completions/etalon"),
    ("elvish", "share/elvish/lib/etalon.elv"),
    ("fish", "share/fish/vendor_completions.d/etalon.fish"),
    ("powershell", "share/powershell/etalon.ps1"),
    ("zsh", "share/zsh/site-functions/_etalon"),
];
const TEXTS: [&str; 4] = ["README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"];
const FOLDERS: [&str; 2] = ["examples/ci", "examples/solver"];
const INSTALL: &str = include_str!("install.md");
const TWO_THOUSAND: u64 = 946_684_800;

/// What the archive holds: path below its one folder, contents, whether it can be run.
type Contents = BTreeMap<String, (Vec<u8>, bool)>;

/// Builds, packs, and proves the archive.
pub fn dist(arguments: &[String]) -> Result<(), Stopped> {
    let Some((program, output)) = read(arguments)? else {
        println!("{HELP}");
        return Ok(());
    };
    let program = match program {
        Some(given) => given,
        None => {
            run(cargo().args(["build", "--release", "--locked"]))?;
            PathBuf::from(etalon().get_program())
        }
    };
    let place = tempfile::tempdir().map_err(|e| Stopped(format!("no temporary folder: {e}")))?;
    let own = stripped(&program, place.path())?;
    let version = words(Command::new(&own).arg("--version"))?.trim().replace(' ', "-");
    let name = format!("{version}-{}", host()?);
    let bytes = archive(&name, &contents(&own, place.path())?).map_err(|e| Stopped(format!("cannot pack: {e}")))?;
    prove(&bytes, &name, place.path())?;
    deliver(&output, &name, &bytes)
}

/// A program that is built already, if one is given, and where the archive goes; none if help is wanted.
fn read(arguments: &[String]) -> Result<Option<(Option<PathBuf>, PathBuf)>, Stopped> {
    let (mut program, mut output) = (None, target().join("dist"));
    let mut rest = arguments.iter();
    while let Some(word) = rest.next() {
        let mut value = || rest.next().map(PathBuf::from).ok_or_else(|| Stopped(format!("{word} needs a value")));
        match word.as_str() {
            "--program" => program = Some(value()?),
            "-o" | "--output" => output = value()?,
            "--help" | "-h" => return Ok(None),
            other => return Err(Stopped(format!("{other} is not an option of dist\n{HELP}"))),
        }
    }
    Ok(Some((program, output)))
}

/// A copy without symbols: a third of the size.
fn stripped(program: &Path, place: &Path) -> Result<PathBuf, Stopped> {
    let copy = place.join("etalon");
    fs::copy(program, &copy).map_err(|e| Stopped(format!("cannot copy {}: {e}", program.display())))?;
    run(Command::new("strip").arg(&copy))?;
    Ok(copy)
}

/// The platform this compiler builds for.
fn host() -> Result<String, Stopped> {
    let text = words(Command::new("rustc").arg("-vV").current_dir(workspace()))?;
    let line = text.lines().find_map(|l| l.strip_prefix("host: "));
    line.map(str::to_owned).ok_or_else(|| Stopped("rustc does not say its host".into()))
}

/// What a command prints.
fn words(command: &mut Command) -> Result<String, Stopped> {
    let name = crate::in_words(command);
    let output = command.output().map_err(|e| Stopped(format!("{name} cannot be run: {e}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(Stopped(format!("{name} {}: {said}", crate::how_it_ended(output.status))));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The program, what it writes about itself, and texts of the checkout.
fn contents(program: &Path, place: &Path) -> Result<Contents, Stopped> {
    let mut all = Contents::new();
    all.insert("bin/etalon".into(), (bytes_of(program)?, true));
    for (shell, path) in COMPLETIONS {
        let script = words(Command::new(program).args(["completions", shell]))?;
        all.insert(path.into(), (script.into_bytes(), false));
    }
    let pages = place.join("man");
    words(Command::new(program).arg("man").arg("-o").arg(&pages))?;
    add_folder(&mut all, &pages, "share/man/man1")?;
    all.insert(format!("{DOCUMENTS}/INSTALL.md"), (INSTALL.into(), false));
    for text in TEXTS {
        all.insert(format!("{DOCUMENTS}/{text}"), (bytes_of(&workspace().join(text))?, false));
    }
    FOLDERS.iter().try_for_each(|f| add_folder(&mut all, &workspace().join(f), &format!("{DOCUMENTS}/{f}")))?;
    Ok(all)
}

/// The files of a folder, without those of folders in it.
fn add_folder(all: &mut Contents, folder: &Path, to: &str) -> Result<(), Stopped> {
    let failed = |e: io::Error| Stopped(format!("cannot list {}: {e}", folder.display()));
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_file() {
            let is_script = path.extension().is_some_and(|e| e == "sh" || e == "py");
            all.insert(format!("{to}/{name}"), (bytes_of(&path)?, is_script));
        }
    }
    Ok(())
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, Stopped> {
    fs::read(path).map_err(|e| Stopped(format!("cannot read {}: {e}", path.display())))
}

fn archive(name: &str, all: &Contents) -> io::Result<Vec<u8>> {
    let zip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    let mut tar = tar::Builder::new(zip);
    for (path, (bytes, runs)) in all {
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(if *runs { 0o755 } else { 0o644 });
        header.set_mtime(time_stamp());
        header.set_uid(0);
        header.set_gid(0);
        tar.append_data(&mut header, format!("{name}/{path}"), bytes.as_slice())?;
    }
    tar.into_inner()?.finish()
}

fn time_stamp() -> u64 {
    std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|t| t.parse().ok()).unwrap_or(TWO_THOUSAND)
}

/// Unpacks it far from the checkout, and runs what came out.
fn prove(bytes: &[u8], name: &str, place: &Path) -> Result<(), Stopped> {
    let elsewhere = place.join("proof");
    tar::Archive::new(GzDecoder::new(bytes))
        .unpack(&elsewhere)
        .map_err(|e| Stopped(format!("the archive cannot be unpacked: {e}")))?;
    let program = elsewhere.join(name).join("bin/etalon");
    for arguments in [&["--version"][..], &["doctor"], &["scene", "check", "builtin:cornell-box-coarse"]] {
        run(Command::new(&program).args(arguments).current_dir(&elsewhere))?;
    }
    Ok(())
}

fn deliver(output: &Path, name: &str, bytes: &[u8]) -> Result<(), Stopped> {
    let file = format!("{name}.tar.gz");
    let hash: String = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect();
    let failed = |e: io::Error| Stopped(format!("cannot write into {}: {e}", output.display()));
    fs::create_dir_all(output).map_err(failed)?;
    fs::write(output.join(&file), bytes).map_err(failed)?;
    fs::write(output.join(format!("{name}.sha256")), format!("{hash}  {file}\n")).map_err(failed)?;
    println!("{}", output.join(&file).display());
    println!("{} MB, SHA-256 {hash}", bytes.len() / 1_000_000);
    Ok(())
}
