//! The asset: edges in the order of their patches.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeClass, EdgeFilter, EdgeId, Mesh, Wing};
use glam::Vec3;
use xxhash_rust::xxh3::Xxh3;

use crate::validate::Content;
use crate::{FusionParams, InvalidPatches};

/// Edges that are culled together. 40 bytes, all of them 4-byte numbers: in WGSL, a struct of
/// scalars, since a `vec3f` would widen it to 48.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Patch {
    /// Bounds both faces' planes of each edge.
    pub bound: DoubleCone,
    /// Place of the first edge.
    pub first_edge: u32,
    /// Number of edges, at least 1.
    pub edge_count: u32,
}

impl Patch {
    /// Places of its edges.
    pub fn edges(&self) -> Range<u32> {
        self.first_edge..self.first_edge.saturating_add(self.edge_count)
    }
}

/// Patches that are culled together. 40 bytes, as [`Patch`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct SuperPatch {
    /// Bounds both faces' planes of each edge of its patches.
    pub bound: DoubleCone,
    /// Index of the first patch.
    pub first_patch: u32,
    /// Number of patches, at least 1.
    pub patch_count: u32,
}

impl SuperPatch {
    /// Indices of its patches.
    pub fn patches(&self) -> Range<u32> {
        self.first_patch..self.first_patch.saturating_add(self.patch_count)
    }
}

/// What a [`PatchSet`] was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Provenance {
    /// How patches were grown.
    pub params: FusionParams,
    /// Which edges are in it.
    pub filter: EdgeFilter,
    /// [`mesh_hash`] of the mesh.
    pub mesh_hash: u64,
    /// Half the longest side of the mesh's box, in model units: what view distances are measured
    /// in. 0 if the mesh has no extent.
    pub unit: f64,
}

/// Statistics of the patches' bounds; zero if there are no patches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Mean half-angle α of the normals, in radians.
    pub mean_half_angle: f64,
    /// Largest half-angle, in radians.
    pub max_half_angle: f64,
    /// Mean distance t from center to apex, in model units.
    pub mean_apex_distance: f64,
    /// Most edges in one patch.
    pub max_edges: u32,
}

/// Patches of a mesh, with all that is needed to extract contour edges without the mesh.
///
/// Edges have a *place*, 0 ..: a patch is a range of places, patches follow one another without a
/// gap, and after the last come the edges that are always tested. [`PatchSet::wings`],
/// [`PatchSet::edge_ids`] and [`PatchSet::classes`] are by place.
///
/// Made by [`fuse`](crate::fuse), saved by [`PatchSet::to_bytes`], loaded by
/// [`PatchSet::from_bytes`]. Every range and every vertex is in range, and every position and bound
/// is finite.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchSet {
    pub(crate) super_patches: Vec<SuperPatch>,
    pub(crate) patches: Vec<Patch>,
    pub(crate) wings: Vec<Wing>,
    pub(crate) edge_ids: Vec<EdgeId>,
    pub(crate) classes: Vec<EdgeClass>,
    pub(crate) positions: Vec<Vec3>,
    pub(crate) provenance: Provenance,
}

impl PatchSet {
    /// Patches, in order of their edges' places.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Super-patches, in order of their patches; empty unless it was made with
    /// [`Levels::Two`](crate::Levels::Two). They follow one another without a gap from patch 0.
    pub fn super_patches(&self) -> &[SuperPatch] {
        &self.super_patches
    }

    /// The same patches under another second level, which replaces what was there; none if it is
    /// empty. For groupings of one's own.
    ///
    /// Each bound must hold the planes of all edges of its patches. [`PatchSet::validate`] checks
    /// that; this checks only that nothing is out of range. Linear.
    ///
    /// # Errors
    /// The first thing that is wrong: super-patches must follow one another from patch 0, hold a
    /// patch each, and have finite bounds.
    pub fn with_super_patches(
        self,
        super_patches: Vec<SuperPatch>,
    ) -> Result<Self, InvalidPatches> {
        let set = Self { super_patches, ..self };
        set.content().validate()?;
        Ok(set)
    }

