//! Pictures of the judge against closed forms.

use super::testing::{camera, flat, light, picture, stage, stream, tracer, wall};
use super::{PictureFault, PictureOptions, RayPicture, cast_picture, compare};
use crate::math::{DVec3, area, intersect_convex};
use crate::scene::{Appearance, Background, Clouds, Finish, Fog, LightShape, Picture, SkyModel, Stage, Texture, Tree};
use crate::view::Photometry;
use std::f64::consts::PI;

fn cast(stage: &Stage, appearance: &Appearance, size: [u32; 2], options: &PictureOptions) -> RayPicture {
    cast_picture(&tracer(stage), appearance, &camera(size), options, stream()).expect("a picture")
}

fn few() -> PictureOptions<'static> {
    PictureOptions { samples: 64, randomisations: 8, ..PictureOptions::default() }
}

/// A triangle before the eye, given in pixels, and the picture of it that areas give, at a scale.
fn edges(scale: [f64; 2]) -> (Stage, [u32; 2], Vec<f64>) {
    let size = [24, 20];
    let corners = [[2.3, 3.1], [21.7, 8.4], [7.9, 18.6]];
    let lifted = corners.map(|[x, y]| camera(size).ray(x, y) * 5.0).to_vec();
    let plane = |x: f64, y: f64| DVec3::new(x * scale[0], y * scale[1], 0.0);
    let triangle: Vec<DVec3> = corners.iter().map(|c| plane(c[0], c[1])).collect();
    let scaled = [0, 1].map(|k| (f64::from(size[k]) * scale[k]).floor() as u32);
    let covered = |i: u32, j: u32| {
        let pixel = flat([f64::from(i), f64::from(i + 1)], [f64::from(j), f64::from(j + 1)], 0.0, true);
        let both = intersect_convex(&pixel, &triangle);
        if both.len() < 3 { 0.0 } else { area(&both) }
    };
    let exact = (0..scaled[1]).flat_map(|j| (0..scaled[0]).map(move |i| (i, j))).map(|(i, j)| covered(i, j));
    (stage(&[(lifted, "grey", 0.0, 0.0)]), scaled, exact.collect())
}

#[test]
fn edges_are_covered_as_areas_say_and_errors_are_honest() {
    for scale in [[1.0, 1.0], [1.5, 0.8]] {
        let (stage, size, exact) = edges(scale);
        let radiance = vec![1.0; 3];
        let options = PictureOptions { samples: 256, randomisations: 16, scale, flat: Some(&radiance), ..few() };
        let got = cast(&stage, &Appearance::default(), [24, 20], &options);
        assert_eq!((got.size, got.mean.len()), (size, exact.len() * 3));
        let (mut sum, mut n, mut worst) = (0.0, 0.0, 0.0f64);
        for (k, area) in exact.iter().enumerate() {
            let (mean, error) = (got.mean[3 * k], got.std_err[3 * k]);
            assert_eq!(mean, got.mean[3 * k + 2]);
            if error == 0.0 {
                // Slivers below a sample or two may be missed by all.
                assert!((mean - area).abs() < 0.02, "{mean} {area}");
            } else {
                let z = (mean - area) / error;
                // Where a corner of the triangle touches a pixel hits are rare, and spreads of rare hits are skewed.
                if (0.02..0.98).contains(area) {
                    (sum, n, worst) = (sum + z * z, n + 1.0, worst.max(z.abs()));
                }
            }
        }
        // z^2 is F(1, 15): mean 15 / 13, variance 3.39; six standard deviations of the sum.
        assert!(n > 40.0 && (sum - n * 15.0 / 13.0f64).abs() < 6.0 * (3.39f64 * n).sqrt(), "{sum} of {n}");
        assert!(worst < 8.0, "{worst}");
        // Against itself in the limit the judge finds nothing; against an error of known size it finds that.
        let exact3: Vec<f64> = exact.iter().flat_map(|a| [*a; 3]).collect();
        let photometry = Photometry::rec709();
        let error = compare(size, 3, &exact3, &got, &photometry, 1.0).expect("alike");
        assert!(error.squared.abs() < 5.0 * error.squared_std_err && error.rms_with_noise > 1e-3, "{error:?}");
        let off: Vec<f64> =
            exact3.iter().enumerate().map(|(k, v)| v + 0.1 * f64::from(1 - (k as i32 / 3) % 2 * 2)).collect();
        let error = compare(size, 3, &off, &got, &photometry, 1.0).expect("alike");
        let mean = exact.iter().sum::<f64>() / exact.len() as f64;
        assert!((error.squared - (0.1 / mean).powi(2)).abs() < 5.0 * error.squared_std_err, "{error:?}");
        assert!(error.rms_interval[0] < 0.1 / mean && 0.1 / mean < error.rms_interval[1] && error.surely_off > 0.4);
    }
}

