use super::*;
use crate::compositing::{Cluster, Line, Span, SpanFace};
use crate::math::DVec3;
use crate::scene::{
    Appearance, Background, Clouds, Finish, Fog, IntensityCurve, Light, LightShape, Material, Picture, SkyModel,
    Texture, Tree,
};
use crate::view::{Camera, Photometry};
use std::path::PathBuf;

/// An image of `count` upright bands with slanting edges, some apart, some lit, and one thing to see through.
fn image(size: [u32; 2], per_line: u32, count: u32) -> SpanImage {
    let camera = Camera {
        name: "front".into(),
        eye: DVec3::new(0.1, -3.0, 0.7),
        target: DVec3::new(0.0, 0.3, 1.0 / 3.0),
        up: DVec3::Z,
        fov: 47.0,
        size,
    };
    let corner = |k: u32, x: f64, z: f64| DVec3::new(x / 7.0 + f64::from(k), 0.1 * f64::from(k), z / 3.0);
    let face = |k: u32| SpanFace {
        key: (format!("wall {}", k / 3), k),
        vertices: vec![corner(k, 0.0, 0.0), corner(k, 1.0, 0.0), corner(k, 1.3, 1.0), corner(k, 0.0, 1.0)],
        material: k % 2,
        cluster: 0,
        two_sided: k.is_multiple_of(3),
        tree: (k == 1).then_some(0),
    };
    let mut faces: Vec<SpanFace> = (0..count).map(face).collect();
    faces.sort_by(|a, b| a.key.cmp(&b.key));
    let width = f64::from(size[0]);
    let line = |j: u32| {
        let y = f64::from(j) / f64::from(per_line);
        let edge = |k: u32| {
            (width * (f64::from(k) + 0.3 + 0.4 * (y * 0.013 + f64::from(k)).fract()) / f64::from(count)).min(width)
        };
        let to = |k: u32| if k % 4 == 3 { edge(k) + 0.4 * (edge(k + 1) - edge(k)) } else { edge(k + 1) };
        let solid = (0..count - 1).map(|k| Span { from: edge(k), to: to(k), face: k, lit: !(j + k).is_multiple_of(5) });
        let over = [
            Span { from: 1.0 / 3.0, to: width / 3.0, face: 1, lit: true },
            Span { from: 0.5, to: 0.75, face: 2, lit: false },
        ];
        Line { solid: solid.collect(), over: if j.is_multiple_of(2) { over.to_vec() } else { Vec::new() } }
    };
    let material = |name: &str, e: f64| Material {
        name: name.into(),
        reflectance: vec![0.1, 0.2, 1.0 / 3.0],
        emission: vec![e; 3],
    };
    SpanImage {
        camera,
        per_line,
        photometry: Photometry::rec709(),
        materials: vec![material("a", 0.0), material("b \"quoted\"", 1e-7)],
        clusters: vec![Cluster { name: "scene".into(), objects: vec!["scene".into()], hash: "ab".into() }],
        faces,
        appearance: appearance(),
        lines: (0..=per_line * size[1]).map(line).collect(),
    }
}

