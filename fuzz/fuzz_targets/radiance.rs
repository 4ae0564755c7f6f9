//! Fuzzes the reader of Radiance scenes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::radiance(data));
