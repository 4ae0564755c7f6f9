//! Values on the meshes of other programs: files written by meshio, trimesh, vtk, pygltflib and OpenEXR (see
//! `mesh_values/generate.py`) hold what was put into them; what etalon writes comes back; broken files are refused.

#[path = "mesh_values/broken.rs"]
mod broken;

use etalon::io::scene::{SceneOptions, open_scene};
use etalon::io::{FileError, MeshValuesOptions, is_mesh_values, read_mesh_values, write_ply_values, write_vtu};
use etalon::math::{DVec3, area, centroid, unit_normal};
use etalon::solution::{MeshValues, Radiosity, ValuesPer};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mesh_values").join(name)
}

fn read_with(name: &str, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    assert!(is_mesh_values(Path::new(name)));
    read_mesh_values(&file(name), options)
}

fn read(name: &str) -> MeshValues {
    read_with(name, &MeshValuesOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn fields(names: &[&str]) -> MeshValuesOptions {
    let fields = Some(names.iter().map(|n| n.to_string()).collect());
    MeshValuesOptions { fields, ..MeshValuesOptions::default() }
}

/// What the generator gives a face, in its order, and a vertex.
fn of_face(f: f64) -> [f64; 3] {
    [1.5 + f, 0.1 * (f + 1.0), 0.001 * f]
}

fn of_vertex(p: DVec3) -> [f64; 3] {
    [1.0 + p.x + 2.0 * p.y, 3.0 - p.x, 0.25 + p.y / 2.0]
}

fn close(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= tolerance * y.abs().max(1.0), "{a:?} {b:?}");
    }
}

/// The three faces lie in the plane z = 0.25, look up, and make up two square metres.
fn is_the_mesh(m: &MeshValues, faces: usize) {
    assert_eq!(m.len(), faces);
    let total: f64 = (0..m.len()).map(|f| area(m.corners(f))).sum();
    assert!((total - 2.0).abs() < 1e-12, "{total}");
    for f in 0..m.len() {
        assert_eq!(unit_normal(m.corners(f)), DVec3::Z);
        assert!(m.corners(f).iter().all(|p| p.z == 0.25));
    }
}

fn holds_face_values(m: &MeshValues, tolerance: f64) {
    is_the_mesh(m, 3);
    assert_eq!((m.per(), m.bands.join("")), (ValuesPer::Face, "rgb".into()));
    for f in 0..3 {
        close(m.values(f), &of_face(f as f64), tolerance);
    }
    assert_eq!(m.corners(2).len(), 4);
}

/// Values of corners, given how the generator's three bands make those of the file.
fn holds_vertex_values(m: &MeshValues, of: impl Fn([f64; 3]) -> Vec<f64>, tolerance: f64) {
    assert_eq!(m.per(), ValuesPer::Corner);
    for f in 0..m.len() {
        for (corner, values) in m.corners(f).iter().zip(m.values(f).chunks_exact(m.bands.len())) {
            close(values, &of(of_vertex(*corner)), tolerance);
        }
    }
}

#[test]
fn ply_of_faces_and_of_vertices() {
    // Floats go before the bytes that the file has too.
    let faces = read("face_big.ply");
    holds_face_values(&faces, 1e-7);
    assert!(faces.notices.is_empty(), "{:?}", faces.notices);
    let bytes = read_with("face_big.ply", &fields(&["red", "green", "blue"])).unwrap();
    close(bytes.values(1), &[10.0 / 255.0, 20.0 / 255.0, 30.0 / 255.0], 1e-15);
    assert!(bytes.notices[0].contains("steps of 1/255"), "{:?}", bytes.notices);
    let one = read_with("face_big.ply", &fields(&["g"])).unwrap();
    assert_eq!(one.bands, ["y"]);
    let vertices = read("vertex.ply");
    is_the_mesh(&vertices, 4);
    holds_vertex_values(&vertices, |v| v.to_vec(), 0.0);
}

#[test]
fn colours_of_eight_bits_are_read_and_told_of() {
    for name in ["bytes.ply", "bytes.glb"] {
        let options = MeshValuesOptions { y_up: Some(false), ..MeshValuesOptions::default() };
        let m = read_with(name, &options).unwrap();
        is_the_mesh(&m, 4);
        assert_eq!(m.bands, ["r", "g", "b"]);
        // Steps of 51 = 255 / 5 in the order of the vertices.
        close(m.values(0), &[0.0, 0.2, 1.0, 0.2, 0.2, 1.0, 0.4, 0.2, 1.0], 1e-15);
        assert!(m.notices.iter().any(|n| n.contains("steps of 1/255")), "{name} {:?}", m.notices);
    }
}

