//! All extractors that keep bounds, behind one call: what is counted is the same for each.

use drypoint_baselines::{AnchoredCones, Meshlets, Snch, Statistics};
use drypoint_cpu::extract_patches;
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint};

/// What a view took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tested {
    /// Bounds of patches, super-patches, nodes or meshlets.
    pub bounds: usize,
    /// Edges.
    pub edges: usize,
}

/// Finds contour edges by exact predicates, through bounds.
pub trait Judge: Sync {
    /// Replaces `contours` by the contour edges seen from `viewpoint`, in any order.
    fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Tested;
}

impl Judge for PatchSet {
    fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Tested {
        let statistics = extract_patches(self, viewpoint, contours);
        Tested {
            bounds: statistics.super_patches_tested + statistics.patches_tested,
            edges: statistics.edges_tested,
        }
    }
}

impl From<Statistics> for Tested {
    fn from(statistics: Statistics) -> Self {
        Self { bounds: statistics.nodes_tested, edges: statistics.edges_tested }
    }
}

impl Judge for Snch<'_> {
    fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Tested {
        self.extract(viewpoint, contours).into()
    }
}

impl Judge for AnchoredCones<'_> {
    fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Tested {
        self.extract(viewpoint, contours).into()
    }
}

impl Judge for Meshlets<'_> {
    fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Tested {
        self.extract(viewpoint, contours).into()
    }
}
