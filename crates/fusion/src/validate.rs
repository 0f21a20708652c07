//! What a [`PatchSet`] promises, checked without the code that makes it.

use drypoint_mesh::{EdgeId, Mesh, MeshAdjacency};
use glam::DVec3;

use crate::{Patch, PatchSet, mesh_hash};

/// What is wrong with a [`PatchSet`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidPatches {
    /// The lists by place are not of one length.
    #[error("{wings} wings, {edge_ids} edge ids and {classes} classes do not match")]
    Lengths {
        /// Number of wings.
        wings: usize,
        /// Number of edge ids.
        edge_ids: usize,
        /// Number of classes.
        classes: usize,
    },
    /// A patch does not begin where the one before ends, holds no edge, or ends beyond the last.
    #[error(
        "patch {patch} holds {edge_count} edges from {first_edge}, and not at least 1 from {expected} to {edges}"
    )]
    Range {
        /// Index of the patch.
        patch: usize,
        /// Where it begins.
        first_edge: u32,
        /// How many edges it claims.
        edge_count: u32,
        /// Where it should begin.
        expected: u32,
        /// Number of edges.
        edges: usize,
    },
    /// A wing names a vertex that does not exist.
    #[error("edge {place} uses vertex {vertex}, but there are only {vertex_count}")]
    VertexOutOfRange {
        /// Place of the edge.
        place: usize,
        /// The vertex.
        vertex: u32,
        /// Number of vertices.
        vertex_count: usize,
    },
    /// A position is NaN or infinite.
    #[error("vertex {vertex} has no finite position")]
    PositionNotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A bound is NaN or infinite, or has a negative size.
    #[error("the bound of patch {patch} is not finite")]
    BoundNotFinite {
        /// Index of the patch.
        patch: usize,
    },
    /// An edge is there twice.
    #[error("edge id {} appears twice", edge.0)]
    DuplicateEdge {
        /// Its id.
        edge: EdgeId,
    },
    /// The plane of a face beside an edge is not within the bound of the edge's patch.
    #[error("a face beside edge {place} is not within the bound of patch {patch}")]
    PlaneOutsideBound {
        /// Index of the patch.
        patch: usize,
        /// Place of the edge.
        place: usize,
    },
    /// Another mesh than it was made from.
    #[error("made from another mesh")]
    AnotherMesh,
    /// An edge of the mesh is missing, is not one that the filter keeps, or differs.
    #[error("edge id {} is missing, should not be there, or differs", edge.0)]
    EdgeDiffers {
        /// Its id.
        edge: EdgeId,
    },
}

