//! Fuzzes the reader of glTF meshes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::gltf(data));