/// A floor, a mirror wall, a pane, a tree and a lamp with a body: everything at once.
fn town() -> (Stage, Appearance) {
    let stage = stage(&[
        (flat([-20.0, 20.0], [0.5, 40.0], -1.5, true), "floor", 0.4, 0.0),
        (wall(12.0, [-3.0, 1.0], [-1.5, 3.0]), "glass", 0.2, 0.0),
        (wall(6.0, [0.5, 2.0], [-1.5, 1.0]), "pane", 0.1, 0.0),
    ]);
    let tree = Tree {
        name: "t".into(),
        object: "trees".into(),
        foot: DVec3::new(-1.0, 8.0, -1.5),
        up: DVec3::Z,
        size: [1.5, 2.0],
        picture: 0,
    };
    let finish = |material: &str, reflection, transparency| Finish {
        material: material.into(),
        reflection,
        transparency,
        refraction: 1.0,
        ..Finish::default()
    };
    let appearance = Appearance {
        lights: vec![
            light(LightShape::Parallel { direction: DVec3::new(0.3, 0.5, -0.8).normalize() }),
            light(LightShape::Area { polygon: flat([-1.0, 1.0], [4.0, 6.0], 4.0, false) }),
            light(LightShape::Sky { model: SkyModel::Overcast, up: DVec3::Z }),
        ],
        fog: Some(Fog { extinction: 0.02, radiance: vec![0.3; 3], background_at: None }),
        background: Background { sky: true, ..Background::default() },
        finishes: vec![finish("glass", 0.6, 0.0), finish("pane", 0.1, 0.7)],
        trees: vec![tree],
        pictures: vec![picture([8, 8], |x, y| [90, 160, 60, if (x + y) % 3 == 0 { 0 } else { 230 }])],
    };
    (stage, appearance)
}

#[test]
fn threads_change_nothing() {
    let (stage, appearance) = town();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| cast(&stage, &appearance, [16, 12], &PictureOptions { samples: 16, ..few() }))
    };
    let (one, three) = (with(1), with(3));
    assert!(one == three && one.rays > 16 * 12 * 16 * 3);
    assert!(one.mean.iter().all(|v| v.is_finite() && *v >= 0.0));
}

#[test]
fn a_floor_under_the_overcast_sky_has_the_radiance_of_seven_ninths() {
    let stage = stage(&[(flat([-1e4, 1e4], [0.1, 1e4], -1.0, true), "floor", 0.5, 0.0)]);
    let lights = vec![light(LightShape::Sky { model: SkyModel::Overcast, up: DVec3::Z })];
    let got = cast(&stage, &Appearance { lights, ..Appearance::default() }, [12, 12], &few());
    let mut sum = (0.0, 0.0);
    for pixel in 8 * 12..12 * 12 {
        sum = (sum.0 + got.mean[3 * pixel], sum.1 + got.std_err[3 * pixel].powi(2));
    }
    let (mean, error) = (sum.0 / 48.0, sum.1.sqrt() / 48.0);
    assert!((mean - 0.5 * 7.0 / 9.0).abs() < 5.0 * error && error < 0.005, "{mean} +- {error}");
}

