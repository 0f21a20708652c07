//! What a [`PatchSet`] promises, checked without the code that makes it.

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeClass, EdgeId, Mesh, MeshAdjacency, Wing};
use glam::Vec3;

use crate::{Patch, PatchSet, SuperPatch, mesh_hash};

/// What the cross product of two unit vectors may be off by if both are differences of f32 positions,
/// taken and made unit length in f64: 8 units of 2⁻⁵³.
const CROSS_ERROR: f64 = 4.0 * f64::EPSILON;

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
    /// A super-patch does not begin where the one before ends, holds no patch, or ends beyond the
    /// last.
    #[error(
        "super-patch {super_patch} holds {patch_count} patches from {first_patch}, and not at least 1 from {expected} to {patches}"
    )]
    SuperRange {
        /// Index of the super-patch.
        super_patch: usize,
        /// Where it begins.
        first_patch: u32,
        /// How many patches it claims.
        patch_count: u32,
        /// Where it should begin.
        expected: u32,
        /// Number of patches.
        patches: usize,
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
    /// A super-patch's bound is NaN or infinite, or has a negative size.
    #[error("the bound of super-patch {super_patch} is not finite")]
    SuperBoundNotFinite {
        /// Index of the super-patch.
        super_patch: usize,
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
    /// The plane of a face beside an edge is not within the bound of the edge's super-patch.
    #[error("a face beside edge {place} is not within the bound of super-patch {super_patch}")]
    PlaneOutsideSuperBound {
        /// Index of the super-patch.
        super_patch: usize,
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
    /// Checks all that can be checked without the mesh: patches follow one another, and so do
    /// super-patches, every edge is there once, every number is finite, and both faces' planes of
    /// every edge are within the bounds of its patch and its super-patch. Linear, but for a sort of
    /// the ids.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), InvalidPatches> {
        self.content().validate()?;
        let mut ids = self.edge_ids.clone();
        ids.sort_unstable();
        if let Some(pair) = ids.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(InvalidPatches::DuplicateEdge { edge: pair[0] });
        }
        for (index, patch) in self.patches.iter().enumerate() {
            if let Some(place) = self.first_outside(&patch.bound, patch) {
                return Err(InvalidPatches::PlaneOutsideBound { patch: index, place });
            }
        }
        for (super_patch, group) in self.super_patches.iter().enumerate() {
            let patches = group.patches();
            let mut patches = self.patches[patches.start as usize..patches.end as usize].iter();
            let outside = patches.find_map(|patch| self.first_outside(&group.bound, patch));
            if let Some(place) = outside {
                return Err(InvalidPatches::PlaneOutsideSuperBound { super_patch, place });
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

    /// Place of the first edge of `patch` beside a face that is not within `bound`.
    fn first_outside(&self, bound: &DoubleCone, patch: &Patch) -> Option<usize> {
        let mut places = patch.edges().map(|place| place as usize);
        places.find(|&place| !self.is_within_bound(place, bound))
    }

    /// Whether the normals of both faces are within α of the axis, and both planes cross the axis
    /// line between the apexes: then no plane passes through either cone of viewpoints. What is
    /// never culled holds everything.
    ///
    /// A sliver's normal is off by [`CROSS_ERROR`] over the sine of the corner that it is taken at, so
    /// that is the widest. Of α, [`SLACK`](drypoint_bounds::SLACK) is five times that for the thinnest
    /// face that is in a patch. But about the middle of a single edge, t may be next to nothing:
    /// there, what the normal is off by counts as far as the corner is away.
    fn is_within_bound(&self, place: usize, bound: &DoubleCone) -> bool {
        if *bound == DoubleCone::ALWAYS {
            return true;
        }
        let wing = self.wings[place];
        let (center, axis) = (bound.center.as_dvec3(), bound.axis.as_dvec3());
        [wing.left_face(), wing.right_face()].into_iter().all(|face| {
            let [a, b, c] = face.map(|vertex| self.positions[vertex as usize].as_dvec3());
            let crosses = [[a, b, c], [b, c, a], [c, a, b]].map(|[a, b, c]| {
                (a, (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()))
            });
            let (a, cross) = crosses.into_iter().fold(crosses[0], |x, y| {
                if y.1.length_squared() > x.1.length_squared() { y } else { x }
            });
            let Some(normal) = cross.try_normalize() else { return false };
            let doubt = CROSS_ERROR / cross.length() * a.distance(center);
            let (cos, sin) = (normal.dot(axis), normal.cross(axis).length());
            let tan = f64::from(bound.tan_squared).sqrt();
            cos > 0.0
                && sin <= tan * cos
                && normal.dot(a - center).abs() <= f64::from(bound.apex_distance) * cos + doubt
        })
    }
}

/// The lists of an asset, wherever they lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Content<'a> {
    pub(crate) super_patches: &'a [SuperPatch],
    pub(crate) patches: &'a [Patch],
    pub(crate) wings: &'a [Wing],
    pub(crate) edge_ids: &'a [EdgeId],
    pub(crate) classes: &'a [EdgeClass],
    pub(crate) positions: &'a [Vec3],
}

impl Content<'_> {
    /// What must hold for no reader to panic: lengths, ranges, vertices, finite numbers.
    pub(crate) fn validate(&self) -> Result<(), InvalidPatches> {
        let edges = self.wings.len();
        if [self.edge_ids.len(), self.classes.len()] != [edges; 2] {
            return Err(InvalidPatches::Lengths {
                wings: edges,
                edge_ids: self.edge_ids.len(),
                classes: self.classes.len(),
            });
        }
        self.validate_patches()?;
        self.validate_super_patches()?;
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

    fn validate_patches(&self) -> Result<(), InvalidPatches> {
        let edges = self.wings.len();
        let mut expected = 0;
        for (patch, &Patch { bound, first_edge, edge_count }) in self.patches.iter().enumerate() {
            expected = end_of(expected, first_edge, edge_count, edges)
                .ok_or(InvalidPatches::Range { patch, first_edge, edge_count, expected, edges })?;
            if !is_finite(&bound) {
                return Err(InvalidPatches::BoundNotFinite { patch });
            }
        }
        Ok(())
    }

    fn validate_super_patches(&self) -> Result<(), InvalidPatches> {
        let patches = self.patches.len();
        let mut expected = 0;
        for (super_patch, group) in self.super_patches.iter().enumerate() {
            let &SuperPatch { bound, first_patch, patch_count } = group;
            expected = end_of(expected, first_patch, patch_count, patches).ok_or(
                InvalidPatches::SuperRange {
                    super_patch,
                    first_patch,
                    patch_count,
                    expected,
                    patches,
                },
            )?;
            if !is_finite(&bound) {
                return Err(InvalidPatches::SuperBoundNotFinite { super_patch });
            }
        }
        Ok(())
    }
}

/// Where a range ends that should begin at `expected`, hold something, and end within `limit`.
fn end_of(expected: u32, first: u32, count: u32, limit: usize) -> Option<u32> {
    let end = first.checked_add(count).filter(|&end| end as usize <= limit);
    end.filter(|_| first == expected && count > 0)
}

fn is_finite(bound: &DoubleCone) -> bool {
    let sizes = [bound.apex_distance, bound.tan_squared];
    bound.center.is_finite()
        && bound.axis.is_finite()
        && sizes.iter().all(|&size| size.is_finite() && size >= 0.0)
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
        let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on).unwrap();
        assert_eq!((set.validate(), set.validate_against(&mesh, &adjacency)), (Ok(()), Ok(())));
        assert!(set.patches.len() > 4);
        // Super-patches of one patch each; the rest of the patches are tested from everywhere.
        let of_one = |(patch, first_patch): (&Patch, u32)| SuperPatch {
            bound: patch.bound,
            first_patch,
            patch_count: 1,
        };
        let groups = set.patches.iter().zip(0..).map(of_one).take(3).collect();
        let mut set = set.with_super_patches(groups).unwrap();
        assert_eq!(set.validate(), Ok(()));
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
    fn broken_super_patches_are_noticed() {
        let is_range = |e| matches!(e, InvalidPatches::SuperRange { super_patch: 1, .. });
        check(|set| set.super_patches[1].first_patch += 1, is_range);
        check(|set| set.super_patches[1].patch_count = 0, is_range);
        check(|set| set.super_patches[1].patch_count = u32::MAX, is_range);
        check(|set| set.super_patches.swap(1, 2), is_range);
        let is_bound = |e| e == InvalidPatches::SuperBoundNotFinite { super_patch: 2 };
        check(|set| set.super_patches[2].bound.center.y = f32::NAN, is_bound);
        check(|set| set.super_patches[2].bound.apex_distance = -1.0, is_bound);
        let is_outside =
            |e| matches!(e, InvalidPatches::PlaneOutsideSuperBound { super_patch: 1, .. });
        check(|set| set.super_patches[1].bound.tan_squared *= 0.99, is_outside);
        check(|set| set.super_patches[1].bound = set.patches[0].bound, is_outside);
        check(
            |set| set.super_patches.last_mut().unwrap().patch_count += 1,
            |e| matches!(e, InvalidPatches::PlaneOutsideSuperBound { super_patch: 2, .. }),
        );
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
