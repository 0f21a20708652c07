//! What the tests, the validation and the benchmark across crates share: meshes, parameters,
//! viewpoints, the comparison of every extractor with the definition, and the report.

pub mod boundary;
pub mod compare;
pub mod hostile;
pub mod judges;
pub mod meshes;
pub mod models;
pub mod presets;
pub mod report;
pub mod soup;
pub mod viewpoints;

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[derive(Debug)]
pub struct Readme;
