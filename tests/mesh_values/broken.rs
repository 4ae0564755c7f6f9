//! Broken files: one message with place and mend each, never a panic.

use super::file;
use etalon::io::{FileError, MeshValuesOptions, read_mesh_values};
use std::path::Path;

/// A change to a sound file: what is replaced by what, and what place and problem must then say.
type Change = (&'static str, &'static str, &'static str, &'static str);

fn refusal(path: &Path, options: &MeshValuesOptions, about: &str) -> FileError {
    let e = match std::panic::catch_unwind(|| read_mesh_values(path, options)) {
        Ok(Err(e)) => e,
        Ok(Ok(_)) => panic!("accepted: {about}"),
        Err(_) => panic!("a panic: {about}"),
    };
    assert!(!e.problem.is_empty() && !e.mend.is_empty(), "{about}: {e}");
    e
}

/// Tries each change of a text and demands that twenty or more are refused as they should be.
fn try_all(name: &str, text: &str, options: impl Fn(&Path) -> MeshValuesOptions, changes: &[Change]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    let sound = options(folder.path());
    let main = if name.ends_with(".csv") { folder.path().join("mesh.obj") } else { path.clone() };
    read_mesh_values(&main, &sound).unwrap_or_else(|e| panic!("the sound file: {e}"));
    assert!(changes.len() >= 20, "{} changes", changes.len());
    for (from, to, place, problem) in changes {
        assert!(from.is_empty() || text.contains(from), "{from:?} is not in the file");
        let broken = if from.is_empty() { to.to_string() } else { text.replacen(from, to, 1) };
        std::fs::write(&path, &broken).unwrap();
        let e = refusal(&main, &sound, &format!("{from:?} -> {to:?}"));
        assert_eq!(e.path, path, "{e}");
        assert!(e.place.contains(place), "{from:?} -> {to:?}: place \"{}\" lacks \"{place}\" ({e})", e.place);
        assert!(e.problem.contains(problem), "{from:?} -> {to:?}: {e}");
    }
}

fn plain(_: &Path) -> MeshValuesOptions {
    MeshValuesOptions::default()
}

#[test]
fn ply() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nproperty float r\nproperty float g\n\
                property float b\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 0.25 0.125\n";
    try_all(
        "a.ply",
        text,
        plain,
        &[
            ("", "", "line 1", "does not begin"),
            ("", "plx\n", "line 1", "does not begin"),
            ("ascii 1.0", "ascii 2.0", "line 2", "version"),
            ("format ascii 1.0\n", "", "line 11", "no format line"),
            ("element vertex 3", "element vertex many", "line 3", "not a count"),
            ("element vertex 3", "element vertex 4", "line 16", "too many"),
            ("element vertex 3", "element vertex 2", "line 15", "too few"),
            ("property float x\n", "", "line 3", "lack x"),
            ("float r", "colour r", "line 9", "unknown type"),
            ("float r", "list uchar float r", "", "no property holds values"),
            ("property float r\n", "", "", "no property holds values"),
            ("vertex_indices", "corners", "line 7", "no list"),
            ("end_header\n", "", "line", "unknown header line"),
            ("0.5", "nan", "line 16", "a value is NaN"),
            ("0.25", "inf", "line 16", "a value is inf"),
            ("0.125", "much", "line 16", "not a number"),
            (" 0.125", "", "line 16", "too few"),
            ("3 0 1 2", "3 0 1 3", "line 16", "names vertex 3"),
            ("3 0 1 2", "2 0 1", "line 16", "2 corners"),
            ("3 0 1 2", "-3 0 1 2", "line 16", "too many"),
            ("1 0 0\n", "1 0 nan\n", "line 14", "not finite"),
            ("3 0 1 2 0.5 0.25 0.125\n", "", "line 15", "ends after 0 of 1"),
            ("0 1 0\n", "2 0 0\n", "", "no face with an area"),
        ],
    );
}

