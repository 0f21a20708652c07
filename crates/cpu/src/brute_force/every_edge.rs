//! Every edge, with the planes of its faces laid out.

use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, Wing};

use crate::edges::{Blocks, EdgePlanes};
use crate::exact::Exact;
use crate::faces::{Frame, LANES};
use crate::kernels::Test;
use crate::simd::{Instructions, Level};
use crate::strips::Strips;
use crate::{Contours, Statistics};

/// Tests every edge, with the planes of both its faces stored beside it: 36 bytes an edge, of which 16
/// are read from everywhere. The simplest that runs at the speed of the memory.
#[derive(Clone, Debug)]
pub struct StoredPlanes<'mesh>(EveryEdge<'mesh, EdgePlanes>);

/// Tests every edge, with faces stored in the order of walks from neighbour to neighbour, so that an
/// edge lies between a face and the one before and one plane serves two edges: some 40 bytes an edge,
/// of which 10 are read from everywhere. The fastest brute force we know.
#[derive(Clone, Debug)]
pub struct FaceStrips<'mesh>(EveryEdge<'mesh, Strips>);

impl<'mesh> StoredPlanes<'mesh> {
    /// Lays out the edges that `filter` keeps, for the newest instructions that this processor has.
    /// Linear.
    pub fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        Self(EveryEdge::new(mesh, adjacency, filter))
    }

    /// The same with certain instructions; `None` if this processor has not got them.
    pub fn with_instructions(mut self, instructions: Instructions) -> Option<Self> {
        self.0.level = instructions.level()?;
        Some(self)
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, by id. Allocates nothing
    /// once `contours` has been used, but where an exact sign needs rational numbers.
    pub fn extract(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        self.0.extract(viewpoint, contours)
    }
}

impl<'mesh> FaceStrips<'mesh> {
    /// Lays out the edges that `filter` keeps, for the newest instructions that this processor has.
    /// Takes the time of sorting the faces.
    pub fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        Self(EveryEdge::new(mesh, adjacency, filter))
    }

    /// The same with certain instructions; `None` if this processor has not got them.
    pub fn with_instructions(mut self, instructions: Instructions) -> Option<Self> {
        self.0.level = instructions.level()?;
        Some(self)
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, in the order of the walks.
    /// Allocates nothing once `contours` has been used, but where an exact sign needs rational numbers.
    pub fn extract(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        self.0.extract(viewpoint, contours)
    }
}

/// All edges of a mesh, in one kind of blocks.
#[derive(Clone, Debug)]
struct EveryEdge<'mesh, B> {
    mesh: &'mesh Mesh,
    level: Level,
    frame: Frame,
    wings: Vec<Wing>,
    blocks: B,
    labels: Vec<[EdgeId; LANES]>,
}

impl<'mesh, B: Blocks> EveryEdge<'mesh, B> {
    fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        let edges: Vec<EdgeId> = adjacency.edges(filter).collect();
        let wings: Vec<Wing> = edges.iter().map(|&edge| adjacency.wing(edge)).collect();
        let frame = Frame::new(mesh.positions(), &wings);
        let mut blocks = B::default();
        blocks.push(&frame, mesh.positions(), &wings, 0);
        let labels = blocks.labels(|place| edges[place]);
        Self { mesh, level: Level::newest(), frame, wings, blocks, labels }
    }

    fn extract(&self, viewpoint: Viewpoint, contours: &mut Contours<EdgeId>) -> Statistics {
        let Contours { found, scratch, .. } = contours;
        found.statistics = Statistics { edges_tested: self.wings.len(), ..Statistics::default() };
        let (positions, wings) = (self.mesh.positions(), &self.wings[..]);
        let (hits, doubtful) = scratch.hits(self.labels.len());
        let count = self.level.run(Test {
            numbers: 0..self.blocks.len(),
            blocks: &self.blocks,
            labels: &self.labels,
            view: self.frame.view(self.level, viewpoint),
            exact: Exact { positions, wings, viewpoint },
            hits,
            doubtful,
            contours: found.room(LANES * self.labels.len()),
        });
        found.statistics.contour_edges = count;
        found.statistics
    }
}
