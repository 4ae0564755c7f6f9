//! `etalon form-factors`

use super::{form_factors_told as told, inputs};
use crate::cli::args::FormFactorsArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::estimate::{Blend, Casting, Estimator, HitCounts, PairFactors, Plan, cast, patch_emitters, settle};
use crate::formfactor::{Surroundings, enforce};
use crate::io::{MatrixLayout, write_matrix};
use crate::raycast::KernelKind;
use crate::reference::{Progress, check_pairs, test_reciprocity};
use crate::sampling::{Role, Stream};
use crate::solution::{FormFactors, SelfCheck};
use crate::study::Session;
use serde_json::{Value, json};
use std::time::Instant;

pub fn run(args: &FormFactorsArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let layout = MatrixLayout::of(&args.output, args.format.as_ref())?;
    let error_layout = args.std_err.as_deref().map(|path| layout.of_errors(path)).transpose()?;
    inputs::check_writable(&args.output)?;
    args.std_err.as_deref().map(inputs::check_writable).transpose()?;
    let plan = inputs::plan(&args.rays)?;
    let stage = inputs::stage(&args.scene, console)?;
    crate::reference::check_size(&stage, &plan)?;
    let session = inputs::session(&stage, kernel, console)?;
    let work = Work::of(&session, &plan, args.rays.seed, console);
    let raw = work.blend().form_factors();
    let checks = work.checks(&session, &raw);
    let enforced = args.enforce.then(|| enforce(&raw, &Surroundings::of(&stage, session.is_enclosure())));
    let f = enforced.as_ref().map_or(&raw, |e| &e.form_factors);
    inputs::write(&args.output, &write_matrix(&args.output, &stage, f, &layout, false)?)?;
    if let (Some(path), Some(layout)) = (&args.std_err, &error_layout) {
        inputs::write(path, &write_matrix(path, &stage, f, layout, true)?)?;
    }
    if plan.target_error.is_some_and(|target| work.relative_error > target) {
        console.notice(&format!("the target error was not reached: {:.2e}", work.relative_error));
    }
    let mut json = summary(&session, &plan, &work, f, begin.elapsed().as_secs_f64());
    json["self_check"] = json!(checks.checks);
    json["passed_self_check"] = json!(checks.passed());
    let mut text = text(&session, &work, f, args);
    if let Some(e) = &enforced {
        json["enforcement"] = json!(e.info);
        text = format!("{text}\n{}", told::enforcement(&stage, &e.info).trim_end());
    }
    console.result(&text, &json);
    for c in checks.failures() {
        console.notice(&format!("the matrix failed its self-check of {}: {}", c.name, c.finding));
    }
    Ok(if checks.passed() { exit::DONE } else { exit::SELF_CHECK })
}

/// Rays per patch that count once more what was settled without them, where no pair is left to rays.
const WITNESS_RAYS: u64 = 256;

/// Pairs settled without rays, and the rays.
pub(super) struct Work {
    pairs: Option<PairFactors>,
    casting: Casting,
    /// Relative error of the whole matrix.
    pub(super) relative_error: f64,
}

impl Work {
    pub(super) fn of(session: &Session, plan: &Plan, seed: u64, console: &Console) -> Self {
        let stage = session.stage();
        let emitters = patch_emitters(stage);
        let present = emitters.iter().flatten().count() as u64;
        if plan.estimator == Estimator::Auto {
            console.begin("settling pairs", Some(present));
        }
        let pairs = settle(stage, plan, &|patches| console.advance(patches));
        let plan = match &pairs {
            Some(p) if p.tally.left == 0 => {
                Plan { rays: plan.rays.min(WITNESS_RAYS), target_error: None, max_time: None, ..*plan }
            }
            _ => *plan,
        };
        let rays = plan.rays_per_randomisation() * u64::from(plan.randomisations) * present;
        console.begin("casting rays", plan.target_error.is_none().then_some(rays));
        let stream = Stream::new(Role::Judge, seed);
        let error = |counts: &HitCounts| blend(pairs.as_ref(), counts).relative_error();
        let casting = cast(&session.tracer(), &emitters, stream, &plan, &error, &|rays| console.advance(rays));
        console.end();
        Self { relative_error: casting.reached.relative_error, pairs, casting }
    }