fn middle(got: &RayPicture) -> f64 {
    got.mean[3 * (got.size[0] as usize * (got.size[1] as usize / 2) + got.size[0] as usize / 2)]
}

/// A narrow look straight ahead: 1 x 1 pixel.
fn straight(stage: &Stage, appearance: &Appearance) -> f64 {
    let narrow = crate::view::Camera { fov: 0.01, ..camera([1, 1]) };
    let got = cast_picture(&tracer(stage), appearance, &narrow, &few(), stream()).expect("a picture");
    middle(&got)
}

#[test]
fn fog_panes_and_mirrors_add_up() {
    let fog = |l: f64, d: f64| l * (-0.05 * d).exp() + 0.8 * (1.0 - (-0.05 * d).exp());
    // A pane 2 m before a wall that shines with 3: straight on, the fog runs from the eye to the wall.
    let pane = stage(&[
        (wall(4.0, [-9.0, 9.0], [-9.0, 9.0]), "pane", 0.0, 0.5),
        (wall(6.0, [-9.0, 9.0], [-9.0, 9.0]), "wall", 0.0, 3.0 * PI),
    ]);
    let mut appearance = Appearance {
        fog: Some(Fog { extinction: 0.05, radiance: vec![0.8; 3], background_at: None }),
        finishes: vec![Finish { material: "pane".into(), transparency: 0.6, refraction: 1.0, ..Finish::default() }],
        ..Appearance::default()
    };
    let exact = 0.4 * fog(0.5 / PI, 4.0) + 0.6 * fog(3.0, 6.0);
    let got = straight(&pane, &appearance);
    assert!((got - exact).abs() < 1e-6, "{got} {exact}");
    // The same as a mirror: 4 m to it and 7 m back to a wall behind the eye.
    let mut behind = wall(-3.0, [-9.0, 9.0], [-9.0, 9.0]);
    behind.reverse();
    let room = stage(&[(wall(4.0, [-9.0, 9.0], [-9.0, 9.0]), "pane", 0.0, 0.5), (behind, "wall", 0.0, 3.0 * PI)]);
    appearance.finishes[0] = Finish { material: "pane".into(), reflection: 0.25, refraction: 1.0, ..Finish::default() };
    let exact = fog(0.75 * 0.5 / PI + 0.25 * fog(3.0, 7.0), 4.0);
    let got = straight(&room, &appearance);
    assert!((got - exact).abs() < 1e-6, "{got} {exact}");
    // The background stays out of the fog unless it has a distance.
    let nothing = stage(&[(flat([0.0, 1.0], [0.0, 1.0], -9.0, true), "x", 0.0, 0.0)]);
    appearance.background.radiance = vec![2.0; 3];
    assert!((straight(&nothing, &appearance) - 2.0).abs() < 1e-12);
    appearance.fog.as_mut().expect("fog").background_at = Some(10.0);
    assert!((straight(&nothing, &appearance) - fog(2.0, 10.0)).abs() < 1e-12);
}

