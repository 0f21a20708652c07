//! Bytes as triangles and viewpoints: every extractor finds what the definition says.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drypoint_fuzz::soup::check(bytes));
