//! Types of the C interface. Values and layouts are those of the Embree 4 headers.

use std::ffi::{c_char, c_void};
use std::fmt;
use std::mem::{offset_of, size_of};
use std::ops::BitOr;

/// Marks a ray that met nothing.
pub const RTC_INVALID_GEOMETRY_ID: u32 = u32::MAX;

macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident = $opaque:ident;)*) => { $(
        #[doc(hidden)]
        #[repr(C)]
        pub struct $opaque { _private: [u8; 0] }
        $(#[$doc])*
        pub type $name = *mut $opaque;
    )* };
}

handles! {
    /// A device: the library's state.
    RTCDevice = RTCDeviceTy;
    /// A scene: geometries and their hierarchy.
    RTCScene = RTCSceneTy;
    /// A geometry: here a triangle mesh.
    RTCGeometry = RTCGeometryTy;
}

macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident { $($code:ident = $value:expr,)* })*) => { $(
        $(#[$doc])*
        ///
        /// A number, not a Rust enum: a library may return values this crate has never heard of.
        #[repr(transparent)]
        #[derive(Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $name(pub u32);

        #[allow(missing_docs)]
        impl $name { $(pub const $code: Self = Self($value);)* }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self.0 {
                    $($value => f.write_str(stringify!($code)),)*
                    other => write!(f, "{}({other})", stringify!($name)),
                }
            }
        }
    )* };
}

codes! {
    /// Error code.
    RTCError {
        NONE = 0, UNKNOWN = 1, INVALID_ARGUMENT = 2, INVALID_OPERATION = 3,
        OUT_OF_MEMORY = 4, UNSUPPORTED_CPU = 5, CANCELLED = 6,
    }
    /// Quality of the hierarchy.
    RTCBuildQuality { LOW = 0, MEDIUM = 1, HIGH = 2, REFIT = 3, }
    /// Options of a scene.
    RTCSceneFlags { NONE = 0, DYNAMIC = 1, COMPACT = 2, ROBUST = 4, FILTER_FUNCTION_IN_ARGUMENTS = 8, }
    /// Format of a buffer's entries.
    RTCFormat { UINT3 = 0x5003, FLOAT3 = 0x9003, }
    /// What a buffer holds.
    RTCBufferType { INDEX = 0, VERTEX = 1, }
    /// Kind of geometry.
    RTCGeometryType { TRIANGLE = 0, QUAD = 1, USER = 120, }
    /// What can be asked of a device.
    RTCDeviceProperty {
        VERSION = 0, VERSION_MAJOR = 1, VERSION_MINOR = 2, VERSION_PATCH = 3,
        NATIVE_RAY4_SUPPORTED = 32, NATIVE_RAY8_SUPPORTED = 33, NATIVE_RAY16_SUPPORTED = 34,
        RAY_MASK_SUPPORTED = 64, BACKFACE_CULLING_ENABLED = 65, FILTER_FUNCTION_SUPPORTED = 66,
        IGNORE_INVALID_RAYS_ENABLED = 67, TRIANGLE_GEOMETRY_SUPPORTED = 96, TASKING_SYSTEM = 128,
    }
    /// Options of a query.
    RTCRayQueryFlags { INCOHERENT = 0, INVOKE_ARGUMENT_FILTER = 2, COHERENT = 0x1_0000, }
}

impl Default for RTCBuildQuality {
    fn default() -> Self {
        Self::MEDIUM
    }
}

impl Default for RTCSceneFlags {
    fn default() -> Self {
        Self::NONE
    }
}

impl BitOr for RTCSceneFlags {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// A single ray.
#[repr(C, align(16))]
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct RTCRay {
    pub org_x: f32,
    pub org_y: f32,
    pub org_z: f32,
    pub tnear: f32,
    pub dir_x: f32,
    pub dir_y: f32,
    pub dir_z: f32,
    pub time: f32,
    pub tfar: f32,
    pub mask: u32,
    pub id: u32,
    pub flags: u32,
}

impl Default for RTCRay {
    /// No direction yet; unlimited, meets everything.
    fn default() -> Self {
        Self {
            org_x: 0.0,
            org_y: 0.0,
            org_z: 0.0,
            tnear: 0.0,
            dir_x: 0.0,
            dir_y: 0.0,
            dir_z: 0.0,
            time: 0.0,
            tfar: f32::INFINITY,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}

/// What a ray met: the fields that every 4.x has. Later fields land in the room of [`RTCRayHit`].
#[repr(C, align(16))]
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct RTCHit {
    pub Ng_x: f32,
    pub Ng_y: f32,
    pub Ng_z: f32,
    pub u: f32,
    pub v: f32,
    pub primID: u32,
    pub geomID: u32,
    pub instID: [u32; 1],
}

impl Default for RTCHit {
    /// Nothing met.
    fn default() -> Self {
        let none = RTC_INVALID_GEOMETRY_ID;
        Self { Ng_x: 0.0, Ng_y: 0.0, Ng_z: 0.0, u: 0.0, v: 0.0, primID: none, geomID: none, instID: [none] }
    }
}

/// A ray and what it met, 256 bytes.
///
/// The headers of 4.2 end at byte 80, those of 4.3 at 84, and a library built for deeper instancing writes
/// more. The alignment makes room for 22 levels without a field of its own, because the published wrapper
/// names every field when it makes one.
#[repr(C, align(256))]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[allow(missing_docs)]
pub struct RTCRayHit {
    pub ray: RTCRay,
    pub hit: RTCHit,
}

/// Eight rays, field by field.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCRay8 {
    pub org_x: [f32; 8],
    pub org_y: [f32; 8],
    pub org_z: [f32; 8],
    pub tnear: [f32; 8],
    pub dir_x: [f32; 8],
    pub dir_y: [f32; 8],
    pub dir_z: [f32; 8],
    pub time: [f32; 8],
    pub tfar: [f32; 8],
    pub mask: [u32; 8],
    pub id: [u32; 8],
    pub flags: [u32; 8],
}

/// What eight rays met: the fields that every 4.x has.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCHit8 {
    pub Ng_x: [f32; 8],
    pub Ng_y: [f32; 8],
    pub Ng_z: [f32; 8],
    pub u: [f32; 8],
    pub v: [f32; 8],
    pub primID: [u32; 8],
    pub geomID: [u32; 8],
    pub instID: [[u32; 8]; 1],
}

/// Eight rays and what they met, 2048 bytes: room for 22 levels of instances, as in [`RTCRayHit`].
#[repr(C, align(64))]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCRayHit8 {
    pub ray: RTCRay8,
    pub hit: RTCHit8,
    room: [u8; 1408],
}

