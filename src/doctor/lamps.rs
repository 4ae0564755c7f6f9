//! Light through few rays: patches that will need many, and scenes without any.

use super::Patient;
use super::probe::{Points, RANDOMISATIONS};
use super::text::{LISTED, names, percent};
use crate::estimate::{Emitter, Plan, patch_emitters};
use crate::math::centroid;
use crate::raycast::{BACK, RayBatch};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use rayon::prelude::*;

/// Rays sent from all lamps together.
const RAYS: usize = 1 << 18;
/// Error of a patch that asks for a finding at the default number of rays, and the error promised by its mend.
const COARSE: f64 = 0.1;
const FINE: f64 = 0.01;
/// Share of the area that must be concerned.
const WORTH_TELLING: f64 = 0.01;

pub(super) fn findings(patient: &Patient) -> Vec<Finding> {
    let stage = patient.stage;
    let luminance = |i: usize| stage.photometry.luminance(stage.emission(i));
    let emitters = patch_emitters(stage);
    let lamps: Vec<usize> = (0..emitters.len()).filter(|i| emitters[*i].is_some() && luminance(*i) > 0.0).collect();
    if lamps.is_empty() && stage.lights.iter().any(|l| stage.photometry.luminance(&l.intensity) > 0.0) {
        // Point lights are not found by rays: they neither need many nor leave the scene dark.
        return Vec::new();
    }
    if lamps.is_empty() {
        return vec![dark(stage)];
    }
    let direct = direct_light(patient, &emitters, &lamps);
    many_rays(stage, &lamps, &direct, ambient(patient, &lamps)).into_iter().collect()
}

/// No light: because nobody asked for any, or because the lamps are hidden.
fn dark(stage: &Stage) -> Finding {
    let mut hidden: Vec<String> = Vec::new();
    for i in 0..stage.patch_count() {
        let (lit, name) = (stage.emission(i).iter().any(|e| *e > 0.0), stage.surface_name(i));
        if lit && hidden.last().is_none_or(|n| n != name) {
            hidden.push(name.to_string());
        }
    }
    let none = hidden.is_empty();
    Finding {
        kind: FindingKind::Dark,
        severity: if none { Severity::Note } else { Severity::Warning },
        what: match none {
            true => "nothing emits: every radiosity is 0".into(),
            false => format!("no light reaches the scene: {} would emit, but is covered or absent", names(&hidden)),
        },
        place: Place { surfaces: hidden, ..Place::default() },
        consequence: None,
        mend: match none {
            true => "give a material an emission, unless only form factors are wanted".into(),
            false => "move the lamp off the plane it shares with another face, or put it first".into(),
        },
    }
}

/// What one ray of a patch brings from the lamps: mean and mean square of the luminance it finds.
#[derive(Debug, Clone, Copy, Default)]
struct Direct {
    mean: f64,
    square: f64,
}

/// Direct light of every patch, from the lamps' end: A_i F_il = A_l F_li.
fn direct_light(patient: &Patient, emitters: &[Option<Emitter>], lamps: &[usize]) -> Vec<Direct> {
    let stage = patient.stage;
    let tracer = patient.probe.tracer(stage);
    let rays = (RAYS / RANDOMISATIONS / lamps.len()).clamp(1, 1 << 14).next_power_of_two();
    let points = Points::new(rays);
    let hits = |l: &usize| {
        let mut counts = std::collections::BTreeMap::<u32, u32>::new();
        let mut batch = RayBatch::default();
        for r in 0..RANDOMISATIONS {
            let Some(emitter) = &emitters[*l] else { continue };
            points.fill(&mut batch, emitter, r);
            let landed = tracer.look(&batch).into_iter().flatten().map(|h| h.2).filter(|p| *p < BACK);
            landed.for_each(|p| *counts.entry(p).or_default() += 1);
        }
        counts
    };
    let counted: Vec<_> = lamps.par_iter().map(hits).collect();
    let mut direct = vec![Direct::default(); stage.patch_count()];
    for (l, counts) in lamps.iter().zip(counted) {
        let bright = stage.photometry.luminance(stage.emission(*l));
        let share = stage.patches[*l].area / (rays * RANDOMISATIONS) as f64;
        for (i, n) in counts {
            let factor = f64::from(n) * share / stage.patches[i as usize].area;
            direct[i as usize].mean += factor * bright;
            direct[i as usize].square += factor * bright * bright;
        }
    }
    direct
}

/// Mean irradiance by reflected light, as if it were spread evenly.
fn ambient(patient: &Patient, lamps: &[usize]) -> f64 {
    let stage = patient.stage;
    let all: Vec<usize> = (0..stage.patch_count()).filter(|i| stage.patches[*i].is_present()).collect();
    let size: f64 = all.iter().map(|i| stage.patches[*i].area).sum();
    let gray = |i: &usize| stage.photometry.luminance(stage.reflectance(*i));
    let reflectance = all.iter().map(|i| stage.patches[*i].area * gray(i)).sum::<f64>() / size;
    let power: f64 =
        lamps.iter().map(|l| stage.patches[*l].area * stage.photometry.luminance(stage.emission(*l))).sum();
    let kept = 1.0 - patient.probe.share(stage, &all, |s| s.escapes).mean;
    // A geometric series of bounces, each of which keeps what is reflected and does not escape.
    let bounce = (reflectance * kept).min(0.999);
    power * kept * bounce / ((1.0 - bounce) * size)
}

fn many_rays(stage: &Stage, lamps: &[usize], direct: &[Direct], ambient: f64) -> Option<Finding> {
    // Rays for a relative error of 1 of the irradiance, were they independent.
    let unit = |d: &Direct| (d.square - d.mean * d.mean).max(0.0) / (d.mean + ambient).powi(2);
    let default = Plan::default().rays as f64;
    let coarse = |n: f64| (n / default).sqrt();
    let mut list: Vec<(f64, u32)> = (0..)
        .zip(direct)
        .zip(&stage.patches)
        .filter(|((_, d), p)| p.is_present() && d.mean > 0.0 && coarse(unit(d)) > COARSE)
        .map(|((i, d), _)| (unit(d), i))
        .collect();
    list.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let area: f64 = list.iter().map(|(_, i)| stage.patches[*i as usize].area).sum();
    let share = area / stage.areas().iter().sum::<f64>();
    let (most, worst) = *list.first()?;
    if share < WORTH_TELLING {
        return None;
    }
    let mut names_of: Vec<&str> = lamps.iter().map(|l| stage.surface_name(*l)).collect();
    names_of.dedup();
    let needed = most / (FINE * FINE);
    Some(Finding {
        kind: FindingKind::ManyRays,
        severity: Severity::Note,
        place: Place {
            surfaces: names_of.iter().map(|n| n.to_string()).collect(),
            patches: list.iter().map(|l| l.1).take(LISTED).collect(),
            values: list.iter().map(|l| l.0 / (FINE * FINE)).take(LISTED).collect(),
            point: Some(centroid(&stage.patches[worst as usize].corners).to_array()),
        },
        what: format!(
            "{} patches ({} of the area) get much of their light from {} through few of their rays",
            list.len(),
            percent(share),
            names(&names_of)
        ),
        consequence: Some(Consequence {
            text: format!(
                "at the default of {default} rays the light of patch {worst} is known to {}; {needed:.1e} would bring \
                 1 % (independent rays; ours do better)",
                percent(coarse(most))
            ),
            value: needed,
            std_err: None,
            unit: "rays".into(),
        }),
        mend: "ask for more --rays, or for a --target-error; larger patches near lamps need fewer".into(),
    })
}
