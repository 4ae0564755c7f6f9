//! Broken mesh files, made from sound ones by one change each.

use crate::gltf;
use serde_json::{Value, json};

/// A broken file with what its refusal must say.
pub struct Case {
    pub name: String,
    /// Mesh file that the scene names.
    pub file: String,
    /// Files beside the scene.
    pub files: Vec<(String, Vec<u8>)>,
    /// False if the mesh has to bring its own materials.
    pub material: bool,
    pub parts: Vec<String>,
}

fn case(name: &str, file: &str, bytes: Vec<u8>, parts: &[&str]) -> Case {
    Case {
        name: name.into(),
        file: file.into(),
        files: vec![(file.into(), bytes)],
        material: true,
        parts: parts.iter().map(|p| p.to_string()).collect(),
    }
}

pub fn all() -> Vec<Case> {
    [obj_cases(), mtl_cases(), ply_text_cases(), ply_binary_cases(), gltf_cases(), glb_cases()]
        .into_iter()
        .flatten()
        .collect()
}

/// A text with one change, which must be one.
fn changed(base: &str, from: &str, to: &str) -> String {
    assert!(base.contains(from), "{from:?} is not in the base");
    base.replacen(from, to, 1)
}

// ---- OBJ and MTL ----

const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl white\nf 1 2 3 4\n";

fn obj_cases() -> Vec<Case> {
    #[rustfmt::skip]
    let table: &[(&str, &str, &str, &[&str])] = &[
        ("vertex beyond reach", "v 1 1 0", "v 1e10 1 0", &["m.obj:4", "beyond 1e9"]),
        ("vertex of seven numbers and a word", "v 1 1 0", "v 1 1 0 x", &["m.obj:4", "\"x\" is not a number"]),
        ("face without corners", "f 1 2 3 4", "f", &["m.obj:7", "no corners"]),
        ("corner of four parts", "f 1 2 3 4", "f 1/1/1/1 2 3", &["m.obj:7", "is not a corner"]),
        ("corner that is a fraction", "f 1 2 3 4", "f 1.5 2 3", &["m.obj:7", "is not a corner"]),
        ("corner beyond all numbers", "f 1 2 3 4", "f 99999999999999999999 2 3", &["m.obj:7", "is not a corner"]),
        ("usemtl without a name", "usemtl white", "usemtl", &["m.obj:6", "a name is missing"]),
        ("a face before its vertices", "mtllib m.mtl", "f 1 2 3", &["m.obj:1", "names vertex 1, but 0"]),
        ("another language", "mtllib m.mtl", "<x3d>", &["m.obj:1", "unknown statement", "Wavefront"]),
        ("a face of one point", "f 1 2 3 4", "f 1 1 1", &["scene.toml:8", "no face with an area"]),
    ];
    let made = |(name, from, to, parts): &(&str, &str, &str, &[&str])| {
        case(&format!("obj: {name}"), "m.obj", changed(OBJ, from, to).into_bytes(), parts)
    };
    let mut cases: Vec<Case> = table.iter().map(made).collect();
    let many: String = (0..5000).map(|i| format!("v {} {} 0\n", i, i * i)).collect();
    let corners: String = (1..=5000).map(|i| format!(" {i}")).collect();
    cases.push(case(
        "obj: 5000 corners",
        "m.obj",
        format!("{many}f{corners}\n").into_bytes(),
        &["m.obj:5001", "5000 corners"],
    ));
    cases.push(case("obj: empty", "m.obj", Vec::new(), &["scene.toml:8", "no face with an area"]));
    cases.push(case("obj: binary", "m.obj", vec![0, 159, 146, 150], &["m.obj:1", "unknown statement"]));
    cases.push(case(
        "no mesh format",
        "m.stl",
        b"solid".to_vec(),
        &["scene.toml:8", "no ending that names a mesh format", ".glb"],
    ));
    cases
}

