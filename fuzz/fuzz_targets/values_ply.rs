//! Fuzzes the reader of values on PLY meshes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::values_ply(data));
