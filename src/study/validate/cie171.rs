//! CIE 171:2006, *Test cases to assess the accuracy of lighting computer programs*: cases 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8.

use super::FALSE_ALARM;
use super::cie171_exact::{area_source, interreflection, point_source, reflector, reflector_behind_box};
use crate::estimate::{Plan, direct_light, lit_patches, patch_emitters};
use crate::io::scene::{SceneFileError, SceneOptions, open_scene};
use crate::math::{DVec3, compensated_sum};
use crate::raycast::{BACK, ESCAPED, KernelError, KernelKind, RayBatch, TraceScratch, Tracer};
use crate::reference::{Evidence, Kept, Options, Progress, ReferenceError, compute_on};
use crate::sampling::{Role, Stream};
use crate::scene::{Receiver, SceneError, Stage};
use crate::stats::{Moments, bonferroni_level, form_factor_interval, t_p_value};
use crate::study::{Session, at_receivers};
use serde::Serialize;
use std::f64::consts::TAU;

/// Deviation per point that practice allows with these cases.
pub const CIE_LIMIT: f64 = 0.05;

/// Deviations below this share of the exact value are rounding of ray directions and coordinates.
const ROUNDING: f64 = 1e-9;

/// Rays per patch of case 5.8 and from the source of 5.4, as a share of those per receiver.
const PATCH_SHARE: u64 = 16;

/// Rays of the small reflector's receivers, as a multiple of those of others: few rays meet it.
const SMALL_MULTIPLE: u64 = 8;

/// One value of the suite.
#[derive(Debug, Clone, Serialize)]
pub struct Measured {
    /// Number of the case in the report.
    pub case: &'static str,
    /// Point, or what is measured.
    pub what: String,
    /// `lx`, `%` or 1.
    pub unit: &'static str,
    /// Closed form.
    pub exact: f64,
    /// Ours.
    pub ours: f64,
    /// Standard error of ours; `None` where no ray brought it or none of them differed.
    pub std_err: Option<f64>,
    /// `ours / exact - 1`; `None` where the exact value is 0.
    pub deviation: Option<f64>,
    /// Difference in standard errors.
    pub z: Option<f64>,
    /// What it comes to.
    pub outcome: Outcome,
}

/// What a value comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Within [`CIE_LIMIT`], and the difference is one that its standard error explains.
    Pass,
    /// The difference is more than chance.
    Fail,
    /// Too few rays: a difference beyond the limit that its standard error explains.
    Inconclusive,
}

