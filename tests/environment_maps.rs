//! World projections and the light they hold, against closed forms and exact shadows.

use etalon::audit::envmap::{Lobe, Station, gather, gather_near, over, within_reach};
use etalon::estimate::PointSight;
use etalon::io::scene::builtin;
use etalon::math::DVec3;
use etalon::raycast::KernelKind;
use etalon::render::{Centre, WorldView};
use etalon::sampling::{Role, Stream};
use etalon::scene::{NO_FACET, Stage};
use etalon::study::Session;
use etalon::study::envmap::{EnvmapRequest, Light, envmap, object};
use etalon::world::{
    Cone, DiffuseMap, Harmonics, Layout, Pyramid, Shape, exact, exact_picture, irradiance_exact, resample,
};
use std::f64::consts::PI;

const WHOLE: [Layout; 3] = [Layout::Cube, Layout::LatLong, Layout::SineLatLong];

fn stage(name: &str) -> Stage {
    builtin(name).expect("built in").at(0).expect("a state")
}

fn session(stage: &Stage) -> Session<'_> {
    Session::open(stage, KernelKind::Builtin).expect("the built-in kernel")
}

/// Radiosities of one number a patch, all different: what they are does not matter to geometry.
fn uneven(stage: &Stage) -> Vec<f64> {
    (0..stage.patch_count())
        .map(|i| 1.0 + (i % 7) as f64 + if stage.emission(i)[0] > 0.0 { 20.0 } else { 0.0 })
        .collect()
}

fn directions(n: u64) -> Vec<DVec3> {
    let s = Stream::new(Role::Witness, 7);
    let one = |k: u64| {
        let (z, turn) = (1.0 - 2.0 * s.unit(2 * k), 2.0 * PI * s.unit(2 * k + 1));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    };
    (0..n).map(one).collect()
}

fn axes(at: DVec3) -> Centre {
    Centre::new(at, DVec3::new(0.2, 1.0, 0.1), DVec3::new(0.1, 0.0, 1.0))
}

/// The exact irradiance at a point: Lambert's formula of every patch, past exact shadows.
fn exact_irradiance(sight: &PointSight, facet: u32, point: DVec3, normal: DVec3, b: &[f64]) -> f64 {
    sight.row(facet, point, normal).iter().map(|s| s.seen * b[s.patch as usize]).sum()
}

#[test]
fn a_uniform_enclosure_is_uniform_in_every_layout_and_filter() {
    let stage = stage("furnace-l");
    let session = session(&stage);
    let centre = axes(DVec3::new(0.5, 0.5, 0.5));
    let b = vec![PI; stage.patch_count()];
    for layout in WHOLE.into_iter().chain([Layout::Fisheye { field: 180.0 }]) {
        let map = WorldView::cast(&session.tracer(), &centre, Shape { layout, size: 24 }, 3).radiances(&b, 1);
        let drawn = |k: usize| map.shape().middle(k).is_some();
        let texels = (0..map.shape().texels()).filter(|k| drawn(*k));
        assert!(texels.into_iter().all(|k| (map.texel(k)[0] - 1.0).abs() < 1e-6), "{layout:?}");
        if !WHOLE.contains(&layout) {
            continue;
        }
        let (pyramid, table, harmonics) =
            (Pyramid::new(map.clone()), DiffuseMap::new(&map, [40, 20]), Harmonics::new(&map));
        for (k, d) in directions(40).into_iter().enumerate() {
            let one = |x: f64, what: &str| assert!((x - 1.0).abs() < 1e-6, "{layout:?} {what} {d} {x}");
            let round = Cone::round(d, [0.001, 0.05, 0.6][k % 3]);
            let quad = Cone::Quad(round.quad());
            one(pyramid.ewa(&round)[0], "ewa");
            one(pyramid.box_filter(&quad)[0], "box");
            one(exact(&map, &round)[0], "exact ellipse");
            one(exact(&map, &quad)[0], "exact quadrilateral");
            one(irradiance_exact(&map, d)[0] / PI, "irradiance");
            one(table.lookup(d)[0] / PI, "table");
            one(harmonics.irradiance(d)[0] / PI, "harmonics");
        }
        for to in WHOLE {
            let other = resample(&map, Shape { layout: to, size: 20 });
            assert!(other.values().iter().all(|v| (v - 1.0).abs() < 1e-6), "{layout:?} to {to:?}");
        }
    }
}

