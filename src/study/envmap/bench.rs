//! What all parts of the audit share: the scene with and without the object, its light, maps of it.

use super::record::Parts;
use super::request::EnvmapRequest;
use crate::audit::envmap::{Lobe, Station, gather, relative_error, weighted_share};
use crate::math::DVec3;
use crate::raycast::Tracer;
use crate::render::{Centre, WorldView};
use crate::sampling::Stream;
use crate::world::{Cone, DiffuseMap, Layout, Pyramid, Shape};
use std::f64::consts::PI;

/// Numbers by station and replicate.
pub(super) type Gathered = Vec<Vec<f64>>;

pub(super) struct Bench<'a> {
    pub request: &'a EnvmapRequest,
    /// Everything that stands there.
    pub full: Tracer<'a>,
    /// The same without the object: what the map shows.
    pub bare: Tracer<'a>,
    /// Luminance of each patch in each replicate.
    pub luminances: Vec<Vec<f64>>,
    /// Its mean.
    pub mean: Vec<f64>,
    /// The judge's.
    pub stream: Stream,
}

/// A map with what is looked up in it.
pub(super) struct Probe {
    pub centre: Centre,
    pub pyramid: Pyramid,
    pub table: DiffuseMap,
}

impl Probe {
    /// Irradiance by the table over a normal of the world.
    pub(super) fn irradiance(&self, normal: DVec3) -> f64 {
        self.table.lookup(self.centre.frame.to_local(normal))[0]
    }

    /// Mean B in a round cone about a direction of the world; half its opening angle, radians.
    pub(super) fn glossy(&self, axis: DVec3, half: f64) -> f64 {
        PI * self.pyramid.ewa(&Cone::round(self.centre.frame.to_local(axis), half))[0]
    }

    /// B in a direction of the world, as the texel there has it.
    pub(super) fn mirror(&self, direction: DVec3) -> f64 {
        let texel = self.pyramid.base().nearest(self.centre.frame.to_local(direction));
        texel.map_or(0.0, |l| PI * f64::from(l[0]))
    }
}

impl Bench<'_> {
    /// Rays of each replicate.
    pub(super) fn rays(&self) -> u64 {
        self.request.rays.div_ceil(self.luminances.len() as u64).next_power_of_two()
    }

    /// What is seen from a centre, the object taken away.
    pub(super) fn view(&self, centre: &Centre, layout: Layout, size: u32) -> WorldView {
        WorldView::cast(&self.bare, centre, Shape { layout, size }, self.request.samples)
    }

    /// Luminance map of a centre.
    pub(super) fn probe(&self, centre: Centre, size: u32) -> Probe {
        let map = self.view(&centre, Layout::Cube, size).radiances(&self.mean, 1);
        let table = DiffuseMap::new(&map, self.request.table);
        Probe { centre, pyramid: Pyramid::new(map), table }
    }

    /// What arrives with the object, or without it.
    pub(super) fn arrives(&self, with_object: bool, stations: &[Station], lobe: Lobe) -> Gathered {
        let tracer = if with_object { &self.full } else { &self.bare };
        gather(tracer, stations, lobe, &self.luminances, self.stream, self.rays())
    }

    /// The error of `map` and its parts: at the centre, at the point without the object, at the point with it.
    pub(super) fn parts(&self, map: &[f64], centre: &Gathered, without: &Gathered, truth: &Gathered) -> Parts {
        let confidence = self.request.confidence;
        let zip = |a: &Gathered, b: &Gathered| -> Gathered {
            a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect()
        };
        let replicates = self.luminances.len();
        let map: Gathered = map.iter().map(|m| vec![*m; replicates]).collect();
        let whole = zip(&map, truth);
        let three = [zip(&map, centre), zip(centre, without), zip(without, truth)];
        let error = |d: &Gathered| relative_error(d, truth, confidence);
        let total = error(&whole);
        let squared = weighted_share(&whole, &whole, truth).unwrap_or(0.0);
        let share =
            |d: &Gathered| weighted_share(&whole, d, truth).filter(|_| squared > 0.0).map_or(0.0, |s| s / squared);
        let sum = |g: &Gathered| g.iter().flatten().sum::<f64>();
        Parts {
            points: map.len(),
            total,
            map: error(&three[0]),
            parallax: error(&three[1]),
            occlusion: error(&three[2]),
            shares: [share(&three[0]), share(&three[1]), share(&three[2])],
            bias: if sum(truth) > 0.0 { sum(&whole) / sum(truth) } else { 0.0 },
        }
    }
}

/// Mean and standard error of replicates.
pub(super) fn mean_of(replicates: &[f64]) -> (f64, f64) {
    let m: crate::stats::Moments = replicates.iter().copied().collect();
    (m.mean, m.std_err().unwrap_or(0.0))
}
