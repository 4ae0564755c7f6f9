//! The folder of a scene: files may be named beside or below it, never elsewhere.

use super::check::{Check, Checked};
use super::error::Refusal;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// Largest file that is read, bytes.
const MAX_FILE: u64 = 1 << 30;

/// Where the files of a scene may lie; `None` for built-in scenes, which name no files.
pub(super) struct Folder {
    root: Option<PathBuf>,
}

impl Folder {
    /// The folder of a scene file.
    pub(super) fn of(scene: &Path) -> Self {
        let parent = scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self { root: parent.canonicalize().ok() }
    }

    /// No folder at all.
    pub(super) fn none() -> Self {
        Self { root: None }
    }

    /// The path of a file that `name` means, seen from `base` (a path below the folder, or empty).
    /// Absolute paths, `..` and links that lead outside are refused.
    pub(super) fn locate(&self, check: Check, span: Range<usize>, base: &Path, name: &str) -> Checked<PathBuf> {
        let refuse = |message: String, mend: &str| check.refuse(Refusal::Path, span.clone(), message, mend);
        let beside = "put the file beside or below the scene file and give its relative path";
        let Some(root) = &self.root else {
            return refuse(format!("\"{name}\": this scene has no folder to look in"), "write the polygons instead");
        };
        let within = Path::new(name).components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if name.is_empty() || name.contains('\0') || !within || name.contains(':') && cfg!(windows) {
            return refuse(format!("the path \"{}\" leaves the scene's folder", name.escape_debug()), beside);
        }
        let path = root.join(base).join(name);
        let real = match path.canonicalize() {
            Ok(real) => real,
            Err(e) => {
                return check.refuse(
                    Refusal::Unreadable,
                    span,
                    format!("cannot open \"{name}\": {}", plain(&e)),
                    "check the name; paths start at the folder of the file that names them",
                );
            }
        };
        match real.starts_with(root) {
            true => Ok(real),
            false => refuse(format!("the path \"{name}\" leads out of the scene's folder through a link"), beside),
        }
    }

    /// A located path as seen from the folder.
    pub(super) fn relative<'p>(&self, path: &'p Path) -> &'p Path {
        self.root.as_ref().and_then(|root| path.strip_prefix(root).ok()).unwrap_or(path)
    }
}

/// The text of a file; bytes that are not UTF-8 (comments in old encodings) are replaced.
pub(super) fn text_of(path: &Path) -> Result<String, String> {
    bytes_of(path).map(lossy)
}

/// Bytes as text; those that are not UTF-8 are replaced.
pub(super) fn lossy(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())
}

/// The bytes of a file of a size that can be read.
pub(super) fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let meta = std::fs::metadata(path).map_err(|e| plain(&e))?;
    if meta.is_dir() {
        return Err("it is a folder".into());
    }
    if meta.len() > MAX_FILE {
        return Err(format!("it has {} bytes, more than the {MAX_FILE} that are read", meta.len()));
    }
    std::fs::read(path).map_err(|e| plain(&e))
}

/// What the system says, without its number.
fn plain(e: &std::io::Error) -> String {
    match e.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => e.to_string(),
    }
}
