//! What would mend a hemi-cube: form factors of the mended method, to be solved and judged like any other.

use super::seen::View;
use crate::estimate::PointSight;
use crate::math::{Bounds, DVec3};
use crate::methods::hemicube::{HemicubeError, Params, Stand, divided, drawn, rows_of, stands};
use crate::scene::{Patch, Stage};
use crate::solution::FormFactors;
use rayon::prelude::*;

/// Receivers that hold this share of the squared error of proximity and visibility are divided.
const SHARE_DIVIDED: f64 = 0.95;

/// Points along an edge of a receiver at which replaced form factors are averaged.
pub const POINTS: u32 = 3;

/// One way to mend.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Cure {
    /// As it is.
    None,
    /// More pixels.
    Resolution {
        /// Pixels along the top's edge.
        resolution: u32,
    },
    /// Every hemi-cube turned about its normal at random.
    Rotation,
    /// Sampling points shifted at random within the pixels, by hemi-cube.
    Jitter,
    /// Patches near the sources divided, with a hemi-cube on each part.
    Subdivision {
        /// Parts along an edge.
        cells: u32,
        /// Patches closer to a source than so many of their diameters are divided.
        distance: f64,
    },
    /// Form factors to the sources by closed forms past exact shadows, at a few points of the receiver.
    Analytic {
        /// Points along an edge of the receiver.
        points: u32,
    },
    /// Both of the last two.
    SubdivisionAndAnalytic {
        /// Parts along an edge.
        cells: u32,
        /// Diameters.
        distance: f64,
        /// Points along an edge of the receiver.
        points: u32,
    },
}

impl Cure {
    /// What it is, in words.
    pub fn words(&self) -> String {
        match self {
            Self::None => "as it is".into(),
            Self::Resolution { resolution } => format!("resolution {resolution}"),
            Self::Rotation => "each hemi-cube turned at random".into(),
            Self::Jitter => "pixels jittered".into(),
            Self::Subdivision { cells, distance } => {
                format!("patches within {distance:.1} diameters of a source in {cells} x {cells} parts")
            }
            Self::Analytic { points } => format!("sources by closed forms at {points} x {points} points"),
            Self::SubdivisionAndAnalytic { cells, distance, points } => format!(
                "sources by closed forms at {points} x {points} points, patches within {distance:.1} diameters in \
                 {cells} x {cells} parts"
            ),
        }
    }
}

/// A cured matrix and what it took.
#[derive(Debug)]
pub struct Cured {
    /// Form factors.
    pub form_factors: FormFactors,
    /// Hemi-cubes drawn.
    pub hemicubes: usize,
    /// Pixels drawn.
    pub pixels: u64,
    /// Points of exact visibility.
    pub points: usize,
}

/// A point of exact visibility takes about as long as so many pixels, with some tens of patches to look at.
const PIXELS_PER_POINT: u64 = 500;

impl Cured {
    /// What it took, in pixels: the same on every machine.
    pub fn work(&self) -> u64 {
        self.pixels + PIXELS_PER_POINT * self.points as u64
    }
}

/// Form factors by the mended method. `sources`: patches of the sources that are replaced or divided for.
pub fn cured(
    stage: &Stage,
    params: &Params,
    sources: &[u32],
    cure: &Cure,
    seed: u64,
    progress: &dyn Fn(usize),
) -> Result<Cured, HemicubeError> {
    let params = match cure {
        Cure::Resolution { resolution } => Params { resolution: *resolution, ..*params },
        Cure::Rotation => Params { turn: Some(seed), ..*params },
        Cure::Jitter => Params { jitter: Some(seed), ..*params },
        _ => *params,
    };
    let standing = match cure {
        Cure::Subdivision { cells, distance } | Cure::SubdivisionAndAnalytic { cells, distance, .. } => {
            divided_near(stage, &params, sources, *cells, *distance)
        }
        _ => stands(stage, &params),
    };
    let hemicubes = standing.iter().map(Vec::len).sum();
    let (mut form_factors, mut points) = (rows_of(stage, &standing, &params, progress)?, 0);
    if let Cure::Analytic { points: edge } | Cure::SubdivisionAndAnalytic { points: edge, .. } = cure {
        (form_factors, points) = replaced(stage, &form_factors, sources, *edge, &params);
    }
    let pixels = hemicubes as u64 * 3 * u64::from(params.resolution).pow(2);
    Ok(Cured { form_factors, hemicubes, pixels, points })
}

