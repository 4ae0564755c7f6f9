//! Fuzzes the reader of solutions as npy.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::solution_npy(data));
