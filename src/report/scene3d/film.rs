//! The steps of a series as a film.

use super::encode::numbers;
use super::layers::{Colouring, Layer, coloured, known};
use super::{Parts, SceneView, has_geometry};
use crate::render::{Exposure, Field, Scale, difference, luminance};
use crate::report::ReportError;
use crate::report::figures::WATTS;
use crate::report::format::count;
use crate::scene::Stage;
use crate::solution::{Radiosity, Series, Snapshot};
use serde::Serialize;

/// At most this many steps of a series.
const STEPS: usize = 24;
/// Bytes of steps that a page holds, all series together, before they are text.
const BUDGET: usize = 4_500_000;

/// The luminances of a series, step by step.
#[derive(Debug, Serialize)]
pub(super) struct Film {
    title: String,
    /// What is left out, in a sentence.
    note: String,
    steps: Vec<Step>,
}

#[derive(Debug, Serialize)]
struct Step {
    label: String,
    /// Luminance of each patch (f32), W/m^2.
    values: String,
}

/// A state with its reference.
#[derive(Debug, Clone, Copy)]
pub struct Filmed<'a> {
    /// The state.
    pub stage: &'a Stage,
    /// Mean of the reference, per patch.
    pub reference: &'a Radiosity,
}

/// Every series on its way to the reference of one state; `None` without geometry or without a step.
///
/// # Errors
/// [`ReportError::Json`], which no series provokes.
pub fn film(now: Filmed, series: &[Series]) -> Result<Option<Parts>, ReportError> {
    Ok(view(now, series).map(|v| Parts::of(&v)).transpose()?)
}

fn view(now: Filmed, series: &[Series]) -> Option<SceneView> {
    let (stage, photometry) = (now.stage, &now.stage.photometry);
    let of_state = |s: &Series| s.snapshots.iter().any(|s| s.edit == stage.state);
    let shown: Vec<&Series> = series.iter().filter(|s| of_state(s)).collect();
    if !has_geometry(stage) || shown.is_empty() {
        return None;
    }
    let areas = stage.areas();
    let bright = luminance(photometry, now.reference);
    let scale = Scale::from_zero(&known(bright.clone()), &areas);
    let mut view = SceneView::new(stage, &stage.cameras);
    view.layers.push(
        Layer::new(
            "reference",
            "Luminance of the reference",
            "In false colour.",
            &known(bright.clone()),
            &scale,
            WATTS,
        )
        .in_range_of("light"),
    );
    view.colourings.push(reference_colours(stage, now.reference, &bright, &areas));
    let most = steps_that_fit(stage.patch_count(), shown.len());
    for (k, series) in shown.iter().enumerate() {
        let (all, kept) = kept(series, stage.state, most);
        let luminances: Vec<Vec<f64>> = kept.iter().map(|s| luminance(photometry, &s.radiosity)).collect();
        let wrong = difference(&bright, &luminances[luminances.len() / 2]);
        view.layers.extend(layers_of(k, &series.name, &scale, &Scale::symmetric(&wrong, &areas, 0.0)));
        view.films.push(reel(series, stage.state, all, &kept, &luminances));
    }
    view.start = "film-1".into();
    Some(view)
}

fn reel(series: &Series, edit: usize, all: usize, kept: &[&Snapshot], luminances: &[Vec<f64>]) -> Film {
    let step = |(s, y): (&&Snapshot, &Vec<f64>)| Step {
        label: label(series, edit, s),
        values: numbers(known(y.clone()).values),
    };
    let note = match kept.len() == all {
        true => format!("All {} snapshots of the series.", count(all)),
        false => {
            format!("{} of {} snapshots, spread evenly over the logarithm of the cost.", count(kept.len()), count(all))
        }
    };
    Film { title: series.name.clone(), note, steps: kept.iter().zip(luminances).map(step).collect() }
}

/// The solution and its difference from the reference.
fn layers_of(film: usize, name: &str, light: &Scale, wrong: &Scale) -> [Layer; 2] {
    let none = Field { values: Vec::new() };
    let key = format!("film-{}", film + 1);
    let light = Layer::new(&key, &format!("{name}: luminance"), "", &none, light, WATTS).in_range_of("light");
    let told = "Solution minus reference, step by step: red where it is too bright, blue where it is too dark. The range \
                is that of the middle step.";
    let title = format!("{name}: difference from the reference");
    let wrong = Layer::new(&format!("{key}-difference"), &title, "", &none, wrong, WATTS);
    // What lies beyond the range differs from step to step: the notes do not say.
    let note = "Step by step; in the colours of the reference.".to_string();
    [
        Layer { film: Some(film), note, ..light },
        Layer { film: Some(film), minus: Some("reference".into()), note: told.into(), ..wrong },
    ]
}

