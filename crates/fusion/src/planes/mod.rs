//! Our own way to grow patches: in the space of planes.
//!
//! What is culled together are planes, wherever their edges are: two edges far apart may share a
//! patch if one line of sight along their faces goes for both. So clusters are compared by where
//! their planes lie ([`Model::place`]).
//!
//! 1. That space, of four dimensions, is cut into cells of some hundred clusters ([`cells`]). In each
//!    cell, those two are fused that gain most, again and again, until a certain share is left
//!    ([`Cell::fuse_best`]). Then it is cut anew, elsewhere, until nothing gains.
//! 2. In sweeps, edges move to where they cost less, clusters whose edges cost less elsewhere are
//!    given up, and what gains is fused ([`Cell::refine`]).
//! 3. Neighbouring clusters are torn into edges, and the pieces fused anew ([`Cell::tear`]).
//!
//! Moves and tears may lose a little, and less from sweep to sweep, so that the search does not end
//! in the first place that is better than all places beside it (Dueck and Scheuer, Threshold
//! Accepting, Journal of Computational Physics 90, 1990).
//!
//! All that ever happens, happens inside one cell, in a fixed order: so cells are worked on in
//! parallel, and the result is the same for any number of threads. Time and memory are linear in the
//! number of edges but for the cuts, which take n log n comparisons.
//!
//! Everything is in f32: it only guides the search. Final bounds are measured in f64, from the mesh.

mod cap;
mod cell;
mod cells;
mod cluster;
mod groups;
mod model;
mod outlines;
mod refine;
mod simd;
mod sums;
mod table;
mod tear;

pub(crate) use cell::MOST_LOOKS;
pub(crate) use groups::group;

use drypoint_mesh::EdgeId;
use rayon::prelude::*;

use crate::geometry::Frame;
use crate::grow::Grown;
use crate::progress::Counter;
use crate::{Cancelled, CostModel, ViewProfile};
use cell::{Care, Cell};
use cluster::{Cluster, Clusters};
use model::Model;
use table::Table;

/// Where the longest side of a cell is cut, round by round: never twice in the same place, so that
/// what a cut kept apart meets in the next round.
const CUTS: [f64; 4] = [0.5, 0.4, 0.6, 0.45];

/// Most edges in a cell of the first round, where a cell of many would only take longer; later
/// cells may hold twice as many each time.
const FIRST_CELL: usize = 64;

/// Share of its clusters that a cell keeps in a round, at least: fewer, and what should be fused
/// across a cut is fused with the second best before. In the first round, and in others.
const KEPT: [f64; 2] = [0.6, 0.7];

/// The same in haste.
const KEPT_IN_HASTE: [f64; 2] = [0.4, 0.6];

/// A round that leaves more than this share of the clusters is the last one.
const STALLED: f64 = 0.99;

/// A round's work on a cluster, as a share of a sweep's work on its edges; and a tear's, in sweeps.
const WORK_OF_ROUND: f64 = 1.0;
const WORK_OF_TEAR: f64 = 4.0;

/// How hard to search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Most clusters in a cell.
    pub(crate) cell: usize,
    /// How many likely partners of a cluster are looked at closely. With one, all is done in haste.
    pub(crate) looks: usize,
    pub(crate) sweeps: usize,
    /// How often all clusters are torn.
    pub(crate) tears: usize,
}

impl Effort {
    fn care(self) -> Care {
        Care { looks: self.looks, is_hasty: self.looks == 1, heat: 0.0 }
    }

    /// Shares of the clusters that a cell keeps, in the first round and in others.
    fn kept(self) -> [f64; 2] {
        if self.care().is_hasty { KEPT_IN_HASTE } else { KEPT }
    }
}

/// Groups `edges`, all of which have a shape.
pub(crate) fn grow_in_planes(
    frame: &Frame,
    edges: &[EdgeId],
    (cost, views): (CostModel, &ViewProfile),
    effort: Effort,
    counter: &Counter,
) -> Result<Grown, Cancelled> {
    let table = Table::new(frame, edges);
    let search = Search::new(&table, Model::new(cost, views), effort, counter);
    let lists: Vec<(bool, Vec<EdgeId>)> = search
        .run()?
        .into_par_iter()
        .map(|cluster| {
            let mut list: Vec<EdgeId> = cluster.items.iter().map(|&n| edges[n as usize]).collect();
            list.sort_unstable();
            // Otherwise it is no dearer to test all its edges from everywhere.
            (cluster.bound.cost < cluster.edges(), list)
        })
        .collect();
    let mut grown = Grown::default();
    for (is_patch, mut list) in lists {
        if is_patch {
            grown.patches.push(list);
        } else {
            grown.always_tested.append(&mut list);
        }
    }
    Ok(grown)
}

