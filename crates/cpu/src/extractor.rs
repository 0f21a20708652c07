//! Patches laid out for the processor.

use std::ops::Range;

use drypoint_bounds::DoubleCone;
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint};

use crate::Statistics;
use crate::bounds::{Bounds, Held};
use crate::contours::{Contours, Found, Scratch};
use crate::edges::{Blocks, EdgePlanes};
use crate::exact::{Exact, Hit};
use crate::faces::{Frame, LANES, View};
use crate::kernels::{Cull, Eye, Test};
use crate::parts::Part;
use crate::simd::{Instructions, Label, Level};

/// Finds contour edges through patches, with the newest instructions of the processor.
///
/// [`extract_patches`](crate::extract_patches) finds the same edges. Here planes are whole numbers of
/// 16 bits, laid out once, sixteen edges side by side; where these are not sure of a sign, at faces seen
/// edge-on, the exact predicate is asked. So the answer is that of the definition, in the same order
/// with any [`Instructions`].
///
/// 28.5 bytes for each place in a block of sixteen edges, beside the patches themselves: a patch's last
/// block may have fewer.
#[derive(Clone, Debug)]
pub struct Extractor<'a> {
    patches: &'a PatchSet,
    level: Level,
    frame: Frame,
    /// The edges of each patch, where two may share a block, then those that no patch holds.
    blocks: EdgePlanes,
    pub(crate) edges: Vec<[EdgeId; LANES]>,
    pub(crate) pairs: Vec<[[u32; 2]; LANES]>,
    /// Of super-patches; they hold blocks of `bounds`.
    groups: Bounds,
    /// Of patches; they hold blocks of edges.
    bounds: Bounds,
    whole: Part,
    /// The same in pieces that fit the second cache.
    pub(crate) tiles: Vec<Part>,
}

/// A viewpoint as kernels read it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    viewpoint: Viewpoint,
    view: View,
    eye: Eye,
}

impl<'a> Extractor<'a> {
    /// Lays out `patches`, for the newest instructions that this processor has. Some 0.5 µs for each
    /// edge.
    pub fn new(patches: &'a PatchSet) -> Self {
        Self::laid_out(patches, Level::newest())
    }

    /// The same for certain instructions; `None` if this processor has not got them.
    pub fn with(patches: &'a PatchSet, instructions: Instructions) -> Option<Self> {
        instructions.level().map(|level| Self::laid_out(patches, level))
    }

