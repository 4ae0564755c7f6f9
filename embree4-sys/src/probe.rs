//! What does this library write, and where? Rays with known answers, traced into canary-filled memory.
//!
//! The number of instance levels and whether hits carry an `instPrimID` are build options that no device
//! property reports, so they are observed.

use crate::api::Api;
use crate::error::LoadError;
use crate::types::*;
use std::ffi::c_void;
use std::mem::{offset_of, size_of};
use std::path::Path;

/// Bytes of a struct that a library writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Runs of bytes written behind the fields that every 4.x has, as (first, one past the last).
    pub beyond: Vec<(usize, usize)>,
    /// Bytes the fields of every 4.x take.
    pub known: usize,
    /// Bytes this crate provides.
    pub room: usize,
}

/// What a library writes on a hit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Into [`RTCRayHit`].
    pub single: Written,
    /// Into [`RTCRayHit8`].
    pub packet8: Written,
}

/// Where the probe looks: far more than we provide, so that a library that writes too much is caught, not felt.
const ARENA: usize = 16 * 1024;

/// Memory for one probe, aligned for every struct.
#[repr(C, align(256))]
struct Arena([u8; ARENA]);

const CANARIES: [u8; 2] = [0xA5, 0x5A];

/// A device of a library that is not yet in use.
pub(crate) struct Device<'a> {
    api: &'a Api,
    handle: RTCDevice,
}

impl<'a> Device<'a> {
    pub(crate) fn new(api: &'a Api, path: &Path) -> Result<Self, LoadError> {
        // SAFETY: a nul-terminated string that outlives the call.
        let handle = unsafe { (api.rtcNewDevice)(c"threads=1".as_ptr()) };
        let device = Self { api, handle };
        if handle.is_null() { Err(device.broken(path, "making a device")) } else { Ok(device) }
    }

    pub(crate) fn property(&self, property: RTCDeviceProperty) -> isize {
        // SAFETY: a live device.
        unsafe { (self.api.rtcGetDeviceProperty)(self.handle, property) }
    }

    fn error(&self) -> RTCError {
        // SAFETY: a live device, or null to ask why there is none.
        unsafe { (self.api.rtcGetDeviceError)(self.handle) }
    }

    fn broken(&self, path: &Path, doing: &'static str) -> LoadError {
        LoadError::Broken { path: path.to_owned(), doing, what: format!("{:?}", self.error()) }
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: ours, and not used again.
            unsafe { (self.api.rtcReleaseDevice)(self.handle) }
        }
    }
}

/// The scene of the probe; the ray `(x, y, 5) + t (0, 0, -1)` meets the second triangle of the second geometry.
struct Scene<'a> {
    api: &'a Api,
    handle: RTCScene,
}

/// A triangle far away, and one tilted so that no two numbers of a hit are alike.
const VERTICES: [[f32; 3]; 6] =
    [[90.0, 0.0, 0.0], [91.0, 0.0, 0.0], [90.0, 1.0, 0.0], [0.0, 0.0, 1.0], [4.0, 0.0, 2.0], [0.0, 8.0, 3.0]];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [3, 4, 5]];
const X: f32 = 1.0;
const Y: f32 = 1.0;
const EXPECTED: Expected = Expected { t: 3.5, normal: [-8.0, -8.0, 32.0], u: 0.25, v: 0.125, prim: 1, geom: 1 };

/// The fields of a hit. `Ng` is compared by direction, as its length is not promised.
#[derive(Debug, Clone, Copy)]
struct Expected {
    t: f32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    prim: u32,
    geom: u32,
}

impl Expected {
    /// What differs, if anything.
    fn difference(&self, ray_t: f32, hit: &RTCHit) -> Option<String> {
        let close = |a: f32, b: f32| (a - b).abs() < 1e-4;
        let n = [hit.Ng_x, hit.Ng_y, hit.Ng_z];
        let scale = n[2] / self.normal[2];
        let along = (0..3).all(|k| close(n[k] / scale, self.normal[k])) && scale > 0.0;
        let same = close(ray_t, self.t) && close(hit.u, self.u) && close(hit.v, self.v) && along;
        let ids = (hit.primID, hit.geomID, hit.instID[0]) == (self.prim, self.geom, RTC_INVALID_GEOMETRY_ID);
        (!(same && ids)).then(|| format!("expected {self:?}, read t: {ray_t}, {hit:?}"))
    }
}