#[test]
fn ply_in_binary() {
    let sound = std::fs::read(file("face_big.ply")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply");
    for end in (0..sound.len()).step_by(sound.len() / 24) {
        std::fs::write(&path, &sound[..end]).unwrap();
        refusal(&path, &MeshValuesOptions::default(), &format!("cut at {end}"));
    }
    let mut nan = sound.clone();
    let at = sound.len() - 12;
    nan[at..at + 4].copy_from_slice(&f32::NAN.to_be_bytes());
    std::fs::write(&path, nan).unwrap();
    let e = refusal(&path, &MeshValuesOptions::default(), "NaN");
    assert_eq!((e.place.as_str(), e.problem.as_str()), ("face 2", "a value is NaN"));
}

#[test]
fn obj() {
    let text = "v 0 0 0 1 0.5 0.25\nv 1 0 0 1 1 1\nv 0 1 0 2 2 2\nf 1 2 3\n";
    try_all(
        "a.obj",
        text,
        plain,
        &[
            ("", "", "", "no face with an area"),
            ("", "<html>\n", "line 1", "unknown statement"),
            ("1 0.5 0.25", "", "line 1", "no colour"),
            ("1 0.5 0.25", "1", "line 1", "no colour"),
            ("1 0.5 0.25", "1 0.5", "line 1", "5 numbers"),
            ("2 2 2", "2 2 2 2 2", "line 3", "8 numbers"),
            ("0.5", "nan", "line 1", "not finite"),
            ("0.5", "inf", "line 1", "not finite"),
            ("0.5", "half", "line 1", "not a number"),
            ("0.5", "1e400", "line 1", "not finite"),
            ("v 1 0 0", "v 1e12 0 0", "line 2", "beyond"),
            ("v 1 0 0", "v one 0 0", "line 2", "not a number"),
            ("f 1 2 3", "f 1 2 4", "line 4", "names vertex 4"),
            ("f 1 2 3", "f 0 1 2", "line 4", "names vertex 0"),
            ("f 1 2 3", "f 1 2 -9", "line 4", "names vertex -9"),
            ("f 1 2 3", "f 1 2 x", "line 4", "not a corner"),
            ("f 1 2 3", "f 1 2/x 3", "line 4", "not a corner"),
            ("f 1 2 3", "f", "line 4", "no corners"),
            ("f 1 2 3", "f 1 2", "", "no face with an area"),
            ("f 1 2 3", "f 1 1 1", "", "no face with an area"),
            ("f 1 2 3", "f 1/1/1/1 2 3", "line 4", "not a corner"),
            ("f 1 2 3", "usemtl\nf 1 2 3", "line 4", "name is missing"),
        ],
    );
}

#[test]
fn tables() {
    let text = "face,r,g\n0,1.5,0.5\n1,2.5,0.25\n2,3.5,0\n";
    let options = |folder: &Path| {
        std::fs::copy(file("mesh.obj"), folder.join("mesh.obj")).unwrap();
        MeshValuesOptions { table: Some(folder.join("a.csv")), ..MeshValuesOptions::default() }
    };
    try_all(
        "a.csv",
        text,
        options,
        &[
            ("", "", "", "is empty"),
            ("", "face\n0\n1\n2\n", "line 1", "no bands"),
            ("", "face,r\n", "0 rows for 3", "has no row"),
            ("face,", "patch,", "line 1", "called \"patch\""),
            ("face,", "vertex,", "3 rows for 6", "vertex 3"),
            ("r,g", "r,r", "line 1", "like another"),
            ("r,g", "r,", "line 1", "like nothing"),
            ("r,g", "r_std_err,g_std_err", "line 1", "no bands"),
            ("r,g", "r", "line 2", "3 cells"),
            ("0,1.5,0.5\n", "", "2 rows for 3", "face 0"),
            ("2,3.5,0\n", "", "2 rows for 3", "face 2"),
            ("2,3.5", "3,3.5", "line 4", "does not exist"),
            ("2,3.5", "18446744073709551615,3.5", "line 4", "does not exist"),
            ("2,3.5", "1,3.5", "line 4", "stands in line 3"),
            ("2,3.5", "-1,3.5", "line 4", "not the number"),
            ("2,3.5", "1.5,3.5", "line 4", "not the number"),
            ("2,3.5", "two,3.5", "line 4", "not the number"),
            ("0.25", "nan", "line 3", "face 1: g is \"nan\""),
            ("0.25", "-inf", "line 3", "not a finite number"),
            ("0.25", "", "line 3", "not a finite number"),
            ("0.25", "a lot", "line 3", "not a finite number"),
            (",0.25", "", "line 3", "2 cells"),
        ],
    );
}

/// A triangle in one buffer: positions, colours.
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
"buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAECAwQFBgcICQoLDA"}]}"#;