struct Search<'a> {
    table: &'a Table,
    model: Model,
    effort: Effort,
    counter: &'a Counter<'a>,
    /// Steps of the counter for the work of one sweep on one edge.
    step: f64,
}

impl<'a> Search<'a> {
    fn new(table: &'a Table, model: Model, effort: Effort, counter: &'a Counter<'a>) -> Self {
        let [kept_at_first, kept] = effort.kept();
        let rounds = WORK_OF_ROUND * (1.0 + kept_at_first / (1.0 - kept));
        let work = rounds + effort.sweeps as f64 + WORK_OF_TEAR * effort.tears as f64;
        Self { table, model, effort, counter, step: 2.0 / work }
    }

    fn run(&self) -> Result<Clusters, Cancelled> {
        let mut clusters = self.first_round()?;
        let mut rounds = 1;
        loop {
            let before = clusters.len() as f64;
            let cell = FIRST_CELL.saturating_mul(1 << rounds.min(20)).min(self.effort.cell);
            clusters = self.in_cells(clusters, cell, rounds, |part| {
                self.count(WORK_OF_ROUND * part.len() as f64)?;
                Ok(self.fuse(part, false))
            })?;
            rounds += 1;
            if clusters.len() as f64 >= STALLED * before {
                break;
            }
        }
        let sweeps = self.effort.sweeps + self.effort.tears;
        for sweep in 0..sweeps {
            let heat = 1.0 - (sweep + 1) as f32 / sweeps as f32;
            let care = Care { heat, ..self.effort.care() };
            let is_tear = sweep >= self.effort.sweeps;
            clusters = self.in_cells(clusters, self.effort.cell, rounds + sweep, |part| {
                let edges: f32 = part.iter().map(|cluster| cluster.edges()).sum();
                let mut cell = Cell::new(self.table, &self.model, part, care);
                cell.refine();
                if is_tear {
                    cell.tear(sweep, self.counter)?;
                    self.count((WORK_OF_TEAR - 1.0) * f64::from(edges))?;
                }
                self.count(f64::from(edges))?;
                Ok(cell.into_clusters())
            })?;
        }
        Ok(clusters)
    }

    /// Edges become clusters only in the cell that is worked on, and half of those are gone
    /// before the next, so that there is never a cluster for each edge.
    fn first_round(&self) -> Result<Clusters, Cancelled> {
        let (table, model) = (self.table, &self.model);
        let places: Vec<_> =
            table.items.par_iter().map(|item| table.place_of_item(item, model)).collect();
        let (order, ranges) = cells::split(&places, FIRST_CELL.min(self.effort.cell), CUTS[0]);
        drop(places);
        let fused = ranges.into_par_iter().map(|range| {
            self.count(WORK_OF_ROUND * range.len() as f64)?;
            let cluster = |&number: &u32| Box::new(Cluster::of_item(table, number, model));
            Ok(self.fuse(order[range].iter().map(cluster).collect(), true))
        });
        Ok(fused.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    fn fuse(&self, part: Clusters, is_first: bool) -> Clusters {
        fuse_cell((self.table, &self.model), part, self.effort, is_first)
    }

    fn in_cells(
        &self,
        clusters: Clusters,
        cell: usize,
        round: usize,
        work: impl Fn(Clusters) -> Result<Clusters, Cancelled> + Sync + Send,
    ) -> Result<Clusters, Cancelled> {
        let parts = in_parts(clusters, &self.model, cell, CUTS[round % CUTS.len()]);
        let parts: Vec<_> = parts.into_par_iter().map(work).collect::<Result<_, _>>()?;
        Ok(parts.into_iter().flatten().collect())
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounds down")]
    fn count(&self, work: f64) -> Result<(), Cancelled> {
        self.counter.count((self.step * work) as usize)
    }
}

/// One round in one cell.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
fn fuse_cell(
    (table, model): (&Table, &Model),
    part: Clusters,
    effort: Effort,
    is_first: bool,
) -> Clusters {
    let care = effort.care();
    let [kept_at_first, kept] = effort.kept();
    let least = (if is_first { kept_at_first } else { kept }) * part.len() as f64;
    let mut cell = Cell::new(table, model, part, care);
    cell.fuse_best(least as usize);
    cell.into_clusters()
}

/// Clusters by cell.
fn in_parts(clusters: Clusters, model: &Model, cell: usize, cut: f64) -> Vec<Clusters> {
    let places: Vec<_> = clusters.par_iter().map(|cluster| cluster.place(model)).collect();
    let (order, ranges) = cells::split(&places, cell, cut);
    let mut clusters: Vec<Option<Box<Cluster>>> = clusters.into_iter().map(Some).collect();
    let mut part = |range: std::ops::Range<usize>| {
        order[range].iter().filter_map(|&number| clusters[number as usize].take()).collect()
    };
    ranges.into_iter().map(&mut part).collect()
}
