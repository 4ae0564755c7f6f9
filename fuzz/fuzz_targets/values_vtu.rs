//! Fuzzes the reader of values on VTK grids.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::values_vtu(data));
