//! The judge of light: what one lamp brings a point, by rays to places of the lamp.

use super::lamp::{Aim, Lamp};
use super::net::{Net, Pair};
use crate::math::DVec3;
use crate::raycast::{RayBatch, Tracer};
use crate::sampling::Stream;
use crate::scene::Light;
use crate::stats::Moments;

/// Independent randomisations whose spread is the standard error.
pub const RANDOMISATIONS: u64 = 16;

/// What is met this share of the way before the lamp stands between: a lamp may lie on a surface.
pub(super) const SHORT_OF_THE_LAMP: f64 = 1.0 - 1e-9;

/// Rays of one batch.
const BATCH: usize = 4096;

/// Irradiance by single lamps in a stage, all of whose facets hide what is behind them.
pub struct LightJudge<'a> {
    tracer: &'a Tracer<'a>,
}

impl<'a> LightJudge<'a> {
    /// A judge on a tracer's stage.
    pub fn new(tracer: &'a Tracer<'a>) -> Self {
        Self { tracer }
    }

    /// The factor of a lamp, irradiance per strength, at a point (m) of a surface with a unit normal, and its standard
    /// error. `from` is the facet that the point lies on: it hides nothing; [`crate::scene::NO_FACET`] for none.
    ///
    /// About `samples` rays in [`RANDOMISATIONS`] randomisations; the standard error is their spread's, with 15 degrees
    /// of freedom. Parallel and point lights take one ray and have no error. Where all samples agree the error is 0 to
    /// rounding, and where less than about 1 / `samples` of a lamp is seen it is not known.
    pub fn irradiance(
        &self,
        point: DVec3,
        normal: DVec3,
        from: u32,
        light: &Light,
        samples: u64,
        stream: Stream,
    ) -> (f64, f64) {
        let lamp = Lamp::new(light);
        if lamp.is_hard() {
            let aims = [lamp.aim(point, normal, [0.5; 2])];
            return (self.received(point, from, &aims)[0], 0.0);
        }
        let net = Net::new(stream, samples.div_ceil(RANDOMISATIONS));
        let all = (0..RANDOMISATIONS).flat_map(|r| {
            let shift = net.shift(0, r, 0);
            let (net, lamp) = (&net, &lamp);
            (0..net.len()).map(move |k| lamp.aim(point, normal, net.at(k, Pair::First, shift)))
        });
        let aims: Vec<Option<Aim>> = all.collect();
        let values = self.received(point, from, &aims);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let moments: Moments = values.chunks_exact(net.len()).map(mean).collect();
        (moments.mean, moments.std_err().unwrap_or(0.0))
    }

    /// What each look brings: its factor, or nothing where something stands between.
    fn received(&self, point: DVec3, from: u32, aims: &[Option<Aim>]) -> Vec<f64> {
        let mut values = vec![0.0; aims.len()];
        let looks: Vec<(usize, Aim)> = aims.iter().enumerate().filter_map(|(k, a)| Some((k, (*a)?))).collect();
        let mut rays = RayBatch { from, ..RayBatch::default() };
        for part in looks.chunks(BATCH) {
            rays.resize(part.len());
            part.iter().enumerate().for_each(|(k, (_, a))| rays.set(k, point, a.direction));
            for ((k, aim), hit) in part.iter().zip(self.tracer.look(&rays)) {
                let clear = hit.is_none_or(|(_, at, _)| at.distance(point) >= aim.distance * SHORT_OF_THE_LAMP);
                values[*k] = if clear { aim.factor } else { 0.0 };
            }
        }
        values
    }
}
