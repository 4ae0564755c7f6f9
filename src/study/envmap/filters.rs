//! Fast filters against the exact one: cube against latitude-longitude, the claim of Greene (1986), measured.

use super::bench::{Bench, Probe};
use super::record::{FilterRow, RoundTripRow};
use super::request::EnvmapRequest;
use crate::math::DVec3;
use crate::render::Centre;
use crate::sampling::{Role, Stream};
use crate::world::{Cone, Layout, Pyramid, Shape, exact, resample, round_trip};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::time::Instant;

/// Full opening angles across the shorter axis, degrees, and longer over shorter axes.
const CONES: [(f64, f64); 6] = [(1.0, 1.0), (1.0, 4.0), (4.0, 1.0), (4.0, 4.0), (16.0, 1.0), (16.0, 4.0)];
/// Exact look-ups that are timed.
const TIMED: usize = 10;
/// Cosine to the vertical from which a direction is near a pole: 30 degrees.
const NEAR: f64 = 0.866_025_403_784_438_6;

/// The cones of one row: in all directions, turned at random.
fn cones(width: f64, stretch: f64, request: &EnvmapRequest) -> Vec<Cone> {
    let stream = Stream::new(Role::Witness, request.seed);
    let cone = |k: u64| {
        let s = stream.child(k);
        let (z, turn) = (1.0 - 2.0 * s.unit(0), TAU * s.unit(1));
        let r = (1.0 - z * z).max(0.0).sqrt();
        let axis = DVec3::new(r * turn.cos(), r * turn.sin(), z).normalize();
        let (x, y) = axis.any_orthonormal_pair();
        let (sine, cosine) = (TAU * s.unit(2)).sin_cos();
        let reach = (0.5 * width.to_radians()).tan();
        Cone::Ellipse { axis, a: (x * cosine + y * sine) * (stretch * reach), b: (y * cosine - x * sine) * reach }
    };
    (0..request.directions).map(cone).collect()
}

/// Latitude-longitude map with about as many texels as a cube of this edge.
fn as_many(size: u32) -> u32 {
    (f64::from(size) * 3f64.sqrt()).round() as u32
}

pub(super) fn filters(bench: &Bench, probe: &Probe, size: u32) -> Vec<FilterRow> {
    let cube = bench.view(&probe.centre, Layout::Cube, size).radiances(&bench.mean, 1);
    let other = Shape { layout: Layout::LatLong, size: as_many(size) };
    let maps = [
        ("cube", Pyramid::new(cube.clone())),
        ("lat-long", Pyramid::new(bench.view(&probe.centre, other.layout, other.size).radiances(&bench.mean, 1))),
        ("lat-long from cube", Pyramid::new(resample(&cube, other))),
    ];
    let mut rows = Vec::new();
    for (width, stretch) in CONES {
        let cones = cones(width, stretch, bench.request);
        for (layout, map) in &maps {
            rows.extend(compare(layout, map, width, stretch, &cones));
        }
    }
    rows
}

fn compare(layout: &'static str, map: &Pyramid, width: f64, stretch: f64, cones: &[Cone]) -> Vec<FilterRow> {
    type Filter<'a> = &'a (dyn Fn(&Cone) -> f64 + Sync);
    // Look-ups are timed one after the other; the many slow ones are shared out.
    let timed = |f: Filter, some: usize| {
        let begin = Instant::now();
        let found: Vec<f64> = cones.iter().take(some).map(f).collect();
        (found, begin.elapsed().as_secs_f64() / some as f64)
    };
    // A box belongs to the quadrilateral cone, a Gaussian to the elliptical.
    let quad = |c: &Cone| Cone::Quad(c.quad());
    let pairs: [(&'static str, Filter, Filter); 2] = [
        ("box", &|c| map.box_filter(&quad(c))[0], &|c| exact(map.base(), &quad(c))[0]),
        ("ewa", &|c| map.ewa(c)[0], &|c| exact(map.base(), c)[0]),
    ];
    let near = |c: &&Cone| c.axis().is_some_and(|a| a.z.abs() > NEAR);
    let row = |(filter, fast, right): (&'static str, Filter, Filter)| {
        let ((fast, seconds), (_, exact_seconds)) = (timed(fast, cones.len()), timed(right, TIMED));
        let right: Vec<f64> = cones.par_iter().map(right).collect();
        let error = |of: &dyn Fn(usize) -> bool| {
            let (mut d, mut t) = (0.0, 0.0);
            for k in (0..cones.len()).filter(|k| of(*k)) {
                d += (fast[k] - right[k]).powi(2);
                t += right[k].powi(2);
            }
            (t > 0.0).then(|| (d / t).sqrt())
        };
        let size = (right.iter().map(|x| x * x).sum::<f64>() / right.len().max(1) as f64).sqrt();
        let worst = fast.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        FilterRow {
            layout,
            filter,
            width,
            stretch,
            error: error(&|_| true).unwrap_or(0.0),
            near_poles: error(&|k| near(&&cones[k])),
            worst: if size > 0.0 { worst / size } else { 0.0 },
            seconds,
            exact_seconds,
        }
    };
    pairs.into_iter().map(row).collect()
}

/// A cube turned into the other layouts and back, at several sizes.
pub(super) fn round_trips(bench: &Bench, centre: &Centre, largest: u32) -> Vec<RoundTripRow> {
    let mut rows = Vec::new();
    for size in [16, 32, 64, 128].into_iter().filter(|s| *s <= largest) {
        let map = bench.view(centre, Layout::Cube, size).radiances(&bench.mean, 1);
        for (name, layout) in [("lat-long", Layout::LatLong), ("sine-lat-long", Layout::SineLatLong)] {
            let found = round_trip(&map, Shape { layout, size: as_many(size) });
            rows.push(RoundTripRow { size, layout: name, rms: found.relative, energy: found.mean_change });
        }
    }
    rows
}