#[test]
fn gltf_colours_of_floats_with_y_up() {
    let m = read("floats.gltf");
    is_the_mesh(&m, 4);
    holds_vertex_values(&m, |v| v.to_vec(), 1e-7);
    assert!(m.notices.is_empty(), "{:?}", m.notices);
}

#[test]
fn obj_colours_and_tables() {
    let m = read("mesh.obj");
    is_the_mesh(&m, 3);
    holds_vertex_values(&m, |v| v.to_vec(), 0.0);
    let table = |name: &str| MeshValuesOptions { table: Some(file(name)), ..MeshValuesOptions::default() };
    holds_face_values(&read_with("mesh.obj", &table("faces.csv")).unwrap(), 1e-15);
    let m = read_with("mesh.obj", &table("vertices.csv")).unwrap();
    assert_eq!(m.bands, ["y"]);
    holds_vertex_values(&m, |v| vec![v[0]], 0.0);
    assert!(m.notices[0].contains("1 columns of errors"), "{:?}", m.notices);
}

#[test]
fn vtu_of_meshio() {
    holds_face_values(&read("cell_ascii.vtu"), 1e-11);
    holds_face_values(&read("cell_inline.vtu"), 0.0);
    holds_face_values(&read("cell_zlib.vtu"), 0.0);
    let m = read("point_zlib.vtu");
    is_the_mesh(&m, 3);
    assert_eq!(m.bands, ["y"]);
    holds_vertex_values(&m, |v| vec![v[0]], 0.0);
    let m = read_with("point_zlib.vtu", &fields(&["B", "temperature"])).unwrap();
    assert_eq!(m.bands, ["B", "temperature"]);
    holds_vertex_values(&m, |v| v[..2].to_vec(), 0.0);
    let e = read_with("point_zlib.vtu", &fields(&["C"])).unwrap_err();
    assert!(e.mend.contains("B, temperature"), "{e}");
}

#[test]
fn vtu_of_vtk_in_every_coding() {
    for name in ["vtk_raw", "vtk_base64", "vtk_plain", "vtk_big", "vtk_ascii"] {
        let m = read(&format!("{name}.vtu"));
        // The strip makes two triangles; the line is left out.
        assert_eq!((m.len(), m.bands.join("")), (4, "rgb".into()), "{name}");
        let areas: Vec<f64> = (0..4).map(|f| area(m.corners(f))).collect();
        close(&areas, &[0.5, 0.5, 1.0, 1.25], 1e-12);
        assert!((0..4).all(|f| unit_normal(m.corners(f)) == DVec3::Z), "{name}");
        let expected = [[1.0, 0.5, 4.0], [1.0, 0.5, 4.0], [2.0, 0.25, 5.0], [3.0, 0.125, 6.0]];
        (0..4).for_each(|f| assert_eq!(m.values(f), expected[f], "{name}"));
        assert!(m.notices[0].contains("1 points and lines"), "{:?}", m.notices);
    }
}

#[test]
fn lightmaps_are_cut_along_their_texels() {
    for (mesh, tolerance) in [("mesh.obj", 1e-12), ("floats.gltf", 1e-6)] {
        let options = MeshValuesOptions { mesh: Some(file(mesh)), ..MeshValuesOptions::default() };
        let m = read_with("map.exr", &options).unwrap();
        assert_eq!((m.per(), m.bands.join("")), (ValuesPer::Face, "rgb".into()));
        let total: f64 = (0..m.len()).map(|f| area(m.corners(f))).sum();
        // One texel of 0.5 m x 1/3 m is empty.
        assert!((total - (2.0 - 1.0 / 6.0)).abs() < tolerance, "{total}");
        for f in 0..m.len() {
            let c = centroid(m.corners(f));
            let (column, row) = ((c.x / 0.5).floor(), ((1.0 - c.y) * 3.0).floor());
            assert_eq!(m.values(f), [column, row, 0.5], "{mesh} {c}");
            assert!((column, row) != (3.0, 0.0) && unit_normal(m.corners(f)).z > 0.999_999);
        }
        assert!(m.notices.iter().any(|n| n.contains("8.333 % of the area lies on empty texels")), "{:?}", m.notices);
        let m = read_with("grey.exr", &options).unwrap();
        assert_eq!(m.bands, ["y"]);
        let power: f64 = (0..m.len()).map(|f| area(m.corners(f)) * m.values(f)[0]).sum();
        // Mean over all texels: column 1.5 + 10 rows of mean 1, over two square metres.
        assert!((power - 2.0 * 11.5).abs() < 20.0 * tolerance, "{power}");
    }
}