/// Cosine map of the cube at a point of a room with a box in it against Lambert's formula past exact shadows: the error
/// falls with the size of texels, faster than their edge.
#[test]
fn light_of_the_map_comes_to_the_closed_form() {
    let full = stage("cornell-box-coarse");
    let (surfaces, middle, _) = object(&full, "tall-block").expect("there");
    let stage = full.without(&surfaces);
    let (session, sight, b) = (session(&stage), PointSight::new(&stage), uneven(&stage));
    let centre = axes(middle);
    let normals = directions(24);
    let truth: Vec<f64> = normals.iter().map(|n| exact_irradiance(&sight, NO_FACET, middle, *n, &b)).collect();
    let error = |size: u32| {
        let map = WorldView::cast(&session.tracer(), &centre, Shape { layout: Layout::Cube, size }, 4).radiances(&b, 1);
        let of = |(n, t): (&DVec3, &f64)| irradiance_exact(&map, centre.frame.to_local(*n))[0] / t - 1.0;
        (normals.iter().zip(&truth).map(|p| of(p).powi(2)).sum::<f64>() / normals.len() as f64).sqrt()
    };
    let errors: Vec<f64> = [8, 16, 32, 64, 128].map(error).to_vec();
    println!("irradiance by the cube's texels against exact shadows, edges of 8 to 128: {errors:?}");
    // From 8 to 128 the edge of a texel falls by 16; samples at random places of the edges of patches would give 16^1.5.
    assert!(errors[4] < errors[0] / 16.0 && errors[4] < 5e-4, "{errors:?}");
}