/// Traces rays with known answers and reports what was written; an error if anything is not as expected.
pub(crate) fn probe(device: &Device<'_>, path: &Path) -> Result<Layout, LoadError> {
    let scene = Scene::new(device, path)?;
    let unknown = |what| LoadError::UnknownLayout { path: path.to_owned(), what };
    let single = scene.trace_single().map_err(unknown)?;
    let packet8 = scene.trace_packet().map_err(unknown)?;
    Ok(Layout { single, packet8 })
}

impl<'a> Scene<'a> {
    fn new(device: &Device<'a>, path: &Path) -> Result<Self, LoadError> {
        let api = device.api;
        // SAFETY: a live device.
        let scene = Self { api, handle: unsafe { (api.rtcNewScene)(device.handle) } };
        if scene.handle.is_null() {
            return Err(device.broken(path, "making a scene"));
        }
        // The first geometry holds the far triangle only: the one to hit has number 1.
        for triangles in [&TRIANGLES[..1], &TRIANGLES[..]] {
            scene.attach(device, triangles).ok_or_else(|| device.broken(path, "making a triangle mesh"))?;
        }
        // Joined: after two commits of the other kind on one thread a worker of TBB spins to the end of the process.
        // SAFETY: a live scene.
        unsafe { (api.rtcJoinCommitScene)(scene.handle) };
        if device.error() == RTCError::NONE { Ok(scene) } else { Err(device.broken(path, "building a hierarchy")) }
    }

    fn attach(&self, device: &Device<'a>, triangles: &[[u32; 3]]) -> Option<()> {
        let api = self.api;
        // SAFETY: live handles; each buffer has room for what is copied; the scene keeps its own reference.
        unsafe {
            let geometry = (api.rtcNewGeometry)(device.handle, RTCGeometryType::TRIANGLE);
            if geometry.is_null() {
                return None;
            }
            let fill = |kind, format, from: *const u8, count: usize| {
                let to: *mut c_void = (api.rtcSetNewGeometryBuffer)(geometry, kind, 0, format, 12, count);
                (!to.is_null()).then(|| std::ptr::copy_nonoverlapping(from, to.cast(), 12 * count))
            };
            let done = fill(RTCBufferType::VERTEX, RTCFormat::FLOAT3, VERTICES.as_ptr().cast(), VERTICES.len())
                .and_then(|()| {
                    fill(RTCBufferType::INDEX, RTCFormat::UINT3, triangles.as_ptr().cast(), triangles.len())
                });
            if done.is_some() {
                (api.rtcCommitGeometry)(geometry);
                (api.rtcAttachGeometry)(self.handle, geometry);
            }
            (api.rtcReleaseGeometry)(geometry);
            done
        }
    }

    fn trace_single(&self) -> Result<Written, String> {
        let ray = RTCRay { org_x: X, org_y: Y, org_z: 5.0, dir_z: -1.0, ..RTCRay::default() };
        let known = offset_of!(RTCRayHit, hit) + size_of::<RTCHit>();
        let trace = |arena: &mut Arena| {
            let rayhit: *mut RTCRayHit = arena.0.as_mut_ptr().cast();
            // SAFETY: the arena is larger than the struct and aligned for it; the scene is committed.
            unsafe {
                (&raw mut (*rayhit).ray).write(ray);
                (&raw mut (*rayhit).hit).write(RTCHit::default());
                (self.api.rtcIntersect1)(self.handle, rayhit, std::ptr::null_mut());
                let (t, hit) = ((*rayhit).ray.tfar, (&raw const (*rayhit).hit).read());
                EXPECTED.difference(t, &hit).map_or(Ok(()), |d| Err(format!("single ray: {d}")))
            }
        };
        observe(trace, known, size_of::<RTCRayHit>())
    }

    fn trace_packet(&self) -> Result<Written, String> {
        let known = offset_of!(RTCRayHit8, hit) + size_of::<RTCHit8>();
        let trace = |arena: &mut Arena| {
            let rayhit: *mut RTCRayHit8 = arena.0.as_mut_ptr().cast();
            let fresh = packet();
            // SAFETY: as for the single ray.
            unsafe {
                (&raw mut (*rayhit).ray).write(fresh.ray);
                (&raw mut (*rayhit).hit).write(fresh.hit);
                (self.api.rtcIntersect8)(&Valid8([-1; 8]), self.handle, rayhit, std::ptr::null_mut());
                let (ray, hit) = ((&raw const (*rayhit).ray).read(), (&raw const (*rayhit).hit).read());
                check_lanes(&ray, &hit)
            }
        };
        observe(trace, known, size_of::<RTCRayHit8>())
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: ours, and not used again; null never gets here alive.
        if !self.handle.is_null() {
            unsafe { (self.api.rtcReleaseScene)(self.handle) }
        }
    }
}

