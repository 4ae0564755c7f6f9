//! Every refusal of the scene format, with its place: one broken file for each, and what its message must say.

#[path = "common/gltf.rs"]
mod gltf;
#[path = "broken/meshes.rs"]
mod meshes;

use assert_cmd::Command;
use etalon::io::scene::{SceneOptions, open_scene, read_scene};
use miette::Diagnostic;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// File, and parts of the one line that refuses it: place first, then what is wrong and how to mend it.
#[rustfmt::skip]
const BROKEN: &[(&str, &[&str])] = &[
    ("format-missing.toml", &[":1:", "format line is missing", "etalon-scene/1"]),
    ("format-newer.toml", &[":2:", "newer", "update etalon"]),
    ("format-foreign.toml", &[":1:", "unknown format"]),
    ("format-number.toml", &[":1:", "expected a string"]),
    ("toml-broken.toml", &[":5"]),
    ("toml-unclosed.toml", &[":8"]),
    ("toml-key-twice.toml", &[":9", "surface \"floor\"", "duplicate key"]),
    ("toml-not-text.toml", &[":1"]),
    ("empty-file.toml", &[":1:", "format line is missing"]),
    ("key-unknown-top.toml", &[":2:", "unknown field `units`"]),
    ("key-unknown-material.toml", &[":4, material \"m\"", "did you mean \"reflectance\""]),
    ("key-unknown-surface.toml", &[":9, surface \"floor\"", "did you mean \"patches\""]),
    ("key-unknown-camera.toml", &[":13, camera \"c\"", "unknown field `focal`"]),
    ("key-unknown-edit.toml", &[":11, edit 1", "unknown field `when`"]),
    ("key-unknown-photometry.toml", &[":3:", "did you mean \"bands\""]),
    ("key-unknown-rotate.toml", &[":11, edit 1", "did you mean \"degrees\""]),
    ("key-wrong-kind.toml", &[":9, surface \"floor\"", "expected a boolean"]),
    ("key-patches-fraction.toml", &[":9, surface \"floor\"", "2.5"]),
    ("key-missing-name.toml", &[":5, surface", "missing field `name`"]),
    ("key-missing-material.toml", &[":6, surface \"floor\"", "has no material"]),
    ("key-missing-outline.toml", &[":6, surface \"floor\"", "neither polygon nor mesh"]),
    ("key-polygon-and-mesh.toml", &[":9, surface \"floor\"", "both polygon and mesh"]),
    ("key-scale-on-polygon.toml", &[":9, surface \"floor\"", "scale is for meshes only"]),
    ("reserved-light.toml", &[":10, light", "type \"sky\" is for pictures", "--lighting"]),
    ("light-no-type.toml", &[":9, light", "missing field `type`"]),
    ("light-unknown.toml", &[":10, light", "no type of light \"spot\"", "point"]),
    ("light-no-position.toml", &[":11, light \"lamp\"", "no position", "[x, y, z]"]),
    ("light-no-intensity.toml", &[":10, light", "no intensity", "W/sr"]),
    ("light-negative.toml", &[":12, light", "intensity -1 is negative"]),
    ("light-bands.toml", &[":12, light", "intensity has 2 numbers, but there are 3 bands"]),
    ("light-lambert-no-direction.toml", &[":13, light", "no direction", "[0, 0, -1]"]),
    ("light-direction.toml", &[":13, light", "isotropic light has no direction", "lambert"]),
    ("light-distribution.toml", &[":13, light", "no distribution \"lamber\"", "did you mean \"lambert\""]),
    ("light-twice.toml", &[":15, light \"lamp\"", "second light \"lamp\""]),
    ("light-table.toml", &[":9", "expected"]),
    ("receiver-no-name.toml", &[":9, receiver", "missing field `name`"]),
    ("receiver-no-normal.toml", &[":9, receiver \"r\"", "missing field `normal`"]),
    ("receiver-zero-normal.toml", &[":12, receiver \"r\"", "normal has no direction"]),
    ("receiver-nan.toml", &[":11, receiver \"r\"", "position is [0, NaN, 1]"]),
    ("receiver-twice.toml", &[":14, receiver \"r\"", "second receiver \"r\""]),
    ("receiver-unknown-key.toml", &[":13, receiver \"r\"", "unknown field `grid`"]),
    ("reserved-specular.toml", &[":5, material \"m\"", "material.specular is reserved"]),
    ("reserved-texture.toml", &[":5, material \"m\"", "expected a table { picture, tile"]),
    ("name-surface-twice.toml", &[":10, surface \"floor\"", "second surface \"floor\""]),
    ("name-material-twice.toml", &[":6, material \"m\"", "second material \"m\""]),
    ("name-camera-twice.toml", &[":14, camera \"c\"", "second camera \"c\""]),
    ("name-empty.toml", &[":6, surface", "surface name is empty"]),
    ("name-with-newline.toml", &[":6, surface", "control characters"]),
    ("name-unknown-material.toml", &[":7, surface \"floor\"", "no material \"wite\""]),
    ("name-material-typo.toml", &[":7, surface \"floor\"", "did you mean \"white\""]),
    ("bands-too-many.toml", &[":4, material \"m\"", "has 4 numbers, but there are 3 bands"]),
    ("bands-too-few-emission.toml", &[":5, material \"m\"", "emission has 2 numbers"]),
    ("bands-mono-three.toml", &[":4:", "3 bands, but the primaries have 1"]),
    ("bands-rec709-one.toml", &[":4:", "1 bands, but the primaries have 3"]),
    ("bands-two-without-weights.toml", &[":3:", "2 bands"]),
    ("bands-luminance-short.toml", &[":4:", "1 luminance weights for 2 bands"]),
    ("bands-luminance-negative.toml", &[":3:", "none negative"]),
    ("bands-luminance-zero.toml", &[":3:", "not all zero"]),
    ("bands-both.toml", &[":3:", "both primaries and luminance"]),
    ("bands-unknown-primaries.toml", &[":3:", "unknown primaries \"rec601\""]),
    ("bands-twice.toml", &[":3:", "named twice"]),
    ("bands-none.toml", &[":3:", "no bands"]),
    ("bands-column-name.toml", &[":3:", "another column"]),
    ("number-reflectance-one.toml", &[":4, material \"m\"", "reflectance 1 is outside [0, 1)"]),
    ("number-reflectance-negative.toml", &[":4, material \"m\"", "reflectance -0.1 is outside"]),
    ("number-reflectance-nan.toml", &[":4, material \"m\"", "reflectance is NaN"]),
    ("number-emission-infinite.toml", &[":5, material \"m\"", "emission is inf"]),
    ("number-emission-negative.toml", &[":5, material \"m\"", "emission -1 is negative"]),
    ("number-material-empty.toml", &[":3, material \"m\"", "neither reflectance nor emission"]),
    ("number-vertex-nan.toml", &[":10, surface \"floor\"", "vertex 1 is"]),
    ("number-vertex-two.toml", &[":8, surface \"floor\"", "vertex 1 has 2 numbers"]),
    ("number-vertex-far.toml", &[":8, surface \"floor\"", "vertex 1 lies beyond"]),
    ("number-max-edge.toml", &[":3:", "max_edge is 0"]),
    ("number-max-edge-nan.toml", &[":3:", "max_edge is NaN"]),
    ("geometry-two-vertices.toml", &[":8, surface \"floor\"", "has 2 vertices"]),
    ("geometry-not-planar.toml", &[":8, surface \"floor\"", "not planar", "2.500e-5 m"]),
    ("geometry-not-convex.toml", &[":8, surface \"floor\"", "not convex"]),
    ("geometry-bow-tie.toml", &[":8, surface \"floor\"", "not convex"]),
    ("geometry-star.toml", &[":8, surface \"floor\"", "not convex"]),
    ("geometry-no-area.toml", &[":8, surface \"floor\"", "no area"]),
    ("geometry-one-point.toml", &[":8, surface \"floor\"", "no area"]),
    ("geometry-vertex-twice.toml", &[":8, surface \"floor\"", "vertices 1 and 2", "same point"]),
    ("counts-zero.toml", &[":9, surface \"floor\"", "patches has the count 0"]),
    ("counts-negative.toml", &[":9, surface \"floor\"", "elements has the count -2"]),
    ("counts-one-for-quad.toml", &[":9, surface \"floor\"", "1 counts for a quadrilateral"]),
    ("counts-two-for-triangle.toml", &[":9, surface \"floor\"", "2 counts for a triangle"]),
    ("counts-pentagon.toml", &[":9, surface \"floor\"", "5 vertices is one patch"]),
    ("counts-beyond-memory.toml", &[":9, surface \"floor\"", "10000000000", "fit into memory"]),
    ("counts-beyond-numbers.toml", &[":9, surface \"floor\"", "fit into memory"]),
    ("counts-elements-beyond.toml", &[":9, surface \"floor\"", "100000000 elements"]),
    ("counts-max-edge-beyond.toml", &["surface \"floor\"", "100000000000000 patches"]),
    ("counts-straight-corner.toml", &[":9, surface \"floor\"", "straight corner"]),
    ("counts-camera-size.toml", &[":13, camera \"c\"", "size is 640 x 0"]),
    ("overlap-same-facing.toml", &[":10, surface \"rug\"", "\"floor\" and \"rug\" overlap", "2.500e-1 m^2"]),
    ("overlap-in-a-later-state.toml", &[":10, surface \"lid\"", "overlap", "state 1"]),
    ("overlap-two-sided.toml", &[":10, surface \"sheet\"", "overlap"]),
    ("empty-no-surface.toml", &[":1", "the scene has no surface"]),
    ("empty-all-absent.toml", &["nothing stands there in state 0"]),
    ("empty-later.toml", &[":9, edit 1", "nothing stands there in state 1"]),
    ("edit-unknown-object.toml", &[":9, edit 1", "no surface belongs to the object \"scen\""]),
    ("edit-add-present.toml", &[":9, edit 1", "stands there already"]),
    ("edit-remove-absent.toml", &[":16, edit 2", "is not there"]),
    ("edit-no-action.toml", &[":9, edit 1", "no action"]),
    ("edit-two-actions.toml", &[":11, edit 1", "two actions, add and remove"]),
    ("edit-misplaced-key.toml", &[":11, edit 1", "remove does not use translate"]),
    ("edit-move-nothing.toml", &[":9, edit 1", "neither translate nor rotate"]),
    ("edit-axis-zero.toml", &[":11, edit 1", "axis has no direction"]),
    ("edit-scale-negative.toml", &[":11, edit 1", "greater than zero"]),
    ("edit-scale-missing.toml", &[":9, edit 1", "neither mesh nor scale"]),
    ("edit-scale-collapses.toml", &[":9, edit 1", "no area"]),
    ("edit-material-unknown.toml", &[":10, edit 1", "no material \"lamp\""]),
    ("edit-material-nothing.toml", &[":9, edit 1", "changes nothing"]),
    ("edit-material-range.toml", &[":11, edit 1", "reflectance 1.2 is outside"]),
    ("edit-replace-unknown.toml", &[":9, edit 1", "object \"cube\""]),
    ("edit-replace-scale-list.toml", &[":12, edit 1", "takes one number"]),
    ("absent-unknown.toml", &[":10", "object \"cube\""]),
    ("absent-twice.toml", &[":10", "listed twice"]),
    ("camera-no-view.toml", &[":12, camera \"c\"", "same point"]),
    ("camera-up-along-view.toml", &[":12, camera \"c\"", "up runs along"]),
    ("camera-fov.toml", &[":13, camera \"c\"", "fov is 180"]),
    ("path-absolute.toml", &[":8, surface \"blocks\"", "leaves the scene's folder"]),
    ("path-up.toml", &[":8, surface \"blocks\"", "leaves the scene's folder"]),
    ("path-up-hidden.toml", &[":8, surface \"blocks\"", "leaves the scene's folder"]),
    ("path-missing.toml", &[":8, surface \"blocks\"", "there is no such file"]),
    ("path-folder.toml", &[":8, surface \"blocks\"", "it is a folder"]),
    ("path-empty.toml", &[":8, surface \"blocks\"", "leaves the scene's folder"]),
    ("mesh-scale-zero.toml", &[":9, surface \"blocks\"", "scale is 0"]),
    ("mesh-up.toml", &[":9, surface \"blocks\"", "up is \"x\""]),
    ("mesh-index-high.toml", &["mesh-index-high.obj:6", "surface \"blocks\"", "names vertex 5"]),
    ("mesh-index-zero.toml", &["mesh-index-zero.obj:5", "names vertex 0"]),
    ("mesh-index-back.toml", &["mesh-index-back.obj:5", "names vertex -9"]),
    ("mesh-index-word.toml", &["mesh-index-word.obj:5", "\"x\" is not a corner"]),
    ("mesh-vertex-word.toml", &["mesh-vertex-word.obj:2", "\"oh\" is not a number"]),
    ("mesh-vertex-nan.toml", &["mesh-vertex-nan.obj:1", "not finite"]),
    ("mesh-vertex-short.toml", &["mesh-vertex-short.obj:1", "2 numbers"]),
    ("mesh-statement.toml", &["mesh-statement.obj:1", "unknown statement \"solid\""]),
    ("mesh-crossing.toml", &["mesh-crossing.obj:6", "crosses itself", "bow"]),
    ("mesh-no-faces.toml", &[":8, surface \"blocks\"", "no face with an area"]),
    ("mesh-only-slivers.toml", &[":8, surface \"blocks\"", "no face with an area"]),
    ("mesh-no-material.toml", &["mesh-no-material.obj:5", "has no material", "material ="]),
    ("mesh-no-library.toml", &["mesh-no-library.obj:5", "no material library defines \"white\""]),
    ("mesh-library-missing.toml", &["mesh-library-missing.obj:5", "gone.mtl", "material ="]),
    ("mesh-library-outside.toml", &["mesh-library-outside.obj:5", "leaves the scene's folder"]),
    ("mesh-kd-one.toml", &["mesh-kd-one.obj:6", "Kd = 1", "mesh-kd-one.mtl:2", "material ="]),
    ("mesh-ke-negative.toml", &["mesh-ke-negative.obj:6", "Ke = -1"]),
    ("mesh-kd-word.toml", &["mesh-kd-word.mtl:2", "\"red\" is not a number"]),
    ("mesh-kd-missing.toml", &["mesh-kd-missing.obj:6", "neither Kd nor Ke"]),
    ("mesh-material-typo.toml", &["mesh-material-typo.obj:6", "did you mean \"white\""]),
    ("mesh-counts-zero.toml", &[":9, surface \"blocks\"", "count 0"]),
    ("mesh-mono.toml", &["mesh-mono.obj:6", "red, green and blue, but the bands of the scene are y"]),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken/scenes")
}

