//! Small stages and lights for the tests of the judge.

use crate::math::DVec3;
use crate::raycast::{BuiltinKernel, Tracer};
use crate::sampling::{Role, Stream};
use crate::scene::{Light, LightShape, Material, Picture, Stage};
use crate::view::Camera;
use std::sync::Arc;

/// A tracer on the built-in kernel.
pub(super) fn tracer(stage: &Stage) -> Tracer<'_> {
    let kernel = Arc::new(BuiltinKernel::new(stage));
    Tracer::new(stage, kernel.clone(), kernel, false)
}

pub(super) fn stream() -> Stream {
    Stream::new(Role::Judge, 10)
}

/// A horizontal rectangle, front up or down.
pub(super) fn flat(x: [f64; 2], y: [f64; 2], z: f64, up: bool) -> Vec<DVec3> {
    let mut v: Vec<DVec3> =
        [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])].map(|(a, b)| DVec3::new(a, b, z)).to_vec();
    if !up {
        v.reverse();
    }
    v
}

/// A wall across y, its front towards the eye at lower y.
pub(super) fn wall(y: f64, x: [f64; 2], z: [f64; 2]) -> Vec<DVec3> {
    [(x[0], z[0]), (x[1], z[0]), (x[1], z[1]), (x[0], z[1])].map(|(a, c)| DVec3::new(a, y, c)).to_vec()
}

pub(super) fn light(shape: LightShape) -> Light {
    Light { name: "l".into(), strength: vec![1.0; 3], shape }
}

/// Polygons each of a material of its own: (name, reflectance, emission).
pub(super) fn stage(polygons: &[(Vec<DVec3>, &str, f64, f64)]) -> Stage {
    let mut stage = Stage::from_polygons(&polygons.iter().map(|p| p.0.clone()).collect::<Vec<_>>());
    let material = |(_, name, rho, emission): &(Vec<DVec3>, &str, f64, f64)| Material {
        name: (*name).into(),
        reflectance: vec![*rho; 3],
        emission: vec![*emission; 3],
    };
    stage.materials = polygons.iter().map(material).collect();
    stage.patches.iter_mut().zip(0..).for_each(|(p, k)| p.material = k);
    stage
}

/// An eye in the origin that looks along y.
pub(super) fn camera(size: [u32; 2]) -> Camera {
    Camera { name: "c".into(), eye: DVec3::ZERO, target: DVec3::Y, up: DVec3::Z, fov: 60.0, size }
}

pub(super) fn picture(size: [u32; 2], rgba: impl Fn(u32, u32) -> [u8; 4]) -> Picture {
    let rgba = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).flat_map(|(x, y)| rgba(x, y)).collect();
    Picture { name: "p".into(), size, rgba }
}
