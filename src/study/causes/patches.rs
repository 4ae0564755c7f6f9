//! Errors of few patches, of one surface, and values that are missing.

use super::jury::{Hypothesis, Jury};
use super::words::{digits, percent, too_bright};
use std::collections::BTreeSet;

const FAMILY: &str = "patches";
/// Surfaces looked at one by one.
const SURFACES: usize = 12;
/// Few patches: this share of all, and at most so many.
const FEW: (f64, usize) = (0.01, 10);
/// Share of the squared error that they hold.
const HELD: f64 = 0.8;
/// Patches of which all pairs are tried.
const EXCHANGED: usize = 4;

pub(super) fn hear(jury: &mut Jury) {
    missing_values(jury);
    surfaces(jury);
    let worst = worst(jury);
    few(jury, &worst);
    exchanged(jury, &worst);
}

/// Values that are exactly 0 where there is light.
fn missing_values(jury: &mut Jury) {
    let case = jury.case;
    let zero = |k: usize| case.solution[k] == 0.0 && case.truth[k] > 0.0;
    let change = case.everywhere(|k| if zero(k) { -case.truth[k] } else { 0.0 });
    let dark: BTreeSet<usize> = (0..change.len()).filter(|k| change[*k] != 0.0).map(|k| k / case.bands).collect();
    let Some(first) = dark.first() else { return };
    let surfaces: BTreeSet<u32> = dark.iter().map(|i| case.stage.patches[*i].surface).collect();
    let name = case.stage.surface_name(*first).to_string();
    let whole = surfaces.len() == 1 && case.patches_of(case.stage.patches[*first].surface).len() == dark.len();
    let (kind, place, sentence) = if whole {
        ("surface-missing", Some(name.clone()), format!("all values of surface \"{name}\" are 0: left out"))
    } else {
        let place = (dark.len() == 1).then(|| format!("{name}, patch {first}"));
        let what = format!("{} values are 0 where there is light, the first at patch {first} (\"{name}\")", dark.len());
        ("values-missing", place, format!("{what}: left out, or NaN replaced by 0"))
    };
    jury.hear(Hypothesis { family: FAMILY, kind, place, parameters: 0, sentence, partly: false }, change);
}

/// One surface off by a factor.
fn surfaces(jury: &mut Jury) {
    let case = jury.case;
    for surface in case.worst_surfaces(SURFACES) {
        let light = case.at(&case.patches_of(surface), |k| case.truth[k]);
        let factor = 1.0 + case.amount(&light);
        let name = case.stage.surfaces[surface as usize].name.clone();
        let sentence = format!("surface \"{name}\" alone is {} (factor {})", too_bright(factor), digits(factor));
        let change = light.iter().map(|b| (factor - 1.0) * b).collect();
        jury.hear(
            Hypothesis {
                family: FAMILY,
                kind: "one-surface",
                place: Some(name),
                parameters: 1,
                sentence,
                partly: false,
            },
            change,
        );
    }
}

/// The few patches with the largest squared error, the worst first.
fn worst(jury: &Jury) -> Vec<usize> {
    let case = jury.case;
    let all = case.areas.iter().filter(|a| **a > 0.0).count();
    let few = ((FEW.0 * all as f64) as usize).clamp(1, FEW.1);
    let found = case.worst(|i| i as u32, few.max(EXCHANGED));
    found.into_iter().map(|i| i as usize).collect()
}

/// A few patches that hold nearly all of the error; no more of them than it takes.
fn few(jury: &mut Jury, worst: &[usize]) {
    let case = jury.case;
    let all = case.areas.iter().filter(|a| **a > 0.0).count();
    let few = ((FEW.0 * all as f64) as usize).clamp(1, FEW.1).min(worst.len());
    for count in 1..=few {
        let chosen = &worst[..count];
        let change = case.at(chosen, |k| case.error[k]);
        let left = case.left(&change);
        if left.bands.max(left.luminance) > 1.0 - HELD {
            continue;
        }
        let (kind, place, sentence) = words(jury, chosen);
        jury.hear(
            Hypothesis { family: FAMILY, kind, place: Some(place), parameters: count, sentence, partly: false },
            change,
        );
        return;
    }
}

fn words(jury: &Jury, chosen: &[usize]) -> (&'static str, String, String) {
    let case = jury.case;
    let off = |i: usize| {
        let of = |v: &[f64]| case.stage.photometry.luminance(&v[i * case.bands..(i + 1) * case.bands]);
        let (truth, error) = (of(&case.truth), of(&case.error));
        let name = case.stage.surface_name(i);
        match truth > 0.0 {
            true => format!("patch {i} of surface \"{name}\" is {}", too_bright(1.0 + error / truth)),
            false => format!("patch {i} of surface \"{name}\" is lit where it should be dark"),
        }
    };
    let text: Vec<String> = chosen.iter().map(|i| off(*i)).collect();
    let places: Vec<String> = chosen.iter().map(|i| i.to_string()).collect();
    match chosen {
        [one] => ("one-patch", format!("patch {one}"), format!("{}, and nearly nothing else is wrong", text[0])),
        _ => {
            let change = case.at(chosen, |k| case.error[k]);
            let held = percent(1.0 - case.left(&change).luminance);
            let sentence = format!("{} patches hold {held} of the squared error: {}", chosen.len(), text.join("; "));
            ("few-patches", format!("patches {}", places.join(", ")), sentence)
        }
    }
}

/// Two patches with each other's values.
fn exchanged(jury: &mut Jury, worst: &[usize]) {
    let case = jury.case;
    let some = &worst[..worst.len().min(EXCHANGED)];
    for (at, i) in some.iter().enumerate() {
        for j in &some[at + 1..] {
            let b = case.bands;
            let mut change = vec![0.0; case.truth.len()];
            for (to, from) in [(i, j), (j, i)] {
                (0..b).for_each(|c| change[to * b + c] = case.truth[from * b + c] - case.truth[to * b + c]);
            }
            let (i, j) = (i.min(j), i.max(j));
            let [x, y] = [i, j].map(|k| format!("{k} (\"{}\")", case.stage.surface_name(*k)));
            let sentence = format!("patches {x} and {y} have each other's values");
            let place = Some(format!("patches {i}, {j}"));
            jury.hear(
                Hypothesis { family: FAMILY, kind: "patches-swapped", place, parameters: 0, sentence, partly: true },
                change,
            );
        }
    }
}
