//! Meshes of all formats: the same geometry, materials, groups, sides and axes whatever the file.

#[path = "common/gltf.rs"]
mod gltf;

use etalon::io::scene::{SceneOptions, open_scene, read_scene};
use etalon::math::DVec3;
use etalon::scene::{Scene, Stage};
use serde_json::{Value, json};
use std::path::Path;

const HEAD: &str = "format = \"etalon-scene/1\"\n[[material]]\nname = \"m\"\nreflectance = 0.5\n";

fn scene_in(folder: &Path, body: &str) -> Scene {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{HEAD}{body}")).unwrap();
    read_scene(&path, &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}\n{body}"))
}

/// A scene of one mesh surface "s".
fn with_mesh(file: &str, bytes: impl AsRef<[u8]>, extra: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(file), bytes).unwrap();
    scene_in(folder.path(), &format!("[[surface]]\nname = \"s\"\nmesh = \"{file}\"\n{extra}"))
}

fn stage_of(root: &Value, extra: &str) -> Stage {
    with_mesh("m.gltf", root.to_string(), extra).at(0).unwrap()
}

fn close(a: DVec3, b: [f64; 3]) -> bool {
    (a - DVec3::from(b)).length() < 1e-12
}

fn names(stage: &Stage) -> Vec<&str> {
    stage.surfaces.iter().map(|s| s.name.as_str()).collect()
}

// ---- the same scene from every format ----

const VERTICES: [[f64; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 1.5, 0.25]];
const TRIANGLES: [[usize; 3]; 3] = [[0, 1, 2], [0, 2, 3], [3, 2, 4]];

fn obj() -> String {
    let v: String = VERTICES.iter().map(|v| format!("v {} {} {}\n", v[0], v[1], v[2])).collect();
    v + &TRIANGLES.iter().map(|t| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1)).collect::<String>()
}

fn ply() -> String {
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        TRIANGLES.len()
    );
    let v: String = VERTICES.iter().map(|v| format!("{} {} {}\n", v[0], v[1], v[2])).collect();
    head + &v + &TRIANGLES.iter().map(|t| format!("3 {} {} {}\n", t[0], t[1], t[2])).collect::<String>()
}

fn triangles_gltf() -> Value {
    let v: Vec<[f32; 3]> = VERTICES.iter().map(|v| v.map(|x| x as f32)).collect();
    let i: Vec<u16> = TRIANGLES.iter().flatten().map(|i| *i as u16).collect();
    gltf::embedded(&v, &i)
}

#[test]
fn every_format_gives_the_same_scene() {
    let all = "material = \"m\"\nup = \"z\"\n";
    let hash = |scene: Scene| scene.at(0).unwrap().hash();
    let expected = hash(with_mesh("m.obj", obj(), all));
    assert_eq!(hash(with_mesh("m.ply", ply(), all)), expected);
    assert_eq!(hash(with_mesh("m.gltf", triangles_gltf().to_string(), all)), expected);
    let mut root = triangles_gltf();
    let uri = root["buffers"][0]["uri"].take();
    let bytes = base64_of(uri.as_str().unwrap());
    root["buffers"][0].as_object_mut().unwrap().remove("uri");
    let glb = gltf::glb(root.to_string().as_bytes(), Some(&bytes));
    assert_eq!(hash(with_mesh("m.glb", &glb, all)), expected);
    // A GLB under the other ending, and a file with its buffer beside it.
    assert_eq!(hash(with_mesh("m.gltf", &glb, all)), expected);
    let folder = tempfile::tempdir().unwrap();
    root["buffers"][0]["uri"] = "the%20buffer.bin".into();
    std::fs::create_dir(folder.path().join("below")).unwrap();
    std::fs::write(folder.path().join("below/m.gltf"), root.to_string()).unwrap();
    std::fs::write(folder.path().join("below/the buffer.bin"), &bytes).unwrap();
    let body = format!("[[surface]]\nname = \"s\"\nmesh = \"below/m.gltf\"\n{all}");
    assert_eq!(hash(scene_in(folder.path(), &body)), expected);
}

fn base64_of(uri: &str) -> Vec<u8> {
    use base64::Engine;
    base64::engine::general_purpose::STANDARD.decode(uri.rsplit(',').next().unwrap()).unwrap()
}

