//! What is looked through at a time.

use std::ops::Range;

use crate::bounds::Bounds;
use crate::edges::EdgePlanes;

/// Blocks of edges in a tile, at most, unless one block of bounds holds more: half a megabyte of planes
/// and labels, so that they stay in the second cache while one viewpoint after the other looks at them.
const TILE: u32 = 1536;

/// A part of all patches.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    /// Blocks of bounds of super-patches.
    pub(crate) groups: Range<u32>,
    /// Blocks of bounds of patches that no super-patch holds.
    pub(crate) bounds: Range<u32>,
    /// Blocks of edges that no patch holds.
    pub(crate) always_tested: Range<u32>,
}

impl Part {
    /// In tiles of about the same size, in order.
    pub(crate) fn tiles(&self, groups: &Bounds, bounds: &Bounds) -> Vec<Self> {
        let blocks_of_patches =
            |range: Range<u32>| range.map(|block| bounds.held_blocks(block)).sum::<u32>();
        let of_groups = cut(self.groups.clone(), |block| {
            groups.held_by(block).iter().map(|held| blocks_of_patches(held.range())).sum()
        });
        let of_patches = cut(self.bounds.clone(), |block| bounds.held_blocks(block));
        let of_edges = cut(self.always_tested.clone(), |_| 1);
        let of_groups = of_groups.into_iter().map(|groups| Self { groups, ..Self::default() });
        let of_patches = of_patches.into_iter().map(|bounds| Self { bounds, ..Self::default() });
        let of_edges =
            of_edges.into_iter().map(|always_tested| Self { always_tested, ..Self::default() });
        of_groups.chain(of_patches).chain(of_edges).collect()
    }

    /// How many super-patches it has, patches that none of these holds, and edges that no patch holds.
    pub(crate) fn counts(
        &self,
        groups: &Bounds,
        bounds: &Bounds,
        blocks: &EdgePlanes,
    ) -> [usize; 3] {
        [
            groups.count(self.groups.clone()),
            bounds.count(self.bounds.clone()),
            blocks.count(self.always_tested.clone()),
        ]
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
