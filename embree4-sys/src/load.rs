//! Finding out whether a file is an Embree 4 we can work with, and keeping it.

use crate::api::Api;
use crate::error::LoadError;
use crate::probe::{self, Layout};
use crate::types::RTCDeviceProperty;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

/// An accepted library. It stays in memory as long as the process lives.
pub struct Library {
    pub(crate) api: Api,
    path: PathBuf,
    version: Version,
    layout: Layout,
    /// Keeps the code mapped.
    _code: libloading::Library,
}

/// Version of a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// 4 in an accepted library.
    pub major: u32,
    /// 0 to 4 so far.
    pub minor: u32,
    /// Patch level.
    pub patch: u32,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

impl Library {
    /// The path it was loaded by.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its version.
    pub fn version(&self) -> Version {
        self.version
    }

    /// What it writes, and where.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
}

static LOADED: OnceLock<Library> = OnceLock::new();
static LOADING: Mutex<()> = Mutex::new(());

/// The library in use, if one was accepted.
pub fn loaded() -> Option<&'static Library> {
    LOADED.get()
}

/// Loads an Embree 4, checks it and puts it into use for the whole process.
///
/// `path` is a file, or a bare name that the system's loader finds. Where the file cannot be loaded by itself,
/// its neighbours named `libtbb*` are loaded first. A refused library leaves the process as it was, and another
/// may be tried. Loading the one in use again is no error.
///
/// # Errors
/// Every [`LoadError`].
///
/// # Safety
/// Loading runs the file's initialisers: it must be a library one trusts.
pub unsafe fn load(path: &Path) -> Result<&'static Library, LoadError> {
    let _one_at_a_time = LOADING.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(library) = loaded() {
        return if library.path == path { Ok(library) } else { Err(another(path, &library.path)) };
    }
    // SAFETY: passed on to the caller.
    let library = unsafe { open(path)? };
    Ok(LOADED.get_or_init(|| library))
}

fn another(path: &Path, loaded: &Path) -> LoadError {
    LoadError::AnotherIsLoaded { path: path.to_owned(), loaded: loaded.to_owned() }
}

/// Loads and checks, without putting into use.
unsafe fn open(path: &Path) -> Result<Library, LoadError> {
    // SAFETY: the caller trusts the file.
    let code = unsafe { map(path) }.or_else(|first| {
        // SAFETY: neighbours of a trusted file.
        unsafe { preload_neighbours(path) };
        // SAFETY: as above.
        unsafe { map(path) }.map_err(|_| first)
    });
    let code = code.map_err(|e| LoadError::NotLoadable { path: path.to_owned(), why: reason(&e) })?;
    // SAFETY: a library with all these names is taken for an Embree; version and probe follow.
    let api = unsafe { Api::resolve(&code) };
    let api = api.map_err(|symbol| LoadError::MissingSymbol { path: path.to_owned(), symbol })?;
    let device = probe::Device::new(&api, path)?;
    let version = version_of(&device);
    if version.major != 4 {
        return Err(LoadError::WrongVersion { path: path.to_owned(), found: version.to_string() });
    }
    let layout = probe::probe(&device, path)?;
    drop(device);
    Ok(Library { api, path: path.to_owned(), version, layout, _code: code })
}

fn version_of(device: &probe::Device<'_>) -> Version {
    let number = |p| u32::try_from(device.property(p)).unwrap_or(0);
    Version {
        major: number(RTCDeviceProperty::VERSION_MAJOR),
        minor: number(RTCDeviceProperty::VERSION_MINOR),
        patch: number(RTCDeviceProperty::VERSION_PATCH),
    }
}

/// The loader's own words: `libloading` keeps them one level down.
fn reason(e: &libloading::Error) -> String {
    std::error::Error::source(e).map_or_else(|| e.to_string(), ToString::to_string)
}

#[cfg(not(windows))]
unsafe fn map(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: passed on to the caller.
    unsafe { libloading::Library::new(path) }
}

/// On Windows a library's own folder is searched for what it needs only on request.
#[cfg(windows)]
unsafe fn map(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::windows::{LOAD_WITH_ALTERED_SEARCH_PATH, Library};
    let flags = if path.is_absolute() { LOAD_WITH_ALTERED_SEARCH_PATH } else { 0 };
    // SAFETY: passed on to the caller.
    unsafe { Library::load_with_flags(path, flags) }.map(Into::into)
}

/// Loads `libtbb*` from the same folder for good, for libraries that carry no search path of their own.
#[cfg(unix)]
unsafe fn preload_neighbours(path: &Path) {
    use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_NOW};
    let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) else { return };
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    files.retain(|f| f.file_name().is_some_and(|n| n.to_string_lossy().starts_with("libtbb")));
    files.sort();
    for file in files {
        // SAFETY: a neighbour of a trusted library; never unloaded.
        if let Ok(library) = unsafe { Library::open(Some(&file), RTLD_NOW | RTLD_GLOBAL) } {
            std::mem::forget(library);
        }
    }
}

#[cfg(not(unix))]
unsafe fn preload_neighbours(_path: &Path) {}