fn mtl_cases() -> Vec<Case> {
    #[rustfmt::skip]
    let table: &[(&str, &str, &[&str])] = &[
        ("without a name", "newmtl\nKd .5 .5 .5\n", &["m.mtl:1", "newmtl without a name"]),
        ("colour first", "Kd .5 .5 .5\nnewmtl white\n", &["m.mtl:1", "before the first newmtl"]),
        ("two numbers", "newmtl white\nKd .5 .5\n", &["m.mtl:2", "2 numbers"]),
        ("no numbers", "newmtl white\nKe\n", &["m.mtl:2", "0 numbers"]),
        ("spectral", "newmtl white\nKd spectral file.rfl\n", &["m.mtl:2", "spectral"]),
        ("not finite", "newmtl white\n\nKd nan 0 0\n", &["m.mtl:3", "not finite"]),
        ("endless light", "newmtl white\nKd 0 0 0\nKe inf 0 0\n", &["m.mtl:3", "not finite"]),
        ("negative", "newmtl white\nKd -.1 0 0\n", &["m.obj:6", "Kd = -0.1 (m.mtl:2)", "outside [0, 1)"]),
        ("grey above one", "newmtl white\nKd 1.5\n", &["m.obj:6", "Kd = 1.5"]),
        ("another case", "newmtl White\nKd .5\n", &["m.obj:6", "did you mean \"White\""]),
        ("empty", "", &["m.obj:6", "there are none"]),
    ];
    let made = |(name, text, parts): &(&str, &str, &[&str])| {
        let mut c = case(&format!("mtl: {name}"), "m.obj", OBJ.into(), parts);
        c.files.push(("m.mtl".into(), text.as_bytes().to_vec()));
        c.material = false;
        c
    };
    table.iter().map(made).collect()
}

// ---- PLY ----

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

fn ply_text_cases() -> Vec<Case> {
    #[rustfmt::skip]
    let table: &[(&str, &str, &str, &[&str])] = &[
        ("wrong magic", "ply\n", "plz\n", &["m.ply:1", "does not begin with \"ply\""]),
        ("no format", "format ascii 1.0\n", "", &["m.ply:8", "no format line"]),
        ("unknown format", "ascii", "utf8", &["m.ply:2", "unknown format \"utf8 1.0\""]),
        ("newer format", "1.0", "2.0", &["m.ply:2", "version is not 1.0"]),
        ("format without version", " 1.0", "", &["m.ply:2", "version is not 1.0"]),
        ("unknown header line", "property double y", "propperty double y", &["m.ply:5", "unknown header line \"propperty\""]),
        ("unknown type", "double y", "real y", &["m.ply:5", "unknown type \"real\""]),
        ("property of no element", "element vertex 4\n", "", &["m.ply:3", "before the first element"]),
        ("count in words", "vertex 4", "vertex four", &["m.ply:3", "\"four\" is not a count"]),
        ("negative count", "vertex 4", "vertex -4", &["m.ply:3", "\"-4\" is not a count"]),
        ("element without count", "vertex 4", "vertex", &["m.ply:3", "unknown header line \"element\""]),
        ("no end of the header", "end_header\n", "", &["m.ply:9", "unknown header line \"0\""]),
        ("no vertices", "element vertex", "element point", &["m.ply", "no element \"vertex\""]),
        ("a cloud of points", "element face", "element facet", &["m.ply", "no element \"face\"", "cloud of points"]),
        ("strips", "element face", "element tristrips", &["m.ply", "instead of tristrips"]),
        ("a vertex without z", "double z", "double w", &["m.ply:3", "lack x, y or z"]),
        ("z as a list", "property double z", "property list uchar double z", &["m.ply:3", "lack x, y or z"]),
        ("no list of corners", "vertex_indices", "corners", &["m.ply:7", "no list vertex_indices"]),
        ("corners that are no list", "list uchar int vertex_indices", "int vertex_indices", &["m.ply:7", "no list vertex_indices"]),
        ("corners as fractions", "uchar int", "uchar float", &["m.ply:7", "list of fractions"]),
        ("count as fraction", "uchar int", "float int", &["m.ply:8", "count of a list is a fraction"]),
        ("list without a count type", "list uchar int", "list int", &["m.ply:8", "of this shape does not exist"]),
        ("element without properties", "element face", "element edge 2\nelement face", &["m.ply:7", "\"edge\" has no properties"]),
        ("second element", "element face", "element vertex", &["m.ply:7", "second element \"vertex\""]),
        ("more vertices than there are", "vertex 4", "vertex 5", &["m.ply:14", "\"vertex\" has too many numbers"]),
        ("fewer vertices than there are", "vertex 4", "vertex 3", &["m.ply:13", "\"face\" has too many numbers"]),
        ("more faces than there are", "face 1", "face 2", &["m.ply:14", "after 1 of 2 elements \"face\""]),
        ("a count beyond the file", "face 1", "face 18446744073709551615", &["m.ply:14", "after 1 of 18446744073709551615"]),
        ("fewer faces than there are", "face 1", "face 0", &["m.ply:14", "lines are left"]),
        ("not a number", "1 1 0", "1 nan 0", &["m.ply:12", "not finite"]),
        ("a word", "1 1 0", "1 oh 0", &["m.ply:12", "\"oh\" is not a number"]),
        ("out of reach", "1 1 0", "1 1e12 0", &["m.ply:12", "beyond 1e9"]),
        ("two coordinates", "1 1 0", "1 1", &["m.ply:12", "too few numbers"]),
        ("corner too high", "4 0 1 2 3", "4 0 1 2 4", &["m.ply:14", "names vertex 4, but there are 4"]),
        ("corner too low", "4 0 1 2 3", "4 0 1 2 -1", &["m.ply:14", "names vertex -1"]),
        ("corner as fraction", "4 0 1 2 3", "4 0 1 2 2.5", &["m.ply:14", "\"2.5\" is not a whole number"]),
        ("face of two corners", "4 0 1 2 3", "2 0 1", &["m.ply:14", "2 corners"]),
        ("face of no corners", "4 0 1 2 3", "0", &["m.ply:14", "0 corners"]),
        ("negative list", "4 0 1 2 3", "-4 0 1 2 3", &["m.ply:14", "too many numbers"]),
        ("list beyond the line", "4 0 1 2 3", "4000000000 0 1 2 3", &["m.ply:14", "too few numbers"]),
        ("only a sliver", "4 0 1 2 3", "3 0 1 1", &["scene.toml:8", "no face with an area"]),
        ("a bow tie", "4 0 1 2 3", "5 0 2 3 1 3", &["m.ply:14", "crosses itself"]),
    ];
    let made = |(name, from, to, parts): &(&str, &str, &str, &[&str])| {
        case(&format!("ply: {name}"), "m.ply", changed(PLY, from, to).into_bytes(), parts)
    };
    let mut cases: Vec<Case> = table.iter().map(made).collect();
    cases.push(case(
        "ply: header cut short",
        "m.ply",
        PLY.as_bytes()[..PLY.find("property double y").unwrap()].to_vec(),
        &["m.ply:4", "header does not end"],
    ));
    cases.push(case("ply: empty", "m.ply", Vec::new(), &["m.ply:1", "does not begin"]));
    let mut own = case("ply: no material", "m.ply", PLY.into(), &["m.ply:14", "PLY has no reflectances", "material ="]);
    own.material = false;
    cases.push(own);
    cases
}

