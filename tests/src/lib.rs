//! What the tests, the validation and the benchmark across crates share: meshes, viewpoints and the
//! comparison of every extractor with the definition.

pub mod compare;
pub mod models;
pub mod viewpoints;
