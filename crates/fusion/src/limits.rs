//! What a runtime cannot take in one piece is cut.

use drypoint_mesh::EdgeId;

use crate::CostModel;
use crate::geometry::Frame;

/// Cuts those patches that hold more edges or vertices than `cost` admits, in the order of their
/// edges. Our own method heeds the limits as it grows, the published one knows of none. Linear.
pub(crate) fn keep_limits(
    frame: &Frame,
    patches: Vec<Vec<EdgeId>>,
    cost: &CostModel,
) -> Vec<Vec<EdgeId>> {
    if cost.admits(usize::MAX, usize::MAX) {
        return patches;
    }
    let mut pieces = Vec::with_capacity(patches.len());
    // Number of the last piece in which each vertex was counted.
    let mut counted_in = vec![usize::MAX; frame.mesh.positions().len()];
    for patch in patches {
        let (mut piece, mut vertices) = (Vec::new(), 0);
        for edge in patch {
            let ends = frame.ends(edge).map(|end| end as usize);
            let new = ends.iter().filter(|&&end| counted_in[end] != pieces.len()).count();
            if !piece.is_empty() && !cost.admits(piece.len() + 1, vertices + new) {
                pieces.push(std::mem::take(&mut piece));
                vertices = 0;
            }
            for end in ends {
                vertices += usize::from(counted_in[end] != pieces.len());
                counted_in[end] = pieces.len();
            }
            piece.push(edge);
        }
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};

    use super::*;

    /// All edges of a ball as one patch, cut.
    fn pieces_of_ball(triangles: usize, max_edges: u32, max_vertices: u32) -> Vec<Vec<EdgeId>> {
        let mesh = shapes::icosphere(triangles);
        let adjacency = MeshAdjacency::new(&mesh);
        let frame = Frame::new(&mesh, &adjacency).unwrap();
        let edges: Vec<EdgeId> = adjacency.edges(EdgeFilter::All).collect();
        let cost = CostModel { max_edges, max_vertices, ..CostModel::PAPER };
        let pieces = keep_limits(&frame, vec![edges.clone()], &cost);
        assert_eq!(pieces.concat(), edges);
        let mut after = pieces.iter().skip(1).map(|piece| piece[0]);
        for piece in &pieces {
            let vertices = |edges: &[EdgeId]| {
                let mut ends: Vec<u32> = edges.iter().flat_map(|&edge| frame.ends(edge)).collect();
                ends.sort_unstable();
                ends.dedup();
                ends.len()
            };
            assert!(cost.admits(piece.len(), vertices(piece)));
            if let Some(next) = after.next() {
                let longer = [&piece[..], &[next]].concat();
                assert!(!cost.admits(longer.len(), vertices(&longer)), "cut too early");
            }
        }
        pieces
    }

    #[test]
    fn a_patch_is_cut_where_the_next_edge_is_one_too_many() {
        let lengths = |pieces: Vec<Vec<EdgeId>>| pieces.iter().map(Vec::len).collect::<Vec<_>>();
        assert_eq!(lengths(pieces_of_ball(20, 12, u32::MAX)), [12, 12, 6]);
        assert_eq!(lengths(pieces_of_ball(20, 1, u32::MAX)), [1; 30]);
        assert_eq!(lengths(pieces_of_ball(20, u32::MAX, 2)), [1; 30]);
        assert!(pieces_of_ball(1_000, 126, 64).len() > 1_500 / 126);
        assert!(pieces_of_ball(1_000, 50, 7).len() > 1_500 / 15);
    }
}