fn appearance() -> Appearance {
    let texture = Texture { picture: 0, origin: DVec3::new(0.1, 0.2, 0.3), tile: [0.5, 0.25] };
    let light = |name: &str, shape| Light { name: name.into(), strength: vec![1.0, 0.5, 1.0 / 7.0], shape };
    let triangle = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let curve = IntensityCurve { axis: -DVec3::Z, samples: vec![(0.0, 1.0), (30.0, 0.8), (90.0, 0.0)] };
    Appearance {
        lights: vec![
            light("sun", LightShape::Parallel { direction: -DVec3::Z }),
            light(
                "p",
                LightShape::Point {
                    position: DVec3::Z,
                    distribution: crate::scene::Distribution::Lambert(DVec3::X),
                    curve: Some(curve),
                },
            ),
            light("l", LightShape::Linear { from: DVec3::ZERO, to: DVec3::X }),
            light("a", LightShape::Area { polygon: triangle.clone() }),
            light("h", LightShape::Polyhedron { faces: vec![triangle] }),
            light("s", LightShape::Sky { model: SkyModel::Clear { sun: DVec3::X }, up: DVec3::Z }),
        ],
        fog: Some(Fog { extinction: 0.01, radiance: vec![0.1; 3], background_at: None }),
        background: Background {
            radiance: vec![1.0; 3],
            picture: Some(0),
            sky: true,
            clouds: Some(Clouds { picture: 0, height: 900.0, tile: [10.0, 20.0], radiance: vec![1.0; 3] }),
        },
        finishes: vec![Finish {
            material: "a".into(),
            colour: Some(texture.clone()),
            bump: Some(texture),
            bump_height: 0.01,
            reflection: 0.25,
            transparency: 0.5,
            refraction: 1.5,
            ..Finish::default()
        }],
        trees: vec![Tree {
            name: "t".into(),
            object: "scene".into(),
            foot: DVec3::X,
            up: DVec3::Z,
            size: [1.0, 2.0],
            picture: 0,
        }],
        pictures: vec![Picture { name: "p.png".into(), size: [2, 3], rgba: (0..24).collect() }],
    }
}

fn file(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().expect("dir");
    let path = dir.path().join("a.span");
    std::fs::write(&path, bytes).expect("written");
    (dir, path)
}

#[test]
fn an_image_comes_back_to_the_bit() {
    let image = image([37, 11], 3, 9);
    let dir = tempfile::tempdir().expect("dir");
    let path = dir.path().join("a.span");
    let length = write_span(&path, &image).expect("written");
    assert_eq!(length, std::fs::metadata(&path).expect("there").len());
    let back = read_span(&path).expect("read");
    assert_eq!(back, image);
    let ends = |i: &SpanImage| {
        let spans = i.lines.iter().flat_map(|l| l.solid.iter().chain(&l.over));
        spans.flat_map(|s| [s.from.to_bits(), s.to.to_bits()]).collect::<Vec<_>>()
    };
    assert_eq!(ends(&back), ends(&image));
    assert_eq!(encode(&back).expect("bytes"), std::fs::read(&path).expect("bytes"));
}

#[test]
fn ends_that_go_wild_come_back_to_the_bit() {
    // Ends at random, faces at random, negative zeros, numbers without a whole mantissa: nothing is foretold well.
    let mut state = 7u64;
    let mut roll = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut wild = image([50, 40], 2, 12);
    for line in &mut wild.lines {
        let mut ends: Vec<f64> = (0..(roll() * 20.0) as usize * 2).map(|_| 50.0 * roll()).collect();
        ends.sort_by(f64::total_cmp);
        let span = |from, to, roll: &mut dyn FnMut() -> f64| Span {
            from,
            to,
            face: (roll() * 12.0) as u32,
            lit: roll() < 0.5,
        };
        line.solid = ends.chunks(2).map(|c| span(c[0], c[1], &mut roll)).collect();
        line.over = ends.iter().map(|e| span(*e, e + roll() * (50.0 - e), &mut roll)).collect();
        if let Some(first) = line.solid.first_mut() {
            first.from = if roll() < 0.5 { -0.0 } else { f64::from_bits(3) };
        }
    }
    let back = decode(&encode(&wild).expect("bytes")).expect("read");
    assert_eq!(format!("{:?}", back.lines), format!("{:?}", wild.lines));
}

#[test]
fn no_byte_can_be_changed_or_lost_unseen() {
    let whole = encode(&image([5, 2], 2, 5)).expect("bytes");
    for at in 0..whole.len() {
        for bit in 0..8 {
            let mut changed = whole.clone();
            changed[at] ^= 1 << bit;
            assert!(decode(&changed).is_err(), "byte {at}, bit {bit}");
        }
        assert!(decode(&whole[..at]).is_err(), "cut to {at}");
    }
    assert!(decode(&[whole.as_slice(), b"x"].concat()).is_err());
    assert!(decode(&whole).is_ok());
}

