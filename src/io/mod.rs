//! Files: scenes, meshes, patches.

pub mod scene;
