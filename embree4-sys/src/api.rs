//! The functions, under their C names.

use crate::load::loaded;
use crate::types::*;
use std::ffi::{c_char, c_void};
use std::ptr::null_mut;

macro_rules! api {
    ($($(#[$doc:meta])* fn $f:ident($($a:ident: $t:ty),*) $(-> $r:ty, else $otherwise:expr)?;)*) => {
        /// Addresses of all functions in one library.
        #[derive(Clone, Copy)]
        pub(crate) struct Api { $(pub(crate) $f: unsafe extern "C" fn($($t),*) $(-> $r)?,)* }

        impl Api {
            /// Looks all functions up; the error is the first name that is missing.
            ///
            /// # Safety
            /// A symbol of that name must be the function of Embree 4.
            pub(crate) unsafe fn resolve(library: &libloading::Library) -> Result<Self, &'static str> {
                Ok(Self { $($f: {
                    // SAFETY: name and signature are those of the Embree 4 headers; the caller vouches for the rest.
                    let symbol = unsafe { library.get(stringify!($f)) };
                    *symbol.map_err(|_| stringify!($f))?
                },)* })
            }
        }

        $($(#[$doc])*
        ///
        /// # Safety
        /// As in the Embree 4 documentation: live handles, and pointers to the structs of this crate.
        pub unsafe fn $f($($a: $t),*) $(-> $r)? {
            match loaded() {
                // SAFETY: the address belongs to a library that passed the probe and is never unloaded.
                Some(library) => unsafe { (library.api.$f)($($a),*) },
                None => { $($otherwise as $r)? }
            }
        })*
    };
}

api! {
    /// New device; null on failure.
    fn rtcNewDevice(config: *const c_char) -> RTCDevice, else null_mut();
    /// One more reference to a device.
    fn rtcRetainDevice(device: RTCDevice);
    /// One reference less.
    fn rtcReleaseDevice(device: RTCDevice);
    /// A property of a device.
    fn rtcGetDeviceProperty(device: RTCDevice, property: RTCDeviceProperty) -> isize, else 0;
    /// First error since the last call of this function on this thread; of a null device: why there is none.
    fn rtcGetDeviceError(device: RTCDevice) -> RTCError, else RTCError::UNKNOWN;
    /// Sets the function called on errors.
    fn rtcSetDeviceErrorFunction(device: RTCDevice, function: RTCErrorFunction, user: *mut c_void);
    /// New scene; null on failure.
    fn rtcNewScene(device: RTCDevice) -> RTCScene, else null_mut();
    /// One more reference to a scene.
    fn rtcRetainScene(scene: RTCScene);
    /// One reference less.
    fn rtcReleaseScene(scene: RTCScene);
    /// Quality of the hierarchy to be built.
    fn rtcSetSceneBuildQuality(scene: RTCScene, quality: RTCBuildQuality);
    /// Options of a scene.
    fn rtcSetSceneFlags(scene: RTCScene, flags: RTCSceneFlags);
    /// Adds a geometry; its number.
    fn rtcAttachGeometry(scene: RTCScene, geometry: RTCGeometry) -> u32, else RTC_INVALID_GEOMETRY_ID;
    /// Builds the hierarchy.
    fn rtcCommitScene(scene: RTCScene);
    /// Builds the hierarchy on the threads that call this: on the calling one alone, if no other does.
    fn rtcJoinCommitScene(scene: RTCScene);
    /// Box around a committed scene.
    fn rtcGetSceneBounds(scene: RTCScene, bounds: *mut RTCBounds);
    /// First hit of one ray.
    fn rtcIntersect1(scene: RTCScene, rayhit: *mut RTCRayHit, args: *mut RTCIntersectArguments);
    /// First hits of eight rays.
    fn rtcIntersect8(valid: *const Valid8, scene: RTCScene, rayhit: *mut RTCRayHit8, args: *mut RTCIntersectArguments);
    /// New geometry; null on failure.
    fn rtcNewGeometry(device: RTCDevice, kind: RTCGeometryType) -> RTCGeometry, else null_mut();
    /// One more reference to a geometry.
    fn rtcRetainGeometry(geometry: RTCGeometry);
    /// One reference less.
    fn rtcReleaseGeometry(geometry: RTCGeometry);
    /// Declares a geometry complete.
    fn rtcCommitGeometry(geometry: RTCGeometry);
    /// New buffer, owned by the geometry; null on failure.
    fn rtcSetNewGeometryBuffer(
        geometry: RTCGeometry,
        kind: RTCBufferType,
        slot: u32,
        format: RTCFormat,
        stride: usize,
        count: usize
    ) -> *mut c_void, else null_mut();
    /// Number of primitives of a user geometry.
    fn rtcSetGeometryUserPrimitiveCount(geometry: RTCGeometry, count: u32);
    /// Pointer handed to callbacks.
    fn rtcSetGeometryUserData(geometry: RTCGeometry, user: *mut c_void);
    /// Bounds callback of a user geometry.
    fn rtcSetGeometryBoundsFunction(geometry: RTCGeometry, function: RTCBoundsFunction, user: *mut c_void);
    /// Intersection callback of a user geometry.
    fn rtcSetGeometryIntersectFunction(geometry: RTCGeometry, function: RTCIntersectFunctionN);
}
