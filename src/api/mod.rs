//! What a Rust program needs: open a scene, compute or open a reference, judge a solution, assert the verdict.
//!
//! Everything here is re-exported at the crate's root and kept stable within a major version. See the example
//! there.

mod assert;
mod check;
mod error;
mod options;
mod reference;
mod scene;

pub use crate::estimate::Estimator;
pub use check::Check;
pub use error::Error;
pub use options::ReferenceOptions;
pub use reference::Reference;
pub use scene::{examine_scene, open_scene, solve};
