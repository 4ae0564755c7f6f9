//! Every light of a scene at points in sight: what shading finds against rays to places of the lamp.

use super::edges::facets;
use super::record::LightRow;
use super::request::CompositingRequest;
use crate::audit::picture::{LightJudge, RANDOMISATIONS};
use crate::compositing::{Casters, Lamp, Projection, SpanImage, Volumes};
use crate::math::{Bounds, DVec3};
use crate::raycast::Tracer;
use crate::sampling::Stream;
use crate::scene::{Light, LightShape, Stage};
use crate::stats::two_sided_t;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::time::Instant;

/// Of 1000 audits in which all is well one has a point beyond what is allowed, or fewer.
const FALSE_ALARMS: f64 = 1e-3;
/// Share of the irradiance below which rounding is all there is.
const ROUNDING: f64 = 1e-6;
/// Rays that see nothing of a lamp may miss a part of it of this many times one in their number: e^-14 is one in a million.
const MISSED: f64 = 14.0;

/// A point in sight.
#[derive(Debug, Clone, Copy)]
struct Site {
    face: u32,
    facet: u32,
    point: DVec3,
    normal: DVec3,
}

/// All lights at `request.points` points of faces that `image` shows.
pub(super) fn lights(
    stage: &Stage,
    tracer: &Tracer,
    image: &SpanImage,
    lights: &[Light],
    request: &CompositingRequest,
    stream: Stream,
) -> Vec<LightRow> {
    let sites = sites(stage, image, request.points, stream.child(0));
    if sites.is_empty() {
        return Vec::new();
    }
    // The judge's stage hides behind every facet; so must the candidate here, glass included.
    let opaque = image.faces.iter().map(|f| if f.tree.is_some() { Vec::new() } else { f.vertices.clone() });
    let casters = Casters::new(opaque.collect());
    let judge = LightJudge::new(tracer);
    let row = |(k, light): (usize, &Light)| {
        of_light(light, image, &sites, &casters, &judge, request.rays, stream.child(1 + k as u64))
    };
    lights.iter().enumerate().map(row).collect()
}

/// Points of the picture drawn at random, on the sub-scanlines nearest to them.
fn sites(stage: &Stage, image: &SpanImage, count: usize, stream: Stream) -> Vec<Site> {
    let projection = Projection::of(&image.camera);
    let facets = facets(stage, image);
    let unit = |k: u64| stream.unit(k);
    let [width, _] = image.camera.size.map(f64::from);
    let at = |k: u64| -> Option<Site> {
        let x = width * unit(2 * k);
        let j = ((image.lines.len() as f64) * unit(2 * k + 1)) as usize;
        let span = image.lines[j].solid.iter().find(|s| s.from <= x && x < s.to)?;
        let face = &image.faces[span.face as usize];
        let y = j as f64 / f64::from(image.per_line);
        let point = projection.point(x, y, face.depth(&image.camera).value(x, y));
        let front = face.normal();
        let seen = front.dot(image.camera.eye - point) > 0.0;
        let facet = facets[span.face as usize];
        let normal = if seen { front } else { -front };
        ((seen || face.two_sided) && face.tree.is_none()).then_some(Site { face: span.face, facet, point, normal })
    };
    // Where most of the picture is background a hundred times as many are tried.
    (0..100 * count as u64).filter_map(at).take(count).collect()
}

