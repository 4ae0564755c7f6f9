//! The hemi-cube of one patch laid open: what its pixels show, what they should show, and the true silhouettes.
//!
//! What a pixel should show is told by a hemi-cube some times finer in the same place: the share of the pixel whose fine
//! pixels show another item is counted wrong. Silhouettes are the borders in the finer one; those of the source are
//! its own edges, projected, where it is in sight.

mod silhouettes;

use crate::methods::hemicube::{Delta, DeltaTable, Face, HemicubeError, Item, ItemBuffer, Params, item_buffer};
use crate::render::{Shown, UnfoldedFace, UnfoldedHemicube, Wrong};
use crate::scene::Stage;
use silhouettes::{borders, projected};
use std::collections::BTreeSet;

/// The finer hemi-cube has so many pixels to one, each way, where it may.
const FINER: u32 = 8;
/// No hemi-cube is finer than this.
const FINEST: u32 = 4096;

/// A hemi-cube laid open, and what it says of a source.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfolded {
    /// The picture's data; its caption is empty.
    pub picture: UnfoldedHemicube,
    /// Form factor to the source as the hemi-cube counts it.
    pub counted: f64,
    /// The same by the finer hemi-cube with exact deltas: near the value at the centre, and free of its table's error.
    pub finer: f64,
    /// Pixels counted for the source.
    pub counted_pixels: usize,
    /// Pixels it covers, by area on the faces.
    pub covered_pixels: f64,
    /// Pixels of the finer hemi-cube to one, each way; at 1 nothing can be told wrong.
    pub times_finer: u32,
}

/// Lays open the hemi-cube of a patch and judges it by a finer one; `sources` are the patches that are one source
/// together, and may be empty. `None` for a patch that takes no part or does not exist.
pub fn unfold(
    stage: &Stage,
    patch: usize,
    params: &Params,
    sources: &BTreeSet<u32>,
) -> Result<Option<Unfolded>, HemicubeError> {
    let times = (FINEST / params.validated()?.resolution).clamp(1, FINER);
    let fine_params = Params { resolution: times * params.resolution, delta: Delta::Exact, ..*params };
    let Some(coarse) = item_buffer(stage, patch, params)? else { return Ok(None) };
    let Some(fine) = item_buffer(stage, patch, &fine_params)? else { return Ok(None) };
    let is_source = |item: Item| item.as_patch().is_some_and(|j| sources.contains(&j));
    let faces = std::array::from_fn(|k| UnfoldedFace {
        shown: coarse.faces[k].iter().map(|item| shown(stage, *item, is_source(*item))).collect(),
        wrong: judge(&coarse.faces[k], &fine.faces[k], coarse.resolution, times as usize, &is_source),
        silhouettes: borders(stage, &fine.faces[k], fine.resolution)
            .chain(projected(
                stage,
                sources,
                (coarse.eye, coarse.frame),
                Face::ALL[k],
                (&fine.faces[k], fine.resolution),
            ))
            .collect(),
    });
    let count = |buffer: &ItemBuffer| buffer.faces.iter().flatten().filter(|item| is_source(**item)).count();
    Ok(Some(Unfolded {
        picture: UnfoldedHemicube { resolution: coarse.resolution, faces, caption: String::new() },
        counted: form_factor(&coarse, &DeltaTable::new(params.resolution, params.delta), &is_source),
        finer: form_factor(&fine, &DeltaTable::new(fine_params.resolution, Delta::Exact), &is_source),
        counted_pixels: count(&coarse),
        covered_pixels: count(&fine) as f64 / f64::from(times * times),
        times_finer: times,
    }))
}

impl Unfolded {
    /// Sentences for the picture. `exact` is the form factor at the centre, or of the patch, with what to call it; the
    /// finer hemi-cube's stands in where it is not known.
    pub fn caption(&self, patch: &str, source: &str, exact: Option<(f64, &str)>) -> String {
        let Self { counted, finer, counted_pixels, covered_pixels, times_finer, .. } = self;
        let by_finer = format!("by a hemi-cube {times_finer} times finer");
        let (value, named) = exact.unwrap_or((*finer, &by_finer));
        let verdict = match counted / value {
            _ if value == 0.0 && *counted == 0.0 => "it is out of sight".to_string(),
            _ if value == 0.0 => "none of it should be seen".to_string(),
            _ if *counted == 0.0 => "it is missed".to_string(),
            ratio => format!("{ratio:.3} times as much"),
        };
        let resolution = self.picture.resolution;
        format!(
            "{patch}, hemi-cube of resolution {resolution}. Source: {source}. It is counted in {counted_pixels} pixels and \
             covers {covered_pixels:.2}. Form factor counted {counted:.4e}, {named} {value:.4e}: {verdict}. Discs mark wrong \
             pixels, their area the share that is wrong."
        )
    }
}

