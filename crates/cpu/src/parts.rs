//! What is looked through at a time.

use std::ops::Range;

use crate::bounds::{Bounds, Held};
use crate::edges::EdgePlanes;

/// Blocks of edges in a tile, at most, unless one block of bounds holds more: half a megabyte of planes
/// and labels, so that they stay in the second cache while one viewpoint after the other looks at them.
const TILE: u32 = 1536;

/// A part of all patches.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    /// Blocks of bounds of super-patches, and how many these are.
    pub(crate) groups: Range<u32>,
    pub(crate) super_patches: usize,
    /// Blocks of bounds of patches that no super-patch holds, and how many these are.
    pub(crate) bounds: Range<u32>,
    pub(crate) patches: usize,
    /// Blocks of edges that no patch holds, and how many edges these are.
    pub(crate) always_tested: Range<u32>,
    pub(crate) edges: usize,
}

impl Part {
    fn of_groups(blocks: Range<u32>, groups: &Bounds) -> Self {
        Self { super_patches: groups.count(blocks.clone()), groups: blocks, ..Self::default() }
    }

    fn of_patches(blocks: Range<u32>, bounds: &Bounds) -> Self {
        Self { patches: bounds.count(blocks.clone()), bounds: blocks, ..Self::default() }
    }

    fn of_edges(blocks: Range<u32>, edges: &EdgePlanes) -> Self {
        Self { edges: edges.count(blocks.clone()), always_tested: blocks, ..Self::default() }
    }

    /// In tiles of about the same size, in order.
    pub(crate) fn tiles(&self, groups: &Bounds, bounds: &Bounds, edges: &EdgePlanes) -> Vec<Self> {
        let in_group = |block: u32| {
            let patches = groups.held_by(block).iter().flat_map(Held::range);
            patches.map(|block| bounds.held_blocks(block)).sum()
        };
        let of_groups = cut(self.groups.clone(), in_group).into_iter();
        let of_patches = cut(self.bounds.clone(), |block| bounds.held_blocks(block)).into_iter();
        let of_edges = cut(self.always_tested.clone(), |_| 1).into_iter();
        of_groups
            .map(|blocks| Self::of_groups(blocks, groups))
            .chain(of_patches.map(|blocks| Self::of_patches(blocks, bounds)))
            .chain(of_edges.map(|blocks| Self::of_edges(blocks, edges)))
            .collect()
    }
}

/// Into runs that weigh no more than [`TILE`], or are one number.
fn cut(range: Range<u32>, weight: impl Fn(u32) -> u32) -> Vec<Range<u32>> {
    let mut runs: Vec<Range<u32>> = Vec::new();
    let mut total = 0;
    for number in range {
        let weight = weight(number);
        match runs.last_mut() {
            Some(run) if total + weight <= TILE => {
                run.end = number + 1;
                total += weight;
            }
            _ => {
                runs.push(number..number + 1);
                total = weight;
            }
        }
    }
    runs
}