fn of_light(
    light: &Light,
    image: &SpanImage,
    sites: &[Site],
    casters: &Casters,
    judge: &LightJudge,
    rays: u64,
    stream: Stream,
) -> LightRow {
    let lamp = Lamp::new(light);
    let faces: BTreeSet<u32> = sites.iter().map(|s| s.face).collect();
    let begin = Instant::now();
    let volumes: Vec<(u32, Volumes)> = faces
        .into_par_iter()
        .map(|f| (f, Volumes::new(&lamp, casters, &Bounds::of(&image.faces[f as usize].vertices))))
        .collect();
    let candidate = |s: &Site| {
        let own = volumes.binary_search_by_key(&s.face, |v| v.0).map(|k| &volumes[k].1);
        own.map_or(0.0, |v| lamp.seen(s.point, s.normal, s.face, v))
    };
    let found: Vec<f64> = sites.par_iter().map(candidate).collect();
    let point_seconds = begin.elapsed().as_secs_f64() / sites.len().max(1) as f64;
    let begin = Instant::now();
    let truth =
        |(k, s): (usize, &Site)| judge.irradiance(s.point, s.normal, s.facet, light, rays, stream.child(k as u64));
    let truths: Vec<(f64, f64)> = sites.par_iter().enumerate().map(truth).collect();
    let judge_point_seconds = begin.elapsed().as_secs_f64() / sites.len().max(1) as f64;
    let open: Vec<f64> = sites.iter().map(|s| lamp.open(s.point, s.normal)).collect();
    // Of a lamp with sharp shadows the judge is exact.
    let missed = if lamp.is_hard() { 0.0 } else { MISSED / rays as f64 };
    let row = Compared::of(&found, &truths, &open, missed);
    row.row(light, sites.len(), point_seconds, judge_point_seconds)
}

/// Sums over points.
#[derive(Default)]
struct Compared {
    lit: usize,
    penumbra: usize,
    dark: usize,
    squares: f64,
    noise: f64,
    truth: f64,
    with_error: usize,
    t_squared: f64,
    worst_t: f64,
    surely_off: usize,
}

impl Compared {
    fn of(found: &[f64], truths: &[(f64, f64)], open: &[f64], missed: f64) -> Self {
        let mut sums = Self::default();
        let brightest = truths.iter().map(|t| t.0).fold(0.0, f64::max);
        for ((found, (mean, std_err)), open) in found.iter().zip(truths).zip(open) {
            match () {
                _ if *found <= ROUNDING * brightest => sums.dark += 1,
                _ if *found >= open * (1.0 - ROUNDING) => sums.lit += 1,
                _ => sums.penumbra += 1,
            }
            let off = found - mean;
            sums.squares += off * off;
            sums.noise += std_err * std_err;
            sums.truth += mean * mean;
            if *std_err > ROUNDING * brightest {
                // A sliver of a lamp that rays may miss is in no standard error of theirs.
                let t = (off.abs() - missed * open).max(0.0) / std_err;
                sums.with_error += 1;
                sums.t_squared += t * t;
                sums.worst_t = sums.worst_t.max(t);
            } else if off.abs() > ROUNDING * brightest + missed * open {
                sums.surely_off += 1;
            }
        }
        sums
    }

    fn row(self, light: &Light, points: usize, point_seconds: f64, judge_point_seconds: f64) -> LightRow {
        let over = |x: f64| if self.truth > 0.0 { (x.max(0.0) / self.truth).sqrt() } else { 0.0 };
        let alarms = FALSE_ALARMS / self.with_error.max(1) as f64;
        let allowed_t = two_sided_t(1.0 - alarms, (RANDOMISATIONS - 1) as f64);
        LightRow {
            name: light.name.clone(),
            kind: kind(&light.shape).into(),
            points,
            lit: self.lit,
            penumbra: self.penumbra,
            dark: self.dark,
            error: over(self.squares - self.noise),
            noise: over(self.noise),
            with_error: self.with_error,
            mean_squared_t: (self.with_error > 0).then(|| self.t_squared / self.with_error as f64),
            worst_t: self.worst_t,
            allowed_t,
            surely_off: self.surely_off,
            within: self.surely_off == 0 && self.worst_t <= allowed_t,
            point_seconds,
            judge_point_seconds,
        }
    }
}

fn kind(shape: &LightShape) -> &'static str {
    match shape {
        LightShape::Parallel { .. } => "parallel",
        LightShape::Point { .. } => "point",
        LightShape::Linear { .. } => "linear",
        LightShape::Area { .. } => "area",
        LightShape::Polyhedron { .. } => "polyhedron",
        LightShape::Sky { .. } => "sky",
    }
}
