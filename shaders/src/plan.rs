//! Cuts work into dispatches that a device allows.

use crate::layout::Work;
use crate::{Chunk, MAX_GROUP, MAX_PIECE, WIDTHS};

/// How contour edges are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Every edge is tested.
    BruteForce,
    /// Patches are tested, super-patches before them where the model has any, and then the edges of those
    /// that may hold a contour edge.
    Patches,
}

/// What a dispatch begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Every edge is tested.
    Edges,
    /// Patches, then the edges of those that survive.
    Patches,
    /// Super-patches, their patches, and these patches' edges.
    SuperPatches,
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dispatch {
    /// What it begins with.
    pub stage: Stage,
    /// The chunk of the model.
    pub chunk: usize,
    /// Its work.
    pub work: Work,
    /// Workgroups along x and y.
    pub grid: [u32; 2],
}

/// What bounds a dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanLimits {
    /// Lanes in a workgroup.
    pub width: u32,
    /// Workgroups along one dimension.
    pub row: u32,
    /// Edges of all instances, 8 GiB of planes: far less than counters of 32 bits hold, and than what takes so
    /// long that a system takes the GPU away.
    pub edges: u32,
}

/// Rounds of a workgroup's lanes in brute force: enough that starting it costs little, and no more than that where
/// too few workgroups would be busy.
pub(crate) const ROUNDS: [u32; 2] = [8, 32];

/// Workgroups that a GPU should have before a workgroup gets more to do: 132 multiprocessors of an NVIDIA H200 hold
/// 2,112 of 128 lanes at once.
const BUSY: u64 = 2048;

/// Super-patches for a workgroup: they hold some ten patches each, of which a fourth is tested.
const SUPER_PATCHES: u32 = 32;

/// Shaders look at them in one round, and count survivors in nine bits and what these hold in the rest.
const _: () = {
    let most = WIDTHS[WIDTHS.len() - 1];
    assert!(SUPER_PATCHES <= WIDTHS[0] && most < 1 << 9);
    assert!(most as u64 * MAX_PIECE as u64 <= u32::MAX as u64 >> 9 && MAX_GROUP <= MAX_PIECE);
};

/// What is to be done for `instances` of a model.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Pieces of the model.
    pub chunks: &'a [Chunk],
    /// Its rigid parts.
    pub part_count: u32,
    /// How contour edges are found.
    pub method: Method,
    /// Number of instances.
    pub instances: u32,
    /// Segments that fit the output.
    pub segment_capacity: u32,
    /// What bounds a dispatch.
    pub limits: PlanLimits,
}

impl Plan<'_> {
    /// Hands its dispatches to `visit`, in order.
    pub fn dispatches(&self, visit: &mut impl FnMut(Dispatch)) {
        for (index, chunk) in self.chunks.iter().enumerate() {
            if self.method == Method::BruteForce {
                for (part, edges) in &chunk.parts {
                    let items = [edges.start, edges.end - edges.start];
                    self.cut(index, Stage::Edges, items, *part, visit);
                }
            } else if chunk.super_patches.is_empty() {
                self.cut(index, Stage::Patches, [0, count(&chunk.patches)], 0, visit);
            } else {
                let items = [0, count(&chunk.super_patches)];
                self.cut(index, Stage::SuperPatches, items, 0, visit);
            }
        }
    }

    /// Most dispatches that fewer instances or other shares could need: with the least for a workgroup.
    pub fn most_dispatches(&self) -> usize {
        let mut count = 0;
        let limits = PlanLimits { width: 1, ..self.limits };
        Self { limits, ..*self }.dispatches(&mut |_| count += 1);
        count
    }

    fn cut(
        &self,
        chunk: usize,
        stage: Stage,
        [first, count]: [u32; 2],
        part: u32,
        visit: &mut impl FnMut(Dispatch),
    ) {
        let share = self.share(stage, count);
        let edges = &self.chunks[chunk].edges;
        let tiles = Tiles {
            limits: self.limits,
            items: [first, count],
            share,
            instances: self.instances,
            most_instances: self.limits.edges / (edges.end - edges.start).max(1),
        };
        let (part_count, segment_capacity) = (self.part_count, self.segment_capacity);
        tiles.cut(&mut |work, grid| {
            let work = Work { part_count, part, segment_capacity, ..work };
            visit(Dispatch { stage, chunk, work, grid });
        });
    }

    /// Items for a workgroup: as many as it has room for, fewer where too few workgroups would be busy.
    fn share(&self, stage: Stage, count: u32) -> u32 {
        let width = self.limits.width;
        let (most, least) = match stage {
            Stage::Edges => (width * ROUNDS[1], width * ROUNDS[0]),
            Stage::Patches => (width, width.div_ceil(8)),
            Stage::SuperPatches => (SUPER_PATCHES.min(width), 1),
        };
        let mut share = most;
        while share / 2 >= least
            && u64::from(count.div_ceil(share)) * u64::from(self.instances) < BUSY
        {
            share /= 2;
        }
        share
    }
}

/// Items of instances, to be cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiles {
    pub(crate) limits: PlanLimits,
    /// The first item, and their number.
    pub(crate) items: [u32; 2],
    /// Items for a workgroup.
    pub(crate) share: u32,
    pub(crate) instances: u32,
    /// Most of these in a dispatch.
    pub(crate) most_instances: u32,
}

impl Tiles {
    /// Hands to `visit` what dispatches have to do, but for parts and segments, and their workgroups along x
    /// and y.
    pub(crate) fn cut(&self, visit: &mut impl FnMut(Work, [u32; 2])) {
        let Self { limits, items: [first, count], share, instances, most_instances } = *self;
        // Workgroups are numbered in 32 bits.
        let most_workgroups = (u64::from(limits.row).pow(2)).min(u64::from(u32::MAX / 2));
        let most_items = small(most_workgroups * u64::from(share));
        for first_item in (first..first + count).step_by(most_items as usize) {
            let item_count = most_items.min(first + count - first_item);
            let blocks = item_count.div_ceil(share);
            let step = small(most_workgroups / u64::from(blocks)).min(most_instances).max(1);
            for first_instance in (0..instances).step_by(step as usize) {
                let instance_count = step.min(instances - first_instance);
                let workgroups = blocks * instance_count;
                // No more rows than needed, and as even as can be.
                let rows = workgroups.div_ceil(limits.row);
                let row = workgroups.div_ceil(rows);
                let work = Work {
                    first_item,
                    item_count,
                    items_per_workgroup: share,
                    first_instance,
                    instance_count,
                    most_instances: instances,
                    row,
                    ..Work::default()
                };
                visit(work, [row, rows]);
            }
        }
    }
}

fn count<T>(items: &[T]) -> u32 {
    small(items.len() as u64)
}

/// What is beyond a u32 is beyond any limit.
pub(crate) fn small(number: u64) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}