/// The same square in binary.
fn ply_binary() -> Vec<u8> {
    let head = PLY.split_inclusive("end_header\n").next().unwrap().replace("ascii", "binary_little_endian");
    let mut out = head.into_bytes();
    for v in [0f64, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.] {
        out.extend(v.to_le_bytes());
    }
    out.push(4);
    (0..4i32).for_each(|i| out.extend(i.to_le_bytes()));
    out
}

fn ply_binary_cases() -> Vec<Case> {
    let sound = ply_binary();
    let (end, body) = (sound.len(), sound.len() - 17 - 96);
    let header = |from: &str, to: &str| {
        let head = changed(std::str::from_utf8(&sound[..body]).unwrap(), from, to);
        [head.into_bytes(), sound[body..].to_vec()].concat()
    };
    let put = |at: usize, bytes: &[u8]| {
        let mut out = sound.clone();
        out[at..at + bytes.len()].copy_from_slice(bytes);
        out
    };
    let made = |name: &str, bytes: Vec<u8>, parts: &[&str]| case(&format!("binary ply: {name}"), "m.ply", bytes, parts);
    vec![
        made(
            "cut in the vertices",
            sound[..body + 50].to_vec(),
            &["m.ply, element vertex", "need at least 96 bytes, but 50 are left"],
        ),
        made("cut before the faces", sound[..body + 96].to_vec(), &["m.ply, element face", "but 0 are left"]),
        made("cut in a face", sound[..end - 1].to_vec(), &["m.ply, face 0", "a list of 4 numbers, but 15 bytes"]),
        made(
            "count beyond the file",
            header("vertex 4", "vertex 4000000000000"),
            &["m.ply, element vertex", "4000000000000 elements"],
        ),
        made(
            "count beyond all numbers",
            header("vertex 4", "vertex 18446744073709551615"),
            &["m.ply, element vertex", "need at least"],
        ),
        made("fewer vertices", header("vertex 4", "vertex 3"), &["m.ply, face 0", "0 corners"]),
        made("other byte order", header("little", "big"), &["m.ply, face 0", "names vertex 16777216"]),
        made("bytes left", [sound.clone(), vec![1, 2, 3]].concat(), &["m.ply (", "3 bytes are left"]),
        made("not a number", put(body + 24, &f64::NAN.to_le_bytes()), &["m.ply, vertex 1", "NaN"]),
        made("endless", put(body + 80, &f64::INFINITY.to_le_bytes()), &["m.ply, vertex 3", "inf"]),
        made("corner too high", put(end - 4, &4i32.to_le_bytes()), &["m.ply, face 0", "names vertex 4"]),
        made("corner too low", put(end - 4, &(-1i32).to_le_bytes()), &["m.ply, face 0", "names vertex -1"]),
        made("a long list", put(end - 17, &[255]), &["m.ply, face 0", "a list of 255 numbers"]),
        made("wider corners", header("uchar int", "uchar double"), &["m.ply:7", "fractions"]),
        made("wider count", header("uchar int", "int int"), &["m.ply, face 0", "a list of"]),
        made("two corners", put(end - 17, &[2])[..end - 8].to_vec(), &["m.ply, face 0", "2 corners"]),
    ]
}

