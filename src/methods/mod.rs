//! The candidates: radiosity methods that the reference judges.

pub mod gather;
pub mod hemicube;
mod info;
mod method;
pub mod shooting;

pub use info::{MethodInfo, PatchVectors, RowSums};
pub use method::{Method, MethodError};
