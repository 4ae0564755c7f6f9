use super::*;
use crate::io::image::{Channel, Samples, exr, png};
use crate::math::DVec3;
use crate::world::{Layout, Shape, WorldMap};
use std::path::{Path, PathBuf};

/// A world that no turn or mirror leaves as it is, in the observer's directions.
fn world(d: DVec3) -> f64 {
    let d = d.normalize();
    3.0 + d.x + 0.7 * d.y - 0.4 * d.z + 0.5 * d.x * d.y + 0.3 * d.y * d.z
}

fn write(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    (folder, path)
}

/// A picture of what `at` says of each pixel's middle (columns and rows, in units of a face or of the height).
fn picture(across: u32, down: u32, n: u32, at: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let (w, h) = (across * n, down * n);
    let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(n);
    let values = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| at(middle(x), middle(y)) as f32);
    exr(w, h, &[Channel { name: "Y".into(), samples: Samples::F32(values.collect()) }], "").expect("encodes")
}

/// Directions of a face's point from its middle (-1 to 1 to the right and downwards), written out by hand: front, right,
/// back, left, up, down.
fn on_face(face: usize, u: f64, v: f64) -> DVec3 {
    match face {
        0 => DVec3::new(u, 1.0, -v),
        1 => DVec3::new(1.0, -u, -v),
        2 => DVec3::new(-u, -1.0, -v),
        3 => DVec3::new(-1.0, u, -v),
        4 => DVec3::new(u, v, 1.0),
        _ => DVec3::new(u, -v, -1.0),
    }
}

/// OpenEXR's faces as its header file draws them, in its own axes (Y up), then turned to ours: x is left, y up, z ahead.
fn openexr(face: usize, u: f64, v: f64) -> DVec3 {
    let (x, y, z) = match face {
        0 => (1.0, -v, u),
        1 => (-1.0, -v, -u),
        2 => (u, 1.0, -v),
        3 => (u, -1.0, v),
        4 => (-u, -v, 1.0),
        _ => (u, -v, -1.0),
    };
    DVec3::new(-x, z, y)
}

fn within(at: f64) -> f64 {
    2.0 * (at - at.floor()) - 1.0
}

fn cross(x: f64, y: f64, faces: &[(u32, u32, usize)], upside_down: bool) -> f64 {
    let found = faces.iter().find(|f| (f.0, f.1) == (x as u32, y as u32));
    found.map_or(f64::NAN, |f| {
        let turn = if upside_down && f.2 == 2 { -1.0 } else { 1.0 };
        world(on_face(f.2, turn * within(x), turn * within(y)))
    })
}

const HORIZONTAL: [(u32, u32, usize); 6] = [(0, 1, 3), (1, 1, 0), (2, 1, 1), (3, 1, 2), (1, 0, 4), (1, 2, 5)];
const VERTICAL: [(u32, u32, usize); 6] = [(0, 1, 3), (1, 1, 0), (2, 1, 1), (1, 3, 2), (1, 0, 4), (1, 2, 5)];

