//! Where surfaces pass through each other.

#[cfg(feature = "visibility")]
mod find;
#[cfg(feature = "visibility")]
mod meeting;
#[cfg(feature = "visibility")]
mod passing;

use glam::DVec3;

use crate::Segment;

/// The lines along which the surfaces of a mesh pass through each other, without an edge there: of
/// one part through another, or of a part through itself. They are the same from everywhere.
///
/// A line goes from one side of a face to the other, and so:
/// - Surfaces that touch have none, be it at a vertex, along an edge, or in a plane that they share:
///   not a box on a floor, nor two boxes side by side, nor a T-junction, nor a surface that is
///   stored twice. This holds up to rounding, by the measure of [`Occluders`](crate::Occluders):
///   4 steps of f32 at the larger one's largest coordinate.
/// - A surface that passes through another exactly along its own edges has a line there: a ball that
///   is cut at its equator.
/// - A surface that comes into a plane of another, stays there for a while and leaves on the other
///   side has none: there is no place where it passes.
/// - Faces that share an edge have none, however many meet there.
///
/// Faces without area pass through nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intersections {
    points: Vec<DVec3>,
    /// By the faces that cross.
    pieces: Vec<Piece>,
}

/// A segment in which two faces cross.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    ends: [End; 2],
    /// The lower one first.
    faces: [u32; 2],
    /// The edge of each face that it runs along up to rounding, lower vertex first.
    edges: [Option<[u32; 2]>; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    not(feature = "visibility"),
    expect(dead_code, reason = "without it nothing finds intersections, and there are none")
)]
enum End {
    /// A welded vertex of the mesh.
    Vertex(u32),
    /// One of the points.
    Point(u32),
}

impl Intersections {
    /// Number of segments: pairs of faces that cross.
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether nothing passes through anything.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Ends of segments that are no vertices.
    pub(crate) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The segments, with points numbered from `first_point` on, each with the edges that it runs
    /// along.
    pub(crate) fn segments(
        &self,
        first_point: u32,
    ) -> impl Iterator<Item = (Segment, [Option<[u32; 2]>; 2])> {
        self.pieces.iter().map(move |piece| {
            let ends = piece.ends.map(|end| match end {
                End::Vertex(vertex) => vertex,
                End::Point(point) => first_point + point,
            });
            (Segment { ends, faces: piece.faces, edge: None }, piece.edges)
        })
    }
}
