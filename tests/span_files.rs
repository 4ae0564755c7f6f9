//! Span files of real scans: read back to the bit, small, the same whatever the threads, refused when harmed.

use etalon::compositing::{ScanRequest, SpanImage, composite};
use etalon::io::scene::{SceneOptions, open_staged, open_with_look, read_lighting};
use etalon::io::{read_span, write_span};
use etalon::scene::{Appearance, LightShape, Scene, Stage};
use std::path::Path;

fn opened(name: &str) -> (Scene, Appearance, Stage) {
    let (scene, look) = open_staged(&format!("builtin:{name}"), &SceneOptions::default()).expect("opens");
    let stage = scene.at(0).expect("stage");
    (scene, look, stage)
}

fn scan(name: &str, per_line: u32, cluster: Option<&[String]>) -> SpanImage {
    let (scene, appearance, stage) = opened(name);
    let mut camera = scene.cameras[0].clone();
    camera.size = [320, 240];
    let request = ScanRequest { stage: &stage, appearance: &appearance, camera: &camera, per_line, cluster };
    request.scan().expect("scans")
}

fn segments(image: &SpanImage) -> usize {
    image.lines.iter().map(|l| l.solid.len() + l.over.len()).sum()
}

fn bytes_of(image: &SpanImage, path: &Path) -> Vec<u8> {
    write_span(path, image).expect("written");
    std::fs::read(path).expect("read")
}

#[test]
fn scans_come_back_to_the_bit_and_are_small() {
    let dir = tempfile::tempdir().expect("dir");
    for name in ["cornell-box", "office", "furnished-room"] {
        let image = scan(name, 3, None);
        let path = dir.path().join("a.span");
        let length = bytes_of(&image, &path).len();
        assert_eq!(read_span(&path).expect("reads"), image, "{name}");
        let (count, faces) = (segments(&image), image.faces.len());
        let each = length as f64 / count as f64;
        println!("{name}: {faces} faces, {count} segments, {length} bytes, {each:.2} a segment");
        // Face, ends and mark as plain numbers take 21.
        assert!(each < 8.0, "{name}: {each} bytes a segment");
    }
}

#[test]
fn files_are_the_same_whatever_the_threads_and_composites_of_files_are_those_of_scans() {
    let dir = tempfile::tempdir().expect("dir");
    let (scene, ..) = opened("office");
    let objects: Vec<String> = scene.objects().into_iter().map(String::from).collect();
    let halves: Vec<SpanImage> =
        [&objects[..1], &objects[1..]].into_iter().map(|part| scan("office", 2, Some(part))).collect();
    let paths: Vec<_> = (0..2).map(|k| dir.path().join(format!("{k}.span"))).collect();
    for (image, path) in halves.iter().zip(&paths) {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
        let first = bytes_of(image, path);
        assert_eq!(one.install(|| bytes_of(image, path)), first);
        let alone: Vec<String> = image.clusters.iter().flat_map(|c| c.objects.clone()).collect();
        assert_eq!(one.install(|| bytes_of(&scan("office", 2, Some(&alone)), path)), first);
    }
    let read: Vec<SpanImage> = paths.iter().map(|p| read_span(p).expect("reads")).collect();
    let from_files = composite(&read[0], &read[1]).expect("composes");
    assert_eq!(from_files, composite(&halves[0], &halves[1]).expect("composes"));
    let path = dir.path().join("both.span");
    write_span(&path, &from_files).expect("written");
    assert_eq!(read_span(&path).expect("reads"), from_files);
}

#[test]
fn harmed_files_are_refused_with_place_and_mend() {
    let dir = tempfile::tempdir().expect("dir");
    let path = dir.path().join("a.span");
    let whole = bytes_of(&scan("cornell-box", 1, None), &path);
    let mut state = 3u64;
    for round in 0..200 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut harmed = whole.clone();
        let at = (state >> 33) as usize % whole.len();
        if round % 2 == 0 {
            harmed.truncate(at)
        } else {
            harmed[at] ^= 1 << (state & 7)
        }
        std::fs::write(&path, &harmed).expect("written");
        let e = read_span(&path).expect_err("harmed").to_string();
        assert!(e.contains("a.span, ") && e.contains("; "), "{e}");
    }
}

#[test]
fn lighting_finds_the_same_shapes_in_a_scene_and_in_its_scan() {
    let dir = tempfile::tempdir().expect("dir");
    let (scene, look) = open_with_look("builtin:cornell-box", &SceneOptions::default()).expect("opens");
    let stage = scene.at(0).expect("stage");
    let mut emits = stage.facets.iter().filter(|f| stage.emission(f.first_patch as usize).iter().any(|e| *e > 0.0));
    let lamp = &stage.surfaces[emits.next().expect("a lamp").surface as usize].name;
    let path = dir.path().join("evening.toml");
    let text = format!("format = \"etalon-lighting/1\"\n[[light]]\ntype = \"area\"\nsurface = \"{lamp}\"\n");
    std::fs::write(&path, text).expect("written");
    let lighting = read_lighting(&path, &scene.photometry.bands).expect("reads");
    let base = look.on(&stage).expect("fits");
    let by_scene = lighting.over(&base, &stage).expect("fits");
    let by_scan = lighting.over(&base, &scan("cornell-box", 1, None)).expect("fits");
    assert_eq!(by_scene, by_scan);
    assert!(matches!(by_scan.lights[0].shape, LightShape::Area { .. }) && by_scan.lights[0].strength[0] > 0.0);
}
