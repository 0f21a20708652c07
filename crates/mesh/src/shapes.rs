//! Procedural meshes.
use crate::Mesh;
/// stub
pub fn icosphere(_n: usize) -> Mesh {
    Mesh::default()
}