/// The judge's rays against exact shadows, at points of the object with and without it, and at the centre.
#[test]
fn rays_agree_with_exact_shadows() {
    let full = stage("cornell-box-coarse");
    let (surfaces, ..) = object(&full, "tall-block").expect("there");
    let bare = full.without(&surfaces);
    let b = uneven(&full);
    let stream = Stream::new(Role::Judge, 3);
    let points = over(&full, &surfaces, 40, stream);
    let luminances = vec![b.clone(); 16];
    let mut worst = 0.0f64;
    for (stage, facet_counts) in [(&full, true), (&bare, false)] {
        let (session, sight) = (session(stage), PointSight::new(stage));
        let facet = |f: u32| if facet_counts { f } else { NO_FACET };
        let stations: Vec<Station> = points
            .iter()
            .map(|p| Station { place: p.place, axis: p.normal, horizon: Some(p.normal), facet: facet(p.facet) })
            .collect();
        let found = gather(&session.tracer(), &stations, Lobe::Cosine, &luminances, stream, 256);
        let chi2: f64 = found
            .iter()
            .zip(&points)
            .map(|(replicates, p)| {
                let n = replicates.len() as f64;
                let mean = replicates.iter().sum::<f64>() / n;
                let se = (replicates.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt();
                let exact = exact_irradiance(&sight, facet(p.facet), p.place, p.normal, &b);
                worst = worst.max((mean - exact).abs() / se.max(1e-12));
                ((mean - exact) / se.max(1e-12)).powi(2)
            })
            .sum();
        // Student t of 15 degrees: squares have mean 15/13; 40 of them beyond 100 by chance in less than one of 10^5.
        assert!(chi2 < 100.0, "{chi2} with the object: {facet_counts}");
    }
    println!("worst of 80 points: {worst:.2} standard errors");
}

/// The hybrid with a long reach is the truth, ray by ray; with none it is the map.
#[test]
fn the_hybrid_goes_from_the_map_to_the_truth() {
    let full = stage("cornell-box-coarse");
    let (surfaces, ..) = object(&full, "tall-block").expect("there");
    let session = session(&full);
    let b = uneven(&full);
    let stream = Stream::new(Role::Judge, 3);
    let points = over(&full, &surfaces, 12, stream);
    let station = |p: &etalon::audit::envmap::Point| Station {
        place: p.place,
        axis: p.normal,
        horizon: Some(p.normal),
        facet: p.facet,
    };
    let stations: Vec<Station> = points.iter().map(station).collect();
    let luminances = vec![b; 2];
    let truth = gather(&session.tracer(), &stations, Lobe::Cosine, &luminances, stream, 256);
    let reaches = [0.0, f64::INFINITY];
    let both = gather_near(&session.tracer(), &stations, Lobe::Cosine, &reaches, &luminances, |_| 5.0, stream, 256);
    for (t, h) in truth.iter().zip(&both) {
        assert!(h[0].iter().all(|x| (x - 5.0).abs() < 1e-12), "{h:?}");
        assert!(t.iter().zip(&h[1]).all(|(t, h)| (t - h).abs() < 1e-9 * t), "{t:?} {h:?}");
    }
}

/// A camera that only turns sees in a cube what it sees by rays: the difference is that of texels, and falls with them.
#[test]
fn a_camera_that_turns_sees_the_cube() {
    let stage = stage("cornell-box-coarse");
    let session = session(&stage);
    let b = uneven(&stage);
    let centre = axes(DVec3::new(0.28, 0.28, 0.2));
    let (w, h) = (64, 48);
    let half = (0.5 * 45f64.to_radians()).tan();
    let turned = DVec3::new(0.4, -0.7, 0.3).normalize();
    let (x_axis, y_axis) = {
        let right = turned.cross(DVec3::Z).normalize();
        (right, right.cross(turned))
    };
    let direction = |x: f64, y: f64| {
        let (u, v) = ((2.0 * x / f64::from(w) - 1.0) * half * 4.0 / 3.0, (1.0 - 2.0 * y / f64::from(h)) * half);
        (turned + x_axis * u + y_axis * v).normalize()
    };
    // By rays: 8 x 8 a pixel.
    let mut rays = etalon::raycast::RayBatch::zeroed((w * h * 64) as usize);
    rays.from = NO_FACET;
    for k in 0..w * h * 64 {
        let (p, s) = (k / 64, k % 64);
        let at = |whole: u32, part: u32| f64::from(whole) + (f64::from(part) + 0.5) / 8.0;
        let d = centre.frame.to_world(direction(at(p % w, s % 8), at(p / w, s / 8)));
        rays.set(k as usize, centre.point, d);
    }
    let seen = session.tracer().look(&rays);
    let value =
        |hit: &Option<(u32, DVec3, u32)>| hit.map_or(0.0, |(_, _, l)| b.get(l as usize).map_or(0.0, |b| b / PI));
    let direct: Vec<f64> = seen.chunks(64).map(|s| s.iter().map(value).sum::<f64>() / 64.0).collect();
    let error = |size: u32| {
        let map = WorldView::cast(&session.tracer(), &centre, Shape { layout: Layout::Cube, size }, 4).radiances(&b, 1);
        let drawn = exact_picture(&map, [w as usize, h as usize], |x, y| Some(direction(x, y)));
        let (d, t) =
            drawn.iter().zip(&direct).fold((0.0, 0.0), |(d, t), (a, b)| (d + (f64::from(*a) - b).powi(2), t + b * b));
        (d / t).sqrt()
    };
    let errors = [64, 128, 256].map(error);
    println!("a perspective from cubes of 64, 128, 256 against rays: {errors:?}");
    assert!(errors[2] < 0.5 * errors[0] && errors[2] < 0.02, "{errors:?}");
}

fn request(scene: &str, object: &str, stage: &Stage) -> EnvmapRequest {
    let camera = stage.cameras.first().cloned().expect("a camera");
    EnvmapRequest {
        scene: scene.into(),
        object: object.into(),
        centres: Vec::new(),
        axes: Centre::new(camera.eye, camera.target - camera.eye, camera.up),
        camera: etalon::view::Camera { size: [32, 24], ..camera },
        shading: [0.5, 0.5],
        size: 32,
        samples: 3,
        table: [40, 20],
        points: 64,
        directions: 20,
        rays: 2048,
        seed: 1,
        stated: 0.05,
        limit: Some(0.05),
        confidence: 0.95,
    }
}

/// Where everything shines alike nothing is wrong; elsewhere the parts of each point add up to the whole, and rays of
/// another seed find the same error within their intervals.
#[test]
fn the_audit_is_right_where_the_answer_is_known() {
    let stage = stage("cornell-box-coarse");
    let request = request("cornell-box-coarse", "tall-block", &stage);
    // The box is open to the front: what shines alike is not all around. Between patches all is alike.
    let light = Light::exact(1, uneven(&stage), "made up".into());
    let one_band =
        Stage { photometry: etalon::view::Photometry { bands: vec!["y".into()], weights: vec![1.0] }, ..stage.clone() };
    let run = |seed: u64| {
        let request = EnvmapRequest { seed, ..request.clone() };
        envmap(&one_band, KernelKind::Builtin, &request, &light, &|_| ()).expect("an audit").record
    };
    let (a, b) = (run(1), run(2));
    for p in &a.points {
        let parts = (p.map - p.at_centre) + (p.at_centre - p.without) + (p.without - p.truth);
        assert!((parts - (p.map - p.truth)).abs() < 1e-9);
    }
    assert!((a.irradiance.shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{:?}", a.irradiance.shares);
    let (x, y) = (a.irradiance.total.expect("light"), b.irradiance.total.expect("light"));
    println!("{}", a.findings.join("\n"));
    // Other points, other rays: their intervals, of what all places have, meet.
    assert!(x.low <= y.high && y.low <= x.high, "{x:?} {y:?}");
    assert!(x.low <= x.value && x.value <= x.high && x.value > 0.0);
    // In the open the error of a map at its own centre is its texels' alone, and grows from there.
    let curve: Vec<f64> = a.range.curve.iter().filter_map(|p| p.parts.total).map(|e| e.value).collect();
    assert!(curve.len() >= 6 && curve[0] < 0.05 && curve.last() > curve.first(), "{curve:?}");
    assert!(a.range.within.is_some_and(|w| w > 0.0));
}

/// Places in the open are seen from the centre, at the distance asked for.
#[test]
fn places_in_the_open_are_in_the_open() {
    let stage = stage("cornell-box-coarse");
    let session = session(&stage);
    let centre = DVec3::new(0.28, 0.28, 0.2);
    let places = within_reach(&session.tracer(), centre, 0.1, 64, Stream::new(Role::Judge, 0));
    assert!(places.len() > 20);
    assert!(places.iter().all(|(p, n)| (p.distance(centre) - 0.1).abs() < 1e-12 && (n.length() - 1.0).abs() < 1e-12));
    assert!(within_reach(&session.tracer(), centre, 100.0, 64, Stream::new(Role::Judge, 0)).len() < 64);
}