#[test]
fn units_and_axes_can_be_given() {
    let options = MeshValuesOptions { scale: 0.01, y_up: Some(true), ..MeshValuesOptions::default() };
    let m = read_with("face_big.ply", &options).unwrap();
    assert_eq!(m.corners(2)[2], DVec3::new(0.02, -0.0025, 0.01));
}

/// Radiosities that differ everywhere, with errors.
fn solution(stage: &etalon::Stage) -> Radiosity {
    let bands = stage.photometry.bands.len();
    let count = stage.patch_count() * bands;
    let values = (0..count).map(|k| 1.0 / 3.0 + k as f64).collect();
    Radiosity { bands, values, std_err: Some((0..count).map(|k| 1e-3 / (k + 1) as f64).collect()) }
}

#[test]
fn what_is_written_on_patches_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    for scene in ["builtin:furnished-room", "builtin:opposed-squares"] {
        let stage = open_scene(scene, &SceneOptions::default()).unwrap().at(0).unwrap();
        let b = solution(&stage);
        for (name, bytes) in [("a.vtu", write_vtu(&stage, &b)), ("a.ply", write_ply_values(&stage, &b))] {
            let path = folder.path().join(name);
            std::fs::write(&path, &bytes).unwrap();
            let m = read_mesh_values(&path, &MeshValuesOptions::default()).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((&m.bands, m.per()), (&stage.photometry.bands, ValuesPer::Face));
            let present: Vec<usize> = (0..b.len()).filter(|i| stage.patches[*i].is_present()).collect();
            assert_eq!(m.len(), present.len(), "{name} {scene} {:?}", m.notices);
            for (f, i) in present.iter().enumerate() {
                assert_eq!(m.values(f), b.of(*i), "{name} {scene}");
                let same = |(p, q): (&DVec3, &DVec3)| *p + 0.0 == *q;
                assert!(stage.patches[*i].corners.iter().zip(m.corners(f)).all(same), "{name} {scene}");
            }
            let errors = read_mesh_values(&path, &fields(&[&format!("radiosity_{}_std_err", m.bands[0])])).unwrap();
            assert_eq!(errors.values(0)[0], b.std_err.as_ref().unwrap()[present[0] * b.bands]);
            assert_eq!(bytes, if name == "a.vtu" { write_vtu(&stage, &b) } else { write_ply_values(&stage, &b) });
        }
        let bare = Radiosity { std_err: None, ..b };
        assert!(!String::from_utf8(write_ply_values(&stage, &bare)).unwrap().contains("std_err"));
        assert!(!String::from_utf8(write_vtu(&stage, &bare)).unwrap().contains("std_err"));
    }
}

#[test]
fn faces_that_are_bent_or_concave_are_cut_and_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("l.obj");
    let l = "v 0 0 0 1 0 0\nv 3 0 0 4 0 0\nv 3 1 0 4 0 1\nv 1 1 0 2 0 1\nv 1 3 0 2 0 3\nv 0 3 0 1 0 3\n\
             f 1 2 3 4 5 6\nf 1 1 2\n";
    std::fs::write(&path, l).unwrap();
    let m = read_mesh_values(&path, &MeshValuesOptions::default()).unwrap();
    assert_eq!(m.len(), 4);
    let total: f64 = (0..4).map(|f| area(m.corners(f))).sum();
    assert!((total - 5.0).abs() < 1e-14);
    for f in 0..4 {
        for (p, v) in m.corners(f).iter().zip(m.values(f).chunks_exact(3)) {
            assert_eq!(v, [1.0 + p.x, 0.0, p.y]);
        }
    }
    assert!(m.notices[0].starts_with("l.obj, line 7: 1 faces that are not planar or not convex"), "{:?}", m.notices);
    assert!(m.notices[1].starts_with("l.obj, line 8: 1 faces without area"), "{:?}", m.notices);
}
