//! Motion blur: a camera that turns while its shutter is open, drawn from a map [G86, "Modeling background objects"].

use crate::cli::exit::Failure;
use crate::math::{DMat3, DVec3};
use crate::view::Camera;
use crate::world::{Pyramid, WorldMap, swept, swept_exactly};
use rayon::prelude::*;

/// Pixels that are held against many instants, and how many.
const PROBES: usize = 16;
const INSTANTS: usize = 64;

/// A picture, and how far some of its pixels are from many instants (root mean square, relative).
pub(super) struct Blurred {
    pub values: Vec<f32>,
    pub off: f64,
}

/// What a camera sees that turns to `end` about the shortest way; `local` takes directions to those of the map.
pub(super) fn blurred(
    map: &WorldMap,
    camera: &Camera,
    end: DVec3,
    local: impl Fn(DVec3) -> DVec3 + Sync,
) -> Result<Blurred, Failure> {
    let begin = (camera.target - camera.eye).normalize();
    let end = end.try_normalize().ok_or_else(|| Failure::input("--turning-to: a direction cannot be 0,0,0"))?;
    let axis = begin.cross(end).try_normalize().unwrap_or(DVec3::Z);
    let angle = begin.angle_between(end);
    if angle > 3.1 {
        return Err(Failure::input("--turning-to: half a turn has no shortest way; turn less far"));
    }
    let [width, height] = camera.size.map(|n| n as usize);
    let path = |pixel: usize| {
        let (x, y) = ((pixel % width) as f64, (pixel / width) as f64);
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(dx, dy)| camera.direction(x + dx, y + dy));
        let local = &local;
        move |t: f64| {
            let turn = DMat3::from_axis_angle(axis, angle * t);
            corners.map(|d| local(turn * d))
        }
    };
    let pyramid = Pyramid::new(map.clone());
    let drawn = |pixel: usize| swept(&pyramid, path(pixel)).into_iter().map(|l| l as f32);
    let values: Vec<f32> = (0..width * height).into_par_iter().flat_map_iter(drawn).collect();
    let bands = map.bands();
    let probe = |k: usize| {
        let pixel = (2 * k + 1) * width * height / (2 * PROBES);
        let exact = swept_exactly(map, path(pixel), INSTANTS);
        let off = exact.iter().zip(&values[pixel * bands..]).map(|(e, v)| (f64::from(*v) - e).powi(2)).sum::<f64>();
        (off, exact.iter().map(|e| e * e).sum::<f64>())
    };
    let probes: Vec<(f64, f64)> = (0..PROBES).into_par_iter().map(probe).collect();
    let (d, t) = probes.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    Ok(Blurred { values, off: if t > 0.0 { (d / t).sqrt() } else { 0.0 } })
}

/// What is said of it.
pub(super) fn words(off: f64) -> String {
    format!(
        "blurred by the turn of the camera: {PROBES} pixels are {:.3} % (rms) off the exact mean of {INSTANTS} instants",
        100.0 * off
    )
}
