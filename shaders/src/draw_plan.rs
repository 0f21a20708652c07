//! Cuts work into draws of task and mesh shaders that a device allows.

use crate::layout::Work;
use crate::plan::small;
use crate::{Chunk, Culling, MeshShape, Method};

/// One draw of mesh shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    /// What it begins with: edges, patches, or blocks of super-patches.
    pub culling: Culling,
    /// Index of the chunk.
    pub chunk: usize,
    /// Of edges, patches, or blocks of super-patches.
    pub work: Work,
    /// Workgroups along x and y.
    pub grid: [u32; 2],
}

/// What bounds a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawLimits {
    /// Lanes of workgroups.
    pub shape: MeshShape,
    /// Task workgroups, or mesh workgroups without these, along one dimension.
    pub row: u32,
    /// The same in all.
    pub workgroups: u32,
    /// Edges of all instances.
    pub edges: u32,
}

/// What is to be drawn for some instances of a model.
#[derive(Clone, Copy, Debug)]
pub struct DrawPlan<'a> {
    /// Pieces of the model.
    pub chunks: &'a [Chunk],
    /// For each, how many blocks its super-patches are in.
    pub block_counts: &'a [u32],
    /// Rigid parts of the model.
    pub part_count: u32,
    /// How contour edges are found.
    pub method: Method,
    /// Number of instances.
    pub instances: u32,
    /// Segments that fit the output, where they are written down.
    pub segment_capacity: u32,
    /// What bounds a draw.
    pub limits: DrawLimits,
}

impl DrawPlan<'_> {
    /// Hands its draws to `visit`, in order.
    pub fn draws(&self, visit: &mut impl FnMut(Draw)) {
        for (index, chunk) in self.chunks.iter().enumerate() {
            if self.method == Method::BruteForce {
                for (part, edges) in &chunk.parts {
                    let items = [edges.start, edges.end - edges.start];
                    self.cut(index, Culling::Nothing, (items, *part), visit);
                }
            } else if chunk.super_patches.is_empty() {
                let items = [0, small(chunk.patches.len() as u64)];
                self.cut(index, Culling::Patches, (items, 0), visit);
            } else {
                let items = [0, self.block_counts[index]];
                self.cut(index, Culling::SuperPatches, (items, 0), visit);
            }
        }
    }

    /// Number of draws. Fewer instances never need more.
    pub fn count(&self) -> usize {
        let mut count = 0;
        self.draws(&mut |_| count += 1);
        count
    }

    fn cut(
        &self,
        chunk: usize,
        culling: Culling,
        ([first, count], part): ([u32; 2], u32),
        visit: &mut impl FnMut(Draw),
    ) {
        let limits = self.limits;
        let items_per_workgroup = match culling {
            Culling::Nothing => limits.shape.edges_per_workgroup,
            Culling::Patches => limits.shape.task_width,
            Culling::SuperPatches => 1,
        };
        let row = limits.row;
        // A task workgroup of the last row that is left over launches nothing, a mesh workgroup is there in vain.
        let most_rows = if culling == Culling::Nothing { 1 } else { u64::from(row) };
        let allowed = u64::from(limits.workgroups).min(u64::from(row) * most_rows);
        // Rows are filled up with at most one workgroup each.
        let most_workgroups = allowed - (allowed.div_ceil(u64::from(row)) - 1);
        // Items of all instances are numbered in 32 bits, and those of the last row beyond them too.
        let most_workgroups = most_workgroups
            .min(u64::from(u32::MAX / items_per_workgroup).saturating_sub(u64::from(row)))
            .max(1);
        let most_items = small(most_workgroups * u64::from(items_per_workgroup));
        let edges = &self.chunks[chunk].edges;
        let most_instances = limits.edges / (edges.end - edges.start).max(1);
        for first_item in (first..first + count).step_by(most_items as usize) {
            let item_count = most_items.min(first + count - first_item);
            let step = (most_items / item_count).min(most_instances).max(1);
            for first_instance in (0..self.instances).step_by(step as usize) {
                let instance_count = step.min(self.instances - first_instance);
                let workgroups = (item_count * instance_count).div_ceil(items_per_workgroup);
                // No more rows than needed, and as even as can be.
                let rows = workgroups.div_ceil(row);
                let grid = [workgroups.div_ceil(rows), rows];
                let work = Work {
                    first_item,
                    item_count,
                    items_per_workgroup,
                    first_instance,
                    instance_count,
                    part_count: self.part_count,
                    part,
                    segment_capacity: self.segment_capacity,
                    first_placement: 0,
                    most_instances: self.instances,
                    row: grid[0],
                };
                visit(Draw { culling, chunk, work, grid });
            }
        }
    }
}