// ---- glTF ----

fn gltf_case(name: &str, change: impl Fn(&mut Value), parts: &[&str]) -> Case {
    let mut root = gltf::square();
    change(&mut root);
    case(&format!("gltf: {name}"), "m.gltf", root.to_string().into_bytes(), parts)
}

/// A change of one value of the sound file: pointer, new value, what is said about it.
fn gltf_cases() -> Vec<Case> {
    let primitive = "/meshes/0/primitives/0";
    let under = |key: &str| format!("{primitive}{key}");
    let no_base64 = "data:application/octet-stream,abcd";
    let short = gltf::data_uri(&[0; 12]);
    let nan = gltf::data_uri(&gltf::bytes(
        &[[0., 0., 0.], [1., f32::NAN, 0.], [1., 1., 0.], [0., 1., 0.]],
        &gltf::SQUARE_TRIANGLES,
    ));
    let high = gltf::data_uri(&gltf::bytes(&gltf::SQUARE, &[0, 1, 2, 0, 2, 4]));
    let projective = json!([1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    #[rustfmt::skip]
    let table: Vec<(&str, String, Value, &[&str])> = vec![
        ("version 1", "/asset/version".into(), json!("1.0"), &["m.gltf, asset", "version is 1.0", "glTF 2.0"]),
        ("version 3", "/asset/version".into(), json!("3.0"), &["m.gltf, asset", "version is 3.0"]),
        ("needs a newer version", "/asset/minVersion".into(), json!("2.1"), &["m.gltf, asset", "version is 2.1"]),
        ("draco", "/extensionsRequired".into(), json!(["KHR_draco_mesh_compression"]), &["m.gltf, extensionsRequired", "KHR_draco_mesh_compression", "without it"]),
        ("meshopt", "/extensionsRequired".into(), json!(["KHR_materials_unlit", "EXT_meshopt_compression"]), &["extensionsRequired", "EXT_meshopt_compression"]),
        ("instancing", "/extensionsRequired".into(), json!(["EXT_mesh_gpu_instancing"]), &["EXT_mesh_gpu_instancing"]),
        ("no address", "/buffers/0/uri".into(), Value::Null, &["m.gltf, buffers[0].uri", "no uri"]),
        ("http", "/buffers/0/uri".into(), json!("http://example.org/m.bin"), &["m.gltf, buffers[0].uri", "http address", "nothing is fetched"]),
        ("https", "/buffers/0/uri".into(), json!("https://example.org/m.bin"), &["https address"]),
        ("file address", "/buffers/0/uri".into(), json!("file:///etc/hostname"), &["file address"]),
        ("buffer outside", "/buffers/0/uri".into(), json!("../m.bin"), &["m.gltf, buffers[0].uri", "leaves the scene's folder"]),
        ("buffer outside, in disguise", "/buffers/0/uri".into(), json!("%2e%2e/m.bin"), &["leaves the scene's folder"]),
        ("absolute buffer", "/buffers/0/uri".into(), json!("/etc/hostname"), &["leaves the scene's folder"]),
        ("buffer that is not there", "/buffers/0/uri".into(), json!("gone.bin"), &["m.gltf, buffers[0].uri", "gone.bin", "there is no such file"]),
        ("buffer that is a folder", "/buffers/0/uri".into(), json!("."), &["m.gltf, buffers[0].uri", "it is a folder"]),
        ("half a byte", "/buffers/0/uri".into(), json!("m%2"), &["m.gltf, buffers[0].uri", "no sound address"]),
        ("broken base64", "/buffers/0/uri".into(), json!("data:x;base64,AA*A"), &["m.gltf, buffers[0].uri", "data are broken"]),
        ("plain data", "/buffers/0/uri".into(), json!(no_base64), &["m.gltf, buffers[0].uri", "not in base64"]),
        ("data cut short", "/buffers/0/uri".into(), json!(short), &["m.gltf, buffers[0].byteLength", "has 12 bytes, but 60"]),
        ("negative length", "/buffers/0/byteLength".into(), json!(-1), &["m.gltf:1", "invalid value"]),
        ("view beyond its buffer", "/bufferViews/0/byteLength".into(), json!(61), &["m.gltf, bufferViews[0].byteLength", "beyond the 60 bytes"]),
        ("view beyond all numbers", "/bufferViews/0/byteOffset".into(), json!(u64::MAX), &["m.gltf, bufferViews[0].byteLength", "beyond"]),
        ("view of no buffer", "/bufferViews/0/buffer".into(), json!(7), &["m.gltf, bufferViews[0].buffer", "no buffer 7"]),
        ("stride too small", "/bufferViews/0/byteStride".into(), json!(8), &["m.gltf, bufferViews[0].byteStride", "stride of 8"]),
        ("stride too large", "/bufferViews/0/byteStride".into(), json!(16), &["m.gltf, accessors[0].count", "do not fit"]),
        ("too many items", "/accessors/0/count".into(), json!(5), &["m.gltf, accessors[0].count", "5 items do not fit into the 48 bytes"]),
        ("items beyond all numbers", "/accessors/1/count".into(), json!(u64::MAX), &["m.gltf, accessors[1].count", "do not fit"]),
        ("offset beyond the view", "/accessors/0/byteOffset".into(), json!(49), &["m.gltf, accessors[0].count", "do not fit"]),
        ("accessor of no view", "/accessors/0/bufferView".into(), json!(9), &["m.gltf, accessors[0].bufferView", "no buffer view 9"]),
        ("accessor without view", "/accessors/0/bufferView".into(), Value::Null, &["m.gltf, accessors[0].bufferView", "without compression"]),
        ("positions in the plane", "/accessors/0/type".into(), json!("VEC2"), &["m.gltf, accessors[0].type", "VEC3 is needed"]),
        ("unknown component", "/accessors/0/componentType".into(), json!(5130), &["m.gltf, accessors[0].componentType", "5130"]),
        ("signed indices", "/accessors/1/componentType".into(), json!(5122), &["m.gltf, accessors[1].componentType", "5122"]),
        ("indices as fractions", "/accessors/1/componentType".into(), json!(5126), &["m.gltf, accessors[1].componentType", "5126"]),
        ("normalised indices", "/accessors/1/normalized".into(), json!(true), &["m.gltf, accessors[1]", "normalised"]),
        ("sparse", "/accessors/0/sparse".into(), json!({"count": 1}), &["m.gltf, accessors[0].sparse", "not read"]),
        ("positions from nowhere", under("/attributes/POSITION"), json!(9), &["m.gltf, accessors[9]", "has 2 accessors"]),
        ("indices from nowhere", under("/indices"), json!(4), &["m.gltf, accessors[4]"]),
        ("positions as indices", under("/indices"), json!(0), &["m.gltf, accessors[0].type", "SCALAR is needed"]),
        ("no positions", under("/attributes"), json!({"NORMAL": 0}), &["m.gltf, meshes[0].primitives[0].attributes", "no POSITION"]),
        ("unknown mode", under("/mode"), json!(7), &["m.gltf, meshes[0].primitives[0].mode", "mode 7"]),
        ("points", under("/mode"), json!(0), &["scene.toml:8", "no face with an area"]),
        ("lines", under("/mode"), json!(3), &["scene.toml:8", "no face with an area"]),
        ("material from nowhere", under("/material"), json!(3), &["m.gltf, meshes[0].primitives[0].material", "no material 3"]),
        ("five corners", "/accessors/1/count".into(), json!(5), &["m.gltf, meshes[0].primitives[0]", "5 corners"]),
        ("index too high", "/buffers/0/uri".into(), json!(high), &["m.gltf, meshes[0].primitives[0], triangle 1", "names vertex 4, but there are 4"]),
        ("not a number", "/buffers/0/uri".into(), json!(nan), &["m.gltf, nodes[0], meshes[0].primitives[0], triangle 0", "beyond"]),
        ("out of reach", "/nodes/0/scale".into(), json!([1e300, 1, 1]), &["m.gltf, nodes[0]", "beyond 1e9 m"]),
        ("no extent", "/nodes/0/scale".into(), json!([0, 1, 1]), &["scene.toml:8", "no face with an area"]),
        ("number beyond doubles", "/nodes/0/scale".into(), json!("x"), &["m.gltf:1", "invalid type"]),
        ("no rotation", "/nodes/0/rotation".into(), json!([0, 0, 0, 0]), &["m.gltf, nodes[0].rotation", "length 0"]),
        ("matrix that projects", "/nodes/0/matrix".into(), projective, &["m.gltf, nodes[0].matrix", "last row"]),
        ("matrix of nine", "/nodes/0/matrix".into(), json!([1, 0, 0, 0, 1, 0, 0, 0, 1]), &["m.gltf:1", "invalid length 9"]),
        ("mesh from nowhere", "/nodes/0/mesh".into(), json!(1), &["m.gltf, nodes[0].mesh", "no mesh 1"]),
        ("child from nowhere", "/nodes/0/children".into(), json!([5]), &["m.gltf, nodes[0].children", "no node 5"]),
        ("its own child", "/nodes/0/children".into(), json!([0]), &["m.gltf, nodes[0].children", "node 0 is reached twice"]),
        ("two parents", "/nodes".into(), json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]), &["reached twice", "trees"]),
        ("a circle", "/nodes".into(), json!([{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}]), &["m.gltf, nodes[2].children", "reached twice"]),
        ("scene from nowhere", "/scene".into(), json!(3), &["m.gltf, scene", "no scene 3"]),
        ("node of the scene from nowhere", "/scenes/0/nodes".into(), json!([8]), &["m.gltf, scenes", "no node 8"]),
        ("nothing shown", "/scenes/0/nodes".into(), json!([]), &["scene.toml:8", "no face with an area", "shown by a node"]),
        ("no accessors", "/accessors".into(), json!({}), &["m.gltf:1", "invalid type"]),
        ("no asset", "/asset".into(), Value::Null, &["m.gltf:1", "asset"]),
    ];
    let mut cases: Vec<Case> = table
        .into_iter()
        .map(|(name, pointer, value, parts)| gltf_case(name, |root| set(root, &pointer, value.clone()), parts))
        .collect();
    cases.push(gltf_case(
        "both kinds of placement",
        |root| {
            root["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
            root["nodes"][0]["translation"] = json!([1, 0, 0]);
        },
        &["m.gltf, nodes[0].matrix", "both a matrix and parts"],
    ));
    cases.push(gltf_case(
        "a forest from a seed",
        |root| {
            // 40 bytes of JSON show 60,000 triangles; a hundred of them would fill the memory.
            let count = 60_000;
            let indices: Vec<u16> = (0..3 * count).map(|i| [0, 1, 2][i % 3]).collect();
            *root = gltf::embedded(&gltf::SQUARE, &indices);
            root["nodes"] = (0..100).map(|_| json!({"mesh": 0})).collect();
            root["scenes"][0]["nodes"] = (0..100).collect();
        },
        &["m.gltf, nodes[34]", "2100000 triangles", "at most 2097152"],
    ));
    cases.extend(own_materials());
    let text = gltf::square().to_string();
    let plain = |name: &str, text: &str, parts: &[&str]| case(&format!("gltf: {name}"), "m.gltf", text.into(), parts);
    cases.push(plain("cut short", &text[..text.len() / 2], &["m.gltf:1", "EOF"]));
    cases.push(plain("empty", "", &["m.gltf:1", "EOF"]));
    cases.push(plain("a list", "\n\n[1, 2]", &["m.gltf:3", "glTF 2.0 file?"]));
    cases.push(plain("not JSON", "{\n  asset: 1 }", &["m.gltf:2", "key must be a string"]));
    cases.push(plain("deep", &"[".repeat(100_000), &["m.gltf:1"]));
    cases
}

/// Sets a value; `null` takes the key away.
fn set(root: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = root.pointer_mut(parent).unwrap_or_else(|| panic!("{parent} is not in the base"));
    let map = parent.as_object_mut().unwrap();
    match value {
        Value::Null => drop(map.remove(key).unwrap()),
        value => drop(map.insert(key.into(), value)),
    }
}

fn own_materials() -> Vec<Case> {
    let colour = "/materials/0/pbrMetallicRoughness/baseColorFactor";
    #[rustfmt::skip]
    let table: Vec<(&str, &str, Value, &[&str])> = vec![
        ("white", colour, json!([1, 1, 1, 1]), &["m.gltf, materials[0]", "baseColorFactor = 1", "outside [0, 1)", "material ="]),
        ("white by default", colour, Value::Null, &["m.gltf, materials[0]", "baseColorFactor = 1"]),
        ("blacker than black", colour, json!([0, -0.5, 0, 1]), &["m.gltf, materials[0]", "baseColorFactor = -0.5"]),
        ("three channels", colour, json!([0.5, 0.5, 0.5]), &["m.gltf:1", "invalid length 3"]),
        ("darkness", "/materials/0/emissiveFactor", json!([0, -1, 0]), &["m.gltf, materials[0]", "emissiveFactor = -1", "less than nothing"]),
        ("no material", "/meshes/0/primitives/0/material", Value::Null, &["m.gltf, nodes[0], meshes[0].primitives[0], triangle 0", "has no material"]),
    ];
    let made = |(name, pointer, value, parts): (&str, &str, Value, &[&str])| {
        let mut c = gltf_case(&format!("own material, {name}"), |root| set(root, pointer, value.clone()), parts);
        c.material = false;
        c
    };
    table.into_iter().map(made).collect()
}

fn glb_cases() -> Vec<Case> {
    let sound = gltf::square_glb();
    let put = |at: usize, v: u32| {
        let mut out = sound.clone();
        out[at..at + 4].copy_from_slice(&v.to_le_bytes());
        out
    };
    let json_size = u32::from_le_bytes([sound[12], sound[13], sound[14], sound[15]]) as usize;
    let made = |name: &str, bytes: Vec<u8>, parts: &[&str]| case(&format!("glb: {name}"), "m.glb", bytes, parts);
    let length = sound.len();
    vec![
        made("wrong magic", [b"gltf", &sound[4..]].concat(), &["m.glb:1", "glTF 2.0 file?"]),
        made("nothing but the magic", sound[..4].to_vec(), &["m.glb, header", "has 4 bytes"]),
        made("version 1", put(4, 1), &["m.glb, header", "version is 1"]),
        made(
            "cut short",
            sound[..length - 10].to_vec(),
            &["m.glb, header", &format!("says {length} bytes, but the file has {}", length - 10)],
        ),
        made("no chunks", put(8, 12), &["m.glb, chunk 0", "no chunks"]),
        made("chunk beyond the file", put(12, 1 << 30), &["m.glb, chunk 0", "1073741824 bytes"]),
        made("second chunk beyond the file", put(20 + json_size, 1000), &["m.glb, chunk 1", "1000 bytes"]),
        made("data first", put(16, 0x004E_4942), &["m.glb, chunk 0", "not JSON"]),
        made("JSON broken in line 2", gltf::glb(b"{\n\"asset\" 1}", None), &["m.glb, JSON chunk, line 2"]),
        made(
            "no data",
            gltf::glb(gltf::frame(4, 6).to_string().as_bytes(), None),
            &["m.glb, buffers[0].uri", "no binary chunk"],
        ),
        made("data of another kind", put(24 + json_size, 7), &["m.glb, buffers[0].uri", "no binary chunk"]),
        made(
            "data too short",
            gltf::glb(gltf::frame(4, 6).to_string().as_bytes(), Some(&[0; 8])),
            &["m.glb, buffers[0].byteLength", "has 8 bytes, but 60"],
        ),
    ]
}