impl PatchSet {
    /// Checks all that can be checked without the mesh: patches follow one another, every edge is
    /// there once, every number is finite, and both faces' planes of every edge are within the
    /// bound of its patch. Linear, but for a sort of the ids.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), InvalidPatches> {
        self.validate_structure()?;
        let mut ids = self.edge_ids.clone();
        ids.sort_unstable();
        if let Some(pair) = ids.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(InvalidPatches::DuplicateEdge { edge: pair[0] });
        }
        for (index, patch) in self.patches.iter().enumerate() {
            for place in patch.edges().map(|place| place as usize) {
                if !self.is_within_bound(place, patch) {
                    return Err(InvalidPatches::PlaneOutsideBound { patch: index, place });
                }
            }
        }
        Ok(())
    }

    /// Checks that it is of this mesh, and holds each edge that its filter keeps once, as it is.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate_against(
        &self,
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
    ) -> Result<(), InvalidPatches> {
        if mesh_hash(mesh) != self.provenance.mesh_hash || mesh.positions() != self.positions {
            return Err(InvalidPatches::AnotherMesh);
        }
        let mut places: Vec<(EdgeId, usize)> =
            self.edge_ids.iter().enumerate().map(|(place, &edge)| (edge, place)).collect();
        places.sort_unstable();
        let mut found = places.into_iter().peekable();
        for edge in adjacency.edges(self.provenance.filter) {
            let is_same = found.next().is_some_and(|(id, place)| {
                id == edge
                    && self.wings[place] == adjacency.wing(edge)
                    && self.classes[place] == adjacency.class(edge)
            });
            if !is_same {
                return Err(InvalidPatches::EdgeDiffers { edge });
            }
        }
        match found.next() {
            Some((edge, _)) => Err(InvalidPatches::EdgeDiffers { edge }),
            None => Ok(()),
        }
    }

    /// What must hold for no reader to panic: lengths, ranges, vertices, finite numbers.
    pub(crate) fn validate_structure(&self) -> Result<(), InvalidPatches> {
        let edges = self.wings.len();
        if [self.edge_ids.len(), self.classes.len()] != [edges; 2] {
            return Err(InvalidPatches::Lengths {
                wings: edges,
                edge_ids: self.edge_ids.len(),
                classes: self.classes.len(),
            });
        }
        let mut expected = 0u32;
        for (index, patch) in self.patches.iter().enumerate() {
            let &Patch { bound, first_edge, edge_count } = patch;
            let end = first_edge.checked_add(edge_count).filter(|&end| end as usize <= edges);
            expected = match end {
                Some(end) if first_edge == expected && edge_count > 0 => end,
                _ => {
                    let patch = index;
                    return Err(InvalidPatches::Range {
                        patch,
                        first_edge,
                        edge_count,
                        expected,
                        edges,
                    });
                }
            };
            let sizes = [bound.apex_distance, bound.tan_squared];
            let is_finite = bound.center.is_finite()
                && bound.axis.is_finite()
                && sizes.iter().all(|&size| size.is_finite() && size >= 0.0);
            if !is_finite {
                return Err(InvalidPatches::BoundNotFinite { patch: index });
            }
        }
        let vertex_count = self.positions.len();
        for (place, wing) in self.wings.iter().enumerate() {
            let vertices = [wing.tail, wing.head, wing.left, wing.right];
            if let Some(&vertex) = vertices.iter().find(|&&v| v as usize >= vertex_count) {
                return Err(InvalidPatches::VertexOutOfRange { place, vertex, vertex_count });
            }
        }
        match self.positions.iter().position(|position| !position.is_finite()) {
            Some(vertex) => Err(InvalidPatches::PositionNotFinite { vertex }),
            None => Ok(()),
        }
    }

    /// Whether the normals of both faces are within α of the axis, and both planes cross the axis
    /// line between the apexes: then no plane passes through either cone of viewpoints.
    fn is_within_bound(&self, place: usize, patch: &Patch) -> bool {
        let wing = self.wings[place];
        let bound = patch.bound;
        let (center, axis) = (bound.center.as_dvec3(), bound.axis.as_dvec3());
        [wing.left_face(), wing.right_face()].into_iter().all(|face| {
            let [a, b, c] = face.map(|vertex| self.positions[vertex as usize].as_dvec3());
            let normal = (b - a).normalize_or_zero().cross((c - a).normalize_or_zero());
            let Some(normal) = DVec3::try_normalize(normal) else { return false };
            let (cos, sin) = (normal.dot(axis), normal.cross(axis).length());
            let tan = f64::from(bound.tan_squared).sqrt();
            cos > 0.0
                && sin <= tan * cos
                && normal.dot(a - center).abs() <= f64::from(bound.apex_distance) * cos
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FusionParams, fuse};
    use drypoint_mesh::{EdgeClass, EdgeFilter, shapes};
    use glam::Vec3;
    use std::ops::ControlFlow;

    /// Breaks a good asset and sees what [`PatchSet::validate`] says.
    #[track_caller]
    fn check(break_it: impl Fn(&mut PatchSet), is_expected: impl Fn(InvalidPatches) -> bool) {
        let mesh = shapes::bumpy_sphere(1_000);
        let adjacency = MeshAdjacency::new(&mesh);
        let go_on = |_| ControlFlow::Continue(());
        let params = FusionParams::PAPER;
        let mut set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on).unwrap();
        assert_eq!((set.validate(), set.validate_against(&mesh, &adjacency)), (Ok(()), Ok(())));
        assert!(set.patches.len() > 4);
        break_it(&mut set);
        let error = set.validate().and_then(|()| set.validate_against(&mesh, &adjacency));
        assert!(error.is_err_and(&is_expected), "{error:?}");
    }

    #[test]
    fn broken_lists_are_noticed() {
        let is_length = |e| matches!(e, InvalidPatches::Lengths { .. });
        check(|set| set.classes.truncate(9), is_length);
        check(|set| set.wings.truncate(9), is_length);
        check(
            |set| set.edge_ids[3] = set.edge_ids[900],
            |e| matches!(e, InvalidPatches::DuplicateEdge { .. }),
        );
        let is_range = |e| matches!(e, InvalidPatches::Range { patch: 2, .. });
        check(|set| set.patches[2].first_edge += 1, is_range);
        check(|set| set.patches[2].edge_count = 0, is_range);
        check(|set| set.patches[2].edge_count = u32::MAX, is_range);
        check(|set| set.patches.swap(2, 3), is_range);
    }

    #[test]
    fn broken_numbers_are_noticed() {
        check(
            |set| set.wings[7].right = drypoint_mesh::Wing::NONE,
            |e| matches!(e, InvalidPatches::VertexOutOfRange { place: 7, .. }),
        );
        check(
            |set| set.positions[5].y = f32::NAN,
            |e| e == InvalidPatches::PositionNotFinite { vertex: 5 },
        );
        let is_bound = |e| e == InvalidPatches::BoundNotFinite { patch: 1 };
        check(|set| set.patches[1].bound.center.x = f32::INFINITY, is_bound);
        check(|set| set.patches[1].bound.axis.x = f32::NAN, is_bound);
        check(|set| set.patches[1].bound.tan_squared = -1.0, is_bound);
        check(|set| set.patches[1].bound.apex_distance = f32::NAN, is_bound);
    }

    #[test]
    fn bounds_too_small_are_noticed() {
        let is_outside = |e| matches!(e, InvalidPatches::PlaneOutsideBound { patch: 3, .. });
        check(|set| set.patches[3].bound.tan_squared *= 0.99, is_outside);
        check(|set| set.patches[3].bound.apex_distance = 0.0, is_outside);
        check(|set| set.patches[3].bound.axis *= -1.0, is_outside);
        check(|set| set.patches[3].bound.axis = Vec3::ZERO, is_outside);
        check(|set| set.patches[3].bound.center += Vec3::ONE, is_outside);
    }

    #[test]
    fn differences_from_the_mesh_are_noticed() {
        let is_different = |e| matches!(e, InvalidPatches::EdgeDiffers { .. });
        check(|set| set.edge_ids[3].0 = 1_000_000, is_different);
        check(|set| set.classes[3] = EdgeClass::NonManifold, is_different);
        check(|set| set.provenance.filter = EdgeFilter::All, is_different);
        check(|set| set.provenance.mesh_hash ^= 1, |e| e == InvalidPatches::AnotherMesh);
        let drop_last = |set: &mut PatchSet| {
            assert!(set.always_tested().is_empty() || set.always_tested().len() < 20);
            let last = set.wings.len() - 1;
            set.wings.truncate(last);
            set.edge_ids.truncate(last);
            set.classes.truncate(last);
            let patch = set.patches.last_mut().unwrap();
            patch.edge_count -= u32::from(patch.edges().end as usize > last);
        };
        check(drop_last, is_different);
    }
}
