//! **etalon**: a ray-traced reference validator and error-metric toolkit for radiosity and view factors.
//!
//! Every method is a candidate; the engine is the judge: form factors in closed form and by exact shadows where that
//! can be had, by rays elsewhere. The judge is judged by rays cast again, by closed forms, by a second kernel, by
//! energy balance and by its own error bars.
//!
//! # In a test of your solver
//!
//! ```no_run
//! use etalon::{Limits, Reference, ReferenceOptions, assert_verdict, open_scene};
//! # fn my_solver(stage: &etalon::Stage) -> etalon::Radiosity { unimplemented!() }
//! # fn main() -> Result<(), etalon::Error> {
//! let stage = open_scene("rooms/office.toml")?.at(0)?;
//! // Cast once, kept in a directory, computed again when the scene changes.
//! let reference = Reference::open_or_compute("target/office.ref", &stage, &ReferenceOptions::default())?;
//! let mine = my_solver(&stage);
//! assert_verdict!(reference.check(&mine, &Limits::rms(0.02))?);
//! # Ok(())
//! # }
//! ```
//!
//! # What is stable
//!
//! The items re-exported here follow semantic versioning. The modules below them are the workings: documented,
//! open to be looked at and used, and free to change with any minor version.
//!
//! # Words
//!
//! - **scene, stage, state**: what the author wrote; what stands there after some edits; how many edits.
//! - **patch, element**: the unit of the radiosity system; a receiver within a patch.
//! - **radiosity** B: W/m^2 leaving a surface, per band; **emission** E: the part it emits itself;
//!   **reflectance** rho: the part of what arrives that is sent back.
//! - **form factor** F_ij: share of the light of patch i that reaches patch j.
//! - **reference**: the judge's radiosities, as R independent replicates; their spread is the error.
//! - **candidate, solution**: a method that is judged; its radiosities.

pub mod api;
pub mod audit;
pub mod carry;
pub mod cli;
pub mod compositing;
pub mod doctor;
pub mod estimate;
pub mod formfactor;
pub mod io;
pub mod math;
pub mod methods;
pub mod metrics;
pub mod raycast;
pub mod reference;
pub mod render;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod solution;
pub mod solver;
pub mod stats;
pub mod study;
pub mod view;
pub mod world;

pub use api::{Check, Error, Estimator, Reference, ReferenceOptions, examine_scene, open_scene, solve};
pub use metrics::{Comparison, Limit, Limits, Metric, Place, Verdict, WorstPatch};
pub use raycast::KernelKind;
pub use scene::{Finding, Patch, Scene, Stage};
pub use solution::{Provenance, Radiosity, SelfCheck};
pub use stats::Estimate;