/// Every length, count, code and index turned over, with checksums made to fit: errors or other images, no panic, and
/// no memory beyond what the file can fill.
#[test]
fn files_with_sound_checksums_and_wrong_contents_are_refused_without_a_panic() {
    let image = image([5, 2], 2, 5);
    let whole = encode(&image).expect("bytes");
    let mut sections = Sections::open(&whole).expect("open");
    let tags = [*b"head", *b"face", *b"vert", *b"dpth", *b"pict", *b"rows", *b"code", *b"ends", frame::END];
    let parts: Vec<([u8; 4], Vec<u8>)> = tags.map(|t| (t, sections.next(t).expect("section").into_owned())).to_vec();
    let (mut refused, mut tried) = (0, 0);
    for which in 0..parts.len() {
        for at in 0..parts[which].1.len() {
            for value in [0xff, 0x80, 0x00] {
                let mut out = Writer::new();
                for (k, (tag, bytes)) in parts.iter().enumerate() {
                    let mut bytes = bytes.clone();
                    if k == which {
                        bytes[at] ^= value ^ 0x01;
                    }
                    out.section(*tag, &bytes).expect("packs");
                }
                tried += 1;
                refused += usize::from(decode(&out.finish()).is_err());
            }
        }
    }
    assert!(tried > 5000 && refused > tried / 2, "{refused} of {tried}");
}

#[test]
fn a_count_that_asks_for_memory_is_refused() {
    let whole = encode(&image([5, 2], 2, 5)).expect("bytes");
    let mut sections = Sections::open(&whole).expect("open");
    let head = String::from_utf8(sections.next(*b"head").expect("head").into_owned()).expect("text");
    let huge = [
        ("\"faces\":5", "\"faces\":1000000000000"),
        ("\"vertices\":20", "\"vertices\":768614336404564651"),
        ("\"lines\":5", "\"lines\":1000000000000"),
        ("\"solid\":20", "\"solid\":18446744073709551615"),
        ("\"over\":6", "\"over\":18446744073709551615"),
        ("[2,3]", "[4294967295,4294967295]"),
        ("[5,2]", "[16384,16384]"),
    ];
    for (old, new) in huge {
        assert!(head.contains(old), "{old} in {head}");
        let mut rest = Sections::open(&whole).expect("open");
        let mut out = Writer::new();
        for tag in [*b"head", *b"face", *b"vert", *b"dpth", *b"pict", *b"rows", *b"code", *b"ends", frame::END] {
            let own = rest.next(tag).expect("section");
            let replaced = head.replace(old, new);
            out.section(tag, if tag == *b"head" { replaced.as_bytes() } else { &own }).expect("packs");
        }
        assert!(decode(&out.finish()).is_err(), "{new}");
    }
    // A section that says it unpacks to a gigabyte and more.
    let mut bomb = Writer::new();
    bomb.section(*b"head", &vec![b' '; 1 << 20]).expect("packs");
    let mut bytes = bomb.finish();
    let at = SPAN_FORMAT.len() + 9;
    bytes[at + 13..at + 21].copy_from_slice(&(1u64 << 40).to_le_bytes());
    assert!(decode(&bytes).is_err());
}

#[test]
fn foreign_files_are_refused_with_their_version() {
    let refused = |bytes: &[u8]| {
        let (_dir, path) = file(bytes);
        read_span(&path).expect_err("refused").to_string()
    };
    let mut newer = encode(&image([5, 2], 2, 5)).expect("bytes");
    newer[SPAN_FORMAT.len() - 1] = b'7';
    let e = refused(&newer);
    assert!(e.contains("version 7") && e.contains(SPAN_FORMAT) && e.contains("a.span"), "{e}");
    assert!(refused(b"").contains("no span file"));
    assert!(refused(b"P6 5 5 255\n").contains("etalon scan"));
    assert!(refused(b"etalon-span/1\n").contains("cut off"));
    let e = read_span(Path::new("nowhere/a.span")).expect_err("missing").to_string();
    assert!(e.contains("no such file"), "{e}");
}

