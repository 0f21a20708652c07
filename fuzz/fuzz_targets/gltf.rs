//! Bytes as a glTF or GLB file.
#![no_main]

use drypoint_fuzz::hostile::check_file;
use drypoint_mesh::io::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| check_file(Format::Gltf, bytes));
