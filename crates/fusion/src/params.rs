//! What is minimised, and how far the search goes.

/// What a patch costs, in the time that one edge test takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// Time of one patch test, in edge tests; above 0. More makes patches larger.
    pub patch_test: f64,
    /// Distance of the viewpoints that patches are tuned for, in units of half the longest side of
    /// the mesh's box, from the center of each patch; above 0. Viewpoints lie that far away in any
    /// direction. Less makes patches rounder and pays when the viewer stands close.
    pub view_distance: f64,
}

impl CostModel {
    /// As Tsiapkolis and Bénard measured it on their GPU and chose it (CGF 2024, §4.2).
    pub const PAPER: Self = Self { patch_test: 1.363, view_distance: 10.0 };

    /// Expected cost E of a view of a patch of `edges` edges that survives with probability
    /// `acceptance`, in edge tests: t_P + H t_e ξ.
    pub fn patch(&self, acceptance: f64, edges: usize) -> f64 {
        self.patch_test + acceptance * edges as f64
    }
}

/// Which sphere bounds the place of a patch's planes. Every sphere touches the supporting line of
/// every edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum SphereKind {
    /// Around the mean of the distinct vertices, through the farthest vertex (Johnson and Cohen,
    /// I3D 2001).
    Mean = 0,
    /// Around the mean of the edges' midpoints, to the farthest supporting line: never mind how
    /// far the edge itself reaches along it (Tsiapkolis and Bénard, CGF 2024, §3.1).
    #[default]
    Reduced = 1,
}

/// How [`fuse`](crate::fuse) grows patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusionParams {
    /// The sphere that bounds each patch.
    pub sphere: SphereKind,
    /// What is minimised.
    pub cost: CostModel,
    /// How many of its best partners a patch remembers, from 1; 0 counts as 1. Changes the time
    /// and the memory (16 bytes a partner), never the result.
    pub cache_size: u32,
    /// Most edges that are fused with each other; `None`: all. The box is halved until no part
    /// holds more. Time grows with it, linearly, and patches end at the cuts: TB24's Table 1 goes
    /// from 512 to 16384.
    pub max_partition: Option<u32>,
}

impl FusionParams {
    /// The published method: Tsiapkolis and Bénard, CGF 2024, with Reduced spheres.
    pub const PAPER: Self = Self {
        sphere: SphereKind::Reduced,
        cost: CostModel::PAPER,
        cache_size: 50,
        max_partition: Some(4096),
    };

    /// The published method with Mean spheres.
    pub const PAPER_MEAN: Self = Self { sphere: SphereKind::Mean, ..Self::PAPER };
}

impl Default for FusionParams {
    fn default() -> Self {
        Self::PAPER
    }
}
