//! Shading against closed forms, and clusters against the whole under every kind of light.

use super::composite::composite;
use super::image::{SpanFace, SpanImage};
use super::project::Projection;
use super::scan::scanned;
use super::shade::{ShadeOptions, Shaded, shade};
use super::testing::{Random, outset, part, triangles};
use crate::math::DVec3;
use crate::scene::{Background, Distribution, Finish, Fog, Light, LightShape, Material, Picture, SkyModel, Tree};
use std::f64::consts::PI;

fn light(name: &str, strength: f64, shape: LightShape) -> Light {
    Light { name: name.into(), strength: vec![strength; 3], shape }
}

fn sun(direction: DVec3) -> Light {
    light("sun", 3.0, LightShape::Parallel { direction: direction.normalize() })
}

fn sky() -> Light {
    light("sky", 1.0, LightShape::Sky { model: SkyModel::Uniform, up: DVec3::Z })
}

fn lamp(position: DVec3) -> Light {
    light("lamp", 20.0, LightShape::Point { position, distribution: Distribution::Isotropic, curve: None })
}

fn shaded(image: &SpanImage) -> Shaded {
    shade(image, &ShadeOptions::default()).expect("usable")
}

/// Red of a pixel.
fn red(shaded: &Shaded, x: u32, y: u32) -> f64 {
    shaded.radiance.values[3 * (y * shaded.radiance.size[0] + x) as usize]
}

/// A large floor 2 m below the eye, front up.
fn floor() -> Vec<DVec3> {
    vec![(-50.0, -1.0), (50.0, -1.0), (50.0, 99.0), (-50.0, 99.0)]
        .into_iter()
        .map(|(x, y)| DVec3::new(x, y, -2.0))
        .collect()
}

/// A level square over the floor.
fn plate(z: f64) -> Vec<DVec3> {
    vec![(-1.0, 5.0), (1.0, 5.0), (1.0, 7.0), (-1.0, 7.0)].into_iter().map(|(x, y)| DVec3::new(x, y, z)).collect()
}

/// An upright wall behind everything, front to the eye.
fn wall(y: f64) -> Vec<DVec3> {
    vec![(-60.0, -60.0), (60.0, -60.0), (60.0, 60.0), (-60.0, 60.0)]
        .into_iter()
        .map(|(x, z)| DVec3::new(x, y, z))
        .collect()
}

fn with(mut image: SpanImage, change: impl FnOnce(&mut SpanImage)) -> SpanImage {
    change(&mut image);
    scanned(image)
}

#[test]
fn a_floor_under_sky_and_sun_has_the_radiance_of_the_closed_forms() {
    let size = [24, 18];
    let under = |lights: Vec<Light>| shaded(&with(outset(vec![floor()], 1, size, 3), |i| i.appearance.lights = lights));
    // Reflectance 0.5; the sky brings pi, the sun 3 cos 60.
    assert!((red(&under(vec![sky()]), 12, 16) - 0.5).abs() < 1e-12);
    let slanted = DVec3::new(0.0, 3f64.sqrt(), -1.0);
    assert!((red(&under(vec![sun(slanted)]), 12, 16) - 0.5 * 1.5 / PI).abs() < 1e-12);
    assert_eq!(red(&under(vec![sun(-slanted)]), 12, 16), 0.0, "from below");
}

#[test]
fn the_sun_throws_the_shadow_of_a_plate_to_its_exact_edges() {
    let size = [64, 48];
    let image =
        with(outset(vec![floor(), plate(-1.0)], 1, size, 3), |i| i.appearance.lights = vec![sun(-DVec3::Z + DVec3::Y)]);
    // The shadow is the plate, 1 m lower and 1 m further.
    let projection = Projection::of(&image.camera);
    let mut cut = 0;
    for (j, line) in image.lines.iter().enumerate() {
        for s in line.solid.iter().filter(|s| s.face == 0) {
            let y = j as f64 / 3.0;
            let depth = image.faces[0].depth(&image.camera).value(0.5 * (s.from + s.to), y);
            let p = projection.point(0.5 * (s.from + s.to), y, depth);
            let inside = p.x.abs() < 1.0 && p.y > 6.0 && p.y < 8.0;
            assert_eq!(s.lit, !inside, "{p}");
            cut += usize::from(!s.lit);
        }
    }
    assert!(cut > 5, "{cut} segments in shadow: too few to tell");
}