impl Default for RTCRayHit8 {
    /// Unlimited rays without direction that have met nothing.
    fn default() -> Self {
        let (zero, none) = ([0.0; 8], [RTC_INVALID_GEOMETRY_ID; 8]);
        let ray = RTCRay8 {
            org_x: zero,
            org_y: zero,
            org_z: zero,
            tnear: zero,
            dir_x: zero,
            dir_y: zero,
            dir_z: zero,
            time: zero,
            tfar: [f32::INFINITY; 8],
            mask: [u32::MAX; 8],
            id: [0; 8],
            flags: [0; 8],
        };
        let hit = RTCHit8 {
            Ng_x: zero,
            Ng_y: zero,
            Ng_z: zero,
            u: zero,
            v: zero,
            primID: none,
            geomID: none,
            instID: [none],
        };
        Self { ray, hit, room: [0; 1408] }
    }
}

/// Which of eight rays take part: -1 or 0, aligned as Embree wants it.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy)]
pub struct Valid8(pub [i32; 8]);

// The layout the probe looks for; a mistake in the structs above is a compile error.
const _: () = {
    assert!(offset_of!(RTCRay, tfar) == 32 && size_of::<RTCRay>() == 48);
    assert!(offset_of!(RTCHit, geomID) == 24 && size_of::<RTCHit>() == 32);
    assert!(offset_of!(RTCRayHit, hit) == 48 && size_of::<RTCRayHit>() == 256);
    assert!(offset_of!(RTCRay8, tfar) == 256 && size_of::<RTCRay8>() == 384);
    assert!(offset_of!(RTCHit8, geomID) == 192 && size_of::<RTCHit8>() == 256);
    assert!(offset_of!(RTCRayHit8, hit) == 384 && size_of::<RTCRayHit8>() == 2048);
};

/// Box around a scene.
#[repr(C, align(16))]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[allow(missing_docs)]
pub struct RTCBounds {
    pub lower_x: f32,
    pub lower_y: f32,
    pub lower_z: f32,
    pub align0: f32,
    pub upper_x: f32,
    pub upper_y: f32,
    pub upper_z: f32,
    pub align1: f32,
}

/// Options of a query; a null pointer does as well. The room behind holds what build options append.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCIntersectArguments {
    pub flags: RTCRayQueryFlags,
    pub feature_mask: u32,
    pub context: *mut RTCRayQueryContext,
    pub filter: RTCFilterFunctionN,
    pub intersect: RTCIntersectFunctionN,
    #[doc(hidden)]
    pub room: [u64; 4],
}

impl Default for RTCIntersectArguments {
    /// What Embree takes for a null pointer: incoherent rays, all features, no callbacks.
    fn default() -> Self {
        Self {
            flags: RTCRayQueryFlags::INCOHERENT,
            feature_mask: u32::MAX,
            context: std::ptr::null_mut(),
            filter: None,
            intersect: None,
            room: [0; 4],
        }
    }
}

/// State of a query that callbacks see. Its size depends on build options, so it is opaque here.
#[repr(C)]
#[derive(Debug)]
pub struct RTCRayQueryContext {
    _private: [u8; 0],
}

/// Arguments of a filter callback.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCFilterFunctionNArguments {
    pub valid: *mut i32,
    pub geometryUserPtr: *mut c_void,
    pub context: *mut RTCRayQueryContext,
    pub ray: *mut c_void,
    pub hit: *mut c_void,
    pub N: u32,
}

/// Arguments of a bounds callback (user geometry).
#[repr(C)]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCBoundsFunctionArguments {
    pub geometryUserPtr: *mut c_void,
    pub primID: u32,
    pub timeStep: u32,
    pub bounds_o: *mut RTCBounds,
}

/// Arguments of an intersection callback (user geometry).
#[repr(C)]
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct RTCIntersectFunctionNArguments {
    pub valid: *mut i32,
    pub geometryUserPtr: *mut c_void,
    pub primID: u32,
    pub context: *mut RTCRayQueryContext,
    pub rayhit: *mut c_void,
    pub N: u32,
    pub geomID: u32,
}

/// Called when a device fails: user pointer, code, message.
pub type RTCErrorFunction = Option<unsafe extern "C" fn(*mut c_void, RTCError, *const c_char)>;
/// Filter callback.
pub type RTCFilterFunctionN = Option<unsafe extern "C" fn(*const RTCFilterFunctionNArguments)>;
/// Bounds callback.
pub type RTCBoundsFunction = Option<unsafe extern "C" fn(*const RTCBoundsFunctionArguments)>;
/// Intersection callback.
pub type RTCIntersectFunctionN = Option<unsafe extern "C" fn(*const RTCIntersectFunctionNArguments)>;