#[test]
fn keys_of_a_surface_work_for_every_format() {
    let extra = "material = \"m\"\nup = \"y\"\nscale = 0.5\npatches = [2]\nelements = [3]\ntwo_sided = true\n";
    let all: Vec<Stage> = [("m.obj", obj()), ("m.ply", ply()), ("m.gltf", triangles_gltf().to_string())]
        .into_iter()
        .map(|(file, text)| with_mesh(file, text, extra).at(0).unwrap())
        .collect();
    for stage in &all {
        assert_eq!((stage.patch_count(), stage.elements.len()), (24, 24 * 9));
        assert_eq!(stage.hash(), all[0].hash());
        let firsts: Vec<_> = stage.facets.iter().map(|f| (f.first_patch, f.first_back_patch)).collect();
        assert_eq!(firsts, [(0, Some(12)), (4, Some(16)), (8, Some(20))]);
        assert!(close(stage.facets[0].normal, [0., -1., 0.]));
    }
}

// ---- glTF: axes, nodes, modes ----

#[test]
fn gltf_is_y_up_and_its_winding_decides_the_front() {
    let stage = stage_of(&gltf::square(), "");
    assert!(close(stage.facets[0].normal, [0., -1., 0.]), "z of the file is -y of the scene");
    assert!(close(stage.facets[0].vertices[2], [1., 0., 1.]));
    let stage = stage_of(&gltf::square(), "up = \"z\"\n");
    assert!(close(stage.facets[0].normal, [0., 0., 1.]));
}

