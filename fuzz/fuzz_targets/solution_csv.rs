//! Fuzzes the reader of solutions as CSV.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::solution_csv(data));