    fn laid_out(patches: &'a PatchSet, level: Level) -> Self {
        let mut layout = Layout {
            patches,
            frame: Frame::new(patches.positions(), patches.wings()),
            blocks: EdgePlanes::default(),
            bounds: Bounds::default(),
        };
        let (cones, held): (Vec<DoubleCone>, Vec<Held>) = patches
            .super_patches()
            .iter()
            .map(|group| (group.bound, layout.push_patches(group.patches())))
            .unzip();
        let mut groups = Bounds::default();
        groups.push(&cones, &held);
        let loose = layout.push_patches(patches.always_tested_patches());
        let always_tested = layout.push_edges(patches.always_tested());
        let whole = Part {
            groups: 0..groups.len(),
            super_patches: cones.len(),
            bounds: loose.range(),
            patches: loose.count as usize,
            always_tested: always_tested.range(),
            edges: always_tested.count as usize,
        };
        let Layout { frame, blocks, bounds, .. } = layout;
        let edges = blocks.labels(|place| patches.edge_ids()[place]);
        let pairs = blocks.labels(|place| patches.wings()[place].ends());
        let tiles = whole.tiles(&groups, &bounds, &blocks);
        Self { patches, level, frame, blocks, edges, pairs, groups, bounds, whole, tiles }
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, by id: those of one patch
    /// after the other, the always-tested ones last. Allocates nothing once `contours` has been used,
    /// but where an exact sign needs rational numbers.
    pub fn edges(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        self.extract(viewpoint, &self.edges, contours)
    }

    /// The same as [`Extractor::edges`], by the edges' vertices in the mesh, lower index first; once
    /// for each wing of an edge where more than two faces meet.
    pub fn vertex_pairs(
        &self,
        viewpoint: Viewpoint,
        contours: &mut Contours<[u32; 2]>,
    ) -> Statistics {
        self.extract(viewpoint, &self.pairs, contours)
    }

    /// The same as [`Extractor::edges`] with no patch skipped.
    pub fn all_edges(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        let Contours { found, scratch, .. } = contours;
        found.statistics =
            Statistics { edges_tested: self.patches.wings().len(), ..Statistics::default() };
        // For what culling needs, too, so that no later call needs more.
        self.make_room(scratch);
        let blocks = 0..self.blocks.len();
        self.test(blocks, self.sight(viewpoint), &self.edges, (scratch.hits(0), found));
        found.statistics
    }

    fn extract<T: Label>(
        &self,
        viewpoint: Viewpoint,
        labels: &[[T; LANES]],
        contours: &mut Contours<T>,
    ) -> Statistics {
        let Contours { found, scratch, .. } = contours;
        found.statistics = Statistics::default();
        // For all there are, so that no later view needs more.
        found.room(LANES * self.blocks.len() as usize);
        self.look_through(&self.whole, self.sight(viewpoint), labels, (scratch, found));
        found.statistics
    }

    pub(crate) fn sight(&self, viewpoint: Viewpoint) -> Sight {
        Sight { viewpoint, view: self.frame.view(self.level, viewpoint), eye: Eye::new(viewpoint) }
    }

    /// Appends the contour edges of `part`.
    pub(crate) fn look_through<T: Label>(
        &self,
        part: &Part,
        sight: Sight,
        labels: &[[T; LANES]],
        (scratch, found): (&mut Scratch, &mut Found<T>),
    ) {
        self.make_room(scratch);
        let Scratch { survivors, bound_blocks, edge_blocks, hits, doubtful } = scratch;
        let groups = self.level.run(Cull {
            numbers: part.groups.clone(),
            bounds: &self.groups,
            eye: sight.eye,
            survivors: &mut *survivors,
            found: &mut *bound_blocks,
        });
        let grouped = bound_blocks[..groups.blocks].iter().copied();
        let patches = self.level.run(Cull {
            numbers: grouped.chain(part.bounds.clone()),
            bounds: &self.bounds,
            eye: sight.eye,
            survivors,
            found: &mut *edge_blocks,
        });
        let end = patches.blocks + part.always_tested.len();
        let always_tested = &mut edge_blocks[patches.blocks..end];
        always_tested
            .iter_mut()
            .zip(part.always_tested.clone())
            .for_each(|(place, block)| *place = block);
        let statistics = &mut found.statistics;
        statistics.super_patches_tested += part.super_patches;
        statistics.super_patches_accepted += groups.survivors;
        statistics.patches_tested += groups.count + part.patches;
        statistics.patches_accepted += patches.survivors;
        statistics.edges_tested += patches.count + part.edges;
        self.test(edge_blocks[..end].iter().copied(), sight, labels, ((hits, doubtful), found));
    }

    /// For whatever is looked through.
    fn make_room(&self, scratch: &mut Scratch) {
        let (groups, bounds) = (self.groups.held.len(), self.bounds.held.len());
        scratch.make_room([
            groups.max(bounds),
            self.bounds.blocks.len(),
            self.blocks.len() as usize,
        ]);
    }

    /// Appends the contour edges in so many blocks of edges.
    fn test<T: Label>(
        &self,
        numbers: impl ExactSizeIterator<Item = u32>,
        sight: Sight,
        labels: &[[T; LANES]],
        ((hits, doubtful), found): ((&mut [Hit], &mut [usize]), &mut Found<T>),
    ) {
        let Sight { viewpoint, view, .. } = sight;
        let (positions, wings) = (self.patches.positions(), self.patches.wings());
        let exact = Exact { positions, wings, viewpoint };
        let contours = found.room(LANES * numbers.len());
        let blocks = &self.blocks;
        let test = Test { numbers, blocks, labels, view, exact, hits, doubtful, contours };
        found.statistics.contour_edges += self.level.run(test);
    }
}

/// What an [`Extractor`] is made of, as it grows.
struct Layout<'a> {
    patches: &'a PatchSet,
    frame: Frame,
    blocks: EdgePlanes,
    bounds: Bounds,
}

impl Layout<'_> {
    /// Gives the blocks of bounds, and how many patches they are of.
    ///
    /// The last block of a patch is seldom full: where what the next has beside whole blocks still fits in,
    /// that begins there, and where both are looked at, there is one block less. If only one is, the edges
    /// of the other are no contour edges, as it was culled. Patches in two blocks of bounds share none, as
    /// these may be looked through by different threads.
    fn push_patches(&mut self, range: Range<u32>) -> Held {
        #[expect(clippy::cast_possible_truncation, reason = "sixteen")]
        const BLOCK: u32 = LANES as u32;
        let patches = &self.patches.patches()[range.start as usize..range.end as usize];
        let mut blocks: Vec<Range<u32>> = Vec::new();
        let (mut cones, mut held) = (Vec::new(), Vec::new());
        for (number, patch) in patches.iter().enumerate() {
            let (mut edges, mut first) = (patch.edges(), self.blocks.len() + count(&blocks));
            let rest = (patch.edge_count - 1) % BLOCK + 1;
            let has_room = |last: &&mut Range<u32>| last.end - last.start + rest <= BLOCK;
            if let Some(last) = blocks.last_mut().filter(|_| number % LANES != 0).filter(has_room) {
                last.end += rest;
                edges.start += rest;
                first -= 1;
            }
            let whole = edges.clone().step_by(LANES);
            blocks.extend(whole.map(|start| start..edges.end.min(start + BLOCK)));
            let end = self.blocks.len() + count(&blocks);
            cones.push(patch.bound);
            held.push(Held { first, blocks: end - first, count: patch.edge_count });
        }
        blocks.into_iter().for_each(|places| {
            self.push_edges(places);
        });
        self.bounds.push(&cones, &held)
    }

    /// Gives the blocks of edges, and how many edges they have.
    fn push_edges(&mut self, places: Range<u32>) -> Held {
        let first = self.blocks.len();
        let count = places.end - places.start;
        let wings = &self.patches.wings()[places.start as usize..places.end as usize];
        self.blocks.push(&self.frame, self.patches.positions(), wings, places.start);
        Held { first, blocks: self.blocks.len() - first, count }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "no more blocks than edge ids")]
fn count(blocks: &[Range<u32>]) -> u32 {
    blocks.len() as u32
}
