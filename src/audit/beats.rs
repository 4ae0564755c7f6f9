//! Beats: where a source covers few pixels, the count goes up and down across a floor with the distance that the
//! grid of pixels and the grid of patches need to come into step again.

use crate::math::DVec3;
use crate::scene::Stage;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Patches along one line of a grid: (place, patch, ratio).
type Line = Vec<(u32, u32, f64)>;

/// A wave has to hold this share of the variance along its direction to be called one.
const LEAST_SHARE: f64 = 0.5;

/// Ratios that vary less than this are steady.
const LEAST_SPREAD: f64 = 0.05;

/// Rows of patches shorter than this show no wave.
const SHORTEST: usize = 8;

/// A wave of the ratio of hemi-cube to exact value across a surface.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Beat {
    /// Name of the surface.
    pub surface: String,
    /// 0 along the first edge of its patches, 1 along the second.
    pub axis: u8,
    /// Length of the wave, m.
    pub period: f64,
    /// The same in patches; 2 is as fast as patches can show.
    pub patches: f64,
    /// Share of the variance of the ratio along this direction that the wave holds.
    pub share: f64,
    /// Standard deviation of the ratio.
    pub spread: f64,
}

/// The strongest wave along each axis of a surface's grid: `ratios` of its patches.
pub(super) fn beats(stage: &Stage, ratios: &[(u32, f64)]) -> Vec<Beat> {
    let along = |axis: u8| {
        let mut rows: BTreeMap<(u32, u32), Line> = BTreeMap::new();
        for (patch, ratio) in ratios {
            let p = &stage.patches[*patch as usize];
            let (line, place) = if axis == 0 { (p.b, p.a) } else { (p.a, p.b) };
            rows.entry((p.facet, line)).or_default().push((place, *patch, *ratio));
        }
        rows.values_mut().for_each(|row| row.sort_by_key(|r| r.0));
        strongest(stage, axis, &rows.into_values().collect::<Vec<_>>())
    };
    [0, 1].into_iter().filter_map(along).collect()
}

/// Power over all rows at every frequency that the longest can tell apart.
fn strongest(stage: &Stage, axis: u8, rows: &[Line]) -> Option<Beat> {
    let long: Vec<&Line> = rows.iter().filter(|r| r.len() >= SHORTEST).collect();
    let longest = long.iter().map(|r| r.len()).max()?;
    let count = long.iter().map(|r| r.len()).sum::<usize>() as f64;
    let means: Vec<f64> = long.iter().map(|r| r.iter().map(|x| x.2).sum::<f64>() / r.len() as f64).collect();
    let variance = |r: &[(u32, u32, f64)], m: f64| r.iter().map(|x| (x.2 - m).powi(2)).sum::<f64>();
    let total: f64 = long.iter().zip(&means).map(|(r, m)| variance(r, *m)).sum();
    let spread = (total / count).sqrt();
    if spread < LEAST_SPREAD {
        return None;
    }
    let power = |frequency: f64| -> f64 {
        let of = |(row, mean): (&&Line, &f64)| {
            let (mut c, mut s) = (0.0, 0.0);
            for (place, _, ratio) in row.iter() {
                let phase = TAU * frequency * f64::from(*place);
                c += (ratio - mean) * phase.cos();
                s += (ratio - mean) * phase.sin();
            }
            // A pure wave of amplitude a has a^2 n / 2 of variance; at the fastest, only its cosine is left.
            let fold = if frequency > 0.499 { 1.0 } else { 2.0 };
            fold * (c * c + s * s) / row.len() as f64
        };
        long.iter().zip(&means).map(of).sum()
    };
    // At least two waves in the longest row: less is a trend.
    let steps = 2 * longest;
    let frequencies = (8..=steps).map(|k| 0.5 * k as f64 / steps as f64);
    let best = frequencies.map(|f| (f, power(f) / total)).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (first, second) = (long[0][0], long[0][1]);
    let centre = |j: u32| {
        let c = &stage.patches[j as usize].corners;
        c.iter().sum::<DVec3>() / c.len() as f64
    };
    let step = centre(first.1).distance(centre(second.1)) / f64::from(second.0 - first.0);
    (best.1 >= LEAST_SHARE).then(|| Beat {
        surface: stage.surfaces[stage.patches[first.1 as usize].surface as usize].name.clone(),
        axis,
        period: step / best.0,
        patches: 1.0 / best.0,
        share: best.1.min(1.0),
        spread,
    })
}
