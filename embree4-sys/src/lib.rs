//! Embree 4 by run-time loading: a layout-safe drop-in for the published `embree4-sys`.
//!
//! The published crate binds the headers of Embree 4.2 at build time. Later 4.x libraries append a field to
//! `RTCHit`, so every hit they report is written past the end of that struct. This crate needs neither
//! headers nor a library to build. It
//!
//! - [`load`]s a library at run time and reports what is wrong with it as a [`LoadError`];
//! - gives every struct the library writes to room behind its last known field (see [`RTCRayHit`]);
//! - traces a few rays into canary-filled memory before it accepts a library, so that [`loaded`] means: version
//!   4.x, all functions there, fields where expected, nothing written past our room ([`Layout`]).
//!
//! Functions keep their C names. Before a successful [`load`] they do what Embree does when it refuses a call:
//! pointers are null, identifiers invalid, [`rtcGetDeviceError`] says [`RTCError::UNKNOWN`], the rest does
//! nothing. A caller that checks for a null device, as the published wrapper does, never gets further.
#![allow(non_camel_case_types, non_snake_case)]

mod api;
mod error;
mod load;
mod probe;
mod types;

pub use api::*;
pub use error::LoadError;
pub use load::{Library, Version, load, loaded};
pub use probe::{Layout, Written};
pub use types::*;