#[test]
fn every_layout_of_others_reads_to_the_same_world() {
    const N: u32 = 32;
    let latlong = |x: f64, y: f64| {
        // OpenEXR: latitude pi / 2 at the top, longitude pi at the left, +X at longitude pi / 2, +Z at 0.
        let (latitude, longitude) = ((0.5 - y) * std::f64::consts::PI, (1.0 - x) * std::f64::consts::PI);
        let (ex, ey, ez) = (longitude.sin() * latitude.cos(), latitude.sin(), longitude.cos() * latitude.cos());
        world(DVec3::new(-ex, ez, ey))
    };
    let pictures = [
        ("latitude-longitude", picture(2, 1, 2 * N, latlong)),
        ("horizontal cross", picture(4, 3, N, |x, y| cross(x, y, &HORIZONTAL, false))),
        ("vertical cross", picture(3, 4, N, |x, y| cross(x, y, &VERTICAL, true))),
        ("column", picture(1, 6, N, |x, y| world(openexr(y as usize, within(x), within(y))))),
        ("row", picture(6, 1, N, |x, y| world(openexr(x as usize, within(x), within(y))))),
    ];
    for (name, bytes) in pictures {
        let (_folder, path) = write("map.exr", &bytes);
        let read = read_world_map(&path, None).expect(name);
        assert!(read.how.contains(name) && read.how.contains("by its proportions"), "{}", read.how);
        assert_eq!(read.bands, ["y"]);
        let shape = read.map.shape();
        for k in 0..shape.texels() {
            let off = (f64::from(read.map.texel(k)[0]) - world(shape.middle(k).expect("whole"))).abs();
            assert!(off < 1e-6, "{name} {k}: {off}");
        }
        for k in 0..500 {
            let (z, phi) = (1.0 - (2.0 * f64::from(k) + 1.0) / 500.0, 2.399_963 * f64::from(k));
            let d = DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
            // Within a texel of 1/16 the world changes by no more than 1.8 times half its diagonal.
            let off = (f64::from(read.map.nearest(d).expect("whole")[0]) - world(d)).abs();
            assert!(off < 0.085, "{name} {d}: {off}");
        }
    }
}

fn uneven(layout: Layout) -> WorldMap {
    let shape = Shape { layout, size: 8 };
    WorldMap::filled(shape, 3, |k, v| {
        let shown = shape.middle(k).is_some();
        let wild = [0.1f32, -3.25e-7, 1e30, f32::MIN_POSITIVE, 0.0, 7.0];
        (0..3).for_each(|b| v[b] = if shown { wild[(k + b) % 6] * (k as f32 + 1.0) } else { 0.0 });
    })
}

#[test]
fn our_own_files_come_back_to_the_bit() {
    let bands = ["r", "450.5 nm", "a b"].map(String::from).to_vec();
    for layout in [Layout::Cube, Layout::LatLong, Layout::SineLatLong, Layout::Fisheye { field: 187.5 }] {
        let map = uneven(layout);
        let bytes = world_map_exr(&map, &bands, "two words", &[]).expect("encodes");
        assert_eq!(bytes, world_map_exr(&map, &bands, "two words", &[]).expect("encodes"));
        let (_folder, path) = write("map.exr", &bytes);
        let read = read_world_map(&path, None).expect("reads");
        assert_eq!((read.map.shape(), &read.bands), (map.shape(), &bands));
        let bits = |m: &WorldMap| m.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read.map), bits(&map), "{layout:?}");
        assert!(read.how.contains("as its header says"), "{}", read.how);
    }
    assert!(world_map_exr(&uneven(Layout::Cube), &bands[1..], "", &[]).is_err());
}

#[test]
fn half_floats_tiles_and_envmap_attributes_are_read() {
    use exr::meta::attribute::EnvironmentMap;
    use exr::prelude::*;
    let value = |x: usize, y: usize| (x + 10 * y) as f32 / 4.0;
    let blocks = [Blocks::ScanLines, Blocks::Tiles(Vec2(5, 3))];
    let all = [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];
    for (blocks, compression) in blocks.into_iter().flat_map(|b| all.map(move |c| (b, c))) {
        let colours = SpecificChannels::rgb(|at: Vec2<usize>| {
            let v = f16::from_f32(value(at.0, at.1));
            (v, v, v)
        });
        let environment_map = Some(EnvironmentMap::Cube);
        let attributes = LayerAttributes { environment_map, ..LayerAttributes::default() };
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let image = Image::from_layer(Layer::new(Vec2(4, 24), attributes, encoding, colours));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).expect("encodes");
        let (_folder, path) = write("map.exr", bytes.get_ref());
        let read = read_world_map(&path, None).expect("reads");
        assert!(read.how.contains("envmap"), "{}", read.how);
        assert_eq!(read.bands, ["r", "g", "b"]);
        // +X is the first face and lies to the left.
        let left = read.map.texel(Shape { layout: Layout::Cube, size: 4 }.index(3, 1, 2));
        assert_eq!(left, [value(1, 2); 3], "{compression:?}");
    }
}

