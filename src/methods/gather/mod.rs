//! The full-matrix method with ray-cast form factors: gather until nothing changes.

mod params;

pub use params::Params;

use crate::estimate::{Casting, Plan, cast, patch_emitters};
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};

/// Casts the candidate's rays: never the judge's, whatever the seed.
pub fn form_factors(tracer: &Tracer, params: &Params, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Casting {
    let plan = Plan { rays: params.rays, randomisations: params.randomisations, ..Plan::default() };
    let stream = Stream::new(Role::Candidate, seed);
    cast(tracer, &patch_emitters(tracer.stage()), stream, &plan, &|_| 0.0, progress)
}
