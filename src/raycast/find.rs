//! Where an Embree library may be.

use super::KernelError;
use super::embree::load;
use embree4_sys::{Library, LoadError};
use std::env;
use std::path::{Path, PathBuf};

/// Names the library: a file, a folder, or `none` to do without.
pub const EMBREE_VARIABLE: &str = "ETALON_EMBREE";

/// A library that may be tried.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// A file, or a bare name for the system's loader.
    pub path: PathBuf,
    /// Which place it comes from, in words.
    pub place: &'static str,
}

/// A candidate that was refused, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// The library.
    pub path: PathBuf,
    /// The reason, in words.
    pub why: String,
}

/// What the search came to.
pub struct Search {
    /// The library in use from now on, if one was accepted.
    pub library: Option<&'static Library>,
    /// Which were refused on the way.
    pub refused: Vec<Refused>,
    /// Places that were searched, in words.
    pub looked_in: String,
}

/// Folder below the user's data folder that `etalon setup embree` fills.
pub fn embree_folder() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "etalon").map(|d| d.data_local_dir().join("embree"))
}

/// Searches all places in order and puts the first acceptable library into use.
pub fn find_embree() -> Search {
    let (candidates, looked_in) = candidates();
    let mut search = Search { library: None, refused: Vec::new(), looked_in };
    for candidate in candidates {
        match load(&candidate.path) {
            Ok(library) => {
                search.library = Some(library);
                break;
            }
            // A library stays for the life of the process: the first one found serves all later searches.
            Err(LoadError::AnotherIsLoaded { .. }) => {
                search.library = embree4_sys::loaded();
                break;
            }
            Err(e) => search.refused.extend(refusal(&candidate, &e)),
        }
    }
    search
}

/// Loads one library and puts it into use for the whole process.
///
/// # Errors
/// [`KernelError::Unusable`] with the reason.
pub fn use_embree(path: &Path) -> Result<&'static Library, KernelError> {
    load(path).map_err(|e| KernelError::Unusable { path: path.to_owned(), why: e.to_string() })
}

/// A name that the system's loader does not know is no library, hence no refusal.
fn refusal(candidate: &Candidate, error: &LoadError) -> Option<Refused> {
    let absent = is_bare(&candidate.path) && matches!(error, LoadError::NotLoadable { .. });
    (!absent).then(|| Refused { path: candidate.path.clone(), why: error.to_string() })
}

impl Search {
    /// The library, or why there is none.
    ///
    /// # Errors
    /// [`KernelError::Unusable`] for the first library that was refused, else [`KernelError::NotFound`].
    pub fn result(self) -> Result<&'static Library, KernelError> {
        let first = self.refused.into_iter().next();
        self.library.ok_or(match first {
            Some(Refused { path, why }) => KernelError::Unusable { path, why },
            None => KernelError::NotFound { looked_in: self.looked_in },
        })
    }
}

/// All candidates in order, and the places in words. A setting of [`EMBREE_VARIABLE`] stands alone.
fn candidates() -> (Vec<Candidate>, String) {
    match env::var_os(EMBREE_VARIABLE).filter(|v| !v.is_empty()) {
        Some(value) if value == "none" => (Vec::new(), format!("no place, as {EMBREE_VARIABLE} is none")),
        Some(value) => (named(Path::new(&value)), format!("{EMBREE_VARIABLE} = {}", Path::new(&value).display())),
        None => everywhere(),
    }
}

/// What the user names: a folder to search, or a file to take as it is.
fn named(path: &Path) -> Vec<Candidate> {
    let place = EMBREE_VARIABLE;
    if path.is_dir() { in_folders(&[path.to_owned()], place) } else { vec![Candidate { path: path.to_owned(), place }] }
}

