//! The audit as a whole.

use super::edges::{Edges, brightest, edges, rate};
use super::findings::findings;
use super::lights::lights;
use super::record::{ClusterRow, CompositeRow, CompositingRecord, PictureRow, Rms};
use super::request::{CompositingError, CompositingRequest};
use crate::audit::picture::{PictureOptions, RayPicture, cast_picture, compare};
use crate::compositing::{Pixels, ScanRequest, ShadeOptions, Shaded, SpanImage, composite, shade};
use crate::io::span_bytes;
use crate::metrics::Verdict;
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};
use crate::scene::{Appearance, Stage};
use std::time::Instant;

/// Sub-scanlines of the shaded picture, as in all of the paper's examples, where they are among those that are tried.
const USUAL: u32 = 3;

/// A finished audit, and what its pictures are drawn from.
pub struct Audited {
    /// Numbers and words.
    pub record: CompositingRecord,
    /// The shaded picture, radiance.
    pub shaded: Pixels,
    /// The same by rays.
    pub rays: RayPicture,
    /// One colour a face, by sub-scanlines.
    pub edges: Vec<(u32, Pixels)>,
    /// The same by rays.
    pub edges_by_rays: RayPicture,
    /// Everything in one.
    pub image: SpanImage,
}

/// Audits compositing on a scene: edges, lights, clusters, the whole picture.
pub fn compositing(
    stage: &Stage,
    appearance: &Appearance,
    tracer: &Tracer,
    request: &CompositingRequest,
    tell: &dyn Fn(&str),
) -> Result<Audited, CompositingError> {
    let stream = Stream::new(Role::Judge, request.seed);
    let Edges { rows, scaled, pictures, judge } = edges(stage, tracer, request, stream.child(0), tell)?;
    let usual = usual(&request.counts);
    let scan = |cluster| ScanRequest { stage, appearance, camera: &request.camera, per_line: usual, cluster };
    tell("the whole scene");
    let begin = Instant::now();
    let mut whole = scan(None).scan()?;
    let emitters = whole.emitters();
    let mut lit = appearance.clone();
    lit.lights.extend(emitters);
    whole.relight(lit.clone());
    let scan_seconds = begin.elapsed().as_secs_f64();
    tell("lights");
    let light_rows = lights(stage, tracer, &whole, &lit.lights, request, stream.child(1));
    tell("clusters");
    let (parts, clusters) = parts(&whole, &scan)?;
    tell("shading");
    let begin = Instant::now();
    let shaded = shade(&whole, &ShadeOptions::default())?;
    let seconds = scan_seconds + begin.elapsed().as_secs_f64();
    let composite = together(&whole, &parts, &lit, &shaded)?;
    tell("the picture by rays");
    let begin = Instant::now();
    let options = PictureOptions { samples: request.samples, ..PictureOptions::default() };
    let rays = cast_picture(tracer, &lit, &request.camera, &options, stream.child(2))?;
    let judge_seconds = begin.elapsed().as_secs_f64();
    let picture = picture(stage, usual, &lit, &shaded, &rays, seconds, judge_seconds, request.samples)?;
    let mut record = CompositingRecord {
        scene: request.scene.clone(),
        camera: request.camera.name.clone(),
        size: request.camera.size,
        faces: whole.faces.len(),
        kernel: tracer.kernel().name.clone(),
        samples: request.samples,
        seed: request.seed,
        rate: rate(&rows),
        verdict: None,
        edges: rows,
        scaled,
        lights: light_rows,
        clusters,
        composite,
        picture,
        findings: Vec::new(),
        limit: request.limit,
        judged_at: usual,
    };
    record.verdict = verdict(&record);
    record.findings = findings(&record, appearance, stage);
    Ok(Audited { record, shaded: shaded.radiance, rays, edges: pictures, edges_by_rays: judge, image: whole })
}

/// Three, or the nearest number below that is tried, or the least.
fn usual(counts: &[u32]) -> u32 {
    let below = counts.iter().filter(|c| **c <= USUAL).max();
    below.or(counts.iter().min()).copied().unwrap_or(USUAL)
}

