//! Patches laid out for the processor.

use std::ops::{Deref, Range};

use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint, is_contour};

use crate::Statistics;
use crate::blocks::{EdgeBlock, Frame, LANES};
use crate::patch_blocks::PatchBlock;
use crate::simd::{self, Eye, Instructions, Labelled, SLACK, Seen};

/// Finds contour edges through patches, with the newest instructions of the processor.
///
/// [`extract_patches`](crate::extract_patches) finds the same edges in the same order. Here planes
/// are whole numbers of 16 bits, laid out once, eight edges side by side; where these are not sure of
/// a sign, at faces seen edge-on, the exact predicate is asked. So the answer is that of the definition,
/// with any [`Instructions`].
///
/// 29 bytes for each place in a block of eight edges, beside the patches themselves: a patch's last
/// block may have fewer.
#[derive(Clone, Debug)]
pub struct Extractor<'a> {
    patches: &'a PatchSet,
    instructions: Instructions,
    frame: Frame,
    blocks: Vec<EdgeBlock>,
    edges: Vec<[EdgeId; LANES]>,
    pairs: Vec<[[u32; 2]; LANES]>,
    /// Places of each block's edges: the first, and how many.
    places: Vec<[u32; 2]>,
    patch_blocks: Vec<PatchBlock>,
    /// Bounds of super-patches, and their [`PatchBlock`]s.
    groups: Vec<(drypoint_bounds::DoubleCone, Range<usize>)>,
    /// [`PatchBlock`]s that no super-patch holds.
    ungrouped: Range<usize>,
    /// Edge blocks that no patch holds.
    always_tested: Range<u32>,
}

/// What an [`Extractor`] found, and memory for the next time: edge ids or vertex pairs.
///
/// It grows once to the places of all edges, and never again for the same extractor.
#[derive(Clone, Debug)]
pub struct Contours<T> {
    found: Vec<T>,
    count: usize,
    blocks: Vec<u32>,
}

impl<T> Default for Contours<T> {
    fn default() -> Self {
        Self { found: Vec::new(), count: 0, blocks: Vec::new() }
    }
}

impl<T> Deref for Contours<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.found[..self.count]
    }
}

impl<'a> Extractor<'a> {
    /// Lays out `patches`, for the newest instructions that this processor has. Linear.
    pub fn new(patches: &'a PatchSet) -> Self {
        Self::laid_out(patches, Instructions::newest())
    }

    /// The same for certain instructions; `None` if this processor has not got them.
    pub fn with(patches: &'a PatchSet, instructions: Instructions) -> Option<Self> {
        instructions.are_here().then(|| Self::laid_out(patches, instructions))
    }

    fn laid_out(patches: &'a PatchSet, instructions: Instructions) -> Self {
        let mut extractor = Self {
            patches,
            instructions,
            frame: Frame::new(patches.positions(), patches.wings()),
            blocks: Vec::new(),
            edges: Vec::new(),
            pairs: Vec::new(),
            places: Vec::new(),
            patch_blocks: Vec::new(),
            groups: Vec::new(),
            ungrouped: 0..0,
            always_tested: 0..0,
        };
        for group in patches.super_patches() {
            let range = extractor.push_patches(group.patches());
            extractor.groups.push((group.bound, range));
        }
        extractor.ungrouped = extractor.push_patches(patches.always_tested_patches());
        let [first, count] = extractor.push_edges(patches.always_tested());
        extractor.always_tested = first..first + count;
        extractor
    }

    fn push_patches(&mut self, range: Range<u32>) -> Range<usize> {
        let start = self.patch_blocks.len();
        let patches = self.patches;
        for eight in patches.patches()[range.start as usize..range.end as usize].chunks(LANES) {
            let blocks: Vec<[u32; 2]> =
                eight.iter().map(|patch| self.push_edges(patch.edges())).collect();
            self.patch_blocks.push(PatchBlock::new(eight, &blocks));
        }
        start..self.patch_blocks.len()
    }

