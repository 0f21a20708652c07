//! The readers: what they make of files, what they say of bad ones, and that nothing shakes them.
#![cfg(all(feature = "obj", feature = "ply", feature = "stl", feature = "gltf"))]

mod errors;
mod estimates;
mod files;
mod gltf;
mod hostile;
mod islands;
mod models;
mod rigs;
mod text;
