//! Patches of patches.

use drypoint_mesh::EdgeId;
use rayon::prelude::*;

use super::cluster::{Cluster, Clusters};
use super::model::Model;
use super::table::Table;
use super::{CUTS, Effort, STALLED, fuse_cell, in_parts};
use crate::geometry::Frame;
use crate::progress::Counter;
use crate::{Cancelled, CostModel, ViewProfile};

/// Groups patches by the expected cost of testing them, as edges are grouped: a group costs one
/// patch test, and one for each of its patches where it survives. Lists of patches; those that are
/// in none are better tested from everywhere.
///
/// Patches are not moved from group to group once they are in one.
pub(crate) fn group(
    frame: &Frame,
    patches: &[&[EdgeId]],
    views: &ViewProfile,
    effort: Effort,
    counter: &Counter,
) -> Result<Vec<Vec<u32>>, Cancelled> {
    // In patch tests.
    let cost = CostModel { patch_test: 1.0, ..CostModel::PAPER };
    let model = Model::new(cost, views);
    let edges: Vec<EdgeId> = patches.concat();
    let table = Table::new(frame, &edges);
    let mut first = 0;
    let ranges: Vec<(u32, std::ops::Range<u32>)> = (0..)
        .zip(patches)
        .map(|(number, patch)| {
            #[expect(clippy::cast_possible_truncation, reason = "edges are numbered by u32")]
            let end = first + patch.len() as u32;
            (number, std::mem::replace(&mut first, end)..end)
        })
        .collect();
    let mut groups: Clusters = ranges
        .into_par_iter()
        .map(|(number, items)| Box::new(Cluster::of_patch(&table, number, items, &model)))
        .collect();
    for round in 0.. {
        let before = groups.len() as f64;
        groups = in_parts(groups, &model, effort.cell, CUTS[round % CUTS.len()])
            .into_par_iter()
            .map(|part| {
                counter.check()?;
                Ok(fuse_cell((&table, &model), part, effort, false))
            })
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .flatten()
            .collect();
        if groups.len() as f64 >= STALLED * before {
            break;
        }
    }
    groups.retain(|group| group.bound.cost < group.edges());
    let mut lists: Vec<Vec<u32>> = groups.into_iter().map(|group| group.items.to_vec()).collect();
    lists.iter_mut().for_each(|list| list.sort_unstable());
    Ok(lists)
}
