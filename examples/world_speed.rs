//! How fast worlds are cast, prefiltered and looked up: `cargo run --release --example world_speed [SCENE]`.
//!
//! The cube is also cast as bare rays through the same kernel, one through the middle of each texel, so that the ratio
//! holds on any machine.

use etalon::math::DVec3;
use etalon::raycast::{KernelKind, RayBatch};
use etalon::render::{Centre, WorldView};
use etalon::sampling::{Role, Stream};
use etalon::scene::NO_FACET;
use etalon::study::Session;
use etalon::world::{Cone, DiffuseMap, Layout, Pyramid, Shape, exact, resample};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::time::Instant;

fn timed<T>(f: impl FnOnce() -> T) -> (T, f64) {
    let begin = Instant::now();
    let found = f();
    (found, begin.elapsed().as_secs_f64())
}

/// Directions of nothing in particular.
fn directions(count: u64) -> Vec<DVec3> {
    let stream = Stream::new(Role::Witness, 1);
    let one = |k: u64| {
        let s = stream.child(k);
        let (z, turn) = (1.0 - 2.0 * s.unit(0), 2.0 * PI * s.unit(1));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    };
    (0..count).map(one).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "builtin:robot-room".into());
    let scene = match name.strip_prefix("builtin:") {
        Some(known) => etalon::io::scene::builtin(known).ok_or("no such built-in scene")?,
        None => etalon::open_scene(&name)?,
    };
    let stage = scene.at(0)?;
    let session = Session::open(&stage, KernelKind::Auto)?;
    let tracer = session.tracer();
    let (lo, hi) = stage.bounds();
    let centre = Centre::new(0.5 * (lo + hi), DVec3::Y, DVec3::Z);
    let bands = stage.band_count();
    let radiosities: Vec<f64> = (0..stage.patch_count() * bands).map(|k| 1.0 + (k % 13) as f64).collect();
    println!(
        "{}: {} patches, kernel {}, {} threads",
        stage.name,
        stage.patch_count(),
        session.kernel().name,
        rayon::current_num_threads()
    );
    let mut last = None;
    for size in [256, 512, 1024] {
        let shape = Shape { layout: Layout::Cube, size };
        let (view, cast) = timed(|| WorldView::cast(&tracer, &centre, shape, 4));
        let (map, shaded) = timed(|| view.radiances(&radiosities, bands));
        let rows = shape.panels() * shape.height();
        let ((), bare) = timed(|| {
            (0..rows).into_par_iter().for_each(|row| {
                let mut rays = RayBatch::zeroed(shape.width());
                rays.from = NO_FACET;
                for x in 0..shape.width() {
                    let d = shape.middle(row * shape.width() + x).unwrap_or(DVec3::Y);
                    rays.set(x, centre.point, centre.frame.to_world(d));
                }
                std::hint::black_box(tracer.look(&rays));
            });
        });
        let texels = shape.texels() as f64;
        println!(
            "cube {size}: {cast:.2} s ({:.2} M texels/s, {:.2} rays a texel, {:.2} M rays/s; bare rays {:.2} M/s), radiances {shaded:.2} s",
            texels / cast / 1e6,
            view.rays as f64 / texels,
            view.rays as f64 / cast / 1e6,
            texels / bare / 1e6
        );
        let (pyramid, made) = timed(|| Pyramid::new(map.clone()));
        let (_, convolved) = timed(|| DiffuseMap::new(&map, [40, 20]));
        println!("  pyramid {made:.3} s ({:.1} M texels/s), diffuse map 40 x 20 {convolved:.3} s", texels / made / 1e6);
        last = Some(pyramid);
    }
    let Some(pyramid) = last else { return Ok(()) };
    let table = DiffuseMap::new(pyramid.base(), [40, 20]);
    let all = directions(20_000);
    let (sum, seconds) = timed(|| all.iter().map(|d| table.lookup(*d)[0]).sum::<f64>());
    println!("diffuse look-up: {:.2} M/s on one thread ({sum:.0})", all.len() as f64 / seconds / 1e6);
    for degrees in [0.1, 1.0, 10.0f64] {
        let cones: Vec<Cone> = all.iter().map(|d| Cone::round(*d, 0.5 * degrees.to_radians())).collect();
        let rate = |f: &dyn Fn(&Cone) -> f64, count: usize| {
            let (sum, seconds) = timed(|| cones[..count].iter().map(f).sum::<f64>());
            std::hint::black_box(sum);
            count as f64 / seconds / 1e3
        };
        println!(
            "cones of {degrees} degrees, thousand look-ups a second on one thread: box {:.0}, ewa {:.0}, exact quadrilateral {:.2}, exact ellipse {:.2}",
            rate(&|c| pyramid.box_filter(c)[0], 20_000),
            rate(&|c| pyramid.ewa(c)[0], 20_000),
            rate(&|c| exact(pyramid.base(), &Cone::Quad(c.quad()))[0], 200),
            rate(&|c| exact(pyramid.base(), c)[0], 50)
        );
    }
    let base = pyramid.level(1);
    for to in [Shape { layout: Layout::LatLong, size: 512 }, Shape { layout: Layout::Cube, size: 256 }] {
        let (_, seconds) = timed(|| resample(base, to));
        println!("cube {} to {:?} {}: {seconds:.2} s", base.shape().size, to.layout, to.size);
    }
    Ok(())
}