/// Why the suite cannot run.
#[derive(Debug, thiserror::Error)]
pub enum CieError {
    /// A scene cannot be read.
    #[error(transparent)]
    File(#[from] SceneFileError),
    /// A scene cannot be set up.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// No radiosities.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

/// A value before it is judged.
struct Found {
    case: &'static str,
    what: String,
    unit: &'static str,
    exact: f64,
    /// Independent replicates.
    values: Vec<f64>,
    /// Where every ray brings one radiosity or nothing: rays of a replicate, and that radiosity.
    yes_or_no: Option<(u64, f64)>,
}

/// Runs the suite: `plan.rays` rays for every receiver, eight times that for those of the small
/// reflector, a sixteenth for every patch of the interreflection case.
///
/// Each value is held against its closed form by Student's t over the replicates, or by the interval of a share where a
/// ray brings all or nothing. All tests together raise a false
/// alarm with a probability of at most [`super::FALSE_ALARM`].
///
/// # Errors
/// If a kernel cannot be had.
pub fn cie171(kernel: KernelKind, plan: &Plan, seed: u64, progress: &dyn Progress) -> Result<Vec<Measured>, CieError> {
    let options = Options { plan: *plan, seed };
    let mut found = Vec::new();
    let mut points = |case, scene, unit, exact: &dyn Fn(&Receiver) -> f64| -> Result<(), CieError> {
        found.extend(receivers(case, scene, unit, exact, kernel, &options, progress)?);
        Ok(())
    };
    points("5.2", "cie171-5-2", "lx", &point_source)?;
    points("5.3", "cie171-5-3", "lx", &area_source)?;
    points("5.6", "cie171-5-6", "%", &|r| reflector(r, 4.0))?;
    points("5.6", "cie171-5-6-large", "%", &|r| reflector(r, 500.0))?;
    points("5.7", "cie171-5-7", "%", &reflector_behind_box)?;
    let many = Options { plan: Plan { rays: plan.rays.saturating_mul(SMALL_MULTIPLE), ..*plan }, seed };
    let small = |r: &Receiver| reflector(r, 0.5);
    found.extend(receivers("5.6", "cie171-5-6-small", "%", &small, kernel, &many, progress)?);
    let few = Plan { rays: (plan.rays / PATCH_SHARE).max(1), ..*plan };
    let options = Options { plan: few, seed };
    found.extend(conservation(kernel, &options)?);
    found.extend(cube(kernel, &options, progress)?);
    found.sort_by_key(|f| f.case);
    let level = bonferroni_level(FALSE_ALARM, found.len());
    Ok(found.into_iter().map(|f| judged(f, level)).collect())
}

fn stages(scene: &str) -> Result<Vec<Stage>, CieError> {
    let scene = open_scene(&format!("builtin:{scene}"), &SceneOptions::default())?;
    Ok((0..=scene.edits.len()).map(|k| scene.at(k)).collect::<Result<_, _>>()?)
}

/// The cases that ask for illuminances at points.
fn receivers(
    case: &'static str,
    scene: &str,
    unit: &'static str,
    exact: &dyn Fn(&Receiver) -> f64,
    kernel: KernelKind,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Vec<Found>, CieError> {
    let mut all = Vec::new();
    for stage in stages(scene)? {
        let session = Session::open(&stage, kernel)?;
        let replicates = at_receivers(&session, options, progress)?.replicates;
        let bright = stage.emissions().into_iter().fold(0.0, f64::max);
        let yes_or_no = (bright > 0.0).then(|| (options.plan.rays_per_randomisation(), bright));
        let suffix = scene.strip_prefix("cie171-5-6-").map_or(String::new(), |s| format!(", {s} reflector"));
        all.extend(stage.receivers.iter().enumerate().map(|(k, receiver)| Found {
            case,
            what: format!("{}{suffix}", receiver.name),
            unit,
            exact: exact(receiver),
            values: replicates.iter().map(|r| r[k]).collect(),
            yes_or_no,
        }));
    }
    Ok(all)
}

/// Case 5.4, twice: what the surfaces receive, and what rays from the source arrive at.
fn conservation(kernel: KernelKind, options: &Options) -> Result<Vec<Found>, CieError> {
    let found =
        |what: &str, values| Found { case: "5.4", what: what.into(), unit: "1", exact: 1.0, values, yes_or_no: None };
    let mut all = Vec::new();
    for stage in stages("cie171-5-4")? {
        let session = Session::open(&stage, kernel)?;
        let tracer = session.tracer();
        let stream = Stream::new(Role::Judge, options.seed);
        let emitters = patch_emitters(&stage);
        let rays = options.plan.rays_per_randomisation();
        let direct = direct_light(&tracer, &lit_patches(&stage, &emitters), stream, rays, options.plan.randomisations);
        let emitted: f64 = stage.lights.iter().map(|l| l.solid_angle() * l.intensity[0]).sum();
        let areas = stage.areas();
        let arriving = |h: &Vec<f64>| compensated_sum(h.iter().zip(&areas).map(|(h, a)| h * a)) / emitted;
        let replicates = direct.map_or_else(Vec::new, |d| d.replicates());
        all.push(found("flux received by the surfaces", replicates.iter().map(arriving).collect()));
        let shares =
            (0..options.plan.randomisations).map(|r| share_arriving(&tracer, stream.child(u64::from(r)), rays));
        all.push(found("flux that rays of the source bring", shares.collect()));
    }
    Ok(all)
}

/// Share of the rays of the first light, sent in all directions alike, that land on a front.
fn share_arriving(tracer: &Tracer, stream: Stream, rays: u64) -> f64 {
    let from = tracer.stage().lights.first().map_or(DVec3::ZERO, |l| l.position);
    let mut batch = RayBatch::zeroed(rays as usize);
    for k in 0..rays {
        let (z, turn) = (2.0 * stream.unit(2 * k) - 1.0, TAU * stream.unit(2 * k + 1));
        let across = (1.0 - z * z).max(0.0).sqrt();
        batch.set(k as usize, from, DVec3::new(across * turn.cos(), across * turn.sin(), z).normalize());
    }
    let mut landings = vec![ESCAPED; rays as usize];
    tracer.trace(&batch, &mut landings, &mut TraceScratch::default());
    landings.iter().filter(|l| **l < BACK).count() as f64 / rays as f64
}

/// Case 5.8: what reaches the walls less what reaches them straight, for every reflectance.
fn cube(kernel: KernelKind, options: &Options, progress: &dyn Progress) -> Result<Vec<Found>, CieError> {
    let mut all = Vec::new();
    for stage in stages("cie171-5-8")? {
        let session = Session::open(&stage, kernel)?;
        let reference = compute_on(&session.tracer(), options, &Evidence::default(), progress, Kept::NONE)?;
        let (areas, rho) = (stage.areas(), stage.reflectance(0)[0]);
        let area: f64 = areas.iter().sum();
        let straight: f64 = stage.lights.iter().map(|l| l.solid_angle() * l.intensity[0]).sum::<f64>() / area;
        let indirect = |b: &Vec<f64>| {
            let mean = compensated_sum(b.iter().zip(&areas).map(|(b, a)| b * a)) / area;
            mean / rho - straight
        };
        all.push(Found {
            case: "5.8",
            what: format!("mean indirect, reflectance {rho}"),
            unit: "lx",
            exact: interreflection(rho),
            values: reference.patches.replicates.iter().map(indirect).collect(),
            yes_or_no: None,
        });
    }
    Ok(all)
}

/// Holds a value against its closed form, at a level for one value.
fn judged(found: Found, level: f64) -> Measured {
    let moments: Moments = found.values.iter().copied().collect();
    let (exact, ours) = (found.exact, moments.mean);
    let difference = ours - exact;
    let std_err = moments.std_err().filter(|s| *s > ROUNDING * exact.abs());
    let deviation = (exact != 0.0).then(|| difference / exact);
    let small = deviation.map_or(difference == 0.0, |d| d.abs() <= CIE_LIMIT);
    let outcome = match (is_consistent(&found, ours, std_err, level), small) {
        (false, _) => Outcome::Fail,
        (true, true) => Outcome::Pass,
        (true, false) => Outcome::Inconclusive,
    };
    let z = std_err.map(|s| difference / s);
    Measured { case: found.case, what: found.what, unit: found.unit, exact, ours, std_err, deviation, z, outcome }
}

/// Student's t on what rounding does not explain; where rays bring all or nothing, the interval of a share, which knows
/// about few hits and none.
fn is_consistent(found: &Found, ours: f64, std_err: Option<f64>, level: f64) -> bool {
    let rounding = ROUNDING * found.exact.abs();
    if let Some((rays, bright)) = found.yes_or_no {
        let hits: Vec<u64> = found.values.iter().map(|v| (v / bright * rays as f64).round() as u64).collect();
        let share = form_factor_interval(&hits, rays, 1.0 - level, None);
        return share.low * bright <= found.exact + rounding && found.exact - rounding <= share.high * bright;
    }
    let beyond = ((ours - found.exact).abs() - rounding).max(0.0);
    // A difference that is not a number is no agreement.
    !ours.is_nan() && t_p_value(beyond, std_err.unwrap_or(0.0), found.values.len() as f64 - 1.0) >= level
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(exact: f64, values: &[f64]) -> Outcome {
        let what = String::new();
        judged(Found { case: "5.2", what, unit: "lx", exact, values: values.to_vec(), yes_or_no: None }, 1e-8).outcome
    }

    #[test]
    fn three_outcomes() {
        assert_eq!(outcome(10.0, &[10.1, 9.9, 10.05, 9.95, 10.0, 10.0, 10.02, 9.98]), Outcome::Pass);
        assert_eq!(outcome(10.0, &[11.01, 11.0, 11.0, 11.0, 11.0, 11.0, 11.0, 10.99]), Outcome::Fail);
        // 4 % off is within practice's 5 %, and still more than chance.
        assert_eq!(outcome(10.0, &[10.4001, 10.4, 10.4, 10.4, 10.4, 10.4, 10.4, 10.3999]), Outcome::Fail);
        assert_eq!(outcome(10.0, &[14.0, 8.0, 13.0, 9.0, 14.0, 8.0, 13.0, 9.0]), Outcome::Inconclusive);
        // No spread: exact to rounding or wrong.
        assert_eq!(outcome(10.0, &[10.000_000_000_1; 8]), Outcome::Pass);
        assert_eq!(outcome(10.0, &[10.000_1; 8]), Outcome::Fail);
        assert_eq!((outcome(0.0, &[0.0; 8]), outcome(0.0, &[1e-9; 8])), (Outcome::Pass, Outcome::Fail));
        assert_eq!(outcome(10.0, &[f64::NAN; 8]), Outcome::Fail, "not a number is not a pass");
    }

    #[test]
    fn no_hit_is_not_a_fault_until_there_should_have_been_many() {
        let outcome = |rays| {
            let (what, values) = (String::new(), vec![0.0; 8]);
            let found = Found { case: "5.6", what, unit: "%", exact: 0.5, values, yes_or_no: Some((rays, 100.0)) };
            judged(found, 1e-8).outcome
        };
        // 0.5 % of the rays: 0.08 and 800 expected in all.
        assert_eq!((outcome(2), outcome(20_000)), (Outcome::Inconclusive, Outcome::Fail));
    }
}
