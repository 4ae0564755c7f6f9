//! Fuzzes the reader of form factors as Matrix Market.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::matrix_mtx(data));
