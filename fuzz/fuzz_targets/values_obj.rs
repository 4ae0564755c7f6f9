//! Fuzzes the reader of values on OBJ meshes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::values_obj(data));
