//! Fuzzes the reader of form factors as CSV.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::matrix_csv(data));
