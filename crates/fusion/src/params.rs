//! What is minimised, and how far the search goes.

use crate::{CostModel, InvalidParams, ViewProfile};

/// How far from 1 the weights of a view profile may sum up to: what sums of f32 lose, and more.
const WEIGHT_TOLERANCE: f64 = 1e-6;

/// What bounds the planes of a patch. All become the same [`DoubleCone`](drypoint_bounds::DoubleCone)
/// and cost the same at run time; they differ in how much they cull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum BoundKind {
    /// A cone around the mean normal, and a sphere around the mean of the distinct vertices, through
    /// the farthest vertex (Johnson and Cohen, I3D 2001).
    Mean = 0,
    /// A cone around the mean normal, and a sphere around the mean of the edges' midpoints, to the
    /// farthest supporting line (Tsiapkolis and Bénard, CGF 2024, §3.1).
    Reduced = 1,
    /// The narrowest cone (Barequet and Elber, 2005), and the smallest sphere that touches every
    /// supporting line.
    Minimal = 2,
    /// The narrowest cone, and the smallest distance between its two apexes that holds the planes
    /// themselves, with no sphere in between: never looser than the others about the same axis line.
    #[default]
    Tight = 3,
}

/// Which sphere the published method measures patches by while it grows them.
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

/// Whether patches are grouped once more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Levels {
    /// Every patch is tested from everywhere.
    #[default]
    One = 1,
    /// Patches are grouped into super-patches, and only those of surviving super-patches are
    /// tested.
    Two = 2,
}

/// How patches are grown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// The published method: in each part of space, the two patches that gain most are fused, as
    /// long as any gain (Tsiapkolis and Bénard, CGF 2024, Algorithm 1). It counts patch tests and
    /// edges, and leaves the rest of the cost model out of account, but for patches that are in the
    /// end no cheaper than their edges: those are given up.
    Greedy {
        /// The sphere that patches are measured by.
        sphere: SphereKind,
        /// How many of its best partners a patch remembers, from 1; 0 counts as 1. Changes the time
        /// and the memory (16 bytes a partner), never the result.
        cache_size: u32,
        /// Most edges that are fused with each other; `None`: all. The box is halved until no part
        /// holds more. Time grows with it, linearly, and patches end at the cuts: TB24's Table 1
        /// goes from 512 to 16384.
        max_partition: Option<u32>,
    },
    /// Ours: patches grow in the space of planes, where what is culled together lies together, and
    /// are then refined edge by edge.
    Planes {
        /// Most patches in the making that are compared with each other at a time; from 8. Time
        /// grows with it, linearly.
        cell: u32,
        /// How many of the likeliest partners of a patch are looked at closely, 1 ..= 4. With 1,
        /// all is done in haste: partners are looked at when it is a patch's turn by what it would
        /// gain at a glance. 0 counts as 1, and more than 4 as 4.
        looks: u32,
        /// How often edges may move to a patch where they cost less, or little more at first.
        sweeps: u32,
        /// How often, after that, two or three neighbouring patches are torn into edges and fused
        /// anew, over all patches: each time some four times the work of a sweep.
        tears: u32,
    },
}

/// How [`fuse`](crate::fuse) grows patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusionParams {
    /// What bounds each patch.
    pub bound: BoundKind,
    /// What is minimised.
    pub cost: CostModel,
    /// For whom: from how far away the mesh is looked at.
    pub views: ViewProfile,
    /// How patches are grown.
    pub method: Method,
    /// Whether patches are grouped once more.
    pub levels: Levels,
}

impl FusionParams {
    /// For building while a model is loaded: some 3 µs of processor time for each edge.
    pub const FAST: Self = Self {
        bound: BoundKind::Tight,
        cost: CostModel::PAPER,
        views: ViewProfile::FAR,
        method: Method::Planes { cell: 96, looks: 1, sweeps: 0, tears: 0 },
        levels: Levels::One,
    };

    /// For building once and viewing often: some 20 µs for each edge, for views that cost 7 to 10 %
    /// less than with [`FusionParams::FAST`].
    pub const DEFAULT: Self =
        Self { method: Method::Planes { cell: 512, looks: 3, sweeps: 4, tears: 0 }, ..Self::FAST };

    /// For an asset that is shipped: some 300 µs for each edge, for the last 1 or 2 %.
    pub const BEST: Self =
        Self { method: Method::Planes { cell: 256, looks: 2, sweeps: 2, tears: 26 }, ..Self::FAST };

    /// The published method: Tsiapkolis and Bénard, CGF 2024, with Reduced spheres. Some 100 µs for
    /// each edge.
    pub const PAPER: Self = Self {
        bound: BoundKind::Reduced,
        cost: CostModel::PAPER,
        views: ViewProfile::PAPER,
        method: Method::Greedy {
            sphere: SphereKind::Reduced,
            cache_size: 50,
            max_partition: Some(4096),
        },
        levels: Levels::One,
    };

    /// The published method with Mean spheres.
    pub const PAPER_MEAN: Self = Self {
        bound: BoundKind::Mean,
        method: Method::Greedy {
            sphere: SphereKind::Mean,
            cache_size: 50,
            max_partition: Some(4096),
        },
        ..Self::PAPER
    };

    /// These, with another limit on the parts of the published method; our own has no parts.
    #[must_use]
    pub const fn with_max_partition(self, max_partition: Option<u32>) -> Self {
        match self.method {
            Method::Greedy { sphere, cache_size, .. } => {
                Self { method: Method::Greedy { sphere, cache_size, max_partition }, ..self }
            }
            Method::Planes { .. } => self,
        }
    }

    /// Whether something can be minimised with them. [`fuse`](crate::fuse) asks before it begins, and
    /// so does whoever reads a patch file: what can be made can be loaded. Counts have no wrong
    /// values: those that are too small count as the least that makes sense.
    ///
    /// # Errors
    /// The first number that is out of its range.
    pub fn check(&self) -> Result<(), InvalidParams> {
        let CostModel { patch_test, accepted_patch, .. } = self.cost;
        if !(is_size(patch_test) && patch_test > 0.0) {
            return Err(InvalidParams::PatchTest { patch_test });
        }
        if !is_size(accepted_patch) {
            return Err(InvalidParams::AcceptedPatch { accepted_patch });
        }
        let ViewProfile { distances, weights } = self.views;
        for (index, distance) in distances.into_iter().enumerate() {
            // Infinitely far is as good a distance as any. NaN is not above 0.
            let is_distance = distance > 0.0;
            if !is_distance {
                return Err(InvalidParams::Distance { index, distance });
            }
        }
        if let Some(index) = weights.iter().position(|&weight| !is_size(weight)) {
            return Err(InvalidParams::Weight { index, weight: weights[index] });
        }
        let sum: f64 = weights.iter().sum();
        if (sum - 1.0).abs() > WEIGHT_TOLERANCE {
            return Err(InvalidParams::WeightSum { sum });
        }
        Ok(())
    }
}

impl Default for FusionParams {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Neither NaN nor infinite nor negative.
pub(crate) fn is_size(x: f64) -> bool {
    x.is_finite() && x >= 0.0
}
