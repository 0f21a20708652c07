//! Patches tested first, then the edges of the survivors.

use std::ops::Range;

use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint, is_contour};

use crate::Statistics;

/// Replaces `contours` by the contour edges of `patches` seen from `viewpoint`, in patch order, the
/// always-tested ones last: the set that brute force finds, from a fraction of the tests. A second
/// level changes the tests, not the answer.
///
/// Linear in the number of super-patches, plus the patches of those that survive and those that no
/// super-patch holds, plus the edges of the patches that survive. Allocates nothing once `contours`
/// is large enough.
pub fn extract_patches(
    patches: &PatchSet,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Statistics {
    let mut statistics = Statistics::default();
    contours.clear();
    for group in patches.super_patches() {
        statistics.super_patches_tested += 1;
        if group.bound.may_hold_contour(viewpoint) {
            statistics.super_patches_accepted += 1;
            test_patches(patches, group.patches(), viewpoint, contours, &mut statistics);
        }
    }
    let ungrouped = patches.always_tested_patches();
    test_patches(patches, ungrouped, viewpoint, contours, &mut statistics);
    statistics.edges_tested += patches.always_tested().len();
    push_contours(patches, patches.always_tested(), viewpoint, contours);
    statistics.contour_edges = contours.len();
    statistics
}

/// Tests a range of patches, and the edges of the survivors.
fn test_patches(
    patches: &PatchSet,
    range: Range<u32>,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
    statistics: &mut Statistics,
) {
    statistics.patches_tested += range.len();
    for patch in &patches.patches()[range.start as usize..range.end as usize] {
        if patch.bound.may_hold_contour(viewpoint) {
            statistics.patches_accepted += 1;
            statistics.edges_tested += patch.edge_count as usize;
            push_contours(patches, patch.edges(), viewpoint, contours);
        }
    }
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
