//! From a mesh to its patches.

use std::ops::ControlFlow;

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency};
use rayon::prelude::*;

use crate::arrange::{Bounded, Group, arrange};
use crate::bound::bound;
use crate::geometry::Frame;
use crate::greedy::{GreedyModel, Settings};
use crate::grow::{Grown, Published, grow_greedily};
use crate::limits::keep_limits;
use crate::planes::{Effort, MOST_LOOKS, group, grow_in_planes};
use crate::progress::Counter;
use crate::{
    Cancelled, CostModel, FuseError, FusionParams, Levels, Method, PatchSet, Progress, Provenance,
    mesh_hash,
};

/// Share of the patches that are tested where there are two levels, as leaves are grown for it:
/// super-patches survive about that often, on the bunny and the dragon.
const TESTED_OF_TWO_LEVELS: f64 = 0.3;

/// Groups the edges of `mesh` that `filter` keeps into patches that make a view cheap.
///
/// On all threads of the current rayon pool; the result is the same for any number of them. The
/// presets of [`FusionParams`] say how long it takes. Memory is linear: with [`FusionParams::FAST`]
/// some 180 bytes for each edge that `filter` keeps, the asset among it.
///
/// `progress` is called every few milliseconds from any of the threads, so that two calls may come
/// out of order; with [`ControlFlow::Break`] it ends the fusion within milliseconds.
///
/// # Errors
/// What [`FusionParams::check`] says, before anything is done; [`Cancelled`], only if `progress`
/// asked for it.
pub fn fuse(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    params: &FusionParams,
    progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<PatchSet, FuseError> {
    fuse_edges(mesh, adjacency, (filter, adjacency.edges(filter).collect()), params, progress)
}

/// As [`fuse`], of some of the edges that the filter keeps: of a rigid part, say, those that do not go on
/// in another one ([`Shape::edges`](drypoint_mesh::rig::Shape::edges)). The patches hold these alone, by id.
///
/// # Errors
/// As [`fuse`].
///
/// # Panics
/// If an edge is no edge of `adjacency`, or a boundary.
pub fn fuse_edges(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    (filter, kept): (EdgeFilter, Vec<EdgeId>),
    params: &FusionParams,
    progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<PatchSet, FuseError> {
    params.check()?;
    let is_kept = |&edge: &EdgeId| adjacency.keeps(edge, filter);
    assert!(kept.iter().all(is_kept), "edges of two faces that the filter keeps");
    let counter = Counter::new(kept.len(), progress);
    counter.count(0)?;
    let frame = Frame::new(mesh, adjacency);
    let (closed, groups, mut always_tested) = match &frame {
        Some(frame) => {
            let Grown { patches, always_tested } = grow(frame, kept, params, &counter)?;
            let patches = keep_limits(frame, patches, &params.cost);
            let (closed, mut open) = bound_each(frame, patches, params, &counter)?;
            open.extend(always_tested);
            let groups = match params.levels {
                Levels::One => Vec::new(),
                Levels::Two => bounded_groups(frame, &closed, params, &counter)?,
            };
            (closed, groups, open)
        }
        // All vertices are at one point, and no face has an area.
        None => (Vec::new(), Vec::new(), kept),
    };
    always_tested.sort_unstable();

    let provenance = Provenance {
        params: *params,
        filter,
        mesh_hash: mesh_hash(mesh),
        unit: frame.map_or(0.0, |frame| frame.unit),
    };
    let set = arrange((mesh, adjacency), closed, &groups, &always_tested, provenance);
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
        edges.into_par_iter().partition(|&edge| frame.has_shape(edge));
    counter.count(2 * without_shape.len())?;
    let cost = cost_below_groups(params);
    let mut grown = match params.method {
        Method::Greedy { sphere, cache_size, max_partition } => {
            let view_distance = params.views.mean_distance();
            let model = GreedyModel { patch_test: cost.patch_test, view_distance };
            let settings = Settings { model, cache_size: cache_size.max(1) as usize };
            let method = Published { sphere, settings, max_partition };
            grow_greedily(frame, &fusible, method, counter)?
        }
        Method::Planes { .. } => {
            let effort = effort(params.method);
            grow_in_planes(frame, &fusible, (cost, &params.views), effort, counter)?
        }
    };
    grown.always_tested.append(&mut without_shape);
    Ok(grown)
}

/// What a patch costs: where there are groups, it is tested only if its own survives.
fn cost_below_groups(params: &FusionParams) -> CostModel {
    let tested = match params.levels {
        Levels::One => 1.0,
        Levels::Two => TESTED_OF_TWO_LEVELS,
    };
    CostModel { patch_test: tested * params.cost.patch_test, ..params.cost }
}

/// How hard to search in the space of planes. Where the method says nothing of it, it is groups that
/// are searched for, which takes little time.
fn effort(method: Method) -> Effort {
    let [cell, looks, sweeps, tears] = match method {
        Method::Planes { cell, looks, sweeps, tears } => {
            [cell.max(8), looks.clamp(1, MOST_LOOKS), sweeps, tears]
        }
        Method::Greedy { .. } => [512, 3, 0, 0],
    };
    let [cell, looks, sweeps, tears] = [cell, looks, sweeps, tears].map(|number| number as usize);
    Effort { cell, looks, sweeps, tears }
}

/// Patches with their bounds; and the edges of those that, so bounded, cost no less than to test each
/// edge: what is never culled, and often what was cut off.
fn bound_each(
    frame: &Frame,
    patches: Vec<Vec<EdgeId>>,
    params: &FusionParams,
    counter: &Counter,
) -> Result<(Vec<Bounded>, Vec<EdgeId>), Cancelled> {
    let bounded: Vec<Bounded> = patches
        .into_par_iter()
        .map(|edges| {
            counter.check()?;
            Ok(Bounded { bound: bound(frame, &edges, params.bound), edges })
        })
        .collect::<Result<_, _>>()?;
    let cost = cost_below_groups(params);
    let is_worth_its_test = |Bounded { bound, edges }: &Bounded| {
        let acceptance = params.views.acceptance(bound, frame.unit);
        *bound != DoubleCone::ALWAYS && cost.patch(acceptance, edges.len()) < edges.len() as f64
    };
    let (closed, open): (Vec<_>, Vec<_>) = bounded.into_iter().partition(is_worth_its_test);
    Ok((closed, open.into_iter().flat_map(|patch| patch.edges).collect()))
}

/// Super-patches with their bounds, but for those that cost no less than to test each patch.
fn bounded_groups(
    frame: &Frame,
    patches: &[Bounded],
    params: &FusionParams,
    counter: &Counter,
) -> Result<Vec<Group>, Cancelled> {
    let lists: Vec<&[EdgeId]> = patches.iter().map(|patch| &patch.edges[..]).collect();
    let groups = group(frame, &lists, &params.views, effort(params.method), counter)?;
    let bounded = groups.into_par_iter().map(|numbers| {
        counter.check()?;
        let edges: Vec<EdgeId> =
            numbers.iter().flat_map(|&number| lists[number as usize]).copied().collect();
        Ok(Group { bound: bound(frame, &edges, params.bound), patches: numbers })
    });
    let mut bounded: Vec<Group> = bounded.collect::<Result<_, _>>()?;
    bounded.retain(|group| {
        let acceptance = params.views.acceptance(&group.bound, frame.unit);
        let cost = CostModel { patch_test: 1.0, ..CostModel::PAPER };
        group.bound != DoubleCone::ALWAYS
            && cost.patch(acceptance, group.patches.len()) < group.patches.len() as f64
    });
    Ok(bounded)
}
