//! Two passes: a sign for each face, then two look-ups for each edge.

use std::cmp::Ordering;

use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, Wing, face_side};

use crate::faces::{FaceBlock, Frame, LANES, View};
use crate::simd::{Instructions, Kernel, Lanes, Level};
use crate::{Contours, Statistics};

/// Tests every edge: one sign for each face, sixteen faces side by side, then two look-ups for each
/// edge. 12 bytes an edge and 9 a face. It tests fewest planes, but look-ups are slow.
#[derive(Clone, Debug)]
pub struct FaceSigns<'mesh> {
    mesh: &'mesh Mesh,
    level: Level,
    frame: Frame,
    faces: Vec<FaceBlock>,
    edges: Vec<Candidate>,
    /// Of each face: [`BACK`], [`BACK_TURNED`], or neither where it is seen edge-on.
    sides: Vec<u8>,
}

/// A face that looks away.
const BACK: u8 = 1;
/// A face that looks away if it is turned over.
const BACK_TURNED: u8 = 2;

/// An edge and the faces it lies between.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    edge: EdgeId,
    left: u32,
    /// Twice the right face, and 1 more if the wing reads it turned over.
    right: u32,
}

impl<'mesh> FaceSigns<'mesh> {
    /// Lays out the edges that `filter` keeps, for the newest instructions that this processor has.
    /// Linear.
    pub fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        let inner =
            adjacency.edges(filter).filter(|&edge| adjacency.wing(edge).right != Wing::NONE);
        let candidate = |edge| {
            let [left, right] = adjacency.sides(edge).map(|half| half.triangle());
            let right = 2 * right + u32::from(adjacency.is_right_turned(edge));
            Candidate { edge, left, right }
        };
        let edges: Vec<Candidate> = inner.map(candidate).collect();
        let wings = adjacency.wings();
        let frame = Frame::new(mesh.positions(), wings);
        let planes: Vec<_> = mesh
            .triangles()
            .iter()
            .map(|triangle| frame.plane(triangle.map(|vertex| mesh.position(vertex))))
            .collect();
        let faces = planes
            .chunks(LANES)
            .map(|planes| FaceBlock::new(|lane| planes[lane.min(planes.len() - 1)]))
            .collect::<Vec<_>>();
        let sides = vec![0; LANES * faces.len()];
        Self { mesh, level: Level::newest(), frame, faces, edges, sides }
    }

    /// The same with certain instructions; `None` if this processor has not got them.
    pub fn with_instructions(mut self, instructions: Instructions) -> Option<Self> {
        self.level = instructions.level()?;
        Some(self)
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, by id. Allocates nothing
    /// once `contours` has been used, but where an exact sign needs rational numbers.
    pub fn extract(&mut self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        let triangles = self.mesh.triangles();
        let ask = |face: usize| {
            let corners = triangles[face].map(|vertex| self.mesh.position(vertex));
            match face_side(corners, viewpoint) {
                Ordering::Less => BACK,
                Ordering::Equal => 0,
                Ordering::Greater => BACK_TURNED,
            }
        };
        let (view, sides) = (self.frame.view(self.level, viewpoint), &mut self.sides[..]);
        self.level.run(Signs { faces: &self.faces, count: triangles.len(), view, ask, sides });
        let found = &mut contours.found;
        found.statistics = Statistics { edges_tested: self.edges.len(), ..Statistics::default() };
        let places = found.room(self.edges.len());
        let mut count = 0;
        for candidate in &self.edges {
            let is_turned = candidate.right & 1;
            let left = self.sides[candidate.left as usize];
            let right = self.sides[(candidate.right >> 1) as usize] >> is_turned;
            // Written in any case, as a branch would be guessed wrong too often.
            places[count] = candidate.edge;
            count += usize::from((left ^ right) & 1);
        }
        found.statistics.contour_edges = count;
        found.statistics
    }
}

/// Finds the side of every face.
struct Signs<'a, F> {
    faces: &'a [FaceBlock],
    count: usize,
    view: View,
    /// The side of a face, where that is doubtful.
    ask: F,
    sides: &'a mut [u8],
}

impl<F: Fn(usize) -> u8> Kernel for Signs<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { faces, count, view, ask, sides } = self;
        for (number, (block, places)) in faces.iter().zip(sides.chunks_exact_mut(LANES)).enumerate()
        {
            let seen = block.sides(lanes, view);
            for (lane, place) in places.iter_mut().enumerate() {
                *place = if seen.back >> lane & 1 == 1 { BACK } else { BACK_TURNED };
            }
            if seen.doubtful != 0 {
                for lane in (0..LANES).filter(|lane| seen.doubtful >> lane & 1 == 1) {
                    let face = LANES * number + lane;
                    if face < count {
                        places[lane] = ask(face);
                    }
                }
            }
        }
    }
}
