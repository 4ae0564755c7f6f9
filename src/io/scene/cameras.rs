//! `[[camera]]`.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::raw;
use crate::math::DVec3;
use crate::view::Camera;

/// Largest side of a picture, pixels.
const MAX_SIDE: i64 = 16_384;

/// Reads all cameras. Defaults: up +z, 60 degrees, 640 x 480.
pub(super) fn cameras(check: Check, tables: &[raw::Camera]) -> Checked<Vec<Camera>> {
    let mut cameras: Vec<Camera> = Vec::new();
    for table in tables {
        let camera = camera(check, table)?;
        if cameras.iter().any(|c| c.name == camera.name) {
            return check.refuse(
                Refusal::Name,
                table.name.span(),
                format!("a second camera \"{}\"", camera.name),
                "give every camera its own name",
            );
        }
        cameras.push(camera);
    }
    Ok(cameras)
}

fn camera(check: Check, table: &raw::Camera) -> Checked<Camera> {
    let eye = check.point("eye", &table.eye)?;
    let target = check.point("target", &table.target)?;
    let up = table.up.as_ref().map_or(Ok(DVec3::Z), |u| check.direction("up", u))?;
    let forward = (target - eye).normalize_or_zero();
    if forward == DVec3::ZERO {
        return check.refuse(Refusal::Number, table.target.span(), "eye and target are the same point", "move one");
    }
    if forward.cross(up.normalize()).length() < 1e-6 {
        let span = table.up.as_ref().unwrap_or(&table.target).span();
        return check.refuse(
            Refusal::Number,
            span,
            "up runs along the direction of view",
            "give another up, such as [0, 1, 0]",
        );
    }
    Ok(Camera {
        name: check.name("camera name", &table.name)?,
        eye,
        target,
        up,
        fov: fov(check, table)?,
        size: size(check, table)?,
    })
}

fn fov(check: Check, table: &raw::Camera) -> Checked<f64> {
    let Some(value) = &table.fov else { return Ok(60.0) };
    let fov = check.positive("fov", value)?;
    match fov < 180.0 {
        true => Ok(fov),
        false => check.refuse(
            Refusal::Number,
            value.span(),
            format!("fov is {fov} degrees"),
            "give a vertical angle between 0 and 180 degrees",
        ),
    }
}

fn size(check: Check, table: &raw::Camera) -> Checked<[u32; 2]> {
    let Some(value) = &table.size else { return Ok([640, 480]) };
    let refuse = |message: String| {
        check.refuse(Refusal::Counts, value.span(), message, format!("give [width, height], each from 1 to {MAX_SIDE}"))
    };
    let [w, h] = value.get_ref()[..] else { return refuse(format!("size has {} numbers", value.get_ref().len())) };
    let fits = |n: i64| (1..=MAX_SIDE).contains(&n);
    if fits(w) && fits(h) { Ok([w as u32, h as u32]) } else { refuse(format!("size is {w} x {h}")) }
}
