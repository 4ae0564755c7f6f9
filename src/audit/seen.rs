//! How the hemi-cubes of the receivers see one source: how many pixels it should cover, who misses it, who counts it
//! double, and the beats between the grid of pixels and the grid of patches.

use super::beats::{Beat, beats};
use super::causes::Cause;
use super::split::Split;
use crate::math::{DVec3, Frame};
use crate::methods::hemicube::{delta_side, delta_top};
use crate::scene::Stage;
use std::collections::BTreeMap;

/// A source counts twice from this ratio of hemi-cube to exact value on.
const DOUBLE: f64 = 1.9;
/// And less than half below this one.
const HALF: f64 = 0.5;

/// Patches of a surface from which beats can be told.
const FEWEST_FOR_BEATS: usize = 12;

/// Receivers listed by name.
const LISTED: usize = 5;

/// One receiver before a source.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct View {
    /// Patch.
    pub patch: u32,
    /// Name of its surface.
    pub surface: String,
    /// From its centre to the source's, m.
    pub distance: f64,
    /// Form factor by the hemi-cube.
    pub cube: f64,
    /// Exact, from the centre of the patch.
    pub point: f64,
    /// The true area average, with its standard error.
    pub mean: f64,
    /// Standard error of it.
    pub mean_error: f64,
    /// The cause that matters most here.
    pub main_cause: Cause,
    /// Pixels that the source would cover at the receiver's resolution: exact value over the delta form factor of the
    /// pixel before its centre.
    pub pixels: f64,
    /// Pixels that show it, likewise.
    pub counted: f64,
    /// Luminance that the error brings at the first bounce.
    pub luminance_error: f64,
    /// Share of that in all errors of this source, in squares weighted by area.
    pub share: f64,
}

/// What the receivers have to do with a source.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Seen {
    /// Receivers that see it, from their centres.
    pub receivers: usize,
    /// Of these: those whose hemi-cube does not show it at all.
    pub missed: usize,
    /// Those that count less than half of it, missed ones included.
    pub less_than_half: usize,
    /// Those that count nearly twice of it or more.
    pub doubled: usize,
    /// Smallest, median and largest of hemi-cube over exact value.
    pub ratio: [f64; 3],
    /// Smallest, median and largest number of pixels it should cover.
    pub pixels: [f64; 3],
    /// Smallest, median and largest distance, m.
    pub distance: [f64; 3],
    /// The receivers with the largest share of the error.
    pub worst: Vec<View>,
    /// Beats across the surfaces, the strongest first.
    pub beats: Vec<Beat>,
}

/// All receivers before a source: patches `source`, radiosities through `unit`, the luminance that one unit of form
/// factor to patch j brings to patch i. `resolution` of the hemi-cubes, which stand as `stands` says: at the receivers,
/// or (`at_source`) at the patches of the source, where pixels are what the receiver covers of theirs.
pub fn views(
    stage: &Stage,
    split: &Split,
    stands: &[Option<(DVec3, Frame)>],
    source: &[u32],
    resolution: u32,
    at_source: bool,
    unit: &dyn Fn(usize, usize) -> f64,
) -> Vec<View> {
    let middle = middle(stage, source);
    let mut out = Vec::new();
    for (i, stand) in stands.iter().enumerate() {
        let Some((eye, frame)) = stand else { continue };
        let (mut cube, mut point, mut mean, mut variance, mut light) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut parts = [0.0f64; 3];
        let mut pixels = [0.0; 2];
        for (j, p) in source.iter().filter_map(|j| Some((*j as usize, split.get(i, *j as usize)?))) {
            cube += p.cube;
            point += p.point;
            mean += p.mean;
            variance += p.mean_error * p.mean_error;
            let delta = match &stands[j] {
                Some((from, frame)) if at_source => {
                    let turned = stage.patches[j].area / stage.patches[i].area;
                    delta_towards(frame, *eye - *from, resolution) * turned
                }
                _ => delta_towards(frame, middle - *eye, resolution),
            };
            if delta > 0.0 {
                pixels = [pixels[0] + p.point / delta, pixels[1] + p.cube / delta];
            }
            light += unit(i, j) * p.error();
            Cause::ALL.iter().zip(&mut parts).for_each(|(c, part)| *part += unit(i, j) * p.part(*c));
        }
        if cube == 0.0 && point == 0.0 && mean == 0.0 {
            continue;
        }
        out.push(View {
            patch: i as u32,
            surface: stage.surfaces[stage.patches[i].surface as usize].name.clone(),
            distance: middle.distance(*eye),
            cube,
            point,
            mean,
            mean_error: variance.sqrt(),
            main_cause: Cause::largest(&parts.map(f64::abs)),
            pixels: pixels[0],
            counted: pixels[1],
            luminance_error: light,
            share: 0.0,
        });
    }
    let weight = |v: &View| stage.patches[v.patch as usize].area * v.luminance_error.powi(2);
    let all: f64 = out.iter().map(weight).sum();
    if all > 0.0 {
        out.iter_mut().for_each(|v| v.share = weight(v) / all);
    }
    out
}