fn everywhere() -> (Vec<Candidate>, String) {
    let installed = env::var_os("EMBREE_DIR").map(PathBuf::from).filter(|p| !p.as_os_str().is_empty());
    let beside = env::current_exe().ok().and_then(|exe| exe.parent().map(Path::to_owned));
    let provided = embree_folder();
    let mut found = Vec::new();
    for (folder, place) in
        [(&installed, "EMBREE_DIR"), (&beside, "beside the program"), (&provided, "the user data folder")]
    {
        found.extend(folder.iter().flat_map(|f| in_folders(&usual_folders(f), place)));
    }
    let place = "the system";
    found.extend(system_names().iter().map(|n| Candidate { path: PathBuf::from(n), place }));
    let told = |p: Option<PathBuf>, unset: &str| p.map_or(unset.to_owned(), |p| p.display().to_string());
    let looked_in = format!(
        "{EMBREE_VARIABLE} (not set), EMBREE_DIR ({}), beside the program ({}), {}, the system's libraries",
        told(installed, "not set"),
        told(beside, "unknown"),
        told(provided, "no user data folder"),
    );
    (found, looked_in)
}

/// A folder, what installations put below it, and the versions that setup has unpacked, newest first.
fn usual_folders(folder: &Path) -> Vec<PathBuf> {
    let mut below: Vec<PathBuf> = entries(folder);
    below.retain(|p| p.is_dir() && file_name(p).starts_with("embree"));
    below.reverse();
    let usual = ["", "lib", "lib64", "bin"].iter().map(|s| folder.join(s));
    usual.chain(below).collect()
}

fn in_folders(folders: &[PathBuf], place: &'static str) -> Vec<Candidate> {
    let files = folders.iter().flat_map(|f| entries(f)).filter(|p| is_library_name(&file_name(p)));
    files.map(|path| Candidate { path, place }).collect()
}

/// Entries of a folder in order of their names; none if it cannot be read.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(read) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = read.flatten().map(|e| e.path()).collect();
    paths.sort();
    paths
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
}

fn is_bare(path: &Path) -> bool {
    path.components().count() == 1
}

/// Wheels mangle the name (`libembree4-4aef3270.so.4`), so it goes by beginning and kind.
fn is_library_name(name: &str) -> bool {
    if cfg!(windows) {
        name.starts_with("embree4") && name.ends_with(".dll")
    } else if cfg!(target_os = "macos") {
        name.starts_with("libembree4") && name.ends_with(".dylib")
    } else {
        name.starts_with("libembree4") && name.contains(".so")
    }
}

/// Names to ask the system's loader for; on macOS also where the package managers put them.
fn system_names() -> &'static [&'static str] {
    if cfg!(windows) {
        &["embree4.dll"]
    } else if cfg!(target_os = "macos") {
        &[
            "libembree4.4.dylib",
            "libembree4.dylib",
            "/opt/homebrew/lib/libembree4.dylib",
            "/usr/local/lib/libembree4.dylib",
        ]
    } else {
        &["libembree4.so.4", "libembree4.so"]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn libraries_go_by_beginning_and_kind() {
        for name in ["libembree4.so.4", "libembree4.so", "libembree4-4aef3270.so.4", "libembree4.so.4.4.0"] {
            assert!(is_library_name(name), "{name}");
        }
        for name in ["libembree3.so.3", "libembree4.a", "libtbb.so.12", "embree4.dll"] {
            assert!(!is_library_name(name), "{name}");
        }
    }

    #[test]
    fn setup_folders_are_searched_newest_first() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["embree-4.3.3-a", "embree-4.4.0-b", "other"] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
        }
        let found = usual_folders(folder.path());
        let names: Vec<String> = found[4..].iter().map(|p| file_name(p)).collect();
        assert_eq!(names, ["embree-4.4.0-b", "embree-4.3.3-a"]);
    }

    #[test]
    fn a_file_that_is_no_library_is_refused_with_its_reason() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("libembree4.so.4");
        std::fs::write(&path, "not a library").unwrap();
        let found = named(folder.path());
        assert_eq!(found.len(), usize::from(cfg!(target_os = "linux")));
        for candidate in found {
            let Err(error) = load(&candidate.path) else { panic!("accepted") };
            // Another test of this process may have put a library into use already.
            if !matches!(error, LoadError::AnotherIsLoaded { .. }) {
                assert_eq!(refusal(&candidate, &error).unwrap().path, path);
            }
        }
    }
}