#[test]
fn gltf() {
    try_all(
        "a.gltf",
        GLTF,
        plain,
        &[
            ("", "", "line 1", "EOF"),
            ("", "{}", "line 1", "missing field"),
            ("\"2.0\"", "\"1.0\"", "asset", "version is 1.0"),
            ("\"COLOR_0\"", "\"COLOR_1\"", "meshes[0].primitives[0].attributes", "no COLOR_0"),
            ("\"COLOR_0\": 1", "\"COLOR_0\": 2", "accessors[2]", "2 accessors"),
            ("\"COLOR_0\": 1", "\"COLOR_0\": -1", "line 2", "invalid value"),
            ("\"VEC4\"", "\"VEC2\"", "accessors[1].type", "VEC2"),
            ("5121", "5125", "accessors[1].componentType", "5125"),
            ("5121", "5126", "accessors[1].count", "do not fit"),
            ("\"normalized\": true", "\"normalized\": false", "accessors[1].normalized", "not normalised"),
            ("true, \"count\": 3", "true, \"count\": 2", "meshes[0].primitives[0].attributes", "2 items for 3"),
            ("true, \"count\": 3", "true, \"count\": 18446744073709551615", "accessors[1].count", "do not fit"),
            ("\"byteLength\": 12", "\"byteLength\": 8", "accessors[1].count", "do not fit"),
            ("\"byteOffset\": 36", "\"byteOffset\": 40", "bufferViews[1].byteLength", "ends beyond"),
            ("\"bufferView\": 1", "\"bufferView\": 7", "accessors[1].bufferView", "no buffer view 7"),
            ("\"byteLength\": 48", "\"byteLength\": 64", "buffers[0].byteLength", "48 bytes"),
            ("base64,AAAA", "base64,A*AA", "buffers[0].uri", "broken"),
            ("data:application/octet-stream;base64,", "https://example.org/", "buffers[0].uri", "https address"),
            ("\"nodes\": [{\"mesh\": 0}]", "\"nodes\": [{\"mesh\": 4}]", "nodes[0].mesh", "no mesh 4"),
            ("\"scenes\": [{\"nodes\": [0]}]", "\"scenes\": [{\"nodes\": []}]", "", "no face with an area"),
            ("{\"bufferView\": 1,", "{\"sparse\": {}, \"bufferView\": 1,", "accessors[1].sparse", "sparse"),
            ("[{\"attributes\"", "[{\"mode\": 9, \"attributes\"", "meshes[0].primitives[0].mode", "mode 9"),
            ("\"normalized\"", "\"extra\": , \"normalized\"", "line 4", "expected value"),
        ],
    );
    // Colours of floats that are not finite: 0x7fc00000 is NaN.
    let nan = GLTF.replace(
        "5121, \"normalized\": true, \"count\": 3, \"type\": \"VEC4\"",
        "5126, \"count\": 3, \"type\": \"SCALAR\"",
    );
    let nan = nan.replace("ECAwQFBgcICQoLDA", "AADAfwAAAAAAAAAA");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("nan.gltf");
    std::fs::write(&path, nan).unwrap();
    let e = refusal(&path, &MeshValuesOptions::default(), "NaN");
    assert_eq!((e.place.as_str(), e.problem.as_str()), ("accessors[1], vertex 0", "a value is NaN"));
}

