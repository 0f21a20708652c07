//! Bounds of patches, eight side by side.

use drypoint_bounds::DoubleCone;
use drypoint_fusion::Patch;

use crate::blocks::LANES;

/// Up to eight patches.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct PatchBlock {
    pub(crate) centers: [[f32; LANES]; 3],
    pub(crate) apex_distances: [f32; LANES],
    pub(crate) axes: [[f32; LANES]; 3],
    pub(crate) tans_squared: [f32; LANES],
    /// The first edge block of each patch, and how many it has.
    pub(crate) blocks: [[u32; 2]; LANES],
    /// How many edges each has.
    pub(crate) edges: [u32; LANES],
    /// A bit for each that is a patch.
    pub(crate) used: u32,
}

impl PatchBlock {
    /// Of at most eight patches, and the edge blocks of each: the first, and how many.
    pub(crate) fn new(patches: &[Patch], blocks: &[[u32; 2]]) -> Self {
        let bound = |lane: usize| patches.get(lane).map_or(DoubleCone::ALWAYS, |patch| patch.bound);
        let column =
            |field: fn(&DoubleCone) -> f32| std::array::from_fn(|lane| field(&bound(lane)));
        Self {
            centers: [column(|b| b.center.x), column(|b| b.center.y), column(|b| b.center.z)],
            apex_distances: column(|b| b.apex_distance),
            axes: [column(|b| b.axis.x), column(|b| b.axis.y), column(|b| b.axis.z)],
            tans_squared: column(|b| b.tan_squared),
            blocks: std::array::from_fn(|lane| blocks.get(lane).copied().unwrap_or_default()),
            edges: std::array::from_fn(|lane| {
                patches.get(lane).map_or(0, |patch| patch.edge_count)
            }),
            used: (1 << patches.len()) - 1,
        }
    }
}
