//! Owned handles of the library: a device and a scene of triangles.

#![allow(unsafe_code)]

use super::{Mesh, TracePacket};
use crate::raycast::{KernelError, KernelInfo};
use embree4_sys::*;
use std::path::{Path, PathBuf};
use std::ptr::null_mut;

/// Loads a library and puts it into use for the whole process; the one in use is found again by any path.
pub(in crate::raycast) fn load(path: &Path) -> Result<&'static Library, LoadError> {
    // SAFETY: the places searched are the user's own settings, our own folder and the system's; whoever can
    // write there can already run code as this user.
    unsafe { embree4_sys::load(path) }
}

/// A device that builds and traces on the calling thread alone.
pub(super) struct Device(RTCDevice);

impl Device {
    pub(super) fn new() -> Result<Self, KernelError> {
        // SAFETY: a nul-terminated string; no device comes of a library that is not loaded.
        let handle = unsafe { rtcNewDevice(c"threads=1".as_ptr()) };
        if handle.is_null() {
            return Err(failed(handle, "making a device"));
        }
        Ok(Self(handle))
    }

    fn check(&self, doing: &'static str) -> Result<(), KernelError> {
        // SAFETY: a live device.
        match unsafe { rtcGetDeviceError(self.0) } {
            RTCError::NONE => Ok(()),
            code => Err(KernelError::Failed { doing, what: format!("{code:?}") }),
        }
    }

    fn has(&self, property: RTCDeviceProperty) -> bool {
        // SAFETY: a live device.
        unsafe { rtcGetDeviceProperty(self.0, property) != 0 }
    }

    /// What the library says of itself.
    pub(super) fn info(&self, library: &Library) -> KernelInfo {
        KernelInfo {
            name: "embree".to_owned(),
            version: library.version().to_string(),
            path: Some(where_mapped(library.path())),
            instruction_set: Some(self.instruction_set()),
        }
    }

    /// Embree picks its code by what the processor can do and tells only the widths it has code for.
    fn instruction_set(&self) -> String {
        let wide = self.has(RTCDeviceProperty::NATIVE_RAY16_SUPPORTED);
        let eight = self.has(RTCDeviceProperty::NATIVE_RAY8_SUPPORTED);
        name_of_set(wide, eight).to_owned()
    }
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn name_of_set(sixteen: bool, eight: bool) -> &'static str {
    match (sixteen, eight) {
        (true, _) => "avx512",
        (_, true) if std::arch::is_x86_feature_detected!("avx2") => "avx2",
        (_, true) => "avx",
        _ if std::arch::is_x86_feature_detected!("sse4.2") => "sse4.2",
        _ => "sse2",
    }
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn name_of_set(_sixteen: bool, eight: bool) -> &'static str {
    if eight { "neon, width 8" } else { "neon" }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: ours, and not used again.
        unsafe { rtcReleaseDevice(self.0) }
    }
}

fn failed(device: RTCDevice, doing: &'static str) -> KernelError {
    // SAFETY: a live device, or null to ask why there is none.
    let code = unsafe { rtcGetDeviceError(device) };
    KernelError::Failed { doing, what: format!("{code:?}") }
}

/// A committed scene of triangles; keeps its device alive.
pub struct Scene {
    handle: RTCScene,
    device: Device,
}

// SAFETY: a committed scene is only read, and Embree allows queries from any number of threads at once.
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

impl Scene {
    /// Builds the hierarchy over the triangles of a mesh.
    pub(super) fn new(device: Device, mesh: &Mesh) -> Result<Self, KernelError> {
        // SAFETY: a live device.
        let scene = Self { handle: unsafe { rtcNewScene(device.0) }, device };
        if scene.handle.is_null() {
            return Err(failed(scene.device.0, "making a scene"));
        }
        // SAFETY: a live scene.
        unsafe {
            rtcSetSceneFlags(scene.handle, RTCSceneFlags::ROBUST);
            rtcSetSceneBuildQuality(scene.handle, RTCBuildQuality::HIGH);
        }
        if !mesh.triangles.is_empty() {
            scene.attach(mesh)?;
        }
        // Joined: after two commits of the other kind on one thread a worker of TBB spins to the end of the process.
        // SAFETY: a live scene.
        unsafe { rtcJoinCommitScene(scene.handle) };
        scene.device.check("building the hierarchy")?;
        Ok(scene)
    }

    fn attach(&self, mesh: &Mesh) -> Result<(), KernelError> {
        // SAFETY: a live device.
        let geometry = unsafe { rtcNewGeometry(self.device.0, RTCGeometryType::TRIANGLE) };
        if geometry.is_null() {
            return Err(failed(self.device.0, "making a triangle mesh"));
        }
        let filled = fill(geometry, RTCBufferType::VERTEX, RTCFormat::FLOAT3, &mesh.corners)
            && fill(geometry, RTCBufferType::INDEX, RTCFormat::UINT3, &mesh.triangles);
        // SAFETY: live handles; the scene takes its own reference before ours is given back.
        unsafe {
            if filled {
                rtcCommitGeometry(geometry);
                rtcAttachGeometry(self.handle, geometry);
            }
            rtcReleaseGeometry(geometry);
        }
        self.device.check("copying the triangles")
    }
}

impl TracePacket for Scene {
    #[inline]
    fn trace(&self, packet: &mut RTCRayHit8, valid: &Valid8) {
        // SAFETY: a committed scene; aligned structs with the room the probe has checked.
        unsafe { rtcIntersect8(valid, self.handle, packet, null_mut()) }
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: ours, and not used again.
            unsafe { rtcReleaseScene(self.handle) }
        }
    }
}

/// Copies triples into a new buffer of a geometry; false if there is no memory for it.
fn fill<T: Copy>(geometry: RTCGeometry, kind: RTCBufferType, format: RTCFormat, triples: &[[T; 3]]) -> bool {
    const { assert!(size_of::<T>() == 4) };
    // SAFETY: a live geometry; the buffer holds as many triples of four bytes as are copied.
    unsafe {
        let buffer = rtcSetNewGeometryBuffer(geometry, kind, 0, format, 12, triples.len());
        if !buffer.is_null() {
            std::ptr::copy_nonoverlapping(triples.as_ptr(), buffer.cast(), triples.len());
        }
        !buffer.is_null()
    }
}

/// The file behind a bare name that the system's loader has found, where the system tells.
fn where_mapped(path: &Path) -> PathBuf {
    if path.components().count() > 1 {
        return path.to_owned();
    }
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    let files = maps.lines().filter_map(|line| line.find('/').map(|at| Path::new(&line[at..])));
    let mut embree = files.filter(|f| f.file_name().is_some_and(|n| n.to_string_lossy().starts_with("libembree4")));
    embree.next().unwrap_or(path).to_owned()
}
