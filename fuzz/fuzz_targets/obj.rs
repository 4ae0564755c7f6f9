//! Fuzzes the reader of OBJ meshes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::obj(data));
