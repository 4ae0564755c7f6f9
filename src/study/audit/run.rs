//! The audit, from the truth to the cures.

use super::auditor::{Auditor, Context};
use super::findings;
use super::judging::Bench;
use super::record::{AuditRecord, Receiver, Wrong};
use super::request::{AuditError, AuditRequest, check, unsolved};
use super::sums::{matrix_error, rate, relative};
use crate::audit::{Effect, Split, fingerprint, first_bounce};
use crate::estimate::PairFactors;
use crate::methods::hemicube;
use crate::reference::{Progress, Reference};
use crate::study::{Session, reference};

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
