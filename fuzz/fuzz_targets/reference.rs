//! Fuzzes the reader of reference directories.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::reference(data));
