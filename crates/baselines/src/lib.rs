//! What patches are measured against: hierarchies and meshlets that others have published.

mod anchored_cones;
#[cfg(test)]
mod check;
mod edges;
mod meshlets;
mod shape;
mod snch;
mod statistics;

pub use anchored_cones::{AnchoredConeParams, AnchoredCones};
pub use meshlets::{MeshletParams, Meshlets};
pub use snch::{Snch, SnchParams};
pub use statistics::Statistics;
