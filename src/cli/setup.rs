//! `etalon setup embree`: finds an Embree 4, or fetches the pinned one into the user's data folder.

mod wheel;

use crate::raycast::{EMBREE_VARIABLE, embree_folder, find_embree, use_embree};
use embree4_sys::{Library, Written};
use serde::Serialize;
use std::fmt;
use std::fs;
use std::io;
use std::path::PathBuf;
use wheel::{PACKAGE, Pin, fetch, library_in, pin_of_this_machine};

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