/// On the edges; and what is wrong for sure fails whatever the limit: a light beyond the judge's errors (skies apart, whose
/// half planes are an approximation that is told), clusters that are not the whole.
fn verdict(record: &CompositingRecord) -> Option<Verdict> {
    let limit = record.limit?;
    let [low, high] = record.edges.iter().find(|r| r.sub_scanlines == record.judged_at)?.error.interval;
    let wrong = record.lights.iter().any(|l| l.kind != "sky" && !l.within)
        || record.composite.as_ref().is_some_and(|c| !c.same_segments);
    Some(match () {
        _ if low > limit || wrong => Verdict::Fail,
        _ if high <= limit => Verdict::Pass,
        _ => Verdict::Inconclusive,
    })
}

/// Every cluster scanned by itself.
fn parts<'a>(
    whole: &SpanImage,
    scan: &dyn Fn(Option<&'a [String]>) -> ScanRequest<'a>,
) -> Result<(Vec<SpanImage>, Vec<ClusterRow>), CompositingError> {
    let (mut images, mut rows) = (Vec::new(), Vec::new());
    for cluster in &whole.clusters {
        let begin = Instant::now();
        let image = ScanRequest { cluster: Some(&cluster.objects), ..scan(None) }.scan()?;
        let seconds = begin.elapsed().as_secs_f64();
        let mut seen = vec![false; image.faces.len()];
        image.lines.iter().flat_map(|l| l.solid.iter().chain(&l.over)).for_each(|s| seen[s.face as usize] = true);
        rows.push(ClusterRow {
            name: cluster.name.clone(),
            faces: image.faces.len(),
            visible_faces: seen.iter().filter(|s| **s).count(),
            segments: image.lines.iter().map(|l| l.solid.len() + l.over.len()).sum(),
            bytes: span_bytes(&image)?.len(),
            seconds,
        });
        images.push(image);
    }
    Ok((images, rows))
}

/// The parts in one, forwards and backwards, against the whole.
fn together(
    whole: &SpanImage,
    parts: &[SpanImage],
    lit: &Appearance,
    shaded: &Shaded,
) -> Result<Option<CompositeRow>, CompositingError> {
    let [first, .., last] = parts else { return Ok(None) };
    let begin = Instant::now();
    let forwards = parts[1..].iter().try_fold(first.clone(), |sum, p| composite(&sum, p))?;
    let seconds = begin.elapsed().as_secs_f64();
    let backwards = parts[..parts.len() - 1].iter().rev().try_fold(last.clone(), |sum, p| composite(&sum, p))?;
    let bytes = span_bytes(&forwards)?.len();
    let (mut same, mut worst) = (true, 0.0f64);
    let brightest = shaded.radiance.values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let joined = |image: &SpanImage| image.lines.iter().map(super::unlit).collect::<Vec<_>>();
    let reference = joined(whole);
    for mut image in [forwards, backwards] {
        image.relight(lit.clone());
        same &= image.faces == whole.faces && joined(&image) == reference;
        if image == *whole {
            // The same image is the same picture.
            continue;
        }
        let other = shade(&image, &ShadeOptions::default())?;
        let off = shaded.radiance.values.iter().zip(&other.radiance.values).map(|(a, b)| (a - b).abs());
        worst = off.fold(worst, f64::max);
    }
    let worst = worst / brightest;
    Ok(Some(CompositeRow { clusters: parts.len(), orders: 2, same_segments: same, worst, bytes, seconds }))
}

fn picture(
    stage: &Stage,
    usual: u32,
    lit: &Appearance,
    shaded: &Shaded,
    rays: &RayPicture,
    seconds: f64,
    judge_seconds: f64,
    samples: u64,
) -> Result<PictureRow, CompositingError> {
    let white = brightest(rays, stage);
    let of = &shaded.radiance;
    let error = compare(of.size, of.bands, &of.values, rays, &stage.photometry, white)?;
    let noise = (error.rms_with_noise.powi(2) - error.squared).max(0.0).sqrt();
    // Noise falls with the root of the samples, and time grows with them.
    let equal = (error.rms > 0.0).then(|| (noise / error.rms).powi(2));
    Ok(PictureRow {
        sub_scanlines: usual,
        lights: lit.lights.iter().map(|l| l.name.clone()).collect(),
        error: Rms { value: error.rms, interval: error.rms_interval },
        noise,
        bias: error.bias,
        off_by_a_step: error.surely_off,
        traced: shaded.traced,
        shadow_bytes: shaded.shadow_bytes,
        passes: shaded.passes,
        seconds,
        judge_seconds,
        judge_rays: rays.rays,
        equal_samples: equal.map(|e| e * samples as f64),
        equal_seconds: equal.map(|e| e * judge_seconds),
    })
}
