//! Antialiasing alone: one colour a face, by number of sub-scanlines and by scale.

use super::record::{EdgeRow, Rms};
use super::request::{CompositingError, CompositingRequest};
use crate::audit::picture::{PictureOptions, RayPicture, cast_picture, compare};
use crate::compositing::{Pixels, Scaling, ScanRequest, SpanImage, flat};
use crate::io::span_bytes;
use crate::raycast::Tracer;
use crate::sampling::Stream;
use crate::scene::{Appearance, Stage};
use std::collections::BTreeMap;
use std::time::Instant;

/// Radiance per facet and band, W/(m^2 sr): drawn at random between 0.2 and 1, so that every edge can be seen, and none
/// counts for the wattage of its lamp.
fn colours(stage: &Stage, stream: Stream) -> Vec<f64> {
    (0..(stage.facets.len() * stage.band_count()) as u64).map(|k| 0.2 + 0.8 * stream.unit(k)).collect()
}

/// Facet of every face of an image of the stage.
pub(super) fn facets(stage: &Stage, image: &SpanImage) -> Vec<u32> {
    let mut counts = vec![0; stage.surfaces.len()];
    let key = |(k, f): (u32, &crate::scene::Facet)| {
        let count = &mut counts[f.surface as usize];
        *count += 1;
        ((stage.surfaces[f.surface as usize].name.as_str(), *count - 1), k)
    };
    let by_key: BTreeMap<(&str, u32), u32> = (0..).zip(&stage.facets).map(key).collect();
    let none = crate::scene::NO_FACET;
    image.faces.iter().map(|f| by_key.get(&(f.key.0.as_str(), f.key.1)).copied().unwrap_or(none)).collect()
}

/// What the edges came to.
pub(super) struct Edges {
    pub(super) rows: Vec<EdgeRow>,
    pub(super) scaled: Vec<EdgeRow>,
    /// Pictures by sub-scanlines, and the judge's.
    pub(super) pictures: Vec<(u32, Pixels)>,
    pub(super) judge: RayPicture,
}

/// The stage without anything that pictures add, scanned with every number of sub-scanlines and drawn at every scale.
pub(super) fn edges(
    stage: &Stage,
    tracer: &Tracer,
    request: &CompositingRequest,
    stream: Stream,
    tell: &dyn Fn(&str),
) -> Result<Edges, CompositingError> {
    let bare = Appearance::default();
    let by_facet = colours(stage, stream.child(2));
    let options = |scale: f64| PictureOptions {
        scale: [scale; 2],
        samples: request.samples,
        flat: Some(&by_facet),
        ..PictureOptions::default()
    };
    tell("edges by rays");
    let judge = cast_picture(tracer, &bare, &request.camera, &options(1.0), stream.child(0))?;
    let bands = stage.band_count();
    let white = brightest(&judge, stage);
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    let mut scanned = Vec::new();
    for per_line in &request.counts {
        tell(&format!("edges with {per_line} sub-scanlines"));
        let scan =
            ScanRequest { stage, appearance: &bare, camera: &request.camera, per_line: *per_line, cluster: None };
        let begin = Instant::now();
        let image = scan.scan()?;
        let seconds = begin.elapsed().as_secs_f64();
        if image.lines.iter().all(|l| l.solid.is_empty()) {
            return Err(CompositingError::Nothing(request.camera.name.clone()));
        }
        let (row, picture) = drawn(stage, &image, 1.0, &by_facet, &judge, white, seconds)?;
        rows.push(row);
        pictures.push((*per_line, picture));
        scanned.push((image, seconds));
    }
    let mut scaled = Vec::new();
    for scale in request.scales.iter().filter(|s| **s != 1.0) {
        tell(&format!("edges at scale {scale}"));
        let rays = cast_picture(tracer, &bare, &request.camera, &options(*scale), stream.child(1))?;
        for (image, seconds) in scanned.iter().filter(|(i, _)| f64::from(i.per_line) >= *scale) {
            scaled.push(drawn(stage, image, *scale, &by_facet, &rays, white, *seconds)?.0);
        }
    }
    debug_assert!(pictures.iter().all(|(_, p)| p.bands == bands));
    Ok(Edges { rows, scaled, pictures, judge })
}

/// Luminance that a display would show as its white.
pub(super) fn brightest(judge: &RayPicture, stage: &Stage) -> f64 {
    let bands = judge.bands;
    judge.mean.chunks(bands).map(|l| stage.photometry.luminance(l)).fold(f64::MIN_POSITIVE, f64::max)
}

fn drawn(
    stage: &Stage,
    image: &SpanImage,
    scale: f64,
    by_facet: &[f64],
    judge: &RayPicture,
    white: f64,
    scan_seconds: f64,
) -> Result<(EdgeRow, Pixels), CompositingError> {
    let bands = stage.band_count();
    let of = |facet: &u32| by_facet[*facet as usize * bands..][..bands].to_vec();
    let colours: Vec<f64> = facets(stage, image).iter().flat_map(of).collect();
    let scaling = Scaling::new(image.per_line, image.camera.size, [scale; 2])?;
    let begin = Instant::now();
    let picture = flat(image, &scaling, bands, &colours);
    let draw_seconds = begin.elapsed().as_secs_f64();
    let error = compare(picture.size, bands, &picture.values, judge, &stage.photometry, white)?;
    let row = EdgeRow {
        sub_scanlines: image.per_line,
        scale,
        error: Rms { value: error.rms, interval: error.rms_interval },
        off_by_a_step: error.surely_off,
        segments: image.lines.iter().map(|l| l.solid.len() + l.over.len()).sum(),
        bytes: span_bytes(image)?.len(),
        scan_seconds,
        draw_seconds,
    };
    Ok((row, picture))
}

/// The power with which errors fall, by least squares over logarithms of those whose interval lies above zero.
pub(super) fn rate(rows: &[EdgeRow]) -> Option<f64> {
    let sure = rows.iter().filter(|r| r.error.interval[0] > 0.0);
    let points: Vec<(f64, f64)> = sure.map(|r| (f64::from(r.sub_scanlines).ln(), r.error.value.ln())).collect();
    if points.len() < 2 {
        return None;
    }
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(a, b), p| (a + (p.0 - mx) * (p.1 - my), b + (p.0 - mx).powi(2)));
    (xx > 0.0).then(|| -xy / xx)
}
