//! The cost model and the view profile, as the search evaluates them.

use glam::Vec3;
use wide::{CmpLt, f32x4};

use crate::{CostModel, ViewProfile};

/// 1.5 · 2²³, in the middle of where f32 holds whole numbers and nothing between them.
const ROUNDER: f32 = 12_582_912.0;

/// What the search minimises. Distances in units of half the longest side of the mesh's box.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) cost: CostModel,
    /// Reciprocals of the distances; 0 for those that do not count.
    nearnesses: f32x4,
    /// How much each counts.
    weights: f32x4,
    /// Reciprocal of the one distance that comes nearest.
    pub(crate) nearness: f32,
    patch_test: f32,
    accepted_patch: f32,
    block: f32,
    block_reciprocal: f32,
}

#[expect(clippy::cast_possible_truncation, reason = "the search is content with f32")]
impl Model {
    pub(crate) fn new(cost: CostModel, views: &ViewProfile) -> Self {
        let nearness = |view: usize| {
            if views.weights[view] > 0.0 { (1.0 / views.distances[view]) as f32 } else { 0.0 }
        };
        Self {
            cost,
            nearnesses: f32x4::from(std::array::from_fn(nearness)),
            weights: f32x4::from(views.weights.map(|weight| weight as f32)),
            nearness: (1.0 / views.mean_distance()) as f32,
            patch_test: cost.patch_test as f32,
            accepted_patch: cost.accepted_patch as f32,
            block: cost.block.max(1) as f32,
            block_reciprocal: 1.0 / cost.block.max(1) as f32,
        }
    }

    /// t_P.
    pub(crate) fn patch_test(&self) -> f32 {
        self.patch_test
    }

    /// Cost of a survivor beside that of its test: t_A + b ⌈edges / b⌉.
    pub(crate) fn survivor(&self, edges: f32) -> f32 {
        self.accepted_patch + self.block * (edges / self.block).ceil()
    }

    /// Probability H that planes survive which a cap and a distance t between center and apex bound.
    pub(crate) fn acceptance(&self, chord_squared: f32, apex_distance: f32) -> f32 {
        let cos = f32x4::splat(1.0 - 0.5 * chord_squared);
        let sin = f32x4::splat(sin(chord_squared));
        let sin_beta = f32x4::splat(apex_distance) * cos * self.nearnesses;
        // Beyond, a root of something negative may be NaN, and is not taken.
        let at = sin * (f32x4::ONE - sin_beta * sin_beta).sqrt() + cos * sin_beta;
        (self.weights * sin_beta.cmp_lt(cos).blend(at, f32x4::ONE)).reduce_add()
    }

    /// No more than the same, whatever the distance: what it is if t is 0.
    pub(crate) fn least_acceptance(chord_squared: f32) -> f32 {
        sin(chord_squared)
    }

    pub(crate) fn patch(&self, acceptance: f32, edges: f32) -> f32 {
        self.patch_test + acceptance * self.survivor(edges)
    }

    /// Roughly the same from α + t / d and a whole number of edges.
    #[inline(always)]
    pub(crate) fn rough_patch(&self, angle: f32, edges: f32) -> f32 {
        let angle = if angle < 1.5 { angle } else { 1.5 };
        let acceptance = angle - angle * angle * angle * 0.155;
        // Half a block more than the edges before its last one, to the nearest whole number of blocks:
        // that is rounded up. Adding and taking away so much rounds, on any number at once.
        let blocks = (edges + 0.5 * (self.block - 1.0)) * self.block_reciprocal;
        let tested = self.block * ((blocks + ROUNDER) - ROUNDER);
        self.patch_test + acceptance * (self.accepted_patch + tested)
    }

    /// Where a set of planes lies, so that those that are cheap to cull together lie together:
    /// normals are as far apart as their angle, parallel planes as far as the angle under which
    /// their distance is seen.
    pub(crate) fn place(&self, axis: Vec3, center: Vec3) -> [f32; 4] {
        [axis.x, axis.y, axis.z, self.nearness * axis.dot(center)]
    }
}

/// Of the angle α whose chord that is.
fn sin(chord_squared: f32) -> f32 {
    (chord_squared * (1.0 - 0.25 * chord_squared)).max(0.0).sqrt()
}
