//! Why [`fuse`](crate::fuse) makes no patches.

use crate::Cancelled;

/// Why there are no patches.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FuseError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Nothing can be minimised with these parameters.
    #[error(transparent)]
    Params(#[from] InvalidParams),
}

/// What is wrong with [`FusionParams`](crate::FusionParams).
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidParams {
    /// [`CostModel::patch_test`](crate::CostModel::patch_test) is NaN, infinite, 0 or negative.
    #[error("a patch test must cost a finite number above 0, not {patch_test}")]
    PatchTest {
        /// What it costs.
        patch_test: f64,
    },
    /// [`CostModel::accepted_patch`](crate::CostModel::accepted_patch) is NaN, infinite or negative.
    #[error("an accepted patch must cost a finite number from 0, not {accepted_patch}")]
    AcceptedPatch {
        /// What it costs.
        accepted_patch: f64,
    },
    /// One of [`ViewProfile::distances`](crate::ViewProfile::distances) is NaN, 0 or negative.
    #[error("view distance {index} must be above 0, not {distance}")]
    Distance {
        /// Which of them, from 0.
        index: usize,
        /// The distance.
        distance: f64,
    },
    /// One of [`ViewProfile::weights`](crate::ViewProfile::weights) is NaN, infinite or negative.
    #[error("the weight of view distance {index} must be a finite number from 0, not {weight}")]
    Weight {
        /// Which of them, from 0.
        index: usize,
        /// The weight.
        weight: f64,
    },
    /// The weights are no distribution.
    #[error("the weights of view distances must sum up to 1, not {sum}")]
    WeightSum {
        /// What they sum up to.
        sum: f64,
    },
}