const VTU: &str = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian" header_type="UInt32">
<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="2">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 0 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5 5</DataArray>
</Cells>
<CellData>
<DataArray type="Float64" Name="radiosity" format="binary">EAAAAAAAAAAAAPA/AAAAAAAAAEA=</DataArray>
</CellData>
</Piece></UnstructuredGrid></VTKFile>
"#;

#[test]
fn vtu() {
    try_all(
        "a.vtu",
        VTU,
        plain,
        &[
            ("", "", "line 1", "no sound XML"),
            ("</Cells>", "", "line", "no sound XML"),
            ("<VTKFile type=\"UnstructuredGrid\"", "<VTKFile type=\"PolyData\"", "line 2", "holds PolyData"),
            ("LittleEndian", "MiddleEndian", "line 2", "byte order"),
            ("UInt32\">", "UInt16\">", "line 2", "header type"),
            ("header_type=", "compressor=\"vtkLZ4DataCompressor\" header_type=", "line 2", "compressor"),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"four\"", "line 3", "is \"four\""),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"", "line 4", "12 numbers, but 15"),
            ("NumberOfCells=\"2\"", "NumberOfCells=\"3\"", "line 8", "2 numbers, but 3"),
            ("NumberOfCells=\"2\"", "", "line 3", "no NumberOfCells"),
            ("1 1 0 0 1 0", "1 1 0 0 1 x", "line 4", "number 11 is \"x\""),
            ("1 1 0 0 1 0", "1 1 0 0 1 nan", "cell 1", "not finite"),
            ("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"", "line 4", "2 numbers"),
            ("type=\"Float32\"", "type=\"Float16\"", "line 4", "Float16"),
            ("0 1 2 0 2 3", "0 1 2 0 2 4", "line 6, array \"connectivity\"", "number 5 is 4"),
            ("0 1 2 0 2 3", "0 1 2 0 2 -1", "line 6", "number 5 is -1"),
            ("Name=\"offsets\"", "Name=\"ends\"", "line 3", "no array \"offsets\""),
            ("3 6</", "6 3</", "line 7", "less than the one before"),
            ("3 6</", "3 7</", "line 7", "number 1 is 7"),
            ("3 6</", "2 6</", "cell 0", "with 2 corners"),
            (">5 5</", ">10 5</", "cell 0", "a tetrahedron"),
            (">5 5</", ">5 22</", "cell 1", "curved"),
            (">5 5</", ">5 42</", "cell 1", "a polyhedron"),
            ("type=\"Float64\" Name=\"radiosity\"", "type=\"Int64\" Name=\"part\"", "line 3", "not plain"),
            ("AEA=", "AE", "line 11, array \"radiosity\"", "base64"),
            ("EAAAAA", "EAEAAA", "line 11", "announced"),
            ("EAAAAA", "CAAAAA", "line 11", "1 numbers, but 2"),
            ("EAAAAAAAAAAAAPA/AAAAAAAAAEA=", "EAAAAAAAAAAAAPh/AAAAAAAAAEA=", "cell 0", "the value of y is NaN"),
            ("format=\"binary\"", "format=\"appended\" offset=\"0\"", "line 11", "no <AppendedData>"),
            ("format=\"binary\"", "format=\"hex\"", "line 11", "\"hex\" does not exist"),
            (
                "</UnstructuredGrid></VTKFile>",
                "</UnstructuredGrid><AppendedData encoding=\"hex\">_0</AppendedData></VTKFile>",
                "<AppendedData>",
                "neither raw",
            ),
        ],
    );
}

#[test]
fn vtu_of_vtk_cut_short() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    for name in ["vtk_raw.vtu", "vtk_base64.vtu", "vtk_big.vtu", "cell_zlib.vtu"] {
        let sound = std::fs::read(file(name)).unwrap();
        let close = sound.windows(4).rposition(|w| w == b"\n  <" || w == b"</Ap").unwrap_or(sound.len()) - 40;
        for end in (0..close).step_by(close / 24) {
            std::fs::write(&path, &sound[..end]).unwrap();
            refusal(&path, &MeshValuesOptions::default(), &format!("{name} cut at {end}"));
        }
    }
}

