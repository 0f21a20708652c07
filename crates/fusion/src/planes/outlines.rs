//! Clusters in a few numbers each, so that one is compared with many at a glance.

use glam::Vec3;

use super::cluster::{Bound, Cluster};
use super::model::Model;
use super::simd::{self, Block, FIELDS, LANES};

/// The last field; negative infinity for a cluster that is gone, so that it never gains.
const COST: usize = FIELDS - 1;

/// A number for each of some clusters, negative infinity for none.
#[derive(Default)]
pub(crate) struct Gains(Vec<[f32; LANES]>);

impl Gains {
    pub(crate) fn none(count: usize) -> Self {
        Self(vec![[f32::NEG_INFINITY; LANES]; count.div_ceil(LANES)])
    }

    pub(crate) fn set(&mut self, number: usize, gain: f32) {
        self.0[number / LANES][number % LANES] = gain;
    }

    /// The first of those with the most, and how much that is.
    pub(crate) fn most(&self) -> Option<(usize, f32)> {
        simd::most(&self.0)
    }
}

/// What is known of a cluster at a glance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline {
    axis: Vec3,
    center: Vec3,
    /// α, roughly.
    half_angle: f32,
    /// t / d.
    apex_angle: f32,
    edges: f32,
    pub(crate) cost: f32,
}

impl Outline {
    pub(crate) fn of(cluster: &Cluster, model: &Model) -> Self {
        Self::of_bound(&cluster.bound, cluster.edges(), model)
    }

    pub(crate) fn of_bound(bound: &Bound, edges: f32, model: &Model) -> Self {
        let chord = bound.cap.chord_squared;
        Self {
            axis: bound.cap.axis,
            center: bound.center,
            half_angle: chord.sqrt() * (1.0 + chord / 24.0),
            apex_angle: bound.apex_distance * model.nearness,
            edges,
            cost: bound.cost,
        }
    }

    fn fields(&self) -> [f32; FIELDS] {
        let ([nx, ny, nz], [cx, cy, cz]) = (self.axis.to_array(), self.center.to_array());
        let Self { half_angle, apex_angle, edges, cost, .. } = *self;
        [nx, ny, nz, cx, cy, cz, half_angle, apex_angle, edges, cost]
    }
}

/// Outlines of numbered clusters, as structure of arrays. Those that are gone never gain.
#[derive(Default)]
pub(crate) struct Outlines {
    blocks: Vec<Block>,
    len: usize,
}

impl Outlines {
    pub(crate) fn with_room_for(count: usize) -> Self {
        Self { blocks: Vec::with_capacity(count.div_ceil(LANES)), len: 0 }
    }

    pub(crate) fn push(&mut self, outline: &Outline) {
        if self.len.is_multiple_of(LANES) {
            let mut gone = [[0.0; LANES]; FIELDS];
            gone[COST] = [f32::NEG_INFINITY; LANES];
            self.blocks.push(gone);
        }
        self.len += 1;
        self.set(self.len - 1, outline);
    }

    pub(crate) fn set(&mut self, number: usize, outline: &Outline) {
        let block = &mut self.blocks[number / LANES];
        for (lanes, value) in block.iter_mut().zip(outline.fields()) {
            lanes[number % LANES] = value;
        }
    }

    pub(crate) fn remove(&mut self, number: usize) {
        self.blocks[number / LANES][COST][number % LANES] = f32::NEG_INFINITY;
    }

    /// Replaces `gains` by what fusing `one` with each would gain, roughly: as if caps were filled to
    /// their rims. Negative infinity for those that are gone.
    pub(crate) fn gains(&self, one: &Outline, model: &Model, gains: &mut Gains) {
        gains.0.resize(self.blocks.len(), [0.0; LANES]);
        simd::gains(&self.blocks, &one.fields(), model, &mut gains.0);
    }
}