fn reference_colours(stage: &Stage, reference: &Radiosity, bright: &[f64], areas: &[f64]) -> Colouring {
    let is_lamp: Vec<bool> = (0..stage.patch_count()).map(|i| stage.emission(i).iter().any(|e| *e > 0.0)).collect();
    let exposure = Exposure::fit(&stage.photometry, bright, areas, &is_lamp);
    Colouring {
        key: "exposure".into(),
        title: "one linear exposure".into(),
        note: "The reference in the exposure that suits it.".into(),
        reference: coloured(&exposure, reference),
        candidate: None,
        before: None,
    }
}

/// How many steps a series may have so that all of them stay within the budget; at least two.
fn steps_that_fit(patches: usize, series: usize) -> usize {
    (BUDGET / (4 * patches.max(1) * series.max(1))).clamp(2, STEPS)
}

/// What a snapshot cost since the last edit: shots, else rays, else its number.
fn cost(series: &Series, edit: usize, s: &Snapshot, number: usize) -> f64 {
    let before = series.snapshots.iter().rfind(|s| s.edit < edit);
    let since = |of: fn(&Snapshot) -> u64| (of(s) - before.map_or(0, of)) as f64;
    let (shots, rays) = (since(|s| s.shots), since(|s| s.rays));
    if shots > 0.0 || s.shots > 0 {
        shots
    } else if s.rays > 0 {
        rays
    } else {
        number as f64
    }
}

/// How many snapshots a state has, and those that are shown: first and last, the others near even steps of log cost.
fn kept(series: &Series, edit: usize, most: usize) -> (usize, Vec<&Snapshot>) {
    let all: Vec<&Snapshot> = series.snapshots.iter().filter(|s| s.edit == edit).collect();
    if all.len() <= most {
        return (all.len(), all);
    }
    let places: Vec<f64> = all.iter().enumerate().map(|(k, s)| (1.0 + cost(series, edit, s, k)).ln()).collect();
    let (first, last) = (places[0], places[all.len() - 1]);
    let mut chosen: Vec<usize> = Vec::new();
    for k in 0..most {
        let goal = first + (last - first) * k as f64 / (most - 1) as f64;
        let at = places.partition_point(|p| *p < goal - 1e-9).min(all.len() - 1);
        if chosen.last().is_none_or(|c| *c < at) {
            chosen.push(at);
        }
    }
    (all.len(), chosen.into_iter().map(|k| all[k]).collect())
}

fn label(series: &Series, edit: usize, s: &Snapshot) -> String {
    let before = series.snapshots.iter().rfind(|s| s.edit < edit);
    let since = if before.is_some() { " since the edit" } else { "" };
    let of = |get: fn(&Snapshot) -> u64| count((get(s) - before.map_or(0, get)) as usize);
    match (s.shots, s.rays) {
        (0, 0) => "no shots, no rays".into(),
        (0, _) => format!("{} rays{since}", of(|s| s.rays)),
        _ => format!("{} shots{since}", of(|s| s.shots)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{direct_light, room};

    fn series(stage: &Stage, shots: &[u64]) -> Series {
        let radiosity = direct_light(stage, true);
        let one =
            |shots: &u64| Snapshot { edit: 0, shots: *shots, rays: 0, seconds: 0.0, radiosity: radiosity.clone() };
        Series { name: "progressive".into(), snapshots: shots.iter().map(one).collect() }
    }

    #[test]
    fn steps_are_spread_over_the_logarithm_and_keep_both_ends() {
        let stage = room();
        let shots: Vec<u64> = (0..1000).collect();
        let series = series(&stage, &shots);
        let (all, kept) = kept(&series, 0, 11);
        let at: Vec<u64> = kept.iter().map(|s| s.shots).collect();
        assert_eq!((all, at[0], at[at.len() - 1]), (1000, 0, 999));
        assert!(at.windows(2).all(|w| w[0] < w[1]));
        // Even in the logarithm: half the steps take the series to about the root of the whole.
        assert!((20..60).contains(&at[at.len() / 2]), "{at:?}");
    }

    #[test]
    fn many_patches_leave_room_for_fewer_steps() {
        assert_eq!(steps_that_fit(500, 3), STEPS);
        assert_eq!(steps_that_fit(50_000, 3), 7);
        assert_eq!(steps_that_fit(10_000_000, 3), 2);
    }

    #[test]
    fn a_film_shows_the_series_of_its_state_alone() {
        let stage = room();
        let reference = direct_light(&stage, false);
        let now = Filmed { stage: &stage, reference: &reference };
        let mut other = series(&stage, &[5]);
        other.snapshots[0].edit = 1;
        let view = view(now, &[series(&stage, &[0, 10, 20]), other.clone()]).expect("a film");
        let keys: Vec<&str> = view.layers.iter().map(|l| l.key.as_str()).collect();
        assert_eq!(keys, ["reference", "film-1", "film-1-difference"]);
        let labels: Vec<&str> = view.films[0].steps.iter().map(|s| s.label.as_str()).collect();
        assert_eq!(labels, ["no shots, no rays", "10 shots", "20 shots"]);
        assert_eq!(view.films[0].note, "All 3 snapshots of the series.");
        assert!(super::view(now, &[other]).is_none());
    }
}