#[test]
fn a_slab_of_glass_displaces_what_is_behind_it() {
    // 1 m of index 1.5 under 45 degrees: the ray goes on parallel, tan 45 - tan(asin(sin 45 / 1.5)) m to the side.
    let shift = 1.0 - (0.5f64.sqrt() / 1.5).asin().tan();
    let mut back = wall(3.0, [-9.0, 9.0], [-9.0, 9.0]);
    back.reverse();
    let look = |edge: f64, refraction: f64| {
        let stage = stage(&[
            (wall(2.0, [-9.0, 9.0], [-9.0, 9.0]), "glass", 0.0, 0.0),
            (back.clone(), "glass", 0.0, 0.0),
            (wall(5.0, [-9.0, edge], [-9.0, 9.0]), "left", 0.0, PI),
            (wall(5.0, [edge, 9.0], [-9.0, 9.0]), "right", 0.0, 2.0 * PI),
        ]);
        let glass = |name: &str| Finish { material: name.into(), transparency: 1.0, refraction, ..Finish::default() };
        let appearance = Appearance { finishes: vec![glass("glass")], ..Appearance::default() };
        let camera = crate::view::Camera { fov: 0.001, target: DVec3::new(1.0, 1.0, 0.0), ..camera([1, 1]) };
        let got = cast_picture(&tracer(&stage), &appearance, &camera, &few(), stream()).expect("a picture");
        got.mean[0]
    };
    // Straight on the ray would arrive at x = 5.
    for (edge, side) in [(5.0 - shift - 0.01, 2.0), (5.0 - shift + 0.01, 1.0)] {
        assert!((look(edge, 1.5) - side).abs() < 1e-9);
        assert!((look(edge, 1.0) - 2.0).abs() < 1e-9);
    }
}

#[test]
fn trees_hide_shine_and_cast_shadows() {
    let opacity = 204.0 / 255.0;
    let tree = |y: f64| Tree {
        name: "t".into(),
        object: "o".into(),
        foot: DVec3::new(0.0, y, -1.0),
        up: DVec3::Z,
        size: [2.0, 2.0],
        picture: 0,
    };
    let stage = stage(&[(wall(6.0, [-9.0, 9.0], [-9.0, 9.0]), "wall", 0.5, 0.0)]);
    let sun = LightShape::Parallel { direction: DVec3::new(0.0, 0.8, -0.6) };
    let mut appearance = Appearance {
        lights: vec![light(sun)],
        trees: vec![tree(4.0)],
        pictures: vec![picture([9, 9], |_, _| [255, 255, 255, 204])],
        ..Appearance::default()
    };
    // The tree faces the light whatever its polygon: E = 1; the wall behind has cos = 0.8, past no tree: the light
    // passes 1.5 m above the point at the tree's distance.
    let exact = opacity / PI + (1.0 - opacity) * 0.5 * 0.8 / PI;
    let got = straight(&stage, &appearance);
    assert!((got - exact).abs() < 1e-6, "{got} {exact}");
    // One that stands in the way of that light, out of the eye's: its shadow falls through both others.
    appearance.trees = vec![Tree { foot: DVec3::new(0.0, 2.0, 2.0), ..tree(2.0) }];
    let got = straight(&stage, &appearance);
    let exact = (1.0 - opacity) * 0.5 * 0.8 / PI;
    assert!((got - exact).abs() < 1e-6, "{got} {exact}");
}

#[test]
fn textures_lie_right_side_up_from_the_left_and_bumps_tilt() {
    // Black below, white above on the left; red, blue on the right.
    let four = picture([2, 2], |x, y| match (x, y) {
        (0, 0) => [255, 255, 255, 255],
        (0, _) => [0, 0, 0, 255],
        (_, 0) => [255, 0, 0, 255],
        _ => [0, 0, 255, 255],
    });
    let stage = stage(&[(wall(4.0, [-9.0, 9.0], [-9.0, 9.0]), "wall", 0.5, 0.0)]);
    let texture = |origin: DVec3| Some(Texture { picture: 0, origin, tile: [4.0, 4.0] });
    let mut appearance = Appearance {
        lights: vec![light(LightShape::Parallel { direction: DVec3::Y })],
        pictures: vec![four],
        finishes: vec![Finish { material: "wall".into(), refraction: 1.0, ..Finish::default() }],
        ..Appearance::default()
    };
    let narrow = crate::view::Camera { fov: 1e-4, ..camera([1, 1]) };
    for (x, z, rgb) in
        [(1.0, 3.0, [1., 1., 1.]), (1.0, 1.0, [0.; 3]), (3.0, 3.0, [1., 0., 0.]), (3.0, 1.0, [0., 0., 1.])]
    {
        appearance.finishes[0].colour = texture(DVec3::new(-x, 0.0, -z));
        let got = cast_picture(&tracer(&stage), &appearance, &narrow, &few(), stream()).expect("a picture");
        for b in 0..3 {
            assert!((got.mean[b] - 0.5 / PI * rgb[b]).abs() < 1e-4, "{x} {z}: {:?}", got.mean);
        }
    }
    // Between black at s = 1/4 and blue at 3/4 (luminance 0.0722) height climbs 0.0722 h in 2 m to the right.
    appearance.finishes[0].colour = None;
    appearance.finishes[0].bump = texture(DVec3::new(-2.0, 0.0, -1.0));
    appearance.finishes[0].bump_height = 30.0;
    let slope: f64 = 0.0722 * 30.0 / 2.0;
    let exact = 0.5 / PI / (1.0 + slope * slope).sqrt();
    let got = straight(&stage, &appearance);
    assert!((got - exact).abs() < 1e-3 * exact, "{got} {exact}");
}

