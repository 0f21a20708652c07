//! The mean over viewpoints.

use drypoint_fusion::Patch;
use drypoint_mesh::Viewpoint;

/// What a view asks for, on the mean of some viewpoints.
pub(crate) struct MeanView {
    /// Patches that survive.
    pub(crate) survivors: f64,
    /// Edges that are tested, those that always are among them.
    pub(crate) tested: f64,
}

/// The mean over `viewpoints`; `always_tested` edges are in no patch.
pub(crate) fn mean_view(
    patches: &[Patch],
    always_tested: usize,
    viewpoints: &[Viewpoint],
) -> MeanView {
    let (mut survivors, mut tested) = (0, 0);
    for &viewpoint in viewpoints {
        for patch in patches.iter().filter(|patch| patch.bound.may_hold_contour(viewpoint)) {
            survivors += 1;
            tested += patch.edge_count as usize;
        }
    }
    let mean = |count: usize| count as f64 / viewpoints.len() as f64;
    MeanView { survivors: mean(survivors), tested: mean(tested) + always_tested as f64 }
}