#[test]
fn clusters_shaded_are_the_whole_shaded_under_all_lights() {
    let square = |c: DVec3| vec![c, c + DVec3::X, c + DVec3::X - DVec3::Y, c - DVec3::Y];
    let lights = vec![
        sun(DVec3::new(0.3, 0.5, -1.0)),
        lamp(DVec3::new(-1.0, 3.0, 2.0)),
        light("tube", 5.0, LightShape::Linear { from: DVec3::new(-2.0, 2.0, 2.5), to: DVec3::new(2.0, 2.0, 2.5) }),
        light("panel", 9.0, LightShape::Area { polygon: square(DVec3::new(0.5, 4.0, 3.0)) }),
        sky(),
    ];
    let mut polygons = triangles(18, 40);
    polygons.push(floor());
    for k in [2, 4] {
        let whole = with(outset(polygons.clone(), k, [20, 15], 2), |i| i.appearance.lights = lights.clone());
        let parts: Vec<SpanImage> = (0..k).rev().map(|c| part(&whole, c)).collect();
        let all = parts[1..].iter().fold(parts[0].clone(), |sum, p| composite(&sum, p).expect("of one view"));
        let (a, b) = (shaded(&whole), shaded(&all));
        let worst = a.radiance.values.iter().zip(&b.radiance.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let brightest = a.radiance.values.iter().copied().fold(0.0, f64::max);
        assert!(worst <= 1e-12 * brightest, "{k} clusters: {worst} of {brightest}");
        assert!(brightest > 0.0);
    }
}

#[test]
fn memory_for_shadows_is_kept_and_changes_nothing() {
    let lights = vec![lamp(DVec3::new(0.0, 3.0, 3.0)), sky()];
    let mut polygons = triangles(150, 41);
    polygons.push(floor());
    let image = with(outset(polygons, 2, [16, 12], 2), |i| i.appearance.lights = lights);
    let all = shaded(&image);
    let few = shade(&image, &ShadeOptions { shadow_memory: 1, ..ShadeOptions::default() }).expect("usable");
    assert!(
        few.passes > all.passes && few.shadow_bytes < all.shadow_bytes,
        "{} passes, {} bytes",
        few.passes,
        few.shadow_bytes
    );
    let worst = all.radiance.values.iter().zip(&few.radiance.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-13, "{worst}");
}

#[test]
fn lights_are_changed_without_a_new_scan() {
    let mut image =
        with(outset(vec![floor(), plate(-1.0)], 1, [32, 24], 3), |i| i.appearance.lights = vec![sun(-DVec3::Z)]);
    let other = with(outset(vec![floor(), plate(-1.0)], 1, [32, 24], 3), |i| {
        i.appearance.lights = vec![sun(DVec3::X - DVec3::Z)]
    });
    image.relight(other.appearance.clone());
    assert_eq!(image, other);
}

#[test]
fn fog_takes_what_its_length_asks_for() {
    let size = [8, 6];
    let image = with(outset(vec![wall(10.0)], 1, size, 1), |i| {
        i.materials[0].emission = vec![PI; 3];
        i.appearance.fog = Some(Fog { extinction: 0.1, radiance: vec![0.25; 3], background_at: None });
    });
    let picture = shaded(&image);
    // The mean over the pixel of radiance 1 seen through 0.1 times the distance, by fine sums.
    let mut mean = 0.0;
    for k in 0..1000 {
        let p = image.camera.ray(4.0 + (f64::from(k) + 0.5) / 1000.0, 3.0);
        mean += (-p.length()).exp() / 1000.0;
    }
    let mid = |y: f64| {
        let p = image.camera.ray(4.5, y);
        (-p.length()).exp()
    };
    // Two sub-scanlines, at the pixel's upper and lower edge, each at the middle of the segment.
    let expected = 0.25 + 0.75 * 0.5 * (mid(3.0) + mid(4.0));
    assert!((red(&picture, 4, 3) - expected).abs() < 1e-12);
    assert!((mean - mid(3.0)).abs() < 2e-3);
}

#[test]
fn a_mirror_shows_what_stands_before_it_and_counts_as_traced() {
    // A mirror wall before the eye; behind the eye a glowing wall.
    let mut back = wall(-5.0);
    back.reverse();
    let image = with(outset(vec![wall(5.0), back], 1, [8, 6], 2), |i| {
        i.materials.push(Material { name: "glow".into(), reflectance: vec![0.0; 3], emission: vec![2.0 * PI; 3] });
        i.faces[1].material = 1;
        i.appearance.finishes =
            vec![Finish { material: "grey".into(), reflection: 0.75, refraction: 1.0, ..Finish::default() }];
    });
    let picture = shaded(&image);
    assert!((red(&picture, 4, 3) - 0.75 * 2.0).abs() < 1e-12);
    assert_eq!(picture.traced, 1.0);
    let plain = shade(&image, &ShadeOptions { trace: false, ..ShadeOptions::default() }).expect("usable");
    assert_eq!((red(&plain, 4, 3), plain.traced), (0.0, 0.0));
}

#[test]
fn glass_lets_through_its_share_scanned_or_traced() {
    let glow = |refraction: f64| {
        with(outset(vec![wall(5.0), wall(9.0)], 1, [8, 6], 2), |i| {
            i.materials.push(Material { name: "glow".into(), reflectance: vec![0.0; 3], emission: vec![PI; 3] });
            i.faces[1].material = 1;
            i.appearance.finishes =
                vec![Finish { material: "grey".into(), transparency: 0.25, refraction, ..Finish::default() }];
        })
    };
    let straight = glow(1.0);
    assert!(straight.lines.iter().all(|l| l.over.len() == 1 && l.solid.len() == 1));
    assert!((red(&shaded(&straight), 4, 3) - 0.25).abs() < 1e-12);
    // A wall is as bright from everywhere: bent light shows the same.
    let bent = glow(1.5);
    assert!(bent.lines.iter().all(|l| l.over.is_empty()));
    assert!((red(&shaded(&bent), 4, 3) - 0.25).abs() < 1e-12);
}

#[test]
fn a_tree_hides_by_its_opacity_and_throws_its_shadow() {
    let picture = Picture { name: "p".into(), size: [64, 64], rgba: [255, 255, 255, 128].repeat(4096) };
    let opacity = 128.0 / 255.0;
    let image = with(outset(vec![floor()], 1, [64, 48], 3), |i| {
        let tree = Tree {
            name: "t".into(),
            object: "o".into(),
            foot: DVec3::new(0.0, 6.0, -2.0),
            up: DVec3::Z,
            size: [2.0, 2.5],
            picture: 0,
        };
        let corners = super::tree::turned(&tree, super::tree::Viewer::Point(i.camera.eye));
        i.faces.push(SpanFace {
            key: ("tree".into(), 0),
            vertices: corners.to_vec(),
            material: 0,
            cluster: 0,
            two_sided: true,
            tree: Some(0),
        });
        i.appearance.trees = vec![tree];
        i.appearance.pictures = vec![picture];
        i.appearance.background = Background { radiance: vec![0.5; 3], ..Background::default() };
        // The sun stands behind the tree: its shadow falls towards the eye.
        i.appearance.lights = vec![sun(DVec3::new(0.0, -1.0, -1.0))];
    });
    let shaded = shaded(&image);
    // Above the horizon: white leaves under a sun of 3, before a background of one half.
    let leaves = 3.0 / PI;
    let seen = red(&shaded, 32, 22);
    assert!((seen - (opacity * leaves + (1.0 - opacity) * 0.5)).abs() < 1e-6, "{seen}");
    // The floor 1 m before the tree is in its shadow, by as much as the leaves take.
    let lit = 0.5 * 3.0 * 0.5f64.sqrt() / PI;
    let projection = Projection::of(&image.camera);
    let at = |p: DVec3| projection.project(p).map(|(x, y, _)| red(&shaded, x as u32, y as u32)).expect("in sight");
    assert!((at(DVec3::new(0.0, 4.6, -2.0)) - lit * (1.0 - opacity)).abs() < 1e-6);
    assert!((at(DVec3::new(1.8, 4.6, -2.0)) - lit).abs() < 1e-12);
}

#[test]
fn scaling_keeps_the_mean() {
    let mut random = Random::new(3);
    let image = with(outset(triangles(30, 60), 1, [30, 20], 4), |i| {
        i.materials[0].emission = (0..3).map(|_| random.next()).collect();
    });
    let mean = |scale: [f64; 2]| {
        let s = shade(&image, &ShadeOptions { scale, ..ShadeOptions::default() }).expect("usable");
        s.radiance.values.iter().sum::<f64>() / s.radiance.values.len() as f64
    };
    let whole = mean([1.0, 1.0]);
    for scale in [[2.0, 1.0], [0.5, 1.0], [1.0, 2.0], [1.0, 0.5], [3.0, 4.0], [1.3, 0.7]] {
        assert!((mean(scale) / whole - 1.0).abs() < 0.01, "{scale:?}");
    }
}

#[test]
fn deep_samples_laid_over_one_another_are_the_flat_picture() {
    let mut polygons = triangles(45, 70);
    polygons.push(floor());
    let image = with(outset(polygons, 2, [24, 18], 3), |i| {
        i.materials.push(Material { name: "glass".into(), reflectance: vec![0.3; 3], emission: vec![0.2; 3] });
        i.faces.iter_mut().step_by(4).for_each(|f| f.material = 1);
        i.appearance.finishes =
            vec![Finish { material: "glass".into(), transparency: 0.6, refraction: 1.0, ..Finish::default() }];
        i.appearance.lights = vec![sun(DVec3::new(0.2, 0.4, -1.0)), lamp(DVec3::new(-1.0, 3.0, 2.0))];
    });
    let flat = shaded(&image);
    let deep = super::deep::deep(&image, &ShadeOptions::default()).expect("usable");
    let mut many = 0;
    for (k, samples) in deep.pixels.iter().enumerate() {
        assert!(samples.windows(2).all(|w| w[0].depth[0] <= w[1].depth[0]));
        let (mut left, mut sum) = (1.0, 0.0);
        for s in samples {
            sum += left * s.radiance[0];
            left *= 1.0 - s.alpha;
        }
        assert!((sum - flat.radiance.values[3 * k]).abs() < 1e-9, "pixel {k}: {sum}");
        assert!((1.0 - left - flat.covered[k]).abs() < 1e-9);
        many += usize::from(samples.len() > 2);
    }
    assert!(many > 50, "{many} pixels of three faces and more");
}