#[test]
fn photographs_are_decoded_to_light() {
    let levels = [0u8, 10, 128, 255];
    let rgba: Vec<u8> = (0..16).flat_map(|k| [levels[k % 4], 255, levels[3 - k % 4], 255]).collect();
    let (_folder, path) = write("sky.png", &png(4, 4, &rgba).expect("encodes"));
    let read = read_world_map(&path, Some(LayoutHint::Fisheye { field: 180.0 })).expect("reads");
    assert_eq!(read.map.shape(), Shape { layout: Layout::Fisheye { field: 180.0 }, size: 4 });
    // IEC 61966-2-1: 10 / 255 is in the straight part, 128 / 255 is 0.2158605.
    let texel = read.map.texel(5);
    assert!((f64::from(texel[0]) - 10.0 / 255.0 / 12.92).abs() < 1e-7 && texel[1] == 1.0);
    assert!((f64::from(texel[2]) - 0.215_860_5).abs() < 1e-6);
    let e = read_world_map(&path, None).expect_err("not by itself").to_string();
    assert!(e.contains("fish-eye") && e.contains("sky.png"), "{e}");
}

#[test]
fn what_does_not_fit_is_refused_with_a_mend() {
    let refused = |bytes: &[u8], hint: Option<LayoutHint>| {
        let (_folder, path) = write("map.exr", bytes);
        read_world_map(&path, hint).expect_err("refused").to_string()
    };
    let e = refused(&picture(5, 3, 4, |_, _| 1.0), None);
    assert!(e.contains("20 x 12") && e.contains("2:1"), "{e}");
    let e = refused(&picture(2, 1, 4, |_, _| 1.0), Some(LayoutHint::VerticalCross));
    assert!(e.contains("3:4"), "{e}");
    let e = refused(&picture(2, 1, 4, |x, y| if x < 0.2 && y < 0.2 { f64::INFINITY } else { 1.0 }), None);
    assert!(e.contains("a value is inf") && e.contains("pixel 0, 0"), "{e}");
    for field in [0.0, -1.0, 361.0, f64::NAN] {
        let e = refused(&picture(1, 1, 4, |_, _| 1.0), Some(LayoutHint::Fisheye { field }));
        assert!(e.contains("degrees"), "{e}");
    }
    assert!(refused(b"", None).contains("no sound"));
    assert!(refused(b"not a picture at all", None).contains("no sound"));
    let e = read_world_map(Path::new("nowhere/map.exr"), None).expect_err("missing").to_string();
    assert!(e.contains("no such file"), "{e}");
    let folder = tempfile::tempdir().expect("folder");
    assert!(read_world_map(folder.path(), None).expect_err("folder").to_string().contains("folder"));
}

#[test]
fn broken_files_end_in_an_error_never_in_a_panic() {
    let bands = ["r", "g", "b"].map(String::from).to_vec();
    let exr = world_map_exr(&uneven(Layout::Cube), &bands, "x", &[]).expect("encodes");
    let rgba: Vec<u8> = (0..16 * 8 * 4).map(|k| (k * k / 91) as u8).collect();
    let png = png(16, 8, &rgba).expect("encodes");
    for whole in [exr, png] {
        for cut in 0..24 {
            let (_folder, path) = write("map", &whole[..whole.len() * cut / 24]);
            let e = read_world_map(&path, None).expect_err("cut off").to_string();
            assert!(e.contains(&path.display().to_string()), "{e}");
        }
        // Bits turned over, in the header too: an error or another map, never a panic.
        let mut state = 1u64;
        for _ in 0..300 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mut broken = whole.clone();
            let reach = if state & 1 == 0 { whole.len() } else { whole.len().min(400) };
            let at = (state >> 33) as usize % reach;
            broken[at] ^= 1 << ((state >> 24) & 7);
            let (_folder, path) = write("map", &broken);
            let _ = read_world_map(&path, None);
        }
    }
}
