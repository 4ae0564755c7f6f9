//! The candidates: radiosity methods that the reference judges.

pub mod gather;
pub mod hemicube;
mod info;

pub use info::{MethodInfo, PatchVectors, RowSums};
