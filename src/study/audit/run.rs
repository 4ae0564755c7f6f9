//! The audit, from the truth to the cures.

use super::findings;
use super::judging::Bench;
use super::record::{At, AuditRecord, CureRun, Form, MatrixError, Receiver, SourceAudit, Wrong};
use crate::audit::{
    Cause, Cure, Effect, FirstBounce, POINTS, Source, Split, Truth, View, cured, fingerprint, first_bounce,
    from_shooters, resolution_by_pixels, seen, source_error, subdivision_distance, views,
};
use crate::estimate::PairFactors;
use crate::math::{DVec3, Frame};
use crate::methods::PatchVectors;
use crate::methods::hemicube::{self, HemicubeError, Params};
use crate::metrics::{Point, fit_rate};
use crate::reference::{Options, Progress, Reference, ReferenceError};
use crate::scene::Stage;
use crate::solution::FormFactors;
use crate::solver::SolverError;
use crate::stats::Estimate;
use crate::study::{JudgeError, Session, reference};
use std::time::Instant;

/// Sources that are looked at closely, at most.
const MOST_SOURCES: usize = 5;

/// And those alone that bring at least this share of the first one's error.
const LEAST_ERROR: f64 = 0.1;

/// A cure by resolution draws no more pixels than this.
const MOST_PIXELS: u64 = 4_000_000_000;

/// Parts of a divided patch along an edge, tried one after the other.
const CELLS: [u32; 2] = [2, 4];

/// What is asked.
#[derive(Debug, Clone)]
pub struct AuditRequest<'a> {
    /// Name of the scene.
    pub scene: String,
    /// The hemi-cube.
    pub params: Params,
    /// Further resolutions for the curve.
    pub resolutions: Vec<u32>,
    /// Angles between 0 and 90 degrees for the curve under rotation.
    pub rotations: u32,
    /// Surfaces or objects to be looked at; empty: those that bring the largest errors.
    pub sources: Vec<String>,
    /// Limit on eq. 7 of reflected light.
    pub limit: Option<f64>,
    /// Confidence of intervals.
    pub confidence: f64,
    /// Where the hemi-cubes stand.
    pub form: Form,
    /// Somebody else's form factors, with the name of their file.
    pub theirs: Option<(&'a FormFactors, String)>,
    /// Run the cures.
    pub cures: bool,
    /// Of the truth; its seed is also that of random turns.
    pub reference: Options,
}

