//! What each fuzz target does with its bytes: read them as a file, as a user would. A refusal is fine; a panic, an
//! endless loop or a gigabyte is not. The tests of the main crate run these on mutated seeds.

use etalon::io::scene::{SceneOptions, open_scene};
use etalon::io::{MeshValuesOptions, StoredReference, read_form_factors, read_mesh_values, read_solution};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Rows and columns that matrices and solutions are read for.
const ROWS: usize = 4;

/// The folder of this process for files that are read back.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| tempfile::tempdir().expect("a temporary folder")).path()
}

/// Writes bytes under a name of this thread.
fn file(name: &str, data: &[u8]) -> PathBuf {
    let own = folder().join(format!("{:?}", std::thread::current().id()).replace(['(', ')'], "-"));
    std::fs::create_dir_all(&own).expect("a folder");
    let path = own.join(name);
    std::fs::write(&path, data).expect("a file");
    path
}

/// Reads a scene and lays out its states. Returns whether it was accepted.
fn scene_at(path: &Path) -> bool {
    let Ok(scene) = open_scene(&path.to_string_lossy(), &SceneOptions::default()) else { return false };
    // Larger ones are right, only slow.
    let patches: usize = scene.surfaces.iter().flat_map(|s| &s.faces).map(|f| f.patches.count()).sum();
    if patches < 10_000 {
        for state in 0..=scene.edits.len().min(8) {
            let _ = scene.at(state);
        }
    }
    true
}

