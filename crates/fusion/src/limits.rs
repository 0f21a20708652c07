//! What a runtime cannot take in one piece is cut.

use drypoint_mesh::EdgeId;

use crate::CostModel;
use crate::geometry::Frame;

/// Cuts those patches that hold more edges or vertices than `cost` admits, in the order of their
/// edges. Our own method heeds the limits as it grows, the published one knows of none.
pub(crate) fn keep_limits(
    frame: &Frame,
    patches: Vec<Vec<EdgeId>>,
    cost: &CostModel,
) -> Vec<Vec<EdgeId>> {
    if cost.admits(usize::MAX, usize::MAX) {
        return patches;
    }
    let mut pieces = Vec::with_capacity(patches.len());
    for patch in patches {
        let mut piece: Vec<EdgeId> = Vec::new();
        let mut vertices: Vec<u32> = Vec::new();
        for edge in patch {
            let ends = frame.ends(edge);
            let mut new: Vec<u32> =
                ends.into_iter().filter(|end| !vertices.contains(end)).collect();
            if !piece.is_empty() && !cost.admits(piece.len() + 1, vertices.len() + new.len()) {
                pieces.push(std::mem::take(&mut piece));
                vertices.clear();
                new = ends.to_vec();
            }
            vertices.append(&mut new);
            piece.push(edge);
        }
        pieces.push(piece);
    }
    pieces
}
