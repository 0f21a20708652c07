//! Bounds, sixteen side by side.

use std::ops::Range;

use drypoint_bounds::DoubleCone;

use crate::faces::LANES;

/// Up to sixteen bounds.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct BoundBlock {
    pub(crate) centers: [[f32; LANES]; 3],
    pub(crate) apex_distances: [f32; LANES],
    pub(crate) axes: [[f32; LANES]; 3],
    pub(crate) tans_squared: [f32; LANES],
}

impl BoundBlock {
    /// Of at most sixteen.
    fn new(bounds: &[DoubleCone]) -> Self {
        let bound = |lane: usize| bounds.get(lane).unwrap_or(&DoubleCone::ALWAYS);
        let column = |field: fn(&DoubleCone) -> f32| std::array::from_fn(|lane| field(bound(lane)));
        Self {
            centers: [column(|b| b.center.x), column(|b| b.center.y), column(|b| b.center.z)],
            apex_distances: column(|b| b.apex_distance),
            axes: [column(|b| b.axis.x), column(|b| b.axis.y), column(|b| b.axis.z)],
            tans_squared: column(|b| b.tan_squared),
        }
    }
}

/// What a bound holds: a run of blocks of the next level, and how many patches or edges of them are its
/// own. It may begin with the block that the bound before ends with.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Held {
    pub(crate) first: u32,
    pub(crate) blocks: u32,
    pub(crate) count: u32,
}

impl Held {
    /// The blocks.
    pub(crate) fn range(&self) -> Range<u32> {
        self.first..self.first + self.blocks
    }
}

/// Bounds in blocks, of patches or of super-patches. Bound i of block b has the number 16 b + i.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bounds {
    pub(crate) blocks: Vec<BoundBlock>,
    /// Of each block, a bit for each bound that there is.
    pub(crate) used: Vec<u16>,
    /// By the number of the bound.
    pub(crate) held: Vec<Held>,
}

impl Bounds {
    /// Appends bounds, and what each holds, in blocks of their own.
    pub(crate) fn push(&mut self, bounds: &[DoubleCone], held: &[Held]) -> Held {
        let first = self.len();
        for (bounds, held) in bounds.chunks(LANES).zip(held.chunks(LANES)) {
            self.blocks.push(BoundBlock::new(bounds));
            self.used.push(u16::MAX >> (LANES - bounds.len()));
            self.held.extend(held);
            self.held.resize(LANES * self.blocks.len(), Held::default());
        }
        #[expect(clippy::cast_possible_truncation, reason = "no more bounds than edge ids")]
        Held { first, blocks: self.len() - first, count: bounds.len() as u32 }
    }

    /// What the bounds of a block hold.
    pub(crate) fn held_by(&self, block: u32) -> &[Held] {
        &self.held[LANES * block as usize..][..LANES]
    }

    /// How many blocks of the next level those of a block hold.
    pub(crate) fn held_blocks(&self, block: u32) -> u32 {
        self.held_by(block).iter().map(|held| held.blocks).sum()
    }

    /// How many bounds are in these blocks.
    pub(crate) fn count(&self, blocks: Range<u32>) -> usize {
        let used = &self.used[blocks.start as usize..blocks.end as usize];
        used.iter().map(|used| used.count_ones() as usize).sum()
    }

    /// How many blocks.
    #[expect(clippy::cast_possible_truncation, reason = "no more bounds than edge ids")]
    pub(crate) fn len(&self) -> u32 {
        self.blocks.len() as u32
    }
}