/// A scene file.
pub fn scene(data: &[u8]) -> bool {
    file("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    scene_at(&file("scene.toml", data))
}

/// An OBJ mesh.
pub fn obj(data: &[u8]) -> bool {
    scene_at(&file("m.obj", data))
}

/// An MTL library, with a mesh that uses the material "white".
pub fn mtl(data: &[u8]) -> bool {
    file("m.mtl", data);
    scene_at(&file("m.obj", b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl white\nf 1 2 3\n"))
}

/// A PLY mesh.
pub fn ply(data: &[u8]) -> bool {
    scene_at(&file("m.ply", data))
}

/// A glTF mesh in JSON.
pub fn gltf(data: &[u8]) -> bool {
    scene_at(&file("m.gltf", data))
}

/// A glTF mesh in one binary file.
pub fn glb(data: &[u8]) -> bool {
    scene_at(&file("m.glb", data))
}

/// A Mitsuba scene, with a mesh beside it.
pub fn mitsuba(data: &[u8]) -> bool {
    file("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    scene_at(&file("m.xml", data))
}

/// A Radiance scene.
pub fn radiance(data: &[u8]) -> bool {
    scene_at(&file("m.rad", data))
}

fn solution(name: &str, data: &[u8]) -> bool {
    let bands = ["r", "g", "b"].map(String::from);
    read_solution(&file(name, data)).is_ok_and(|s| s.fit(&bands, &[true; ROWS]).is_ok())
}

/// A solution as CSV.
pub fn solution_csv(data: &[u8]) -> bool {
    solution("s.csv", data)
}

/// A solution as JSON.
pub fn solution_json(data: &[u8]) -> bool {
    solution("s.json", data)
}

/// A solution as npy.
pub fn solution_npy(data: &[u8]) -> bool {
    solution("s.npy", data)
}

/// A solution as npz.
pub fn solution_npz(data: &[u8]) -> bool {
    solution("s.npz", data)
}

fn matrix(name: &str, data: &[u8]) -> bool {
    read_form_factors(&file(name, data), ROWS).is_ok()
}

/// Form factors as CSV.
pub fn matrix_csv(data: &[u8]) -> bool {
    matrix("f.csv", data)
}

/// Form factors as Matrix Market.
pub fn matrix_mtx(data: &[u8]) -> bool {
    matrix("f.mtx", data)
}

/// Form factors as npz.
pub fn matrix_npz(data: &[u8]) -> bool {
    matrix("f.npz", data)
}

fn values(path: &Path, options: MeshValuesOptions) -> bool {
    read_mesh_values(path, &options).is_ok()
}

/// Values on a PLY mesh.
pub fn values_ply(data: &[u8]) -> bool {
    values(&file("v.ply", data), MeshValuesOptions::default())
}

/// Values on an OBJ mesh.
pub fn values_obj(data: &[u8]) -> bool {
    values(&file("v.obj", data), MeshValuesOptions::default())
}

/// A table of values beside an OBJ mesh of one triangle.
pub fn values_table(data: &[u8]) -> bool {
    let table = Some(file("v.csv", data));
    let mesh = file("t.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    values(&mesh, MeshValuesOptions { table, ..MeshValuesOptions::default() })
}

/// Values on a glTF mesh in JSON.
pub fn values_gltf(data: &[u8]) -> bool {
    values(&file("v.gltf", data), MeshValuesOptions::default())
}

/// Values on a glTF mesh in one binary file.
pub fn values_glb(data: &[u8]) -> bool {
    values(&file("v.glb", data), MeshValuesOptions::default())
}

/// Values on a VTK grid.
pub fn values_vtu(data: &[u8]) -> bool {
    values(&file("v.vtu", data), MeshValuesOptions::default())
}

/// An EXR lightmap on an OBJ mesh of one triangle.
pub fn values_exr(data: &[u8]) -> bool {
    let mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    let mesh = Some(file("l.obj", mesh));
    values(&file("v.exr", data), MeshValuesOptions { mesh, ..MeshValuesOptions::default() })
}

/// A reference directory with one file replaced: the first byte chooses it, checksums are made to fit.
pub fn reference(data: &[u8]) -> bool {
    let Some((which, data)) = data.split_first() else { return false };
    let mut files = sound_reference().to_vec();
    let at = usize::from(*which) % files.len();
    files[at].1 = data.to_vec();
    let replaced = files[at].0.clone();
    let manifest = files.iter_mut().find(|(name, _)| name == "reference.json").map(|(_, bytes)| bytes);
    if let Some(bytes) = manifest.filter(|_| replaced != "reference.json") {
        *bytes = with_checksum(bytes, &replaced, data);
    }
    let paths: Vec<PathBuf> = files.iter().map(|(name, bytes)| file(name, bytes)).collect();
    StoredReference::read(paths[0].parent().unwrap_or(Path::new("."))).is_ok()
}

/// The manifest with the checksum of a file replaced.
fn with_checksum(manifest: &[u8], name: &str, data: &[u8]) -> Vec<u8> {
    let mut value: serde_json::Value = serde_json::from_slice(manifest).expect("a sound manifest");
    let sum: String = Sha256::digest(data).iter().map(|b| format!("{b:02x}")).collect();
    value["sha256"][name] = sum.into();
    // The manifest's own checksum is that of its text without it.
    value["checksum"] = "".into();
    let own: String = Sha256::digest(value.to_string()).iter().map(|b| format!("{b:02x}")).collect();
    value["checksum"] = own.into();
    value.to_string().into_bytes()
}

/// The files of a small reference, by name; computed when first asked for.
pub fn sound_reference() -> &'static [(String, Vec<u8>)] {
    static FILES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    FILES.get_or_init(|| {
        let target = folder().join("sound");
        let words =
            ["etalon", "-q", "reference", "builtin:opposed-squares", "--rays", "1024", "--kernel", "builtin", "-o"];
        let mut arguments: Vec<OsString> = words.iter().map(OsString::from).collect();
        arguments.push(target.clone().into());
        etalon::cli::run(arguments);
        let entries = std::fs::read_dir(&target).expect("the reference").filter_map(Result::ok);
        let mut files: Vec<(String, Vec<u8>)> = entries
            .map(|e| (e.file_name().to_string_lossy().into_owned(), std::fs::read(e.path()).unwrap_or_default()))
            .collect();
        files.sort();
        files
    })
}
