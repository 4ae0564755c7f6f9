//! The audit, from the points to the findings.

use super::bench::{Bench, Probe};
use super::irradiance::Over;
use super::pictures::{Coloured, Picture, Shader};
use super::record::{EnvmapRecord, Parts, Speed};
use super::request::{EnvmapError, EnvmapRequest, Light};
use super::{filters, findings, range, reflection, sizes};
use crate::audit::envmap::over;
use crate::math::DVec3;
use crate::metrics::Verdict;
use crate::raycast::KernelKind;
use crate::render::Centre;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::study::Session;
use crate::world::{DiffuseMap, Layout, Pyramid};
use std::time::Instant;

/// Edge of the cubes that many centres are compared with.
const QUICK: u32 = 64;

/// Edge of the cube that tells how much room there is.
const NEAR: u32 = 32;
/// Pixels across the spheres.
const SPHERE: u32 = 96;

/// The record, and what it looks like.
pub struct Audited {
    /// What was found.
    pub record: EnvmapRecord,
    /// Spheres, then the object in its scene.
    pub pictures: Vec<Picture>,
}

/// Surfaces of the object, the middle of the box around what of them stands there, and half its diagonal, metres.
///
/// # Errors
/// [`EnvmapError::NoObject`], [`EnvmapError::Absent`].
pub fn object(stage: &Stage, name: &str) -> Result<(Vec<u32>, DVec3, f64), EnvmapError> {
    let surfaces = stage.surfaces_named(name);
    if surfaces.is_empty() {
        let mut known: Vec<&str> = stage.surfaces.iter().map(|s| s.object.as_str()).collect();
        known.sort_unstable();
        known.dedup();
        return Err(EnvmapError::NoObject { name: name.into(), known: known.join(", ") });
    }
    let corners = stage.facets.iter().filter(|f| surfaces.contains(&f.surface)).flat_map(|f| &f.vertices);
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
    if !(lo.is_finite() && hi.is_finite()) {
        return Err(EnvmapError::Absent { name: name.into() });
    }
    Ok((surfaces, 0.5 * (lo + hi), 0.5 * (hi - lo).length()))
}