/// Why there is no audit.
#[derive(Debug, thiserror::Error)]
pub enum AuditError {
    /// The judge.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The hemi-cube.
    #[error(transparent)]
    Hemicube(#[from] HemicubeError),
    /// A patch system.
    #[error("the patch system with {what} cannot be solved: {source}")]
    Solver {
        /// Which matrix.
        what: String,
        /// Why.
        source: SolverError,
    },
    /// A comparison.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// No such source.
    #[error("there is no surface and no object \"{name}\" in this scene{near}; `etalon scene patches` lists them")]
    NoSource {
        /// As given.
        name: String,
        /// Names that are near.
        near: String,
    },
    /// Lights that hemi-cubes do not see.
    #[error("the scene has {0} point lights, which hemi-cubes do not see; use an emitting surface, or leave them out")]
    PointLights(usize),
    /// Nothing to audit.
    #[error("nothing in this scene is lit: no surface emits, so that no error can matter; give a material an emission")]
    Dark,
    /// A matrix of another scene.
    #[error("the form factors have {got} rows where the scene has {expected} patches; give those of this scene")]
    ForeignMatrix {
        /// Rows.
        got: usize,
        /// Patches.
        expected: usize,
    },
}

/// The record, and what pictures are made of.
pub struct Audited {
    /// The record.
    pub record: AuditRecord,
    /// All pairs.
    pub split: Split,
    /// Radiosities.
    pub effect: Effect,
}

/// Runs an audit.
///
/// # Errors
/// [`AuditError`].
pub fn audit(session: &Session, request: &AuditRequest, progress: &dyn Progress) -> Result<Audited, AuditError> {
    let stage = session.stage();
    check(stage, request)?;
    let (stored, truth) = reference(session, &request.reference, progress)?;
    let self_check_failures = stored.self_check.failures().map(|c| format!("{}: {}", c.name, c.finding)).collect();
    let auditor = Auditor {
        stage,
        request,
        progress,
        bench: Bench::new(stage, stored, request.limit, request.confidence),
        truth: &truth,
        stands: stage.patches.iter().map(|p| hemicube::stand(p, &request.params)).collect(),
    };
    let own;
    let cube = match &request.theirs {
        Some((theirs, _)) => *theirs,
        None => {
            own = auditor.rows(&request.params)?;
            &own
        }
    };
    let found = request.theirs.as_ref().map(|(theirs, _)| fingerprint(stage, theirs));
    let at_stands = auditor.split(cube);
    let split = auditor.in_form(at_stands);
    let effect = Effect::of(stage, &split).map_err(|source| unsolved("the hemi-cube's form factors", source))?;
    let luminance = |v: &[f64], i: usize| {
        let bands = stage.band_count();
        stage.photometry.luminance(&v[i * bands..(i + 1) * bands])
    };
    let emission = stage.emissions();
    let reflected: Vec<f64> =
        (0..stage.patch_count()).map(|i| luminance(&effect.truth, i) - luminance(&emission, i)).collect();
    if reflected.iter().all(|y| *y == 0.0) {
        return Err(AuditError::Dark);
    }
    let first = first_bounce(stage, &split, &effect.cube, &reflected);
    let context = Context { split: &split, effect: &effect, first: &first, reflected: &reflected };
    let resolution = found.as_ref().and_then(|f| f.resolution).unwrap_or(request.params.resolution);
    let mut sources = auditor.sources(&context, resolution)?;
    let view_list = match sources.first() {
        Some(s) => auditor.views(&context, &s.source.patches, resolution),
        None => Vec::new(),
    };
    let (wrong, verdict) = auditor.bench.judge(&effect.cube)?;
    let mut without = [Wrong { rms: None, top1: None }; 3];
    for (k, values) in effect.without.iter().enumerate() {
        without[k] = auditor.bench.judge(values)?.0;
    }
    let resolutions = auditor.resolutions(&context)?;
    let rotations = auditor.rotations(&context)?;
    let mut cures = if request.cures { auditor.cures(&context, &sources)? } else { Vec::new() };
    cures.sort_by_key(|c| c.work);
    for (k, s) in sources.iter_mut().enumerate() {
        s.mended_by = request.limit.and_then(|limit| cures.iter().position(|c| c.by_source[k] <= limit));
    }
    let receivers = (0..stage.patch_count()).map(|i| Receiver {
        first: first.receivers[i],
        std_err: first.std_err[i],
        carried: [0, 1, 2].map(|k| luminance(&effect.parts[k], i)),
        reflected: reflected[i],
        row_sum: split.row(i).map(|(_, p)| p.cube).sum(),
    });
    let alone = [0, 1, 2].map(|k| relative(stage, &|i| luminance(&effect.parts[k], i), &reflected));
    let mut record = AuditRecord {
        scene: request.scene.clone(),
        patches: stage.patches.iter().filter(|p| p.is_present()).count(),
        method: request.params.to_string(),
        theirs: request.theirs.as_ref().map(|(_, name)| name.clone()),
        form: request.form,
        resolution,
        truth: told(&truth, session),
        confidence: request.confidence,
        limit: request.limit,
        verdict,
        wrong,
        without,
        alone,
        infinite: auditor.bench.judge(&effect.point)?.0,
        matrix: matrix_error(stage, &split),
        sources,
        ranking: first.sources.clone(),
        views: view_list,
        rate: rate(&resolutions, request.confidence),
        resolutions,
        rotations,
        cures,
        receivers: receivers.collect(),
        fingerprint: found,
        self_check_failures,
        findings: Vec::new(),
    };
    record.findings = findings::of(&record);
    Ok(Audited { record, split, effect })
}

fn check(stage: &Stage, request: &AuditRequest) -> Result<(), AuditError> {
    if !stage.lights.is_empty() {
        return Err(AuditError::PointLights(stage.lights.len()));
    }
    if stage.emissions().iter().all(|e| *e == 0.0) {
        return Err(AuditError::Dark);
    }
    if let Some((theirs, _)) = &request.theirs
        && theirs.n != stage.patch_count()
    {
        return Err(AuditError::ForeignMatrix { got: theirs.n, expected: stage.patch_count() });
    }
    request.params.validated()?;
    for name in &request.sources {
        if patches_named(stage, name).is_empty() {
            let known = stage.surfaces.iter().map(|s| s.name.as_str());
            let near = known.filter(|k| k.contains(name.as_str()) || name.contains(*k)).take(3);
            let near: Vec<&str> = near.collect();
            let near = if near.is_empty() { String::new() } else { format!(" (there is {})", near.join(", ")) };
            return Err(AuditError::NoSource { name: name.clone(), near });
        }
    }
    Ok(())
}

/// Patches present of a surface, or of all surfaces of an object.
fn patches_named(stage: &Stage, name: &str) -> Vec<u32> {
    let of = |i: &u32| {
        let p = &stage.patches[*i as usize];
        let s = &stage.surfaces[p.surface as usize];
        p.is_present() && (s.name == name || s.object == name)
    };
    (0..stage.patch_count() as u32).filter(of).collect()
}

fn unsolved(what: &str, source: SolverError) -> AuditError {
    AuditError::Solver { what: what.into(), source }
}

/// How the truth was come by, in words.
fn told(truth: &Reference, session: &Session) -> String {
    let rays = truth.counts.rays * u64::from(truth.counts.randomisations);
    let kernel = &session.kernel().name;
    match &truth.settled {
        Some(PairFactors { tally, .. }) if tally.left == 0 => format!(
            "all pairs without rays: {} closed forms, {} past exact shadows, {} unseen",
            tally.visible, tally.partial, tally.unseen
        ),
        Some(PairFactors { tally, .. }) => format!(
            "{} pairs without rays, {} left to {rays} rays per patch ({kernel})",
            tally.visible + tally.partial + tally.unseen,
            tally.left
        ),
        None => format!("{rays} rays per patch ({kernel})"),
    }
}

/// `sqrt(sum A y^2 / sum A Y^2)`.
fn relative(stage: &Stage, y: &dyn Fn(usize) -> f64, reflected: &[f64]) -> f64 {
    let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
        (0..stage.patch_count()).map(|i| stage.patches[i].area * of(i) * of(i)).sum()
    };
    (sum(y) / sum(&|i| reflected[i])).sqrt()
}