/// Lane k looks from height 5 + k; odd lanes look past everything.
fn packet() -> RTCRayHit8 {
    let mut p = RTCRayHit8::default();
    for k in 0..8 {
        p.ray.org_x[k] = if k % 2 == 0 { X } else { -50.0 };
        p.ray.org_y[k] = Y;
        p.ray.org_z[k] = 5.0 + k as f32;
        p.ray.dir_z[k] = -1.0;
    }
    p
}

fn check_lanes(ray: &RTCRay8, hit: &RTCHit8) -> Result<(), String> {
    for k in 0..8 {
        let lane = lane(hit, k);
        let wrong = if k % 2 == 0 {
            Expected { t: EXPECTED.t + k as f32, ..EXPECTED }.difference(ray.tfar[k], &lane)
        } else {
            let missed = lane.geomID == RTC_INVALID_GEOMETRY_ID && ray.tfar[k] == f32::INFINITY;
            (!missed).then(|| format!("expected no hit, read {lane:?}"))
        };
        if let Some(what) = wrong {
            return Err(format!("ray {k} of 8: {what}"));
        }
    }
    Ok(())
}

fn lane(hit: &RTCHit8, k: usize) -> RTCHit {
    RTCHit {
        Ng_x: hit.Ng_x[k],
        Ng_y: hit.Ng_y[k],
        Ng_z: hit.Ng_z[k],
        u: hit.u[k],
        v: hit.v[k],
        primID: hit.primID[k],
        geomID: hit.geomID[k],
        instID: [hit.instID[0][k]],
    }
}

/// Runs a trace on two different canaries: a byte counts as written if it changed in either.
fn observe(trace: impl Fn(&mut Arena) -> Result<(), String>, known: usize, room: usize) -> Result<Written, String> {
    let mut changed = vec![false; ARENA];
    for canary in CANARIES {
        let mut arena = Box::new(Arena([canary; ARENA]));
        trace(&mut arena)?;
        changed.iter_mut().zip(arena.0).for_each(|(c, byte)| *c |= byte != canary);
    }
    let beyond = runs(&changed, known);
    match beyond.last() {
        Some(&(_, end)) if end > room => Err(format!("it writes up to byte {end} of a struct of {room}")),
        _ => Ok(Written { beyond, known, room }),
    }
}

/// Runs of `true` from `start` on, as (first, one past the last).
fn runs(changed: &[bool], start: usize) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for i in (start..changed.len()).filter(|&i| changed[i]) {
        match runs.last_mut() {
            Some(run) if run.1 == i => run.1 = i + 1,
            _ => runs.push((i, i + 1)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writes_behind_the_known_fields_are_found() {
        let trace = |arena: &mut Arena| {
            arena.0[3] = 1;
            arena.0[80..84].copy_from_slice(&[0xA5, 1, 2, 0x5A]);
            arena.0[90] = 0;
            Ok(())
        };
        let w = observe(trace, 80, 256).unwrap();
        assert_eq!(w.beyond, [(80, 84), (90, 91)]);
    }

    #[test]
    fn writes_beyond_the_room_are_refused() {
        let trace = |arena: &mut Arena| {
            arena.0[256] = 7;
            Ok(())
        };
        assert_eq!(observe(trace, 80, 256).unwrap_err(), "it writes up to byte 257 of a struct of 256");
    }

    #[test]
    fn a_field_out_of_place_is_noticed() {
        let good = RTCHit {
            Ng_x: -8.0,
            Ng_y: -8.0,
            Ng_z: 32.0,
            u: 0.25,
            v: 0.125,
            primID: 1,
            geomID: 1,
            instID: [RTC_INVALID_GEOMETRY_ID],
        };
        assert_eq!(EXPECTED.difference(3.5, &good), None);
        assert!(EXPECTED.difference(3.5, &RTCHit { u: 0.125, v: 0.25, ..good }).is_some());
        assert!(EXPECTED.difference(3.5, &RTCHit { primID: 0, ..good }).is_some());
        assert!(EXPECTED.difference(3.5, &RTCHit { Ng_x: 8.0, ..good }).is_some());
        assert!(EXPECTED.difference(3.5, &RTCHit { instID: [0], ..good }).is_some());
        assert!(EXPECTED.difference(3.0, &good).is_some());
    }
}
