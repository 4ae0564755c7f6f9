//! Fuzzes the reader of EXR lightmaps.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::values_exr(data));