/// Errors of the matrix, rows weighted by area.
fn matrix_error(stage: &Stage, split: &Split) -> MatrixError {
    let mut sums = [0.0; 6];
    for i in 0..split.len() {
        let weight = stage.patches[i].area.powi(2);
        for (_, p) in split.row(i) {
            let parts = Cause::ALL.map(|c| p.part(c));
            for (sum, x) in sums.iter_mut().zip([p.mean, p.error(), parts[0], parts[1], parts[2], p.mean_error]) {
                *sum += weight * x * x;
            }
        }
    }
    let share = |k: usize| if sums[0] > 0.0 { (sums[k] / sums[0]).sqrt() } else { 0.0 };
    MatrixError { total: share(1), by_cause: [share(2), share(3), share(4)], noise: share(5) }
}

/// Exponent of aliasing against resolution.
fn rate(resolutions: &[At], confidence: f64) -> Option<Estimate> {
    let point = |at: &At| Point { x: at.x, error: Estimate::exact(at.aliasing), floor: None };
    fit_rate(&resolutions.iter().map(point).collect::<Vec<_>>(), confidence).map(|r| r.slope)
}

/// What everybody needs.
struct Auditor<'a> {
    stage: &'a Stage,
    request: &'a AuditRequest<'a>,
    progress: &'a dyn Progress,
    bench: Bench,
    truth: &'a Reference,
    stands: Vec<Option<(DVec3, Frame)>>,
}

/// What the hemi-cube came to.
struct Context<'a> {
    split: &'a Split,
    effect: &'a Effect,
    first: &'a FirstBounce,
    reflected: &'a [f64],
}

