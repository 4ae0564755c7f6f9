//! Pairs settled without rays, judged: measured again by rays, and summed up against closure.

use super::self_check::{FALSE_ALARM, check};
use crate::estimate::{HitCounts, PairFactors};
use crate::formfactor::Groups;
use crate::math::compensated_sum;
use crate::scene::Stage;
use crate::solution::{Check, FormFactors};
use crate::stats::{sidak, t_p_value};

/// Rays find facets in single precision: flows may differ by this share without anything being wrong.
const SINGLE_PRECISION: f64 = 1e-6;

/// Flows below so many of the smallest steps are too grainy for a t test.
const LEAST_STEPS: f64 = 200.0;

/// Gaps of an enclosure that other checks let pass.
const GAP: f64 = 1e-6;

/// Pairs settled without rays against the rays of `counts`, and rows against closure. `matrix` is the whole matrix,
/// rays included.
pub fn check_pairs(
    stage: &Stage,
    pairs: &PairFactors,
    counts: &HitCounts,
    matrix: &FormFactors,
    enclosure: bool,
) -> Vec<Check> {
    vec![by_rays(stage, pairs, counts), closure(stage, pairs, matrix, enclosure)]
}

/// Flows between surfaces through settled pairs, as computed and as rays count them: a t test, beyond the errors stated,
/// over the randomisations for each pair of surfaces, the worst judged for their number.
fn by_rays(stage: &Stage, pairs: &PairFactors, counts: &HitCounts) -> Check {
    let groups = Groups::of(stage);
    let (n, areas) = (groups.count, stage.areas());
    let (mut exact, mut stated) = (vec![0.0; n * n], vec![0.0; n * n]);
    let errors = pairs.form_factors.std_err.as_deref().unwrap_or_default();
    let mut rays = vec![vec![0.0; n * n]; usize::from(counts.randomisations)];
    for i in 0..stage.patch_count() {
        let from = groups.of_patch[i] * n;
        for (k, (j, f)) in pairs.form_factors.row(i).enumerate() {
            exact[from + groups.of_patch[j]] += areas[i] * f;
            stated[from + groups.of_patch[j]] += areas[i] * errors[pairs.form_factors.row_starts[i] + k];
        }
        for e in &counts.rows[i] {
            if !pairs.left.holds(i, e.patch()) {
                let f = e.count() as f64 / counts.rays as f64;
                rays[e.randomisation()][from + groups.of_patch[e.patch()]] += areas[i] * f;
            }
        }
    }
    // The whole exchange besides: a share lost everywhere shows there first.
    let whole = n * n;
    exact.push(exact.iter().sum());
    stated.push(stated.iter().sum());
    rays.iter_mut().for_each(|f| f.push(f.iter().sum()));
    let step = areas.iter().copied().fold(0.0, f64::max) / counts.rays as f64;
    let (mut p_min, mut tested, mut worst, mut largest) = (1.0f64, 0, 0, 0.0f64);
    for k in 0..=whole {
        let hits: f64 = rays.iter().map(|f| f[k]).sum();
        if hits.max(exact[k] * rays.len() as f64) < LEAST_STEPS * step {
            continue;
        }
        tested += 1;
        let (mean, std_err) = spread(rays.iter().map(|f| f[k] - exact[k]));
        largest = largest.max(mean.abs() / exact[k].max(step));
        let beyond = (mean.abs() - SINGLE_PRECISION * exact[k] - stated[k]).max(0.0);
        let p = if beyond == 0.0 { 1.0 } else { t_p_value(beyond, std_err, rays.len() as f64 - 1.0) };
        if p < p_min {
            (p_min, worst) = (p, k);
        }
    }
    if tested == 0 {
        return check("pairs by rays", true, "not tested: no two surfaces exchange enough hits".into());
    }
    let p = sidak(p_min, tested);
    let name = |g: usize| stage.surfaces.get(g).map_or("", |s| s.name.as_str());
    let places = if worst == whole {
        ", worst the sum of all".into()
    } else if stage.surfaces.len() == n && p < 1.0 {
        format!(", worst {} to {}", name(worst / n), name(worst % n))
    } else {
        String::new()
    };
    let finding = format!(
        "flows of settled pairs counted by rays: p = {p:.2e} over {tested} pairs of surfaces, \
         largest difference {largest:.1e}{places}"
    );
    check("pairs by rays", p >= FALSE_ALARM, finding)
}

/// Mean and standard error.
fn spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let r = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / r;
    let squares: f64 = values.map(|v| (v - mean).powi(2)).sum();
    (mean, (squares / (r * (r - 1.0))).sqrt())
}

/// In a closed scene a row without rays sums to one within the sum of its errors: nothing makes it do so but being
/// right.
fn closure(stage: &Stage, pairs: &PairFactors, matrix: &FormFactors, enclosure: bool) -> Check {
    let name = "closure";
    if !enclosure {
        return check(name, true, "not tested: the scene is open".into());
    }
    let settled = |i: &usize| stage.patches[*i].is_present() && pairs.left.is_settled(*i);
    let rows: Vec<usize> = (0..stage.patch_count()).filter(settled).collect();
    if rows.is_empty() {
        return check(name, true, "not tested: every row has pairs left to rays".into());
    }
    let errors = matrix.std_err.as_deref().unwrap_or_default();
    let (mut largest, mut worst, mut excess) = (0.0f64, rows[0], f64::NEG_INFINITY);
    for i in &rows {
        let span = matrix.row_starts[*i]..matrix.row_starts[i + 1];
        let defect = (matrix.row_sum(*i) - 1.0).abs();
        let beyond = defect - compensated_sum(errors[span].iter().copied());
        largest = largest.max(defect);
        if beyond > excess {
            (excess, worst) = (beyond, *i);
        }
    }
    let passed = excess <= GAP || stage.enclosure != Some(true);
    let place = if passed { String::new() } else { format!("; worst patch {worst} of {}", stage.surface_name(worst)) };
    check(name, passed, format!("{} rows without rays sum to 1 within {largest:.1e}{place}", rows.len()))
}
