//! Every edge, tested: what patches are measured against.

mod every_edge;
mod exact;
mod face_signs;
mod naive;

pub use every_edge::{FaceStrips, StoredPlanes};
pub use exact::BruteForce;
pub use face_signs::FaceSigns;
pub use naive::extract_naively;