/// Runs the audit.
///
/// # Errors
/// [`EnvmapError`].
pub fn envmap(
    stage: &Stage,
    kernel: KernelKind,
    request: &EnvmapRequest,
    light: &Light,
    tell: &dyn Fn(&str),
) -> Result<Audited, EnvmapError> {
    if !stage.lights.is_empty() {
        return Err(EnvmapError::PointLights);
    }
    let (surfaces, middle, radius) = object(stage, &request.object)?;
    let bare_stage = stage.without(&surfaces);
    let (full, bare) = (Session::open(stage, kernel)?, Session::open(&bare_stage, kernel)?);
    let radiosities = light.mean();
    let bands = light.radiosities.bands;
    // The question is about this light: map and rays see the same radiosities, whatever their own error is.
    let mean: Vec<f64> = radiosities.chunks(bands).map(|b| stage.photometry.luminance(b)).collect();
    let luminances = vec![mean.clone(); light.radiosities.count()];
    let stream = Stream::new(Role::Judge, request.seed);
    let bench = Bench { request, full: full.tracer(), bare: bare.tracer(), luminances, mean, stream };

    let places = if request.centres.is_empty() { vec![middle] } else { request.centres.clone() };
    let mut speed = Vec::new();
    let made = places.iter().map(|p| probe(&bench, request.axes.moved(*p), &radiosities, bands, &mut speed));
    let (probes, coloured): (Vec<Probe>, Vec<Coloured>) = made.unzip();
    let near = bench.view(&probes[0].centre, Layout::Cube, NEAR).distances;
    let free = f64::from(near.iter().copied().fold(f32::INFINITY, f32::min));
    if let Some(dark) = probes.iter().find(|p| p.pyramid.base().values().iter().all(|v| *v == 0.0)) {
        let [x, y, z] = dark.centre.point.to_array();
        return Err(EnvmapError::Dark { x, y, z });
    }
    let points = over(stage, &surfaces, request.points, stream.child(2));
    if points.is_empty() {
        return Err(EnvmapError::Covered { name: request.object.clone() });
    }
    tell("irradiance over the object");
    let object = Over::find(&bench, &probes, points.clone());
    // What is about one map is about the first.
    let alone = if probes.len() == 1 { None } else { Some(object.served(&bench, &probes[..1])) };
    let one = alone.as_ref().unwrap_or(&object);
    let irradiance = object.parts(&bench);
    tell("distance from the centre");
    let range = range::range(&bench, &probes[0]);
    tell("reflections");
    let reflection = reflection::reflection(&bench, &probes, &points);
    tell("filters, layouts, sizes");
    let mut record = EnvmapRecord {
        scene: request.scene.clone(),
        object: request.object.clone(),
        centres: places.iter().map(|p| p.to_array()).collect(),
        size: request.size,
        table: request.table,
        truth: light.source.clone(),
        rays: bench.rays() * bench.luminances.len() as u64,
        confidence: request.confidence,
        limit: request.limit,
        verdict: verdict(&irradiance, request.limit),
        irradiance,
        by_distance: object.by_distance(&bench, &probes),
        points: object.rows(&probes),
        range,
        reflection,
        filters: filters::filters(&bench, &probes[0], request.size),
        sizes: sizes::sizes(&bench, &probes[0], one),
        tables: sizes::tables(&bench, &probes[0], one),
        harmonics: sizes::harmonics(&bench, &probes[0], one),
        several: object.several(&bench, &probes[0], request.size.min(QUICK)),
        hybrid: object.hybrid(&bench, &probes, radius),
        round_trips: filters::round_trips(&bench, &probes[0].centre, request.size),
        speed,
        findings: Vec::new(),
    };
    record.findings = findings::findings(&record);
    tell("pictures");
    let [dc, sc] = request.shading;
    let mut shader =
        Shader { maps: &coloured, radiosities: &radiosities, bands, dc, sc, reach: radius, seed: request.seed };
    // A cube's own inner sphere, where the object is a cube and the room wide enough.
    let sphere = (radius / 3f64.sqrt()).min(0.9 * free);
    let mut pictures = shader.spheres(&bench.bare, request.camera.eye, sphere, SPHERE);
    pictures.extend(shader.in_scene(&bench.full, &request.camera, &surfaces));
    Ok(Audited { record, pictures })
}

/// A map of luminance and one of all bands, with how long its parts took.
fn probe(
    bench: &Bench,
    centre: Centre,
    radiosities: &[f64],
    bands: usize,
    speed: &mut Vec<Speed>,
) -> (Probe, Coloured) {
    let mut timed = |name: &'static str, begin: Instant, count: u64| {
        speed.push(Speed { name, count, seconds: begin.elapsed().as_secs_f64() });
    };
    let begin = Instant::now();
    let view = bench.view(&centre, Layout::Cube, bench.request.size);
    let map = view.radiances(&bench.mean, 1);
    let texels = map.shape().texels() as u64;
    timed("cube", begin, texels);
    let table_size = bench.request.table;
    let begin = Instant::now();
    let table = DiffuseMap::new(&map, table_size);
    timed("diffuse map", begin, u64::from(table_size[0]) * u64::from(table_size[1]));
    let begin = Instant::now();
    let pyramid = Pyramid::new(map);
    timed("pyramid", begin, texels);
    let colours = view.radiances(radiosities, bands);
    let in_colour = Coloured { centre, table: DiffuseMap::new(&colours, table_size), pyramid: Pyramid::new(colours) };
    (Probe { centre, pyramid, table }, in_colour)
}

fn verdict(parts: &Parts, limit: Option<f64>) -> Option<Verdict> {
    let limit = limit?;
    Some(match &parts.total {
        Some(e) if e.low > limit => Verdict::Fail,
        Some(e) if e.high <= limit => Verdict::Pass,
        _ => Verdict::Inconclusive,
    })
}
