//! The reference directory: self-contained, checksummed, written whole or not at all.
//!
//! `reference.json` (format, provenance, self-check, checksums), `scene.json` (the scene at its state),
//! `replicates.npz` (R x N x bands, elements likewise), `reference.csv` (means with standard errors, for people),
//! `timing.json` (the clock, apart from everything else).

use super::{BandNames, FileError, SolutionFormat, archive, npz, write_solution};
use crate::scene::{Finding, Stage};
use crate::solution::{Provenance, Replicates, SelfCheck};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Format of the directory.
const FORMAT: &str = "etalon-reference/1";
const MANIFEST: &str = "reference.json";
const SCENE: &str = "scene.json";
const REPLICATES: &str = "replicates.npz";
const MEANS: &str = "reference.csv";
const TIMING: &str = "timing.json";

/// All that a reference directory holds.
#[derive(Debug, Clone)]
pub struct StoredReference {
    /// The scene at its state.
    pub stage: Stage,
    /// Hash of the scene.
    pub scene_hash: String,
    /// Replicate radiosities of the patches.
    pub patches: Replicates,
    /// Replicate radiosities of the elements, where patches have more than one.
    pub elements: Option<Replicates>,
    /// How it was computed.
    pub provenance: Provenance,
    /// What the judge found about itself.
    pub self_check: SelfCheck,
    /// Relative error after each wave of rays: (rays per patch, error in the norm of eq. 7).
    pub waves: Vec<(u64, f64)>,
    /// What the scene doctor found.
    pub findings: Vec<Finding>,
}

#[derive(Serialize, Deserialize)]
struct Manifest {
    format: String,
    scene: String,
    scene_hash: String,
    state: usize,
    passed_self_check: bool,
    provenance: Provenance,
    self_check: SelfCheck,
    waves: Vec<(u64, f64)>,
    #[serde(default)]
    findings: Vec<Finding>,
    sha256: BTreeMap<String, String>,
    /// SHA-256 of this file with this string empty.
    checksum: String,
}

/// True if a path looks like a reference directory.
pub fn is_reference(path: &Path) -> bool {
    path.is_dir()
}

/// Files of a directory: (name, bytes).
pub type Files = Vec<(String, Vec<u8>)>;

impl StoredReference {
    /// The files of the directory. `seconds` goes to the clock's own file.
    pub fn files(&self, seconds: f64) -> Files {
        let mut files = vec![
            (SCENE.to_string(), json(&self.stage)),
            (REPLICATES.to_string(), self.replicates()),
            (MEANS.to_string(), self.means()),
        ];
        let manifest = Manifest {
            format: FORMAT.into(),
            scene: self.stage.name.clone(),
            scene_hash: self.scene_hash.clone(),
            state: self.stage.state,
            passed_self_check: self.self_check.passed(),
            provenance: self.provenance.clone(),
            self_check: self.self_check.clone(),
            waves: self.waves.clone(),
            findings: self.findings.clone(),
            sha256: files.iter().map(|(name, bytes)| (name.clone(), sha256(bytes))).collect(),
            checksum: String::new(),
        };
        let checksum = sha256(&json(&manifest));
        files.push((MANIFEST.to_string(), json(&Manifest { checksum, ..manifest })));
        files.push((TIMING.to_string(), json(&serde_json::json!({ "seconds": seconds }))));
        files
    }

    fn replicates(&self) -> Vec<u8> {
        let mut members = npz::Members::default();
        let mut add = |name: &str, r: &Replicates| {
            let shape = [r.count() as u64, r.len() as u64, r.bands as u64];
            members.add(name, npz::array(&shape, &r.replicates.concat()));
        };
        add("patches", &self.patches);
        if let Some(e) = &self.elements {
            add("elements", e);
        }
        members.zip()
    }

    fn means(&self) -> Vec<u8> {
        let present: Vec<bool> = self.stage.patches.iter().map(|p| p.is_present()).collect();
        let names = BandNames {
            scene: &self.stage.name,
            scene_hash: &self.scene_hash,
            bands: &self.stage.photometry.bands,
            present: &present,
        };
        write_solution(&self.patches.mean(), names, SolutionFormat::Csv)
    }

    /// Reads a directory and verifies every byte of it.
    pub fn read(folder: &Path) -> Result<Self, FileError> {
        Self::from(&Reader { place: folder, source: Source::Folder })
    }

    /// The same from the bytes of a zip archive of such a directory; `name` is what it is called.
    pub fn read_archive(name: &Path, bytes: &[u8]) -> Result<Self, FileError> {
        let files = archive::unzip(name, bytes)?;
        Self::from(&Reader { place: name, source: Source::Files(files) })
    }

    /// The directory as one zip archive.
    pub fn archive(&self, seconds: f64) -> Vec<u8> {
        archive::zip(&self.files(seconds))
    }

