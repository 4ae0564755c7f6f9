//! Fuzzes the reader of MTL libraries.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::mtl(data));
