//! Fuzzes the reader of form factors as npz.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::matrix_npz(data));
