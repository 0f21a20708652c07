//! Patches tested first, then the edges of the survivors.

use std::ops::Range;

use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint, is_contour};

use crate::Statistics;

/// Replaces `contours` by the contour edges of `patches` seen from `viewpoint`, in patch order, the
/// always-tested ones last: the set that brute force finds, from a fraction of the tests.
///
/// Linear in the number of patches plus the edges of the survivors. Allocates nothing once
/// `contours` is large enough.
pub fn extract_patches(
    patches: &PatchSet,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Statistics {
    let mut statistics =
        Statistics { patches_tested: patches.patches().len(), ..Default::default() };
    contours.clear();
    let mut test = |edges: Range<u32>| {
        statistics.edges_tested += edges.len();
        push_contours(patches, edges, viewpoint, contours);
    };
    for patch in patches.patches() {
        if patch.bound.may_hold_contour(viewpoint) {
            statistics.patches_accepted += 1;
            test(patch.first_edge..patch.first_edge + patch.edge_count);
        }
    }
    test(patches.always_tested());
    statistics.contour_edges = contours.len();
    statistics
}

/// Replaces `contours` by the contour edges of `patches`, in patch order, with no patch skipped: the
/// brute force for an asset whose triangles are not at hand.
pub fn extract_all_wings(
    patches: &PatchSet,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Statistics {
    let every = 0..patches.always_tested().end;
    contours.clear();
    push_contours(patches, every.clone(), viewpoint, contours);
    Statistics { edges_tested: every.len(), contour_edges: contours.len(), ..Statistics::default() }
}

fn push_contours(
    patches: &PatchSet,
    edges: Range<u32>,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) {
    let range = edges.start as usize..edges.end as usize;
    let candidates = patches.wings()[range.clone()].iter().zip(&patches.edge_ids()[range]);
    // The exact sign of a face does not depend on the edge that asks for it, so this agrees with
    // brute force, which asks once per face.
    let seen = candidates.filter(|(wing, _)| is_contour(patches.positions(), wing, viewpoint));
    contours.extend(seen.map(|(_, edge)| edge));
}
