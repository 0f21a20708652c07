//! What the tests, the validation and the benchmark across crates share: meshes, parameters,
//! viewpoints and the comparison of every extractor with the definition.

pub mod boundary;
pub mod compare;
pub mod meshes;
pub mod models;
pub mod presets;
pub mod viewpoints;

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[derive(Debug)]
pub struct Readme;
