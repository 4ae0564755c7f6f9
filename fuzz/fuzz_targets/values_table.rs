//! Fuzzes the reader of tables of values beside meshes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::values_table(data));