/// Hemi-cubes of all patches, several on those near a source.
fn divided_near(stage: &Stage, params: &Params, sources: &[u32], cells: u32, distance: f64) -> Vec<Vec<Stand>> {
    let boxes = boxes_of(stage, sources);
    let of = |(number, patch): (usize, &Patch)| {
        let near = patch.is_present() && diameters_to(patch, &boxes) < distance;
        drawn(divided(patch, if near { cells } else { 1 }, params), number, params)
    };
    stage.patches.iter().enumerate().map(of).collect()
}

fn boxes_of(stage: &Stage, sources: &[u32]) -> Vec<Bounds> {
    sources.iter().map(|j| Bounds::of(&stage.patches[*j as usize].corners)).collect()
}

/// Distance from a patch to the nearest of some boxes, in diameters of the patch.
fn diameters_to(patch: &Patch, boxes: &[Bounds]) -> f64 {
    let own = Bounds::of(&patch.corners);
    let size = (own.hi - own.lo).length();
    let gap = |b: &Bounds| {
        let apart = (b.lo - own.hi).max(own.lo - b.hi).max(DVec3::ZERO);
        apart.length()
    };
    boxes.iter().map(gap).fold(f64::INFINITY, f64::min) / size.max(f64::MIN_POSITIVE)
}

/// The matrix with the columns of the sources by exact sight from points of the receivers. Returns the points used.
fn replaced(stage: &Stage, f: &FormFactors, sources: &[u32], edge: u32, params: &Params) -> (FormFactors, usize) {
    let sight = PointSight::new(stage);
    let is_source = |j: u32| sources.binary_search(&j).is_ok();
    let row = |i: usize| {
        let patch = &stage.patches[i];
        let mut row: Vec<(u32, f64)> = f.row(i).map(|(j, v)| (j as u32, v)).filter(|(j, _)| !is_source(*j)).collect();
        let eyes = if patch.is_present() { divided(patch, edge, params) } else { Vec::new() };
        for eye in &eyes {
            let seen = sight.row_of(patch.facet, eye.eye, patch.normal, is_source);
            row.extend(seen.iter().map(|s| (s.patch, s.seen * eye.weight)));
        }
        row.sort_by_key(|e| e.0);
        row.dedup_by(|b, a| {
            let same = a.0 == b.0;
            a.1 += if same { b.1 } else { 0.0 };
            same
        });
        (row, eyes.len())
    };
    let rows: Vec<(Vec<(u32, f64)>, usize)> = (0..f.n).into_par_iter().map(row).collect();
    let points = rows.iter().map(|r| r.1).sum();
    (FormFactors::from_exact_rows(rows.into_iter().map(|r| r.0).collect()), points)
}

/// Within how many of its diameters of a source a patch has to be divided so that the patches divided hold nearly all
/// of the error that proximity and visibility bring; `None` where there is no such error. `errors`: luminance by
/// receiver.
pub fn subdivision_distance(stage: &Stage, sources: &[u32], errors: &[f64]) -> Option<f64> {
    let boxes = boxes_of(stage, sources);
    let present = (0..stage.patch_count()).filter(|i| stage.patches[*i].is_present());
    let mut by_distance: Vec<(f64, f64)> = present
        .map(|i| (diameters_to(&stage.patches[i], &boxes), stage.patches[i].area * errors[i] * errors[i]))
        .filter(|(d, _)| d.is_finite())
        .collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = by_distance.iter().map(|x| x.1).sum();
    if all == 0.0 {
        return None;
    }
    let mut held = 0.0;
    let reached = by_distance.iter().find(|(_, e)| {
        held += e;
        held >= SHARE_DIVIDED * all
    });
    // A little beyond the last of them, so that it is among them.
    reached.map(|(d, _)| (d * 1.001 + 0.05).max(0.1))
}

/// The resolution at which a source would cover enough pixels everywhere that counting them errs by `limit` at most: a
/// source of k pixels along an edge is counted as floor(k) to ceil(k), so about `2 / k` wrong at worst.
pub fn resolution_by_pixels(views: &[View], resolution: u32, limit: f64) -> Option<u32> {
    let smallest = views.iter().filter(|v| v.point > 0.0).map(|v| v.pixels).fold(f64::INFINITY, f64::min);
    let wanted = (2.0 / limit).powi(2);
    let factor = (wanted / smallest).sqrt().max(1.0);
    let resolution = (f64::from(resolution) * factor / 2.0).ceil() * 2.0;
    resolution.is_finite().then_some(resolution.min(1e9) as u32)
}
