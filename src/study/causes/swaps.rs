//! Materials in each other's place: everywhere, on two surfaces, or on one.

use super::case::Case;
use super::jury::{Hypothesis, Jury};
use super::quick::Quick;
use crate::scene::Material;

/// Materials of which all pairs are tried: those with most of the squared error.
const MATERIALS: usize = 12;
/// Surfaces of which all pairs are tried, and surfaces that are given every other material.
const SURFACES: usize = 8;
const REPAINTED: usize = 4;

const FAMILY: &str = "material";

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    let irradiance = quick.irradiance();
    let material_of = |i: usize| case.stage.patches[i].material;
    let materials = case.worst(material_of, MATERIALS);
    for (a, b) in pairs(&materials) {
        let swap = |i: usize| match material_of(i) {
            m if m == a => b,
            m if m == b => a,
            m => m,
        };
        let (x, y) = (name(case, a), name(case, b));
        let sentence = format!("materials \"{x}\" and \"{y}\" are swapped");
        say(jury, quick, &irradiance, &swap, ("materials-swapped", format!("{x}, {y}"), sentence));
    }
    let surfaces = case.worst_surfaces(SURFACES);
    // A surface with patches of several materials is left out.
    let only = |s: u32| {
        let mut all = case.patches_of(s).into_iter().map(material_of);
        let first = all.next();
        first.filter(|f| all.all(|m| m == *f))
    };
    let surface = |s: u32| case.stage.surfaces[s as usize].name.as_str();
    for (a, b) in pairs(&surfaces) {
        let (Some(ma), Some(mb)) = (only(a), only(b)) else { continue };
        let swap = |i: usize| match case.stage.patches[i].surface {
            s if s == a => mb,
            s if s == b => ma,
            _ => material_of(i),
        };
        let (x, y) = (surface(a), surface(b));
        let sentence = format!("surfaces \"{x}\" and \"{y}\" have each other's material");
        say(jury, quick, &irradiance, &swap, ("surface-materials-swapped", format!("{x}, {y}"), sentence));
    }
    for &s in surfaces.iter().take(REPAINTED) {
        for m in (0..case.stage.materials.len() as u32).filter(|m| only(s).is_some_and(|o| o != *m)).take(MATERIALS) {
            let repaint = |i: usize| if case.stage.patches[i].surface == s { m } else { material_of(i) };
            let (x, y) = (surface(s), name(case, m));
            let sentence = format!("surface \"{x}\" has material \"{y}\"");
            say(jury, quick, &irradiance, &repaint, ("surface-material", x.to_string(), sentence));
        }
    }
}

fn name(case: &Case, material: u32) -> String {
    case.stage.materials[material as usize].name.clone()
}

/// All pairs, each in ascending order.
fn pairs(of: &[u32]) -> Vec<(u32, u32)> {
    let all = of.iter().enumerate().flat_map(|(at, a)| of[at + 1..].iter().map(move |b| (*a.min(b), *a.max(b))));
    all.collect()
}

/// Hears the world in which patch i has material `of(i)`.
fn say(
    jury: &mut Jury,
    quick: &Quick,
    irradiance: &[f64],
    of: &dyn Fn(usize) -> u32,
    (kind, place, sentence): (&'static str, String, String),
) {
    let case = jury.case;
    let material = |k: usize| -> &Material { &case.stage.materials[of(k / case.bands) as usize] };
    let reflectance = case.everywhere(|k| material(k).reflectance[k % case.bands]);
    let source = case.everywhere(|k| {
        let emission = material(k).emission[k % case.bands] - case.emission[k];
        emission + (reflectance[k] - case.reflectance[k]) * irradiance[k]
    });
    if source.iter().all(|s| *s == 0.0) {
        return;
    }
    let Some(change) = quick.spread_with(&source, &reflectance) else { return };
    jury.hear(Hypothesis { family: FAMILY, kind, place: Some(place), parameters: 0, sentence, partly: true }, change);
}
