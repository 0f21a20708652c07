//! Edges, sixteen side by side.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use drypoint_mesh::Wing;
use glam::Vec3;

use crate::faces::{FaceBlock, Frame, LANES, Plane, View};
use crate::simd::Lanes;

/// What a block's edges are, a bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Seen {
    /// Contour edges, if they are not doubtful.
    pub(crate) contours: u16,
    /// Edges beside a face of which the exact predicate must tell.
    pub(crate) doubtful: u16,
}

impl Seen {
    /// Whether there is an edge that may be a contour edge.
    #[inline(always)]
    pub(crate) fn is_any(self) -> bool {
        (self.contours | self.doubtful) != 0
    }
}

/// Edges in blocks of up to sixteen, each edge at a place among all.
pub(crate) trait Blocks: Default {
    /// Appends the edges of `wings`, which have the places from `first_place` on, in blocks of their
    /// own. Those of one face only are never contour edges.
    fn push(&mut self, frame: &Frame, positions: &[Vec3], wings: &[Wing], first_place: u32);

    /// What is looked at of every block; slices, so that a loop need not ask for them again.
    type LookedAt<'a>: Copy
    where
        Self: 'a;

    fn looked_at(&self) -> Self::LookedAt<'_>;

    /// The contour edges of a block, certain but for those that are doubtful.
    fn look<L: Lanes>(blocks: Self::LookedAt<'_>, lanes: L, block: u32, view: View) -> Seen;

    /// The place of an edge; `None` if there is no such edge.
    fn place(&self, block: u32, lane: usize) -> Option<u32>;

    /// How many blocks.
    fn len(&self) -> u32;

    /// What `labels` has for each place; lanes without an edge get that of the first.
    fn labels<T: Copy>(&self, labels: impl Fn(usize) -> T) -> Vec<[T; LANES]> {
        let label = |block: u32| {
            let place = |lane| self.place(block, lane);
            let first = (0..LANES).find_map(place).expect("no block is without an edge");
            std::array::from_fn(|lane| labels(place(lane).unwrap_or(first) as usize))
        };
        (0..self.len()).map(label).collect()
    }
}

/// The planes of both faces of each edge: four cache lines a block.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgePlanes {
    /// Of left faces and right faces.
    planes: Vec<[FaceBlock; 2]>,
    /// The place of each block's first edge, and how many there are, at places that follow.
    places: Vec<[u32; 2]>,
}

impl EdgePlanes {
    /// How many edges are in these blocks.
    pub(crate) fn count(&self, blocks: Range<u32>) -> usize {
        let places = &self.places[blocks.start as usize..blocks.end as usize];
        places.iter().map(|[_, count]| *count as usize).sum()
    }
}

impl Blocks for EdgePlanes {
    type LookedAt<'a> = &'a [[FaceBlock; 2]];

    /// An edge of one face only is as if it had that on both sides, and so are lanes without one. Linear.
    #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
    fn push(&mut self, frame: &Frame, positions: &[Vec3], wings: &[Wing], first_place: u32) {
        let plane = |face: [u32; 3]| frame.plane(face.map(|vertex| positions[vertex as usize]));
        for (wings, number) in wings.chunks(LANES).zip(0..) {
            let lane = |lane: usize| {
                let wing = &wings[lane.min(wings.len() - 1)];
                let left = plane(wing.left_face());
                let has_two = lane < wings.len() && wing.right != Wing::NONE;
                [left, if has_two { plane(wing.right_face()) } else { left }]
            };
            let planes: [[Plane; 2]; LANES] = std::array::from_fn(lane);
            self.planes.push([0, 1].map(|side| FaceBlock::new(|lane| planes[lane][side])));
            self.places.push([first_place + number * LANES as u32, wings.len() as u32]);
        }
    }

    #[inline(always)]
    fn looked_at(&self) -> &[[FaceBlock; 2]] {
        &self.planes
    }

    #[inline(always)]
    fn look<L: Lanes>(planes: &[[FaceBlock; 2]], lanes: L, block: u32, view: View) -> Seen {
        let [left, right] = &planes[block as usize];
        let heights = [left.heights(lanes, view), right.heights(lanes, view)];
        Seen { contours: lanes.differ(heights), doubtful: lanes.any_within(heights, view.margin) }
    }

    #[expect(clippy::cast_possible_truncation, reason = "a lane")]
    fn place(&self, block: u32, lane: usize) -> Option<u32> {
        let [first, count] = self.places[block as usize];
        (lane < count as usize).then(|| first + lane as u32)
    }

    #[expect(clippy::cast_possible_truncation, reason = "at most one for each edge id")]
    fn len(&self) -> u32 {
        self.planes.len() as u32
    }
}
