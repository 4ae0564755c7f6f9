//! Embree through the published wrapper `embree4-rs`, unmodified, on our drop-in for its sys crate.
//!
//! Only what is sound of it is used: `Device::try_new(None)`, triangle meshes and `intersect_1`. The wrapper asks
//! for the error state after every ray and knows no packets, so it is slower than the kernel of its own.

#![allow(unsafe_code)]

use super::embree::{EmbreeKernel, Mesh, TracePacket};
use super::{BuiltinKernel, KernelError, KernelInfo};
use crate::scene::Stage;
use embree4_rs::geometry::TriangleMeshGeometry;
use embree4_rs::{CommittedScene, Device, Scene, SceneOptions};
use embree4_sys::*;
use std::sync::Arc;

/// Size of what `intersect_1` hands back.
#[expect(clippy::type_complexity, reason = "the signature is the wrapper's")]
const fn size_of_answer<Answer, E>(
    _: fn(&CommittedScene, RTCRay, Option<&RTCIntersectArguments>) -> Result<Option<Answer>, E>,
) -> usize {
    size_of::<Answer>()
}

// On the published sys crate the library would write past the wrapper's hit record. That build must not exist.
const _: () = assert!(
    size_of_answer(CommittedScene::intersect_1) == 256,
    "embree4-rs must be built on this workspace's embree4-sys: keep the [patch.crates-io] entry"
);

/// A committed scene of the wrapper.
pub struct Wrapped(CommittedScene);

// SAFETY: its handles are not bound to a thread: Embree counts references atomically and keeps errors per thread.
// The wrapper declares the other half, `Sync`, itself.
unsafe impl Send for Wrapped {}

impl EmbreeKernel<Wrapped> {
    /// Prepares a stage through the wrapper; `library` must be the one in use, `exact` of the same stage.
    ///
    /// # Errors
    /// [`KernelError::Failed`] if the wrapper reports an error.
    pub fn through_wrapper(library: &Library, stage: &Stage, exact: Arc<BuiltinKernel>) -> Result<Self, KernelError> {
        let mesh = Mesh::new(stage, &exact);
        let scene = Wrapped::new(&mesh)?;
        let info = KernelInfo {
            name: "embree4-rs".to_owned(),
            version: format!("0.0.16 on Embree {}", library.version()),
            path: Some(library.path().to_owned()),
            instruction_set: None,
        };
        Ok(Self::around(scene, mesh, info, stage, exact))
    }
}

impl Wrapped {
    fn new(mesh: &Mesh) -> Result<Self, KernelError> {
        let device = Device::try_new(None).map_err(|e| failed("making a device", &e))?;
        let corners: Vec<_> = mesh.corners.iter().map(|c| (c[0], c[1], c[2])).collect();
        let triangles: Vec<_> = mesh.triangles.iter().map(|t| (t[0], t[1], t[2])).collect();
        // An empty mesh is refused by Embree; a scene without geometry is not.
        let geometry = if triangles.is_empty() {
            None
        } else {
            let made = TriangleMeshGeometry::try_new(&device, &corners, &triangles);
            Some(made.map_err(|e| failed("copying the triangles", &e))?)
        };
        let options = SceneOptions { build_quality: RTCBuildQuality::HIGH, flags: RTCSceneFlags::ROBUST };
        let scene = Scene::try_new(device, options).map_err(|e| failed("making a scene", &e))?;
        if let Some(g) = &geometry {
            scene.attach_geometry(g).map_err(|e| failed("making a triangle mesh", &e))?;
        }
        scene.commit().map(Self).map_err(|e| failed("building the hierarchy", &e))
    }
}

impl TracePacket for Wrapped {
    fn trace(&self, packet: &mut RTCRayHit8, valid: &Valid8) {
        for k in (0..8).filter(|k| valid.0[*k] != 0) {
            // A ray the wrapper cannot trace stays without a hit, and escapes are decided again further up.
            if let Ok(Some(met)) = self.0.intersect_1(ray(&packet.ray, k), None) {
                packet.ray.tfar[k] = met.ray.tfar;
                packet.hit.primID[k] = met.hit.primID;
                packet.hit.geomID[k] = met.hit.geomID;
            }
        }
    }
}

fn ray(r: &RTCRay8, k: usize) -> RTCRay {
    RTCRay {
        org_x: r.org_x[k],
        org_y: r.org_y[k],
        org_z: r.org_z[k],
        dir_x: r.dir_x[k],
        dir_y: r.dir_y[k],
        dir_z: r.dir_z[k],
        ..RTCRay::default()
    }
}

fn failed(doing: &'static str, error: &impl ToString) -> KernelError {
    KernelError::Failed { doing, what: error.to_string() }
}
