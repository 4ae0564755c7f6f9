//! `etalon check --until-decided`: better references of the same scene until the verdict is sure.

use super::bench::Bench;
use super::{inputs, told};
use crate::cli::args::{CheckArgs, Kernel};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::estimate::{Estimator, Plan};
use crate::io::{Claim, StoredReference};
use crate::reference::Options;
use crate::solution::TruthLevel;
use crate::study::{self, Against, Judgement, Look, Question, Seen, confidence_of_look, judge};
use std::time::{Duration, Instant};

/// Time to decide in, unless said otherwise.
const PATIENCE: Duration = Duration::from_secs(600);

/// Judges by the stored reference and, while that leaves a limit open, by better ones. The last reference computed takes
/// the place of the stored one in `bench`, and the confidence of its look that in `question`.
pub fn until_decided(
    args: &CheckArgs,
    bench: &mut Bench,
    question: &mut Question,
    kernel: Kernel,
    console: &Console,
) -> Result<(Judgement, Vec<Look>), Failure> {
    if bench.reference().is_none() {
        return Err(Failure::input(
            "--until-decided computes better references, and --reference is a solution; name a reference directory",
        ));
    }
    let begin = Instant::now();
    let patience = args.max_time.map_or(PATIENCE, |t| t.0);
    let mut last_took = Duration::ZERO;
    let mut newest: Option<(StoredReference, f64)> = None;
    let asked = question.confidence;
    let decided = study::until_decided(asked, |k, confidence, factor| -> Result<Option<Seen>, Failure> {
        question.confidence = confidence;
        if k > 1 {
            let left = patience.saturating_sub(begin.elapsed());
            let old = bench.reference().expect("seen above");
            if left.is_zero() || last_took.mul_f64(0.5 * factor) > left {
                console.notice("no time is left for a better reference (--max-time)");
                return Ok(None);
            }
            console.notice(&format!("look {k}: a reference of about {factor} times the rays"));
            let since = Instant::now();
            let better = better(old, factor, k, left, kernel, console)?;
            last_took = since.elapsed();
            newest = Some((better.clone(), last_took.as_secs_f64()));
            bench.against = Against::Reference(Box::new(better));
        }
        let judgement = judge(&bench.solution, &bench.against, bench.before.as_ref(), &bench.receivers, question)?;
        let p = &bench.reference().expect("seen above").provenance;
        Ok(Some(Seen { judgement, rays_per_patch: p.rays_per_patch, relative_error: p.relative_error }))
    })?;
    let decided = decided.expect("the first look needs no time");
    // What follows speaks of the last look.
    question.confidence = confidence_of_look(asked, decided.looks.len() as u32);
    if let (Some(folder), Some((stored, seconds))) = (&args.save_reference, newest) {
        let claim = Claim::take(folder, super::reference::MARKER)?;
        claim.publish(&stored.files(seconds))?;
        console.notice(&format!("the last reference is kept in {}", folder.display()));
    }
    Ok((decided.judgement, decided.looks))
}

/// A reference of the same scene with more rays and a seed of its own, so that the looks share no noise of rays.
fn better(
    old: &StoredReference,
    factor: f64,
    look: u32,
    left: Duration,
    kernel: Kernel,
    console: &Console,
) -> Result<StoredReference, Failure> {
    let session = inputs::session(&old.stage, inputs::kernel_kind(kernel), console)?;
    let p = &old.provenance;
    let plan = Plan {
        rays: (p.rays_per_patch as f64 * factor).round() as u64,
        randomisations: p.randomisations,
        target_error: None,
        max_time: Some(left),
        estimator: if p.estimator == Estimator::Auto.name() { Estimator::Auto } else { Estimator::Rays },
    };
    let options = Options { plan, seed: p.seed.wrapping_add(u64::from(look)) };
    let mut stored = match p.truth {
        TruthLevel::PatchSystem => study::reference(&session, &options, console)?.0,
        TruthLevel::Continuous => study::continuous_reference(&session, &options, console)?.0,
    };
    console.end();
    stored.findings = old.findings.clone();
    let failed = stored.self_check.failures().next().map(|c| format!("{}: {}", c.name, c.finding));
    match failed {
        None => Ok(stored),
        Some(what) => Err(Failure {
            code: exit::SELF_CHECK,
            ..Failure::input(format!("the better reference failed its self-check of {what}"))
        }),
    }
}

/// The looks as the reader has to know them.
pub fn told(looks: &[Look]) -> Option<String> {
    if looks.len() < 2 {
        return None;
    }
    let of = |l: &Look| {
        format!(
            "{} rays (one-sigma error {:.1e}, at {} confidence): {}",
            inputs::thousands(l.rays_per_patch),
            l.relative_error,
            told::percent(l.confidence),
            told::verdict(l.verdict)
        )
    };
    let list: Vec<String> = looks.iter().map(of).collect();
    Some(format!("{} looks, each by a better reference: {}", looks.len(), list.join("; ")))
}