#[test]
fn every_broken_scene_is_refused_with_its_place_and_its_mend() {
    let mut wrong = Vec::new();
    for (file, parts) in BROKEN {
        match read_scene(&folder().join(file), &SceneOptions::default()) {
            Ok(_) => wrong.push(format!("{file}: accepted")),
            Err(e) => {
                let line = e.to_string();
                let missing: Vec<_> = parts.iter().filter(|p| !line.contains(**p)).collect();
                if !missing.is_empty() || line.contains('\n') {
                    wrong.push(format!("{file}: {line}\n    lacks {missing:?}"));
                }
                if e.help().is_none() {
                    wrong.push(format!("{file}: no mend in: {line}"));
                }
                if !line.starts_with(&e.place()) || !e.place().contains(file.trim_end_matches(".toml")) {
                    wrong.push(format!("{file}: the place is {}", e.place()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_broken_scene_stands_in_the_table() {
    let listed: BTreeSet<String> = BROKEN.iter().map(|(f, _)| f.to_string()).collect();
    let there = std::fs::read_dir(folder()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let there: BTreeSet<String> = there.filter(|f| f.ends_with(".toml")).collect();
    assert_eq!(listed, there);
    assert_eq!(listed.len(), BROKEN.len());
}

/// Writes the files of a case beside a scene that names the mesh.
fn laid_out(case: &meshes::Case) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &case.files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let material = if case.material { "material = \"m\"\n" } else { "" };
    let text = format!(
        "format = \"etalon-scene/1\"\n[[material]]\nname = \"m\"\nreflectance = 0.5\n\
         [[surface]]\nname = \"s\"\n\nmesh = \"{}\"\n{material}",
        case.file
    );
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    folder
}

#[test]
fn every_broken_mesh_is_refused_with_its_place_and_its_mend() {
    let cases = meshes::all();
    let mut wrong = Vec::new();
    for case in &cases {
        let folder = laid_out(case);
        let name = &case.name;
        match read_scene(&folder.path().join("scene.toml"), &SceneOptions::default()) {
            Ok(_) => wrong.push(format!("{name}: accepted")),
            Err(e) => {
                let line = e.to_string();
                let missing: Vec<_> = case.parts.iter().filter(|p| !line.contains(p.as_str())).collect();
                if !missing.is_empty() || line.contains('\n') || line.len() > 500 {
                    wrong.push(format!("{name}: {line}\n    lacks {missing:?}"));
                }
                if e.help().is_none() || !e.place().contains("scene.toml:8, surface \"s\"") {
                    wrong.push(format!("{name}: no mend, or not led from the scene file: {line}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let names: BTreeSet<&str> = cases.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.len(), cases.len());
    assert!(cases.len() + BROKEN.len() >= 190, "{}", cases.len() + BROKEN.len());
}

/// Meshes given as scenes are refused as well, unless only their materials are wrong: those become grey.
#[test]
fn broken_meshes_given_as_scenes_end_with_exit_code_2() {
    for case in meshes::all().iter().filter(|c| c.material && c.file != "m.stl").step_by(5) {
        let folder = laid_out(case);
        let run = Command::cargo_bin("etalon")
            .unwrap()
            .args(["scene", "check"])
            .arg(folder.path().join(&case.file))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{}: {said}", case.name);
        assert!(said.contains(&case.file) && run.stdout.is_empty(), "{}: {said}", case.name);
    }
}

#[test]
fn the_report_marks_the_place_in_the_file() {
    let e = read_scene(&folder().join("number-reflectance-one.toml"), &SceneOptions::default()).unwrap_err();
    assert_eq!(e.place(), "number-reflectance-one.toml:4, material \"m\"");
    let mut page = String::new();
    miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor())
        .render_report(&mut page, &e)
        .unwrap();
    for part in
        ["etalon::scene::number", "reflectance = 1.0", "outside [0, 1)", "help:", "number-reflectance-one.toml:4"]
    {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
}

#[test]
fn a_file_that_is_not_there_is_refused_by_name() {
    let e = open_scene("nowhere/at-all.toml", &SceneOptions::default()).unwrap_err();
    assert!(e.to_string().contains("nowhere/at-all.toml: cannot read the scene: there is no such file"), "{e}");
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_out_of_the_folder_is_refused() {
    let inside = tempfile::tempdir().unwrap();
    let outside = tempfile::tempdir().unwrap();
    std::fs::copy(folder().join("sound.obj"), outside.path().join("sound.obj")).unwrap();
    std::os::unix::fs::symlink(outside.path().join("sound.obj"), inside.path().join("link.obj")).unwrap();
    let scene = inside.path().join("scene.toml");
    let text = "format = \"etalon-scene/1\"\n[[material]]\nname = \"m\"\nreflectance = 0.5\n\
                [[surface]]\nname = \"s\"\nmaterial = \"m\"\nmesh = \"link.obj\"\n";
    std::fs::write(&scene, text).unwrap();
    let e = read_scene(&scene, &SceneOptions::default()).unwrap_err();
    assert!(e.to_string().contains("scene.toml:8, surface \"s\"") && e.to_string().contains("through a link"), "{e}");
}