    /// Indices of the patches that no super-patch holds, which are tested from everywhere: all of
    /// them if there is no second level.
    pub fn always_tested_patches(&self) -> Range<u32> {
        let first = self.super_patches.last().map_or(0, |patch| patch.patches().end);
        #[expect(clippy::cast_possible_truncation, reason = "a patch holds an edge")]
        let end = self.patches.len() as u32;
        first..end
    }

    /// Vertices of each edge; all four exist.
    pub fn wings(&self) -> &[Wing] {
        &self.wings
    }

    /// Id of each edge in the [`MeshAdjacency`](drypoint_mesh::MeshAdjacency) it comes from.
    pub fn edge_ids(&self) -> &[EdgeId] {
        &self.edge_ids
    }

    /// What each edge is.
    pub fn classes(&self) -> &[EdgeClass] {
        &self.classes
    }

    /// Places of the edges that no patch holds: those that are cheaper to test than to cull, and
    /// those beside faces that span no plane.
    pub fn always_tested(&self) -> Range<u32> {
        let first = self.patches.last().map_or(0, |patch| patch.edges().end);
        #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
        let end = self.wings.len() as u32;
        first..end
    }

    /// The mesh's vertices, which wings name, in the order of its file.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    pub(crate) fn content(&self) -> Content<'_> {
        Content {
            super_patches: &self.super_patches,
            patches: &self.patches,
            wings: &self.wings,
            edge_ids: &self.edge_ids,
            classes: &self.classes,
            positions: &self.positions,
        }
    }

    /// What it was made from.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Which edges of the mesh are in it.
    pub fn edge_filter(&self) -> EdgeFilter {
        self.provenance.filter
    }

    /// Expected cost of a view in edge tests, by the cost model and the view profile that it was
    /// made for: E of each patch, 1 for each edge that is always tested, t_P for each super-patch,
    /// less t_P for each patch of those that are culled.
    pub fn expected_cost(&self) -> f64 {
        let FusionParams { cost, views, .. } = self.provenance.params;
        let acceptance = |bound: &DoubleCone| views.acceptance(bound, self.provenance.unit);
        let patch_cost =
            |patch: &Patch| cost.patch(acceptance(&patch.bound), patch.edge_count as usize);
        // Patches of a culled super-patch are not tested.
        let saved = |group: &SuperPatch| {
            let untested = (1.0 - acceptance(&group.bound)) * f64::from(group.patch_count);
            cost.patch_test * (untested - 1.0)
        };
        self.patches.iter().map(patch_cost).sum::<f64>() + self.always_tested().len() as f64
            - self.super_patches.iter().map(saved).sum::<f64>()
    }

    /// Statistics of the bounds.
    pub fn summary(&self) -> Summary {
        let half_angle = |patch: &Patch| f64::from(patch.bound.tan_squared).sqrt().atan();
        let half_angles = || self.patches.iter().map(half_angle);
        let apex_distances = self.patches.iter().map(|p| f64::from(p.bound.apex_distance));
        let count = self.patches.len().max(1) as f64;
        // Folded, because the empty `sum` of floats is −0.
        Summary {
            mean_half_angle: half_angles().fold(0.0, |sum, x| sum + x) / count,
            max_half_angle: half_angles().fold(0.0, f64::max),
            mean_apex_distance: apex_distances.fold(0.0, |sum, x| sum + x) / count,
            max_edges: self.patches.iter().map(|patch| patch.edge_count).max().unwrap_or(0),
        }
    }
}

/// A number that tells one mesh from another: XXH3 of positions and triangles, −0 and 0 apart.
/// Linear, about a millisecond for a million triangles.
pub fn mesh_hash(mesh: &Mesh) -> u64 {
    let mut hash = Xxh3::new();
    hash.update(&(mesh.positions().len() as u64).to_le_bytes());
    hash.update(&little_endian(mesh.positions()));
    hash.update(&little_endian(mesh.triangles()));
    hash.digest()
}

/// Bytes of data that consists of 4-byte numbers, each in little-endian order.
pub(crate) fn little_endian<T: Pod>(data: &[T]) -> Vec<u8> {
    let words: &[u32] = bytemuck::cast_slice(data);
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
