//! Fuzzes the reader of Mitsuba scenes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| etalon_fuzz::mitsuba(data));