    /// The first of their blocks, and how many.
    #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
    fn push_edges(&mut self, places: Range<u32>) -> [u32; 2] {
        let start = self.blocks.len();
        for first in places.clone().step_by(LANES) {
            let count = (places.end - first).min(LANES as u32);
            let range = first as usize..(first + count) as usize;
            let wings = &self.patches.wings()[range.clone()];
            let edges = &self.patches.edge_ids()[range];
            self.blocks.push(self.frame.block(self.patches.positions(), wings));
            let last = wings.len() - 1;
            self.edges.push(std::array::from_fn(|lane| edges[lane.min(last)]));
            self.pairs.push(std::array::from_fn(|lane| wings[lane.min(last)].ends()));
            self.places.push([first, count]);
        }
        [start as u32, (self.blocks.len() - start) as u32]
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, by id, in patch order, the
    /// always-tested ones last. Allocates nothing once `contours` has been used, but where
    /// an exact sign needs rational numbers.
    pub fn edges(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        self.extract(viewpoint, &self.edges, EdgeId(0), contours)
    }

    /// The same as [`Extractor::edges`], by the edges' vertices in the mesh, lower index first; once
    /// for each wing of an edge where more than two faces meet.
    pub fn vertex_pairs(
        &self,
        viewpoint: Viewpoint,
        contours: &mut Contours<[u32; 2]>,
    ) -> Statistics {
        self.extract(viewpoint, &self.pairs, [0; 2], contours)
    }

    /// The same as [`Extractor::edges`] with no patch skipped: a brute force, and the fastest that
    /// goes from edge to edge.
    pub fn all_edges(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        self.make_room(EdgeId(0), contours);
        for (place, number) in contours.blocks[..self.blocks.len()].iter_mut().zip(0..) {
            *place = number;
        }
        self.test(self.blocks.len(), viewpoint, &self.edges, contours);
        Statistics {
            edges_tested: self.patches.wings().len(),
            contour_edges: contours.count,
            ..Statistics::default()
        }
    }

    fn make_room<T: Copy>(&self, empty: T, contours: &mut Contours<T>) {
        let room = LANES * self.blocks.len() + SLACK;
        if contours.found.len() < room {
            contours.found = vec![empty; room];
            contours.blocks = vec![0; self.blocks.len() + SLACK];
        }
    }

    fn extract<T: Copy>(
        &self,
        viewpoint: Viewpoint,
        labels: &[[T; LANES]],
        empty: T,
        contours: &mut Contours<T>,
    ) -> Statistics {
        self.make_room(empty, contours);
        let eye = if viewpoint.is_point() {
            Eye::Point(viewpoint.xyz().to_array())
        } else {
            Eye::Direction(viewpoint.xyz().normalize_or_zero().as_vec3())
        };
        let mut statistics = Statistics::default();
        let mut count = 0;
        let mut cull = |range: &Range<usize>, statistics: &mut Statistics| {
            let patches = &self.patch_blocks[range.clone()];
            let culled = simd::cull(self.instructions, patches, eye, &mut contours.blocks[count..]);
            statistics.patches_accepted += culled.survivors;
            statistics.edges_tested += culled.edges;
            count += culled.blocks;
        };
        for (bound, range) in &self.groups {
            if bound.may_hold_contour(viewpoint) {
                statistics.super_patches_accepted += 1;
                statistics.patches_tested += self.patch_blocks[range.clone()]
                    .iter()
                    .map(|block| block.used.count_ones() as usize)
                    .sum::<usize>();
                cull(range, &mut statistics);
            }
        }
        cull(&self.ungrouped, &mut statistics);
        statistics.edges_tested += self.patches.always_tested().len();
        statistics.super_patches_tested = self.groups.len();
        statistics.patches_tested += self.patches.always_tested_patches().len();
        let end = count + self.always_tested.len();
        for (place, number) in
            contours.blocks[count..end].iter_mut().zip(self.always_tested.clone())
        {
            *place = number;
        }
        self.test(end, viewpoint, labels, contours);
        statistics.contour_edges = contours.count;
        statistics
    }

    /// Tests the edges of the first so many of the blocks in `contours`.
    fn test<T: Copy>(
        &self,
        blocks: usize,
        viewpoint: Viewpoint,
        labels: &[[T; LANES]],
        contours: &mut Contours<T>,
    ) {
        let view = self.frame.view(viewpoint);
        let ask = |block: u32, seen: Seen| self.decided(block, seen, viewpoint);
        let numbers = &contours.blocks[..blocks];
        let edges = Labelled { blocks: &self.blocks, labels };
        contours.count =
            simd::test(self.instructions, numbers, edges, view, &ask, &mut contours.found);
    }

    /// Contour edges of a block in which some are doubtful.
    #[cold]
    fn decided(&self, block: u32, seen: Seen, viewpoint: Viewpoint) -> u32 {
        let [first, count] = self.places[block as usize];
        let is_contour = |lane: u32| {
            let wing = &self.patches.wings()[(first + lane) as usize];
            is_contour(self.patches.positions(), wing, viewpoint)
        };
        let doubtful =
            (0..count).filter(|lane| seen.doubtful >> lane & 1 == 1 && is_contour(*lane));
        doubtful.fold(seen.contours & !seen.doubtful, |contours, lane| contours | 1 << lane)
    }
}
