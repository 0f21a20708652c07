//! From a mesh to its patches.

use std::ops::ControlFlow;

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency};
use rayon::prelude::*;

use crate::bound::bound;
use crate::geometry::Frame;
use crate::greedy::{GreedyModel, Settings};
use crate::grow::{Grown, Published, grow_greedily};
use crate::progress::Counter;
use crate::{
    Cancelled, FusionParams, Method, Patch, PatchSet, Progress, Provenance, SphereKind, mesh_hash,
};

/// Groups the edges of `mesh` that `filter` keeps into patches (Tsiapkolis and Bénard, CGF 2024,
/// Algorithm 1).
///
/// On all threads of the current rayon pool; the result is the same for any number of them. With
/// [`FusionParams::PAPER`], some 80 µs of processor time for each edge; it grows with
/// `max_partition`.
///
/// `progress` is called every few milliseconds from any of the threads, so that two calls may come
/// out of order; with [`ControlFlow::Break`] it ends the fusion within milliseconds.
///
/// # Errors
/// [`Cancelled`], only if `progress` asked for it.
pub fn fuse(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    params: &FusionParams,
    progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<PatchSet, Cancelled> {
    let kept: Vec<EdgeId> = adjacency.edges(filter).collect();
    let counter = Counter::new(kept.len(), progress);
    counter.count(0)?;
    let frame = Frame::new(mesh, adjacency);
    let mut grown = match &frame {
        Some(frame) => grow(frame, kept, params, &counter)?,
        // All vertices are at one point, and no face has an area.
        None => Grown { always_tested: kept, ..Grown::default() },
    };
    let bounded: Vec<(DoubleCone, Vec<EdgeId>)> = std::mem::take(&mut grown.patches)
        .into_par_iter()
        .map(|edges| {
            counter.check()?;
            let bound =
                frame.as_ref().map_or(DoubleCone::ALWAYS, |f| bound(f, &edges, params.bound));
            Ok((bound, edges))
        })
        .collect::<Result<_, _>>()?;
    // What is never culled is no patch: its test would be wasted.
    let (open, closed): (Vec<_>, Vec<_>) =
        bounded.into_iter().partition(|(bound, _)| *bound == DoubleCone::ALWAYS);
    let mut always_tested = grown.always_tested;
    always_tested.extend(open.into_iter().flat_map(|(_, edges)| edges));
    always_tested.sort_unstable();

    let provenance = Provenance {
        params: *params,
        filter,
        mesh_hash: mesh_hash(mesh),
        unit: frame.map_or(0.0, |frame| frame.unit),
    };
    let set = arrange(mesh, adjacency, &closed, &always_tested, provenance);
    debug_assert_eq!(set.validate(), Ok(()));
    counter.finish()?;
    Ok(set)
}

/// Groups `edges`. Those beside a face that spans no plane are always tested.
fn grow(
    frame: &Frame,
    edges: Vec<EdgeId>,
    params: &FusionParams,
    counter: &Counter,
) -> Result<Grown, Cancelled> {
    let (fusible, mut without_shape): (Vec<EdgeId>, Vec<EdgeId>) =
        edges.into_par_iter().partition(|&edge| frame.shape(edge).is_some());
    counter.count(2 * without_shape.len())?;
    let published = |sphere, cache_size: u32, max_partition| {
        let model = GreedyModel {
            patch_test: params.cost.patch_test,
            view_distance: params.views.mean_distance(),
        };
        let settings = Settings { model, cache_size: cache_size.max(1) as usize };
        Published { sphere, settings, max_partition }
    };
    let mut grown = match params.method {
        Method::Greedy { sphere, cache_size, max_partition } => {
            let method = published(sphere, cache_size, max_partition);
            grow_greedily(frame, &fusible, method, counter)?
        }
        Method::Planes { .. } => {
            let method = published(SphereKind::Reduced, 50, Some(512));
            grow_greedily(frame, &fusible, method, counter)?
        }
    };
    grown.always_tested.append(&mut without_shape);
    Ok(grown)
}

/// Puts edges in the order of their patches, and those that are always tested behind them.
fn arrange(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    patches: &[(DoubleCone, Vec<EdgeId>)],
    always_tested: &[EdgeId],
    provenance: Provenance,
) -> PatchSet {
    let in_patches = patches.iter().flat_map(|(_, edges)| edges);
    let edge_ids: Vec<EdgeId> = in_patches.chain(always_tested).copied().collect();
    let mut first_edge = 0;
    let place = |(bound, edges): &(DoubleCone, Vec<EdgeId>)| {
        #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
        let edge_count = edges.len() as u32;
        let patch = Patch { bound: *bound, first_edge, edge_count };
        first_edge += edge_count;
        patch
    };
    PatchSet {
        super_patches: Vec::new(),
        patches: patches.iter().map(place).collect(),
        wings: edge_ids.iter().map(|&edge| adjacency.wing(edge)).collect(),
        classes: edge_ids.iter().map(|&edge| adjacency.class(edge)).collect(),
        edge_ids,
        positions: mesh.positions().to_vec(),
        provenance,
    }
}
