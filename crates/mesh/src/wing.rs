//! Edges as a renderer reads them: four vertices each.

use bytemuck::{Pod, Zeroable};

/// Index of a [`Wing`] in a [`MeshAdjacency`](crate::MeshAdjacency).
///
/// A manifold or boundary edge is one wing; a non-manifold edge has several, one per pair of its
/// faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Pod, Zeroable)]
#[repr(transparent)]
pub struct EdgeId(pub u32);

impl EdgeId {
    /// The id as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One side of an edge: `3 * triangle + corner`, from that corner to the triangle's next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Pod, Zeroable)]
#[repr(transparent)]
pub struct HalfEdge(pub u32);

impl HalfEdge {
    /// The missing right side of a boundary edge.
    pub const NONE: Self = Self(u32::MAX);

    /// The triangle it belongs to. Meaningless for [`HalfEdge::NONE`].
    pub fn triangle(self) -> u32 {
        self.0 / 3
    }

    /// The corner it starts from, 0..3.
    pub fn corner(self) -> usize {
        (self.0 % 3) as usize
    }
}

/// An edge with the opposite vertices of the two faces that meet there.
///
/// ```text
///        head
///       / ^ \
///  left   |   right
///       \ | /
///        tail
/// ```
///
/// The left face is (tail, head, left), the right one (head, tail, right), both counter-clockwise
/// seen from outside. Vertices are welded: of all vertices at one position the lowest index.
///
/// Where two faces meet with inconsistent winding, the right one is read as the wing says, that
/// is, turned over; the contour test so stays local to the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Pod, Zeroable)]
#[repr(C)]
pub struct Wing {
    /// Where the edge starts, in the direction of its left face.
    pub tail: u32,
    /// Where the edge ends.
    pub head: u32,
    /// Third vertex of the left face.
    pub left: u32,
    /// Third vertex of the right face; [`Wing::NONE`] on a boundary edge.
    pub right: u32,
}

impl Wing {
    /// The missing right vertex of a boundary edge.
    pub const NONE: u32 = u32::MAX;

    /// Corners of the left face.
    pub fn left_face(&self) -> [u32; 3] {
        [self.tail, self.head, self.left]
    }

    /// Corners of the right face, as the wing reads it. Its last entry is [`Wing::NONE`] on a
    /// boundary edge.
    pub fn right_face(&self) -> [u32; 3] {
        [self.head, self.tail, self.right]
    }

    /// The two ends, lower index first.
    pub fn ends(&self) -> [u32; 2] {
        [self.tail.min(self.head), self.tail.max(self.head)]
    }
}
