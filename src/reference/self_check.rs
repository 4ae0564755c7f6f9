//! The judge judged: leaks, the second kernel, reciprocity, energy and the residual.

use crate::estimate::HitCounts;
use crate::formfactor::{Groups, Reciprocity, reciprocity};
use crate::raycast::Tally;
use crate::scene::Stage;
use crate::solution::{Check, SelfCheck};
use crate::stats::t_p_value;

/// False alarms allowed per run and statistical check.
pub(super) const FALSE_ALARM: f64 = 1e-6;
/// Largest relative error of radiosity that leaks of a declared enclosure may cause.
const LEAK_LIMIT: f64 = 1e-4;
/// Share of re-traced rays, away from edges, on which two kernels may disagree.
const DISAGREEMENT_LIMIT: f64 = 1e-4;
/// Relative residual that the solution has to keep.
const RESIDUAL_LIMIT: f64 = 1e-11;

/// What the self-check needs from outside.
#[derive(Debug, Clone, Default)]
pub struct Evidence {
    /// Name of the kernel that traced a sample of the rays again; `None` where there is no second one.
    pub witness: Option<String>,
    /// Rays traced again.
    pub retraced: u64,
    /// Rays of those that pass so close to an edge that either answer is right.
    pub near_edge: u64,
    /// Rays on which the kernels disagree.
    pub disagreements: u64,
    /// True if the author says the scene is closed; a leak is then a failure.
    pub declared_enclosure: bool,
}

/// All checks of a patch-system reference. `mean` is the solution of the mean matrix, N x bands.
pub(super) fn run(
    stage: &Stage,
    counts: &HitCounts,
    mean: &[f64],
    residual: f64,
    enclosure: bool,
    evidence: &Evidence,
) -> SelfCheck {
    SelfCheck {
        checks: vec![
            leaks_of(stage, &counts.tally, enclosure, evidence.declared_enclosure),
            witness(evidence),
            exchange(stage, &test_reciprocity(stage, counts)),
            energy(stage, counts, mean),
            independence(counts),
            check("residual", residual <= RESIDUAL_LIMIT, format!("the patch system is solved to {residual:.1e}")),
        ],
    }
}

pub(super) fn check(name: &str, passed: bool, finding: String) -> Check {
    Check { name: name.into(), passed, finding }
}

/// The reciprocity test of a casting, surface against surface.
pub fn test_reciprocity(stage: &Stage, counts: &HitCounts) -> Reciprocity {
    let groups = Groups::of(stage);
    let areas = stage.areas();
    let largest = areas.iter().copied().fold(0.0, f64::max);
    let flows = counts.flows(&areas, &groups.of_patch, groups.count);
    reciprocity(&flows, groups.count, largest / counts.rays as f64)
}

pub(super) fn leaks_of(stage: &Stage, t: &Tally, enclosure: bool, declared: bool) -> Check {
    let share = (t.escapes + t.back_hits) as f64 / t.rays.max(1) as f64;
    let brightest = stage.materials.iter().flat_map(|m| &m.reflectance).copied().fold(0.0, f64::max);
    // Each bounce loses `share`; a series of bounces at the highest reflectance sums them.
    let effect = share / (1.0 - brightest);
    let lost = format!("{} of {} rays escape and {} hit a back", t.escapes, t.rays, t.back_hits);
    if !(enclosure || declared) {
        return check("leaks", true, format!("the scene is open: {lost}"));
    }
    let consequence = format!("{lost}; at reflectance {brightest} that takes at most {effect:.1e} of the light");
    let passed = !declared || effect <= LEAK_LIMIT;
    let verdict =
        if passed { "" } else { "; the scene says it is an enclosure: look for gaps and surfaces wound backwards" };
    check("leaks", passed, format!("{consequence}{verdict}"))
}

pub(super) fn witness(e: &Evidence) -> Check {
    let Some(name) = &e.witness else {
        return check("second kernel", true, "not available: no second ray kernel on this machine".into());
    };
    let judged = (e.retraced - e.near_edge).max(1);
    let passed = e.disagreements as f64 <= DISAGREEMENT_LIMIT * judged as f64;
    let finding = format!(
        "{} rays traced again by {name}: {} within 1e-5 of an edge left out, {} disagreements",
        e.retraced, e.near_edge, e.disagreements
    );
    check("second kernel", passed, finding)
}

fn exchange(stage: &Stage, r: &Reciprocity) -> Check {
    let Some(p) = r.p_value else {
        return check("reciprocity", true, "not tested: no two surfaces exchange enough hits".into());
    };
    let names = match r.worst {
        Some((g, h)) if stage.surfaces.len() > g.max(h) => {
            format!(", worst {} and {}", stage.surfaces[g].name, stage.surfaces[h].name)
        }
        _ => String::new(),
    };
    check("reciprocity", p >= FALSE_ALARM, format!("p = {p:.2e} over {} pairs of surfaces{names}", r.pairs))
}

