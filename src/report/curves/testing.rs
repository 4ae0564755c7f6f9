//! A little run for the tests: two methods before and after an edit, by formula.

use super::{About, CurvesReport};
use crate::report::Phase;
use crate::stats::Estimate;
use crate::study::converge::{Curve, CurvePoint, digest};

/// Errors fall as `scale / shots`.
pub(super) fn curve(method: &str, edit: usize, scale: f64) -> Curve {
    let point = |k: u32| {
        let shots = if k == 0 { 0 } else { 5u64 << k };
        let value = scale / (shots.max(3)) as f64;
        let estimate = |v: f64| Estimate { value: v, std_err: Some(0.01 * v), low: 0.97 * v, high: 1.03 * v };
        CurvePoint {
            shots: shots + 1000 * edit as u64,
            rays: 64 * shots + 64_000 * edit as u64,
            seconds: 0.01 * shots as f64,
            shots_since_edit: shots,
            rays_since_edit: 64 * shots,
            seconds_since_edit: 0.01 * shots as f64,
            rms: Some(estimate(value)),
            top1: (edit > 0).then(|| estimate(3.0 * value)),
            noise_floor: Some(2e-4),
            top1_noise_floor: (edit > 0).then_some(5e-4),
        }
    };
    Curve { method: method.into(), edit, points: (0..9).map(point).collect() }
}

pub(super) fn report() -> CurvesReport {
    let methods = [("progressive:rays=256", 1.0), ("redistribution", 0.15)];
    let curves: Vec<Curve> =
        (0..2).flat_map(|edit| methods.map(|(m, s)| curve(m, edit, if edit == 0 { 1.0 } else { s }))).collect();
    let digest = digest(&curves, 0.95);
    let pair = |a: &str, b: &str| (a.to_string(), b.to_string());
    let about = About {
        scene: "a room <with> \"names\"".into(),
        confidence: 0.95,
        settings: vec![pair("--rays", "1024")],
        provenance: vec![pair("scene hash", "abc")],
        notices: Vec::new(),
        replay: "etalon converge room.toml".into(),
        timing: vec![Phase { name: "reference".into(), seconds: 1.5 }],
    };
    CurvesReport { about, curves, digest, pictures: Vec::new(), film: None }
}
