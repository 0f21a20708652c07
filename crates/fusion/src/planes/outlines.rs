//! Clusters in a few numbers each, so that one is compared with many at a glance.

use glam::Vec3;
use wide::{CmpEq, f32x4};

use super::cluster::Cluster;
use super::model::Model;

const LANES: usize = 4;
const FIELDS: usize = 10;

/// A number for each of some clusters, negative infinity for none.
#[derive(Default)]
pub(crate) struct Gains(Vec<f32x4>);

impl Gains {
    pub(crate) fn none(count: usize) -> Self {
        Self(vec![f32x4::splat(f32::NEG_INFINITY); count.div_ceil(LANES)])
    }

    pub(crate) fn set(&mut self, number: usize, gain: f32) {
        self.0[number / LANES].as_array_mut()[number % LANES] = gain;
    }

    /// The first of those with the most, and how much that is.
    pub(crate) fn most(&self) -> Option<(usize, f32)> {
        let most = self.0.iter().fold(f32x4::splat(f32::NEG_INFINITY), |a, b| a.fast_max(*b));
        let most = most.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max);
        if most == f32::NEG_INFINITY {
            return None;
        }
        let is_most = |block: &f32x4| block.cmp_eq(f32x4::splat(most)).move_mask();
        let (block, mask) = self.0.iter().map(is_most).enumerate().find(|(_, mask)| *mask != 0)?;
        Some((LANES * block + mask.trailing_zeros() as usize, most))
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
        let bound = &cluster.bound;
        let chord = bound.cap.chord_squared;
        Self {
            axis: bound.cap.axis,
            center: bound.center,
            half_angle: chord.sqrt() * (1.0 + chord / 24.0),
            apex_angle: bound.apex_distance * model.nearness,
            edges: cluster.edges(),
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
    blocks: Vec<[f32x4; FIELDS]>,
    len: usize,
}

impl Outlines {
    pub(crate) fn push(&mut self, outline: &Outline) {
        if self.len.is_multiple_of(LANES) {
            let mut gone = [f32x4::ZERO; FIELDS];
            gone[FIELDS - 1] = f32x4::splat(f32::NEG_INFINITY);
            self.blocks.push(gone);
        }
        self.len += 1;
        self.set(self.len - 1, outline);
    }

    pub(crate) fn set(&mut self, number: usize, outline: &Outline) {
        let block = &mut self.blocks[number / LANES];
        for (column, value) in block.iter_mut().zip(outline.fields()) {
            column.as_array_mut()[number % LANES] = value;
        }
    }

    pub(crate) fn remove(&mut self, number: usize) {
        let block = &mut self.blocks[number / LANES];
        block[FIELDS - 1].as_array_mut()[number % LANES] = f32::NEG_INFINITY;
    }

    /// Replaces `gains` by what fusing `one` with each would gain, roughly: as if caps were filled to
    /// their rims. Negative infinity for those that are gone.
    pub(crate) fn gains(&self, one: &Outline, model: &Model, gains: &mut Gains) {
        gains.0.clear();
        let fields = one.fields().map(f32x4::splat);
        let [nx, ny, nz, cx, cy, cz, half_angle, apex_angle, edges, cost] = fields;
        let half = f32x4::splat(0.5);
        for block in &self.blocks {
            let (dx, dy, dz) = (block[0] - nx, block[1] - ny, block[2] - nz);
            let between = (dx * dx + dy * dy + dz * dz).sqrt();
            let angle =
                block[6].fast_max(half_angle).fast_max(half * (block[6] + half_angle + between));
            // How high one center lies above the other, along the axis half-way between.
            let height = (block[0] + nx) * (block[3] - cx)
                + (block[1] + ny) * (block[4] - cy)
                + (block[2] + nz) * (block[5] - cz);
            let height = (half * height).abs() * f32x4::splat(model.nearness);
            let apex =
                block[7].fast_max(apex_angle).fast_max(half * (block[7] + apex_angle + height));
            let union = model.rough_patch(angle + apex, block[8] + edges);
            gains.0.push(block[9] + cost - union);
        }
    }
}
