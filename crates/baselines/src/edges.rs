//! The edges that a baseline holds, in an order of its own.

use std::ops::Range;

use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, Wing, is_contour};
use glam::Vec3;

use crate::Statistics;

/// Edges by place, and the positions that their wings name.
#[derive(Clone, Debug)]
pub(crate) struct Edges<'mesh> {
    positions: &'mesh [Vec3],
    ids: Vec<EdgeId>,
    wings: Vec<Wing>,
}

impl<'mesh> Edges<'mesh> {
    /// Those that `filter` keeps and that have two faces, by id: others are never contour edges.
    pub(crate) fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        let has_two_faces = |edge: &EdgeId| adjacency.wing(*edge).right != Wing::NONE;
        let ids: Vec<EdgeId> = adjacency.edges(filter).filter(has_two_faces).collect();
        let wings = ids.iter().map(|&edge| adjacency.wing(edge)).collect();
        Self { positions: mesh.positions(), ids, wings }
    }

    pub(crate) fn len(&self) -> usize {
        self.ids.len()
    }

    pub(crate) fn positions(&self) -> &'mesh [Vec3] {
        self.positions
    }

    pub(crate) fn ids(&self) -> &[EdgeId] {
        &self.ids
    }

    pub(crate) fn wings(&self) -> &[Wing] {
        &self.wings
    }

    /// The edges at these places, in that order.
    pub(crate) fn arranged(&self, places: &[u32]) -> Self {
        let ids = places.iter().map(|&place| self.ids[place as usize]).collect();
        let wings = places.iter().map(|&place| self.wings[place as usize]).collect();
        Self { positions: self.positions, ids, wings }
    }

    /// Appends the contour edges among those at `places`, and counts.
    pub(crate) fn test(
        &self,
        places: Range<u32>,
        viewpoint: Viewpoint,
        contours: &mut Vec<EdgeId>,
        statistics: &mut Statistics,
    ) {
        let places = places.start as usize..places.end as usize;
        let edges = self.ids[places.clone()].iter().zip(&self.wings[places.clone()]);
        let before = contours.len();
        contours.extend(
            edges
                .filter(|(_, wing)| is_contour(self.positions, wing, viewpoint))
                .map(|(edge, _)| *edge),
        );
        statistics.edges_tested += places.len();
        statistics.contour_edges += contours.len() - before;
    }
}
