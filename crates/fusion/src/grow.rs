//! From edges to lists of edges: every part of space on its own, in parallel.

use drypoint_mesh::EdgeId;
use rayon::prelude::*;

use crate::extent::{Extent, MeanExtent, ReducedExtent};
use crate::geometry::Frame;
use crate::greedy::{Settings, fuse_greedily};
use crate::partition::{Placed, split_in_space};
use crate::progress::Counter;
use crate::{Cancelled, SphereKind};

/// Edges that are worth culling together, and those that are not.
#[derive(Debug, Default)]
pub(crate) struct Grown {
    /// Each in order of ids; patches of one part of space one after another.
    pub(crate) patches: Vec<Vec<EdgeId>>,
    /// In no order of use, but the same every time.
    pub(crate) always_tested: Vec<EdgeId>,
}

/// What the published method needs to know.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Published {
    pub(crate) sphere: SphereKind,
    pub(crate) settings: Settings,
    pub(crate) max_partition: Option<u32>,
}

/// Groups `edges`, all of which have a shape, by the published method.
pub(crate) fn grow_greedily(
    frame: &Frame,
    edges: &[EdgeId],
    method: Published,
    counter: &Counter,
) -> Result<Grown, Cancelled> {
    let mut placed: Vec<Placed> =
        edges.iter().map(|&edge| Placed { edge, midpoint: frame.midpoint(edge) }).collect();
    let most = method.max_partition.map_or(usize::MAX, |most| most as usize);
    let parts = split_in_space(&mut placed, most);
    counter.count(0)?;

    let grow_part = match method.sphere {
        SphereKind::Mean => grow_part::<MeanExtent>,
        SphereKind::Reduced => grow_part::<ReducedExtent>,
    };
    let grown: Vec<Grown> = parts
        .par_iter()
        .map(|part| grow_part(frame, part, method.settings, counter))
        .collect::<Result<_, _>>()?;
    let mut all = Grown::default();
    for mut part in grown {
        all.patches.append(&mut part.patches);
        all.always_tested.append(&mut part.always_tested);
    }
    Ok(all)
}

fn grow_part<E: Extent>(
    frame: &Frame,
    part: &[EdgeId],
    settings: Settings,
    counter: &Counter,
) -> Result<Grown, Cancelled> {
    counter.check()?;
    let shapes: Vec<_> = part.iter().filter_map(|&edge| frame.shape(edge)).collect();
    debug_assert_eq!(shapes.len(), part.len(), "edges without a shape are in no part");
    let clusters = fuse_greedily::<E>(&shapes, settings, &|steps| counter.count(steps))?;
    counter.count(clusters.len())?;

    let mut grown = Grown::default();
    for cluster in clusters {
        let mut edges: Vec<_> = cluster.edges.iter().map(|&number| part[number as usize]).collect();
        edges.sort_unstable();
        // Otherwise it is no dearer to test all its edges from everywhere.
        if cluster.cost < edges.len() as f64 {
            grown.patches.push(edges);
        } else {
            grown.always_tested.append(&mut edges);
        }
    }
    grown.patches.sort_unstable();
    Ok(grown)
}
