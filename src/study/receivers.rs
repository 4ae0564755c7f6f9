//! Irradiance at the receivers of a scene: radiosities first, then rays from every receiver.

use super::Session;
use crate::estimate::{Plan, irradiance};
use crate::reference::{self, Evidence, Kept, Options, Progress, ReferenceError};
use crate::sampling::{Role, Stream};
use crate::solution::Replicates;

/// Branch of the judge's stream that rays of receivers are drawn from: "rcv".
const RECEIVERS: u64 = 0x72_6376;

/// Irradiance at every receiver, W/m^2 per band, as replicates: their spread holds the errors of the radiosities and of
/// the receivers' own rays, of which there are as many as the plan has for a patch.
///
/// Where nothing reflects, radiosity is emission, and only receivers cast rays.
///
/// # Errors
/// If the radiosities cannot be solved.
pub fn at_receivers(
    session: &Session,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Replicates, ReferenceError> {
    let stage = session.stage();
    let tracer = session.tracer();
    let black = stage.reflectances().iter().all(|r| *r == 0.0);
    let radiosities = if black {
        let replicates = vec![stage.emissions(); usize::from(options.plan.randomisations)];
        Replicates { bands: stage.band_count(), replicates }
    } else {
        reference::compute_on(&tracer, options, &Evidence::default(), progress, Kept::NONE)?.patches
    };
    progress.begin("rays of receivers", None);
    let stream = Stream::new(Role::Judge, options.seed).child(RECEIVERS);
    let plan = Plan { target_error: None, max_time: None, ..options.plan };
    Ok(irradiance(&tracer, &radiosities, stream, plan.rays_per_randomisation()))
}