    /// What was settled without rays, counted by rays and summed up.
    pub(super) fn checks(&self, session: &Session, f: &FormFactors) -> SelfCheck {
        let of = |p| check_pairs(session.stage(), p, &self.casting.counts, f, session.is_enclosure());
        SelfCheck { checks: self.pairs.as_ref().map_or(Vec::new(), of) }
    }

    pub(super) fn blend(&self) -> Blend<'_> {
        blend(self.pairs.as_ref(), &self.casting.counts)
    }

    /// Relative error after each wave, of exact points or of rays: what the errors of the result came from last.
    fn waves(&self) -> &[(u64, f64)] {
        match &self.pairs {
            Some(p) if p.tally.left == 0 => &p.waves,
            _ => &self.casting.waves,
        }
    }
}

fn blend<'a>(pairs: Option<&'a PairFactors>, counts: &'a HitCounts) -> Blend<'a> {
    pairs.map_or_else(|| Blend::of_rays(counts), |p| Blend::new(p, counts))
}

/// Smallest, largest and mean row sum of the patches present.
fn row_sums(session: &Session, f: &FormFactors) -> [f64; 3] {
    let present = (0..f.n).filter(|i| session.stage().patches[*i].is_present());
    let sums: Vec<f64> = present.map(|i| f.row_sum(i)).collect();
    let min = sums.iter().copied().fold(f64::INFINITY, f64::min);
    let max = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [min, max, sums.iter().sum::<f64>() / sums.len() as f64]
}

fn max_std_err(f: &FormFactors) -> f64 {
    f.std_err.iter().flatten().copied().fold(0.0, f64::max)
}

fn summary(session: &Session, plan: &Plan, work: &Work, f: &FormFactors, seconds: f64) -> Value {
    let [min, max, mean] = row_sums(session, f);
    let casting = &work.casting;
    let tally = casting.counts.tally;
    json!({
        "patches": f.n,
        "estimator": plan.estimator,
        "pairs": work.pairs.as_ref().map(|p| p.tally),
        "rays_per_patch": casting.reached.rays_per_patch,
        "randomisations": casting.counts.randomisations,
        "rays": tally.rays,
        "kernel": session.kernel().name,
        "kernel_version": session.kernel().version,
        "instruction_set": session.kernel().instruction_set,
        "seconds": seconds,
        "stored": f.stored(),
        "relative_error": work.relative_error,
        "missed_target": plan.target_error.is_some_and(|target| work.relative_error > target),
        "waves": work.waves(),
        "max_std_err": max_std_err(f),
        "row_sums": { "min": min, "max": max, "mean": mean },
        "reciprocity": test_reciprocity(session.stage(), &casting.counts),
        "enclosure": session.is_enclosure(),
        "escapes": tally.escapes,
        "back_hits": tally.back_hits,
    })
}

fn text(session: &Session, work: &Work, f: &FormFactors, args: &FormFactorsArgs) -> String {
    let [min, max, _] = row_sums(session, f);
    let casting = &work.casting;
    let pairs = work.pairs.as_ref().map_or(String::new(), |p| {
        let [visible, unseen, partial, left] =
            [p.tally.visible, p.tally.unseen, p.tally.partial, p.tally.left].map(inputs::thousands);
        format!(
            "pairs: {visible} visible (closed form), {unseen} proved unseen, {partial} perhaps hidden in part \
             (exact shadows), {left} left to rays\n"
        )
    });
    format!(
        "{} x {} form factors, {} stored, written to {}\n\
         {pairs}{} rays per patch in {} randomisations ({} kernel)\n\
         relative error {:.2e}, largest standard error {:.2e}\n\
         row sums {min:.9} to {max:.9} ({} scene)",
        f.n,
        f.n,
        inputs::thousands(f.stored() as u64),
        args.output.display(),
        inputs::thousands(casting.reached.rays_per_patch),
        casting.counts.randomisations,
        session.kernel().name,
        work.relative_error,
        max_std_err(f),
        if session.is_enclosure() { "closed" } else { "open" },
    )
}