fn shown(stage: &Stage, item: Item, is_source: bool) -> Shown {
    match item.as_patch() {
        Some(_) if is_source => Shown::Source,
        Some(patch) => Shown::Patch { patch, surface: stage.patches[patch as usize].surface },
        None if item == Item::BACK => Shown::Back,
        None => Shown::Nothing,
    }
}

/// What is wrong with each pixel of a face of `n` columns, by a face with `times` pixels to one each way.
fn judge(coarse: &[Item], fine: &[Item], n: usize, times: usize, is_source: &impl Fn(Item) -> bool) -> Vec<Wrong> {
    let cell = |(k, item): (usize, &Item)| {
        let (column, row) = (k % n * times, k / n * times);
        let (mut other, mut source) = (0u32, 0u32);
        for line in row..row + times {
            for seen in &fine[line * n * times + column..][..times] {
                other += u32::from(seen != item);
                source += u32::from(is_source(*seen));
            }
        }
        let whole = (times * times) as f32;
        let counted = f32::from(u8::from(is_source(*item)));
        Wrong { excess: counted - source as f32 / whole, mixed: other as f32 / whole }
    };
    coarse.iter().enumerate().map(cell).collect()
}

/// Sum of deltas over the source.
fn form_factor(buffer: &ItemBuffer, table: &DeltaTable, is_source: &impl Fn(Item) -> bool) -> f64 {
    let (n, half) = (buffer.resolution, buffer.resolution / 2);
    let from_axis = |k: usize| if k < half { half - 1 - k } else { k - half };
    let mut sum = crate::math::Compensated::default();
    for (face, items) in Face::ALL.iter().zip(&buffer.faces) {
        for (k, _) in items.iter().enumerate().filter(|(_, item)| is_source(**item)) {
            let (column, row) = (from_axis(k % n), k / n);
            sum.add(if *face == Face::Top { table.top(column, from_axis(row)) } else { table.side(column, row) });
        }
    }
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::scene::builtin;
    use crate::render::Outline;

    fn number(stage: &Stage, surface: &str) -> usize {
        (0..stage.patch_count()).find(|i| stage.surface_name(*i) == surface).expect("a surface of that name")
    }

    fn lamp_from(state: usize, probe: &str, settings: &str) -> Unfolded {
        let stage = builtin("small-lamp").expect("a scene").at(state).expect("a state");
        let lamp = BTreeSet::from([number(&stage, "lamp") as u32]);
        unfold(&stage, number(&stage, probe), &settings.parse().expect("settings"), &lamp)
            .expect("a hemi-cube")
            .expect("a patch that takes part")
    }

    fn source_pixels(u: &Unfolded) -> Vec<(usize, Wrong)> {
        let top = &u.picture.faces[0];
        (0..top.shown.len()).filter(|k| top.shown[*k] == Shown::Source).map(|k| (k, top.wrong[k])).collect()
    }

    /// A lamp of edge s at distance d covers s / d of the top, whose pixels are 2 / N wide.
    #[test]
    fn a_lamp_covers_its_projection() {
        for (state, edge) in [(0, 0.5), (1, 0.4), (2, 0.2)] {
            for (probe, resolution) in [("probe-axis", 50), ("probe-off-centre", 50), ("probe-centred-100", 100)] {
                let u = lamp_from(state, probe, &format!("resolution={resolution}"));
                let across = edge / 10.0 * f64::from(resolution) / 2.0;
                // Each side of the square is off by half a fine pixel at most.
                let unsure = 2.0 * across / 8.0 + 1.0 / 64.0;
                assert!((u.covered_pixels - across * across).abs() <= unsure, "{probe}: {}", u.covered_pixels);
                let signed: f32 = u.picture.faces.iter().flat_map(|f| &f.wrong).map(|w| w.excess).sum();
                let expected = u.counted_pixels as f64 - u.covered_pixels;
                assert!((f64::from(signed) - expected).abs() < 1e-4, "what is counted and not covered is all there is");
            }
        }
    }

    #[test]
    fn a_missed_lamp_and_a_doubled_one() {
        let missed = lamp_from(2, "probe-axis", "resolution=50");
        assert_eq!((missed.counted, missed.counted_pixels), (0.0, 0));
        assert!((missed.finer / 1.2730698032e-4 - 1.0).abs() < 1e-3, "0.5 pixels are 4 of the finer: {}", missed.finer);
        let top = &missed.picture.faces[0];
        let short: Vec<f32> = top.wrong.iter().map(|w| w.excess).filter(|e| *e != 0.0).collect();
        assert_eq!(short, [-0.0625; 4], "a quarter of a pixel squared in each of four");
        assert!(missed.caption("a", "b", None).contains("it is missed"));
        let doubled = lamp_from(0, "probe-axis", "resolution=50");
        assert!((doubled.counted - 2.0339276856e-3).abs() < 1e-12);
        assert!((doubled.finer / 7.9511214958e-4 - 1.0).abs() < 1e-3, "{}", doubled.finer);
        let around: Vec<usize> = source_pixels(&doubled).into_iter().map(|(k, _)| k).collect();
        assert_eq!(around, [24 * 50 + 24, 24 * 50 + 25, 25 * 50 + 24, 25 * 50 + 25]);
        for (_, wrong) in source_pixels(&doubled) {
            assert!((wrong.excess - 0.609_375).abs() < 1e-6, "5/8 of a pixel each way are covered: {}", wrong.excess);
        }
    }

    #[test]
    fn the_silhouette_of_the_source_is_its_projection() {
        let u = lamp_from(0, "probe-axis", "resolution=50");
        let of = |face: usize| u.picture.faces[face].silhouettes.iter().filter(|s| s.outline == Outline::Source);
        let ends: Vec<[f64; 2]> = of(0).flat_map(|s| s.ends).collect();
        assert_eq!(ends.len(), 8);
        assert!(ends.iter().flatten().all(|c| (c.abs() - 0.025).abs() < 1e-12), "{ends:?}");
        assert!((1..5).all(|face| of(face).count() == 0));
    }

    /// The lamp of the Cornell box is 3 x 2 patches; one corner of the floor sees it whole, a place behind a block not at all.
    #[test]
    fn silhouettes_go_around_a_source_of_many_patches_where_it_is_seen() {
        let stage = builtin("cornell-box").expect("a scene").at(0).expect("a state");
        let lamp = (0..stage.patch_count()).filter(|i| stage.surface_name(*i) == "light").map(|i| i as u32).collect();
        for (patch, edges) in [(1, 10), (120, 0)] {
            let u = unfold(&stage, patch, &"resolution=50".parse().expect("settings"), &lamp);
            let u = u.expect("a hemi-cube").expect("a patch");
            let all = u.picture.faces.iter().flat_map(|f| &f.silhouettes);
            assert_eq!(all.filter(|s| s.outline == Outline::Source).count(), edges, "patch {patch}");
            assert_eq!(u.covered_pixels > 0.0, edges > 0);
        }
    }

    /// In a cube the ceiling's edges lie on edges of pixels, and so do the walls' but for the upright ones, which run
    /// along the diagonals of the top.
    #[test]
    fn pixels_are_wrong_where_edges_cross_them_and_nowhere_else() {
        let stage = builtin("cube-one-emitter").expect("a scene").at(0).expect("a state");
        let u = unfold(&stage, 0, &"resolution=40".parse().expect("settings"), &BTreeSet::new());
        let u = u.expect("a hemi-cube").expect("a patch");
        assert!(u.picture.faces[1..].iter().flat_map(|f| &f.wrong).all(|w| *w == Wrong::default()));
        let top = &u.picture.faces[0];
        for (k, wrong) in top.wrong.iter().enumerate() {
            let (column, row) = (k % 40, k / 40);
            let crossed = (column == row || column + row == 39) && !(10..30).contains(&row);
            assert_eq!(wrong.mixed > 0.0, crossed, "{column} {row}");
            assert!(!crossed || (wrong.mixed - 0.5).abs() <= 1.0 / 16.0, "cut in half: {}", wrong.mixed);
        }
        assert!(top.silhouettes.iter().all(|s| s.outline == Outline::Surfaces));
        // Four walls stand around the ceiling, whose edge is half as long as the top's.
        let length = |s: &crate::render::Silhouette| (s.ends[0][0] - s.ends[1][0]).hypot(s.ends[0][1] - s.ends[1][1]);
        assert!(top.silhouettes.iter().map(length).sum::<f64>() >= 4.0);
        assert!(unfold(&stage, 99, &Params::default(), &BTreeSet::new()).expect("no error").is_none());
    }
}