/// Errors are read off the spread of the randomisations: two that drew the same numbers would make them too small.
fn independence(counts: &HitCounts) -> Check {
    let mut prints = vec![0u64; usize::from(counts.randomisations)];
    for (i, row) in counts.rows.iter().enumerate() {
        for e in row {
            let word = (i as u64) << 40 ^ (e.patch() as u64) << 20 ^ e.count();
            let print = &mut prints[e.randomisation()];
            *print = (*print ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        }
    }
    let name = "randomisations";
    let deals = counts.rows.iter().map(Vec::len).max().unwrap_or(0);
    // Where every ray of a row lands in one patch, all randomisations count alike.
    if deals <= usize::from(counts.randomisations) {
        return check(name, true, "not tested: no row meets more than one patch".into());
    }
    let twin = (0..prints.len()).find_map(|r| (0..r).find(|q| prints[*q] == prints[r]).map(|q| (q, r)));
    match twin {
        None => check(name, true, format!("no two of {} count the same hits", prints.len())),
        Some((q, r)) => {
            let finding = format!("numbers {q} and {r} count the same hits everywhere: a seed was used twice");
            check(name, false, finding)
        }
    }
}

/// What all patches receive must be what all patches send, less what is lost on the way. Rays count it from
/// both ends: received `sum A_i F_ij B_j`, sent `sum A_i B_i (1 - lost_i)`.
fn energy(stage: &Stage, counts: &HitCounts, mean: &[f64]) -> Check {
    let bands = stage.band_count();
    let r = usize::from(counts.randomisations);
    let mut defects = vec![vec![0.0; r]; bands];
    let mut sent = vec![0.0; bands];
    for (i, row) in counts.rows.iter().enumerate() {
        let area = stage.patches[i].area;
        for e in row {
            let flow = area * e.count() as f64 / counts.rays as f64;
            for c in 0..bands {
                // Every hit is energy received by i from j; seen from the other end, energy that i sends.
                defects[c][e.randomisation()] += flow * (mean[e.patch() * bands + c] - mean[i * bands + c]);
                sent[c] += flow * mean[i * bands + c] / r as f64;
            }
        }
    }
    let tested: Vec<(f64, f64)> =
        defects.iter().zip(&sent).filter(|(_, s)| **s > 0.0).map(|(d, s)| relative_mean(d, *s)).collect();
    if tested.is_empty() {
        return check("energy", true, "not tested: nothing shines".into());
    }
    let worst = tested.iter().map(|(m, se)| t_or_one(*m, *se, r)).fold(1.0, f64::min);
    let largest = tested.iter().map(|(m, _)| m.abs()).fold(0.0, f64::max);
    let noise = tested.iter().map(|(_, se)| *se).fold(0.0, f64::max);
    let passed = worst * tested.len() as f64 >= FALSE_ALARM;
    check(
        "energy",
        passed,
        format!("received and sent energy differ by {largest:.1e} (standard error {noise:.1e}), p = {worst:.2e}"),
    )
}

fn relative_mean(d: &[f64], scale: f64) -> (f64, f64) {
    let r = d.len() as f64;
    let mean = d.iter().sum::<f64>() / r;
    let squares: f64 = d.iter().map(|x| (x - mean).powi(2)).sum();
    (mean / scale, (squares / (r * (r - 1.0))).sqrt() / scale)
}

/// Two-sided p; 1 where mean and error are both rounding.
pub(super) fn t_or_one(mean: f64, std_err: f64, r: usize) -> f64 {
    if mean.abs() <= 1e-12 && std_err <= 1e-12 { 1.0 } else { t_p_value(mean, std_err, r as f64 - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Entry;

    #[test]
    fn a_seed_used_twice_is_found() {
        let counts = |second: u64| {
            let mut c = HitCounts::empty(3, 2, vec![true, true]);
            c.rays = 8;
            let row = |patch: u32, n: u64| {
                vec![
                    Entry::new(patch, 0, 3),
                    Entry::new(patch, 1, n),
                    Entry::new(patch + 1, 0, 5),
                    Entry::new(patch + 1, 1, 8 - n),
                ]
            };
            c.rows = vec![row(0, second), row(1, second)];
            c
        };
        assert!(independence(&counts(4)).passed);
        let twice = independence(&counts(3));
        assert!(!twice.passed && twice.finding.contains("used twice"), "{}", twice.finding);
    }
}