    fn from(reader: &Reader) -> Result<Self, FileError> {
        let folder = reader.place;
        let manifest = reader.manifest()?;
        let load = |name: &str| reader.verified(name, &manifest);
        load(MEANS)?;
        let stage: Stage = reader.parse(SCENE, &load(SCENE)?)?;
        let path = folder.join(REPLICATES);
        let members = npz::unzip(&path, &load(REPLICATES)?)?;
        let replicates = |name: &str, rows: usize| -> Result<Option<Replicates>, FileError> {
            let Some(bytes) = members.get(name) else { return Ok(None) };
            let (shape, values) = npz::numbers(&path, name, bytes)?;
            let bands = stage.band_count();
            match shape[..] {
                [r, n, b] if n as usize == rows && b as usize == bands && r > 1 => {
                    let replicates = values.chunks(rows * bands).map(<[f64]>::to_vec).collect();
                    Ok(Some(Replicates { bands, replicates }))
                }
                _ => Err(reader.damaged(REPLICATES, format!("array \"{name}\" has shape {shape:?}"))),
            }
        };
        let patches = replicates("patches", stage.patch_count())?
            .ok_or_else(|| reader.damaged(REPLICATES, "array \"patches\" is missing".into()))?;
        let elements = replicates("elements", stage.elements.len())?;
        if stage.hash() != manifest.scene_hash {
            return Err(reader.damaged(SCENE, "the scene does not have the hash it is filed under".into()));
        }
        Ok(Self {
            stage,
            scene_hash: manifest.scene_hash,
            patches,
            elements,
            provenance: manifest.provenance,
            self_check: manifest.self_check,
            waves: manifest.waves,
            findings: manifest.findings,
        })
    }
}

/// Where the files are.
enum Source {
    Folder,
    Files(BTreeMap<String, Vec<u8>>),
}

struct Reader<'a> {
    /// Folder, or what an archive is called.
    place: &'a Path,
    source: Source,
}

impl Reader<'_> {
    fn path(&self, name: &str) -> PathBuf {
        self.place.join(name)
    }

    fn damaged(&self, name: &str, problem: String) -> FileError {
        FileError::new(&self.path(name), problem)
            .mend("the reference is damaged: compute it again with `etalon reference SCENE -o DIR`")
    }

    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileError> {
        if let Source::Files(files) = &self.source {
            return files.get(name).cloned().ok_or_else(|| self.damaged(name, "is missing".into()));
        }
        std::fs::read(self.path(name)).map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => self.damaged(name, "is missing".into()),
            _ => FileError::system(&self.path(name), "read", &e).mend("a reference is a folder of readable files"),
        })
    }

    fn parse<T: for<'de> Deserialize<'de>>(&self, name: &str, bytes: &[u8]) -> Result<T, FileError> {
        serde_json::from_slice(bytes)
            .map_err(|e| self.damaged(name, format!("cannot be read: {e}")).at(format!("line {}", e.line())))
    }

    fn manifest(&self) -> Result<Manifest, FileError> {
        if matches!(self.source, Source::Folder) && !self.path(MANIFEST).is_file() {
            return Err(FileError::new(self.place, format!("is not a reference directory: it has no {MANIFEST}"))
                .mend("make one with `etalon reference SCENE -o DIR`"));
        }
        let bytes = self.bytes(MANIFEST)?;
        let value: serde_json::Value = self.parse(MANIFEST, &bytes)?;
        match value.get("format").and_then(|f| f.as_str()) {
            Some(FORMAT) => {}
            Some(format) if format.starts_with("etalon-reference/") => {
                return Err(FileError::new(&self.path(MANIFEST), format!("has format {format}")).mend(format!(
                    "this version reads {FORMAT}: update etalon if a newer one wrote it, or compute the reference again"
                )));
            }
            _ => return Err(self.damaged(MANIFEST, format!("does not say that it is {FORMAT}"))),
        }
        let manifest: Manifest = self.parse(MANIFEST, &bytes)?;
        let text = String::from_utf8_lossy(&bytes).replace(&manifest.checksum, "");
        if manifest.checksum != sha256(text.as_bytes()) {
            return Err(self.damaged(MANIFEST, "does not have the checksum it was written with".into()));
        }
        Ok(manifest)
    }

    fn verified(&self, name: &str, manifest: &Manifest) -> Result<Vec<u8>, FileError> {
        let bytes = self.bytes(name)?;
        match manifest.sha256.get(name) {
            Some(sum) if *sum == sha256(&bytes) => Ok(bytes),
            Some(_) => Err(self.damaged(name, "does not have the checksum it was written with".into())),
            None => Err(self.damaged(MANIFEST, format!("has no checksum of {name}"))),
        }
    }
}

fn json(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec_pretty(value).expect("finite data serialise");
    bytes.push(b'\n');
    bytes
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}
