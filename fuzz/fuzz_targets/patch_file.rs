//! Bytes as a patches file: refused with a reason, or good for everything that patches are for.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drypoint_fuzz::hostile::check_patch_file(bytes));