impl Auditor<'_> {
    fn rows(&self, params: &Params) -> Result<FormFactors, HemicubeError> {
        self.progress.begin("hemi-cubes", Some(self.stage.patch_count() as u64));
        let done = std::cell::Cell::new(0);
        let told = |rows: usize| self.progress.advance((rows - done.replace(rows)) as u64);
        hemicube::form_factors(self.stage, params, &told)
    }

    /// Every pair taken apart, as the hemi-cubes stand.
    fn split(&self, cube: &FormFactors) -> Split {
        self.progress.begin("taking pairs apart", Some(self.stage.patch_count() as u64));
        let counts = &self.truth.counts;
        let one_hit = 1.0 / (counts.rays as f64 * f64::from(counts.randomisations)).max(1.0);
        let settled = self.truth.settled.as_ref();
        let unseen_error = |i: usize, j: usize| match settled {
            Some(pairs) if !pairs.left.holds(i, j) => 0.0,
            _ => one_hit,
        };
        let truth = Truth { form_factors: &self.truth.form_factors, unseen_error: &unseen_error };
        Split::of(self.stage, &self.stands, cube, truth, &|rows| self.progress.advance(rows))
    }

    fn in_form(&self, split: Split) -> Split {
        match self.request.form {
            Form::Receiver => split,
            Form::Shooter => split.from_shooters(self.stage),
        }
    }

    /// Luminance that a unit of form factor to patch j brings to patch i.
    fn unit<'a>(&'a self, context: &'a Context) -> impl Fn(usize, usize) -> f64 + Sync + 'a {
        let vectors = PatchVectors::of(self.stage);
        let weights = &self.stage.photometry.weights;
        move |i, j| {
            let band = |b: usize| {
                weights[b] * vectors.reflectance[i * vectors.bands + b] * context.effect.cube[j * vectors.bands + b]
            };
            (0..vectors.bands).map(band).sum()
        }
    }

    fn views(&self, context: &Context, source: &[u32], resolution: u32) -> Vec<View> {
        let unit = self.unit(context);
        let at_source = self.request.form == Form::Shooter;
        views(self.stage, context.split, &self.stands, source, resolution, at_source, &unit)
    }

    /// The sources asked for, or those that bring the largest errors.
    fn sources(&self, context: &Context, resolution: u32) -> Result<Vec<SourceAudit>, AuditError> {
        let all = &context.first.sources;
        let chosen: Vec<Source> = if self.request.sources.is_empty() {
            let least = all.first().map_or(0.0, |s| LEAST_ERROR * s.error);
            all.iter().take(MOST_SOURCES).filter(|s| s.error >= least && s.error > 0.0).cloned().collect()
        } else {
            self.request.sources.iter().map(|name| self.source_named(context, name)).collect()
        };
        let limit = self.request.limit.unwrap_or(0.05);
        let of = |source: Source| {
            let views = self.views(context, &source.patches, resolution);
            SourceAudit {
                seen: seen(self.stage, &views),
                main_cause: source.main_cause(),
                resolution_by_pixels: resolution_by_pixels(&views, resolution, limit),
                mended_by: None,
                source,
            }
        };
        Ok(chosen.into_iter().map(of).collect())
    }

    /// A surface, or an object as one source.
    fn source_named(&self, context: &Context, name: &str) -> Source {
        if let Some(found) = context.first.sources.iter().find(|s| s.name == name) {
            return found.clone();
        }
        let patches = patches_named(self.stage, name);
        let error = |cause: Option<Cause>| {
            let part = |p: &crate::audit::Pair| cause.map_or(p.error(), |c| p.part(c));
            self.error_of(context, &patches, &context.split.matrix(part), true)
        };
        let parts: Vec<&Source> =
            context.first.sources.iter().filter(|s| s.patches.iter().any(|p| patches.contains(p))).collect();
        let area = |s: &Source| s.patches.iter().map(|j| self.stage.patches[*j as usize].area).sum::<f64>();
        let whole: f64 = parts.iter().map(|s| area(s)).sum();
        Source {
            name: name.into(),
            luminance: parts.iter().map(|s| s.luminance * area(s) / whole.max(f64::MIN_POSITIVE)).sum(),
            error: error(None),
            by_cause: Cause::ALL.map(|c| error(Some(c))),
            patches,
        }
    }

    /// First-bounce error that a matrix (or, `difference`, one that is a difference already) brings from some patches.
    fn error_of(&self, context: &Context, source: &[u32], f: &FormFactors, difference: bool) -> f64 {
        let unit = self.unit(context);
        let truth = (!difference).then_some(context.split);
        source_error(self.stage, f, truth, source, &unit, context.reflected)
    }

    /// The curve over resolutions; the one audited among them.
    fn resolutions(&self, context: &Context) -> Result<Vec<At>, AuditError> {
        let mut all = self.request.resolutions.clone();
        if self.request.theirs.is_none() {
            all.push(self.request.params.resolution);
        }
        all.sort_unstable();
        all.dedup();
        let of = |resolution: u32| {
            let params = Params { resolution, ..self.request.params }.validated()?;
            self.at(context, f64::from(resolution), &params)
        };
        all.into_iter().map(of).collect()
    }

    fn rotations(&self, context: &Context) -> Result<Vec<At>, AuditError> {
        let step = 90.0 / f64::from(self.request.rotations.max(1));
        let of = |k: u32| {
            let rotation = self.request.params.rotation + f64::from(k) * step;
            self.at(context, f64::from(k) * step, &Params { rotation, ..self.request.params })
        };
        (0..self.request.rotations).map(of).collect()
    }

    fn at(&self, context: &Context, x: f64, params: &Params) -> Result<At, AuditError> {
        let begin = Instant::now();
        let f = self.rows(params)?;
        let seconds = begin.elapsed().as_secs_f64();
        let aliasing = context.split.aliasing_of(self.stage, &self.matrix_in_form(&f));
        let wrong = self.judged(&f, &format!("the hemi-cube at {params}"))?.0;
        Ok(At { x, wrong, aliasing, seconds })
    }

    fn matrix_in_form<'f>(&self, f: &'f FormFactors) -> std::borrow::Cow<'f, FormFactors> {
        match self.request.form {
            Form::Receiver => std::borrow::Cow::Borrowed(f),
            Form::Shooter => std::borrow::Cow::Owned(from_shooters(self.stage, f)),
        }
    }

    /// A matrix of rows as the hemi-cubes stand, solved and judged.
    fn judged(&self, f: &FormFactors, what: &str) -> Result<(Wrong, Option<crate::metrics::Verdict>), AuditError> {
        let f = self.matrix_in_form(f);
        let solved = crate::audit::radiosity(self.stage, &f).map_err(|source| unsolved(what, source))?;
        Ok(self.bench.judge(&solved)?)
    }

    /// Runs the cures: what the sources call for, in turn.
    fn cures(&self, context: &Context, sources: &[SourceAudit]) -> Result<Vec<CureRun>, AuditError> {
        let mut patches: Vec<u32> = sources.iter().flat_map(|s| s.source.patches.iter().copied()).collect();
        patches.sort_unstable();
        patches.dedup();
        let run = |cure: Cure| self.cure(context, sources, &patches, cure);
        let mut runs = vec![run(Cure::None)?, run(Cure::Rotation)?, run(Cure::Jitter)?];
        let present = self.stage.patches.iter().filter(|p| p.is_present()).count() as u64;
        let enough = |wrong: &Wrong| match (self.request.limit, wrong.rms) {
            (Some(limit), Some(rms)) => rms.high <= limit,
            _ => false,
        };
        let infinite = self.bench.judge(&context.effect.point)?.0.rms.map_or(0.0, |e| e.low);
        // Where no resolution will do, two steps show it.
        let most_doublings = if self.request.limit.is_none_or(|limit| infinite > limit) { 2 } else { 5 };
        for doubling in 1..=5 {
            let resolution = self.request.params.resolution << doubling;
            if resolution > 4096 || present * 3 * u64::from(resolution).pow(2) > MOST_PIXELS {
                break;
            }
            runs.push(run(Cure::Resolution { resolution })?);
            if enough(&runs[runs.len() - 1].wrong) || doubling == most_doublings {
                break;
            }
        }
        let spatial: Vec<f64> = context.first.receivers.iter().map(|r| r[1] + r[2]).collect();
        let analytic = Cure::Analytic { points: POINTS };
        runs.push(run(analytic)?);
        if let Some(distance) = subdivision_distance(self.stage, &patches, &spatial) {
            for cells in CELLS {
                runs.push(run(Cure::Subdivision { cells, distance })?);
            }
            let best = Cure::SubdivisionAndAnalytic { cells: CELLS[0], distance, points: POINTS };
            runs.push(run(best)?);
        }
        Ok(runs)
    }

    fn cure(
        &self,
        context: &Context,
        sources: &[SourceAudit],
        patches: &[u32],
        cure: Cure,
    ) -> Result<CureRun, AuditError> {
        let words = cure.words();
        self.progress.begin(&words, Some(self.stage.patch_count() as u64));
        let done = std::cell::Cell::new(0);
        let told = |rows: usize| self.progress.advance((rows - done.replace(rows)) as u64);
        let begin = Instant::now();
        let made = cured(self.stage, &self.request.params, patches, &cure, self.request.reference.seed, &told)?;
        let seconds = begin.elapsed().as_secs_f64();
        let (wrong, verdict) = self.judged(&made.form_factors, &words)?;
        let f = self.matrix_in_form(&made.form_factors);
        let by_source = sources.iter().map(|s| self.error_of(context, &s.source.patches, &f, false)).collect();
        let (hemicubes, pixels, points, work) = (made.hemicubes, made.pixels, made.points, made.work());
        Ok(CureRun { words, cure, wrong, verdict, by_source, seconds, hemicubes, pixels, points, work })
    }
}
