//! From lists of edges to ranges.

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeId, Mesh, MeshAdjacency};

use crate::{Patch, PatchSet, Provenance, SuperPatch};

/// Edges that are culled together.
#[derive(Debug)]
pub(crate) struct Bounded {
    pub(crate) bound: DoubleCone,
    pub(crate) edges: Vec<EdgeId>,
}

/// Patches that are culled together, by number. No patch is in two.
#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) bound: DoubleCone,
    pub(crate) patches: Vec<u32>,
}

/// Puts patches in the order of their groups, those without one behind them, and edges in the order
/// of their patches, those that are always tested behind them.
pub(crate) fn arrange(
    (mesh, adjacency): (&Mesh, &MeshAdjacency),
    patches: Vec<Bounded>,
    groups: &[Group],
    always_tested: &[EdgeId],
    provenance: Provenance,
) -> PatchSet {
    let mut first_patch = 0;
    let super_patch = |group: &Group| {
        let patch_count = count(group.patches.len());
        let super_patch = SuperPatch { bound: group.bound, first_patch, patch_count };
        first_patch += patch_count;
        super_patch
    };
    let super_patches = groups.iter().map(super_patch).collect();

    let mut left: Vec<Option<Bounded>> = patches.into_iter().map(Some).collect();
    let grouped = groups.iter().flat_map(|group| &group.patches);
    let mut ordered: Vec<Bounded> =
        grouped.filter_map(|&number| left[number as usize].take()).collect();
    ordered.extend(left.into_iter().flatten());

    let in_patches = ordered.iter().flat_map(|patch| &patch.edges);
    let edge_ids: Vec<EdgeId> = in_patches.chain(always_tested).copied().collect();
    let mut first_edge = 0;
    let place = |patch: &Bounded| {
        let edge_count = count(patch.edges.len());
        let patch = Patch { bound: patch.bound, first_edge, edge_count };
        first_edge += edge_count;
        patch
    };
    PatchSet {
        super_patches,
        patches: ordered.iter().map(place).collect(),
        wings: edge_ids.iter().map(|&edge| adjacency.wing(edge)).collect(),
        classes: edge_ids.iter().map(|&edge| adjacency.class(edge)).collect(),
        edge_ids,
        positions: mesh.positions().to_vec(),
        provenance,
    }
}

#[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
fn count(length: usize) -> u32 {
    length as u32
}
