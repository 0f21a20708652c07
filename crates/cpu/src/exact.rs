//! Edges that whole numbers are not sure of.

use bytemuck::{Pod, Zeroable};
use drypoint_mesh::{Viewpoint, Wing, is_contour};
use glam::Vec3;

use crate::edges::{Blocks, Seen};
use crate::faces::LANES;

/// A block, and what was seen of it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Hit {
    pub(crate) block: u32,
    pub(crate) seen: Seen,
}

/// An edge that is doubtful.
#[derive(Clone, Copy, Debug, Default)]
struct Doubt {
    /// Number of the hit.
    hit: usize,
    lane: u32,
    place: u32,
}

/// What the exact predicate asks for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exact<'a> {
    pub(crate) positions: &'a [Vec3],
    /// By place.
    pub(crate) wings: &'a [Wing],
    pub(crate) viewpoint: Viewpoint,
}

impl Exact<'_> {
    /// Sets the contour edges right of the `hits` with these numbers, where they are doubtful. Out of line,
    /// as few are.
    #[cold]
    pub(crate) fn decide<B: Blocks>(&self, blocks: &B, hits: &mut [Hit], doubtful: &[usize]) {
        let mut doubts = [Doubt::default(); LANES];
        let mut count = 0;
        for &hit in doubtful {
            let Hit { block, seen } = hits[hit];
            let mut left = seen.doubtful;
            while left != 0 {
                let lane = left.trailing_zeros();
                left &= left - 1;
                // Lanes without an edge are never contours.
                let Some(place) = blocks.place(block, lane as usize) else { continue };
                doubts[count] = Doubt { hit, lane, place };
                count += 1;
                if count == LANES {
                    self.decide_together(&doubts, hits);
                    count = 0;
                }
            }
        }
        self.decide_together(&doubts[..count], hits);
    }

    /// All wings first, then all their corners: memory is far away, but answers many at a time.
    fn decide_together(&self, doubts: &[Doubt], hits: &mut [Hit]) {
        const OWN: Wing = Wing { tail: 0, head: 1, left: 2, right: 3 };
        let mut wings = [OWN; LANES];
        let mut corners = [[Vec3::ZERO; 4]; LANES];
        for (wing, doubt) in wings.iter_mut().zip(doubts) {
            *wing = self.wings[doubt.place as usize];
        }
        for ((corners, wing), _) in corners.iter_mut().zip(&wings).zip(doubts) {
            let vertices = [wing.tail, wing.head, wing.left, wing.right];
            for (corner, vertex) in corners.iter_mut().zip(vertices) {
                // That of a boundary edge is not asked for.
                *corner = self.positions.get(vertex as usize).copied().unwrap_or_default();
            }
        }
        for ((corners, wing), doubt) in corners.iter().zip(&wings).zip(doubts) {
            let own =
                if wing.right == Wing::NONE { Wing { right: Wing::NONE, ..OWN } } else { OWN };
            let contours = &mut hits[doubt.hit].seen.contours;
            *contours &= !(1 << doubt.lane);
            *contours |= u16::from(is_contour(corners, &own, self.viewpoint)) << doubt.lane;
        }
    }
}