#[test]
fn nodes_place_their_meshes_parents_first() {
    let mut root = gltf::square();
    // Child: twice as large, then moved by 1 along x. Parent: a quarter turn about z, then up by 10.
    let h = 0.5f64.sqrt();
    root["nodes"] = json!([
        { "children": [1], "rotation": [0, 0, h, h], "translation": [0, 0, 10] },
        { "mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1] },
    ]);
    let stage = stage_of(&root, "up = \"z\"\n");
    let corners: Vec<DVec3> = stage.facets[0].vertices.clone();
    for (corner, expected) in corners.into_iter().zip([[0., 1., 10.], [0., 3., 10.], [-2., 3., 10.]]) {
        assert!(close(corner, expected), "{corner} {expected:?}");
    }
    assert!((stage.areas().iter().sum::<f64>() - 4.0).abs() < 1e-12);
}

#[test]
fn a_mirrored_node_keeps_its_fronts_in_front() {
    let mut root = gltf::square();
    // A mirror in x alone, and one in all three axes: the square's front stays on the side that it is moved to.
    for (scale, normal) in
        [([-1., 1., 1.], [0., 0., 1.]), ([-2., -2., -2.], [0., 0., -1.]), ([-1., -1., 1.], [0., 0., 1.])]
    {
        root["nodes"][0]["scale"] = json!(scale);
        let stage = stage_of(&root, "up = \"z\"\n");
        assert!(stage.facets.iter().all(|f| close(f.normal, normal)), "{scale:?}: {}", stage.facets[0].normal);
    }
    // A closed box seen from outside stays one.
    let corners: Vec<[f32; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|b| b as f32)).collect();
    let quads: [[u16; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices: Vec<u16> = quads.iter().flat_map(|q| [q[0], q[1], q[2], q[0], q[2], q[3]]).collect();
    let mut cube = gltf::embedded(&corners, &indices);
    for scale in [[1., 1., 1.], [1., -1., 1.], [-1., -1., -1.]] {
        cube["nodes"][0]["scale"] = json!(scale);
        let stage = stage_of(&cube, "");
        let volume: f64 =
            stage.facets.iter().map(|f| f.vertices[0].dot(f.vertices[1].cross(f.vertices[2])) / 6.0).sum();
        assert!((volume - 1.0).abs() < 1e-12, "{scale:?}: {volume}");
    }
}

#[test]
fn strips_and_fans_are_wound_like_lists() {
    for (mode, indices, count) in [(5, vec![0u16, 1, 3, 2], 2), (6, vec![0, 1, 2, 3], 2), (5, vec![0, 0, 1, 3, 2], 2)] {
        let mut root = gltf::embedded(&gltf::SQUARE, &indices);
        root["meshes"][0]["primitives"][0]["mode"] = mode.into();
        // The strip with a doubled vertex begins with a triangle without area, which turns the others round.
        let normal = if indices.len() == 5 { -1.0 } else { 1.0 };
        let stage = stage_of(&root, "up = \"z\"\n");
        assert_eq!(stage.patch_count(), count);
        assert!(stage.facets.iter().all(|f| close(f.normal, [0., 0., normal])), "mode {mode}");
        assert!((stage.areas().iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    let mut root = gltf::embedded(&[gltf::SQUARE[0], gltf::SQUARE[1], gltf::SQUARE[2]], &[]);
    root["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    assert_eq!(stage_of(&root, "").patch_count(), 1);
}

#[test]
fn a_mesh_may_be_shown_more_than_once_and_points_are_left_out() {
    let mut root = gltf::square();
    root["nodes"] =
        json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b", "translation": [0, 0, 3] }, { "name": "c" }]);
    root["scenes"][0]["nodes"] = json!([0, 1, 2]);
    root["meshes"][0]["primitives"].as_array_mut().unwrap().push(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    let scene = with_mesh("m.gltf", root.to_string(), "");
    let stage = scene.at(0).unwrap();
    assert_eq!(names(&stage), ["s/a", "s/b"]);
    assert_eq!(stage.patch_count(), 4);
    assert!(
        scene.notices.iter().any(|n| n == "m.gltf: 2 primitives of points and lines were left out"),
        "{:?}",
        scene.notices
    );
}

#[test]
fn quantised_positions_are_read() {
    let mut root = gltf::frame(3, 3);
    let positions: Vec<u8> =
        [[0i16, 0, 0, 0], [32767, 0, 0, 0], [0, 32767, 0, 0]].iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let mut bytes = positions.clone();
    bytes.extend([0u16, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
    root["buffers"][0] = json!({ "byteLength": bytes.len(), "uri": gltf::data_uri(&bytes) });
    root["bufferViews"] =
        json!([{ "buffer": 0, "byteLength": 24, "byteStride": 8 }, { "buffer": 0, "byteOffset": 24, "byteLength": 6 }]);
    root["accessors"][0]["componentType"] = 5122.into();
    root["accessors"][0]["normalized"] = true.into();
    root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert!((stage_of(&root, "").areas()[0] - 0.5).abs() < 1e-12);
}

// ---- materials and sides ----

#[test]
fn colours_of_gltf_become_reflectance_and_emission_as_written() {
    let mut root = gltf::square();
    root["materials"] = json!([{
        "name": "lamp", "pbrMetallicRoughness": { "baseColorFactor": [0.7, 0.1, 0.3, 1], "metallicFactor": 0.5,
            "baseColorTexture": { "index": 0 } },
        "emissiveFactor": [1, 0.5, 0], "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 12 } },
    }]);
    let scene = with_mesh("m.gltf", root.to_string(), "");
    let lamp = &scene.materials[1];
    assert_eq!(
        (lamp.name.as_str(), &lamp.reflectance, &lamp.emission),
        ("s/lamp", &vec![0.7, 0.1, 0.3], &vec![12.0, 6.0, 0.0])
    );
    for part in ["baseColorTexture", "metallic"] {
        assert!(
            scene.notices.iter().any(|n| n.starts_with("m.gltf, materials[0]") && n.contains(part)),
            "{:?}",
            scene.notices
        );
    }
    // A lamp that says nothing about its base colour reflects nothing, and says so.
    root["materials"] = json!([{ "emissiveFactor": [1, 1, 1] }]);
    let scene = with_mesh("m.gltf", root.to_string(), "");
    assert_eq!((&scene.materials[1].reflectance, scene.materials[1].name.as_str()), (&vec![0.0; 3], "s/material 0"));
    assert_eq!(scene.notices.len(), 1);
    // A material of the scene file overrides them all.
    let scene = with_mesh("m.gltf", root.to_string(), "material = \"m\"\n");
    assert_eq!((scene.materials.len(), scene.notices.len()), (1, 0));
}

#[test]
fn double_sided_materials_have_backs_unless_the_scene_file_says_otherwise() {
    let mut root = gltf::square();
    root["materials"].as_array_mut().unwrap().push(json!({ "name": "leaf", "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorFactor": [0.2, 0.6, 0.2, 1] } }));
    root["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "attributes": { "POSITION": 0 }, "indices": 1, "material": 1 }));
    root["meshes"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 1 }] }));
    root["meshes"][0]["primitives"].as_array_mut().unwrap().pop();
    root["nodes"] = json!([{ "mesh": 1 }, { "mesh": 0, "translation": [0, 0, 1] }]);
    root["scenes"][0]["nodes"] = json!([0, 1]);
    let firsts = |extra: &str| -> Vec<(u32, Option<u32>)> {
        stage_of(&root, extra).facets.iter().map(|f| (f.first_patch, f.first_back_patch)).collect()
    };
    // Only the leaf has backs: they follow all fronts of the surface, in order.
    assert_eq!(firsts(""), [(0, Some(4)), (1, Some(5)), (2, None), (3, None)]);
    assert_eq!(firsts("two_sided = true\n"), [(0, Some(4)), (1, Some(5)), (2, Some(6)), (3, Some(7))]);
    assert_eq!(firsts("two_sided = false\n"), [(0, None), (1, None), (2, None), (3, None)]);
    let stage = stage_of(&root, "");
    assert_eq!(stage.patch_count(), 6);
    assert_eq!(stage.patches[5].normal, -stage.patches[1].normal);
    assert_eq!(stage.reflectance(5), [0.2, 0.6, 0.2]);
}

// ---- groups ----

#[test]
fn groups_become_surface_names_and_change_nothing_else() {
    let plain = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\n";
    let grouped =
        plain.replace("f 5", "g lid\nf 5").replace("f 1 2 6", "o sides\nf 1 2 6").replace("f 4", "g lid\nf 4");
    let extra = "material = \"m\"\nobject = \"box\"\ntwo_sided = true\npatches = [2, 2]\n";
    let (one, many) = (with_mesh("m.obj", plain, extra), with_mesh("m.obj", &grouped, extra));
    let (one, many) = (one.at(0).unwrap(), many.at(0).unwrap());
    assert_eq!(one.hash(), many.hash());
    assert_eq!(names(&one), ["s"]);
    assert_eq!(names(&many), ["s", "s/lid", "s/sides"]);
    assert!(many.surfaces.iter().all(|s| s.object == "box"));
    let of_face = ["s", "s/lid", "s/sides", "s/lid"];
    for patch in 0..32 {
        assert_eq!(many.surface_name(patch), of_face[patch % 16 / 4], "patch {patch}");
    }
    // Every face in a group: the surface itself has no patch and is not listed; a group of no face neither.
    let all = grouped.replacen("f 1", "g empty\nv 9 9 9\ng floor\nf 1", 1);
    let stage = with_mesh("m.obj", &all, extra).at(0).unwrap();
    assert_eq!(names(&stage), ["s/floor", "s/lid", "s/sides"]);
}

#[test]
fn names_of_groups_follow_a_replacement() {
    let folder = tempfile::tempdir().unwrap();
    let square = |group: &str, z: u32| format!("v 0 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0 1 {z}\ng {group}\nf 1 2 3 4\n");
    std::fs::write(folder.path().join("old.obj"), square("wood", 0)).unwrap();
    std::fs::write(folder.path().join("new.obj"), square("steel", 1)).unwrap();
    let body = "[[surface]]\nname = \"s\"\nobject = \"table\"\nmaterial = \"m\"\nmesh = \"old.obj\"\ntwo_sided = true\n\
                [[edit]]\nreplace = \"table\"\nmesh = \"new.obj\"\n";
    let scene = scene_in(folder.path(), body);
    let (before, after) = (scene.at(0).unwrap(), scene.at(1).unwrap());
    assert_eq!((before.patch_count(), after.patch_count()), (2, 2), "the new square takes over the numbers");
    assert_eq!((before.surface_name(1), after.surface_name(1)), ("s/wood", "table (edit 1)/steel"));
    assert_eq!(after.patches[1].corners[0].z, 1.0);
}

// ---- meshes as scenes ----

fn direct(file: &str, bytes: impl AsRef<[u8]>) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(file);
    std::fs::write(&path, bytes).unwrap();
    open_scene(path.to_str().unwrap(), &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_mesh_is_a_scene_by_itself() {
    for (file, bytes) in [("room.obj", obj().into_bytes()), ("room.PLY", ply().into_bytes())] {
        let scene = direct(file, bytes);
        let stage = scene.at(0).unwrap();
        assert_eq!((scene.name.as_str(), names(&stage)), ("room", vec!["room"]));
        assert_eq!((stage.reflectance(0), stage.emission(0)), (&[0.5; 3][..], &[0.0; 3][..]));
        assert!(
            scene.notices.iter().any(|n| n.contains("3 faces") && n.contains("grey, reflectance 0.5")),
            "{:?}",
            scene.notices
        );
    }
    let scene = direct("lamp.glb", gltf::square_glb());
    assert_eq!((scene.at(0).unwrap().reflectance(0), scene.notices.len()), (&[0.7, 0.6, 0.5][..], 0));
    // A material that cannot be used is told, and its faces are grey.
    let mut root = gltf::square();
    root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, 1, 1]);
    let scene = direct("white.gltf", root.to_string());
    assert_eq!(scene.at(0).unwrap().reflectance(0), [0.5; 3]);
    assert!(scene.notices.iter().any(|n| n.contains("outside [0, 1)")), "{:?}", scene.notices);
    // The largest edge of the command line divides it.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.obj");
    std::fs::write(&path, obj()).unwrap();
    let fine = open_scene(path.to_str().unwrap(), &SceneOptions { max_edge_override: Some(0.5) }).unwrap();
    assert!(fine.at(0).unwrap().patch_count() > 3);
}