#[test]
fn images_that_do_not_fit_together_are_not_written() {
    type Harm = fn(&mut SpanImage);
    let harms: [(&str, Harm); 16] = [
        ("face 99 of 5", |i| i.lines[0].solid[0].face = 99),
        ("from 3", |i| i.lines[0].solid[0].from = 3.0),
        ("in order", |i| i.lines[0].solid.swap(0, 1)),
        ("in order", |i| i.lines[0].over.swap(0, 1)),
        ("NaN", |i| i.lines[0].over[1].to = f64::NAN),
        ("5 pixels", |i| i.lines[0].over[1].to = 5.5),
        ("sub-scanlines where", |i| i.lines.truncate(3)),
        ("material 2 of 2", |i| i.faces[0].material = 2),
        ("cluster 1 of 1", |i| i.faces[4].cluster = 1),
        ("tree 3 of 1", |i| i.faces[4].tree = Some(3)),
        ("corners", |i| i.faces[0].vertices[1].x = f64::INFINITY),
        ("keys", |i| i.faces.swap(0, 1)),
        ("camera", |i| i.camera.target = i.camera.eye),
        ("bands", |i| i.photometry.weights.truncate(2)),
        ("light \"sun\"", |i| i.appearance.lights[0].strength[0] = f64::NAN),
        ("picture", |i| i.appearance.pictures[0].rgba.truncate(5)),
    ];
    for (says, harm) in harms {
        let mut image = image([5, 2], 2, 5);
        harm(&mut image);
        let dir = tempfile::tempdir().expect("dir");
        let path = dir.path().join("a.span");
        let e = write_span(&path, &image).expect_err(says).to_string();
        assert!(e.contains(says) && !path.exists(), "{says}: {e}");
    }
}

/// Triangles at random, each cut by every sub-scanline as a scan would: ends with the rounding of real ones.
fn triangles(count: u32) -> SpanImage {
    let mut image = image([1024, 768], 3, 3);
    let mut state = 11u64;
    let mut roll = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let eye = crate::compositing::Projection::of(&image.camera);
    image.faces = (0..count)
        .map(|k| {
            let (x, y, z) = (roll() * 1024.0, roll() * 768.0, 0.1 + roll());
            let vertices = (0..3).map(|_| eye.point(x + 90.0 * roll(), y + 90.0 * roll(), z + 0.1 * roll())).collect();
            SpanFace { key: ("mesh".into(), k), vertices, material: 0, cluster: 0, two_sided: false, tree: None }
        })
        .collect();
    let cut = |face: &SpanFace, y: f64| {
        let p: Vec<(f64, f64)> = face.vertices.iter().filter_map(|v| eye.project(*v)).map(|p| (p.0, p.1)).collect();
        let edge = |a: (f64, f64), b: (f64, f64)| {
            ((a.1 > y) != (b.1 > y)).then(|| (a.0 + (y - a.1) / (b.1 - a.1) * (b.0 - a.0)).clamp(0.0, 1024.0))
        };
        let x: Vec<f64> = (0..p.len()).filter_map(|i| edge(p[i], p[(i + 1) % p.len()])).collect();
        (x.len() == 2).then(|| (x[0].min(x[1]), x[0].max(x[1])))
    };
    for (j, line) in image.lines.iter_mut().enumerate() {
        let span = |(k, face)| cut(face, j as f64 / 3.0).map(|(from, to)| Span { from, to, face: k as u32, lit: true });
        let mut spans: Vec<Span> = image.faces.iter().enumerate().filter_map(span).collect();
        spans.sort_by(|a, b| a.from.total_cmp(&b.from));
        *line = Line { solid: Vec::new(), over: spans };
    }
    image
}

#[test]
fn straight_edges_take_a_few_bytes_a_segment() {
    let image = triangles(2000);
    let spans: usize = image.lines.iter().map(|l| l.solid.len() + l.over.len()).sum();
    let begin = std::time::Instant::now();
    let bytes = encode(&image).expect("bytes");
    let (packed, begin) = (begin.elapsed(), std::time::Instant::now());
    assert_eq!(decode(&bytes).expect("read"), image);
    let each = bytes.len() as f64 / spans as f64;
    println!("{spans} segments: {each:.2} bytes each, written in {packed:?}, read in {:?}", begin.elapsed());
    // Two ends of eight bytes, not foretold, would take sixteen.
    assert!(each < 3.0, "{each} bytes a segment");
}