#[test]
fn backgrounds_are_stretched_and_clouds_lie_on_their_plane() {
    let stage = stage(&[(flat([0.0, 1.0], [0.0, 1.0], -9.0, true), "x", 0.0, 0.0)]);
    let halves = picture([2, 1], |x, _| if x == 0 { [255; 4] } else { [0, 0, 0, 255] });
    // Half a tile of solid white, half of nothing.
    let stripes = picture([64, 1], |x, _| if x < 32 { [255; 4] } else { [255, 255, 255, 0] });
    let mut appearance = Appearance { pictures: vec![halves, stripes], ..Appearance::default() };
    appearance.background = Background { radiance: vec![3.0; 3], picture: Some(0), ..Background::default() };
    let got = cast(&stage, &appearance, [8, 8], &few());
    assert!((got.mean[0] - 3.0).abs() < 1e-12 && got.mean[3 * 7].abs() < 1e-12, "{:?}", &got.mean[..24]);
    let clouds = Clouds { picture: 1, height: 100.0, tile: [40.0, 10.0], radiance: vec![5.0; 3] };
    appearance.background = Background { radiance: vec![1.0; 3], clouds: Some(clouds), ..Background::default() };
    let narrow = |x: f64| crate::view::Camera { fov: 1e-4, target: DVec3::new(x, 50.0, 100.0), ..camera([1, 1]) };
    for (x, l) in [(10.0, 5.0), (30.0, 1.0), (50.0, 5.0), (-30.0, 5.0)] {
        let got = cast_picture(&tracer(&stage), &appearance, &narrow(x), &few(), stream()).expect("a picture");
        assert!((got.mean[0] - l).abs() < 1e-9, "{x}: {}", got.mean[0]);
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let (stage, mut appearance) = town();
    let tracer = tracer(&stage);
    let cast = |a: &Appearance, o: &PictureOptions| cast_picture(&tracer, a, &camera([4, 4]), o, stream()).err();
    let scale = |s: [f64; 2]| PictureOptions { scale: s, ..few() };
    for bad in [[0.1, 1.0], [f64::NAN, 1.0], [1.0, -2.0], [1.0, f64::INFINITY]] {
        assert!(matches!(cast(&appearance, &scale(bad)), Some(PictureFault::Scale(_))));
    }
    let flat = [1.0; 4];
    let wrong = PictureOptions { flat: Some(&flat), ..few() };
    assert!(matches!(cast(&appearance, &wrong), Some(PictureFault::Length { .. })));
    appearance.trees[0].picture = 5;
    assert_eq!(cast(&appearance, &few()), Some(PictureFault::Missing(5)));
    appearance.trees[0].picture = 0;
    appearance.pictures[0] = Picture { rgba: vec![0; 7], ..appearance.pictures[0].clone() };
    assert!(matches!(cast(&appearance, &few()), Some(PictureFault::Bytes { .. })));
}
