//! Scene, mesh, matrix, solution and image formats; files that are whole or not there.

pub mod atomic;
pub mod image;
