//! Patches of a model that moves: Tsiapkolis and Bénard, CGF 43(4), 2024, §4.1.

use std::ops::ControlFlow;

use drypoint_mesh::EdgeFilter;
use drypoint_mesh::rig::Skin;

use crate::{FuseError, FusionParams, PatchSet, Progress, fuse_edges};

/// Groups the edges of each shape of `skin` into patches, in the order of [`Skin::shapes`]: parts of one
/// shape share them. Edge ids are those of the shape's own adjacency.
///
/// As [`fuse`](crate::fuse) for one shape after the other; `progress` counts the edges of all.
///
/// # Errors
/// As [`fuse`](crate::fuse).
pub fn fuse_shapes(
    skin: &Skin,
    filter: EdgeFilter,
    params: &FusionParams,
    progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<Vec<PatchSet>, FuseError> {
    let counts: Vec<usize> =
        skin.shapes().iter().map(|shape| shape.edges(filter).count()).collect();
    let edges = counts.iter().sum();
    let mut done = 0;
    let mut sets = Vec::with_capacity(counts.len());
    for (shape, count) in skin.shapes().iter().zip(counts) {
        let tell = |of_shape: Progress| {
            progress(Progress { edges_done: done + of_shape.edges_done, edges })
        };
        let kept = shape.edges(filter).collect();
        sets.push(fuse_edges(&shape.mesh, &shape.adjacency, (filter, kept), params, &tell)?);
        done += count;
    }
    Ok(sets)
}
