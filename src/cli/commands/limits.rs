//! The limits of a check, as the options give them.

use super::bench::Bench;
use crate::cli::args::{CheckArgs, CompareArgs};
use crate::cli::exit::Failure;
use crate::metrics::{Limit, Limits, Metric};
use crate::study::Baseline;
use std::path::Path;

/// All limits given; at least one.
pub fn given(args: &CheckArgs) -> Result<Limits, Failure> {
    let more = &args.limits;
    let whole = [
        (Metric::Rms, args.max_rms),
        (Metric::Top1, args.max_top1),
        (Metric::Worst, more.max_worst),
        (Metric::Energy, more.max_energy),
        (Metric::Visible, more.max_visible),
    ];
    let mut all: Vec<Limit> = whole.into_iter().filter_map(|(m, max)| Some(Limit::new(m, max?.0))).collect();
    all.extend(more.named.iter().cloned());
    if more.baseline.is_some() {
        // Without a margin, whatever is not surely worse is kept: a close call is told by what would have been caught.
        let max = more.max_worse.map_or(0.0, |x| x.0);
        all.push(Limit { unless_sure: more.max_worse.is_none(), ..Limit::new(Metric::Worse, max) });
    }
    if all.is_empty() {
        return Err(Failure::input(
            "a check needs at least one limit: give --max-rms, --max-top1, --max-worst, --max-energy, --max-visible, --limit \
             or --baseline",
        ));
    }
    if let Some(twice) = (1..all.len()).find(|k| all[..*k].iter().any(|l| l.key() == all[*k].key())) {
        return Err(Failure::input(format!("the limit on {} is given twice; give it once", all[twice].key())));
    }
    if args.max_top1.is_some() && args.compare.before.is_none() {
        return Err(Failure::input(
            "--max-top1 needs --before: the reference (or solution) of the state before the change",
        ));
    }
    Ok(all.into_iter().collect())
}

/// The baseline, if it belongs to what is judged.
pub fn baseline(path: &Path, bench: &Bench, args: &CompareArgs) -> Result<Baseline, Failure> {
    let refused = |why: &str| {
        let message = format!("--baseline {}: {why}; save one for this reference", path.display());
        Failure::input(message).at(path.display().to_string())
    };
    let baseline = Baseline::read(path)?;
    let Some(reference) = bench.reference() else {
        return Err(refused("a baseline is held against a reference, and --reference is a solution"));
    };
    match baseline.misfit(reference, bench.per_element, args.reflected) {
        Some(why) => Err(refused(&why)),
        None => Ok(baseline),
    }
}