/// Sums the receivers of a source up.
pub fn seen(stage: &Stage, views: &[View]) -> Seen {
    let lit: Vec<&View> = views.iter().filter(|v| v.point > 0.0).collect();
    let ratios: Vec<f64> = lit.iter().map(|v| v.cube / v.point).collect();
    let count = |holds: &dyn Fn(f64) -> bool| ratios.iter().filter(|r| holds(**r)).count();
    let mut worst: Vec<View> = views.to_vec();
    worst.sort_by(|a, b| b.share.total_cmp(&a.share));
    worst.truncate(LISTED);
    Seen {
        receivers: lit.len(),
        missed: count(&|r| r == 0.0),
        less_than_half: count(&|r| r < HALF),
        doubled: count(&|r| r >= DOUBLE),
        ratio: spread(ratios.clone()),
        pixels: spread(lit.iter().map(|v| v.pixels).collect()),
        distance: spread(lit.iter().map(|v| v.distance).collect()),
        worst,
        beats: all_beats(stage, &lit),
    }
}

/// Beats on every surface with enough receivers.
fn all_beats(stage: &Stage, lit: &[&View]) -> Vec<Beat> {
    let mut by_surface: BTreeMap<u32, Vec<(u32, f64)>> = BTreeMap::new();
    for v in lit {
        by_surface.entry(stage.patches[v.patch as usize].surface).or_default().push((v.patch, v.cube / v.point));
    }
    let enough = by_surface.values().filter(|list| list.len() >= FEWEST_FOR_BEATS);
    let mut found: Vec<Beat> = enough.flat_map(|list| beats(stage, list)).collect();
    found.sort_by(|a, b| (b.share * b.spread).total_cmp(&(a.share * a.spread)));
    found
}

/// Smallest, median, largest; zeros for nothing.
fn spread(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    match values.as_slice() {
        [] => [0.0; 3],
        all => [all[0], all[all.len() / 2], all[all.len() - 1]],
    }
}

/// Centre of area of some patches.
fn middle(stage: &Stage, patches: &[u32]) -> DVec3 {
    let of = |j: &u32| &stage.patches[*j as usize];
    let area: f64 = patches.iter().map(|j| of(j).area).sum();
    let centre = |j: &u32| of(j).corners.iter().sum::<DVec3>() / of(j).corners.len() as f64;
    patches.iter().map(|j| centre(j) * (of(j).area / area)).sum()
}

/// Delta form factor of a pixel in a direction of the scene; 0 below the horizon.
fn delta_towards(frame: &Frame, direction: DVec3, resolution: u32) -> f64 {
    let d = frame.to_local(direction);
    let pixel = (2.0 / f64::from(resolution)).powi(2);
    let side = d.x.abs().max(d.y.abs());
    if d.z <= 0.0 {
        0.0
    } else if d.z >= side {
        delta_top(d.x / d.z, d.y / d.z, pixel)
    } else {
        delta_side(d.x.abs().min(d.y.abs()) / side, d.z / side, pixel)
    }
}