#[test]
fn lightmaps() {
    let folder = tempfile::tempdir().unwrap();
    let (map, mesh) = (folder.path().join("a.exr"), folder.path().join("a.obj"));
    let options = MeshValuesOptions { mesh: Some(mesh.clone()), ..MeshValuesOptions::default() };
    let (picture, text) = (std::fs::read(file("map.exr")).unwrap(), std::fs::read_to_string(file("mesh.obj")).unwrap());
    std::fs::write(&map, &picture).unwrap();
    let changes: &[Change] = &[
        ("vt 0.5 1.0", "vt 0.5 1.5", "line 13", "outside the picture"),
        ("vt 0.0 0.0", "vt -0.1 0.0", "line 13", "outside the picture"),
        ("vt 0.0 0.0", "vt nan 0.0", "line 7", "not finite"),
        ("vt 0.0 0.0", "vt 0.0", "line 7", "1 numbers"),
        ("vt 0.5 1.0", "vt 0.25 0.0", "line 13", "no area in the picture"),
        ("f 1/1", "f 1", "line 13", "no texture coordinates"),
        ("f 1/1", "f 1/9", "line 13", "names texture point 9"),
        ("f 1/1", "f 1/0", "line 13", "names texture point 0"),
        ("v 0.0 0.0 0.25", "v 0.0 0.0 1e300", "line 1", "not finite or beyond"),
    ];
    for (from, to, place, problem) in changes {
        assert!(text.contains(from), "{from}");
        std::fs::write(&mesh, text.replacen(from, to, 1)).unwrap();
        let e = refusal(&map, &options, to);
        assert!(e.path == mesh && e.place.contains(place) && e.problem.contains(problem), "{from} -> {to}: {e}");
    }
    std::fs::write(&mesh, &text).unwrap();
    let other = |o: MeshValuesOptions| refusal(&map, &o, "options");
    let base = || options.clone();
    assert!(other(MeshValuesOptions { mesh: None, ..base() }).mend.contains("--mesh"));
    assert!(other(MeshValuesOptions { mesh: Some("a.ply".into()), ..base() }).problem.contains(".ply"));
    assert!(other(MeshValuesOptions { mesh: Some("none.obj".into()), ..base() }).problem.contains("no such file"));
    assert!(other(MeshValuesOptions { table: Some("a.csv".into()), ..base() }).problem.contains("a table"));
    assert!(
        other(MeshValuesOptions { fields: Some(vec!["Z".into()]), ..base() }).mend.contains("there are A, B, G, R")
    );
    assert!(other(MeshValuesOptions { fields: Some(vec![]), ..base() }).place == "header");
    assert!(other(MeshValuesOptions { scale: 0.0, ..base() }).problem.contains("0 m"));
    assert!(other(MeshValuesOptions { scale: 1e300, ..base() }).problem.contains("beyond"));
    for end in (0..picture.len() - 1).step_by(picture.len() / 24) {
        std::fs::write(&map, &picture[..end]).unwrap();
        refusal(&map, &options, &format!("cut at {end}"));
    }
}

#[test]
fn names_that_tell_no_format() {
    for name in ["a", "a.stl", "a.vtk"] {
        assert!(!etalon::io::is_mesh_values(Path::new(name)));
        assert!(refusal(Path::new(name), &MeshValuesOptions::default(), name).mend.contains(".vtu"));
    }
    for name in ["none.ply", "none.vtu", "none.obj", "none.glb"] {
        let e = refusal(Path::new(name), &MeshValuesOptions::default(), name);
        assert!(e.to_string().contains("no such file"), "{e}");
    }
    let mesh = MeshValuesOptions { mesh: Some("b.obj".into()), ..MeshValuesOptions::default() };
    assert!(refusal(Path::new("a.vtu"), &mesh, "mesh").mend.contains("lightmaps only"));
}
