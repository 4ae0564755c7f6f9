//! Fuzzes the reader of scene files.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::scene(data));
