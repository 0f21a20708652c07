//! Our own way to grow patches: in the space of planes.
//!
//! What is culled together are planes, wherever their edges are: two edges far apart may share a
//! patch if one line of sight along their faces goes for both. So clusters are compared by where
//! their planes lie ([`Model::place`]).
//!
//! 1. That space, of four dimensions, is cut into cells of a few dozen clusters ([`cells`]). In each
//!    cell, those two are fused that gain most, again and again, until some six tenths are left
//!    ([`Cell::fuse_best`]). Then it is cut anew, elsewhere, until nothing gains.
//! 2. In sweeps, edges move to where they cost less, clusters whose edges cost less elsewhere are
//!    given up, and what gains is fused ([`Cell::refine`]).
//! 3. Neighbouring clusters are torn into edges, and the pieces fused anew ([`Cell::tear`]).
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
mod sums;
mod table;
mod tear;

pub(crate) use groups::group;

use drypoint_mesh::EdgeId;
use rayon::prelude::*;

use crate::geometry::Frame;
use crate::grow::Grown;
use crate::progress::Counter;
use crate::{Cancelled, CostModel, ViewProfile};
use cell::Cell;
use cluster::Cluster;
use model::Model;
use table::Table;

/// Where the longest side of a cell is cut, round by round: never twice in the same place, so that
/// what a cut kept apart meets in the next round.
const CUTS: [f64; 4] = [0.5, 0.4, 0.6, 0.45];

/// Most edges in a cell of the first round, where a cell of many would only take longer; later
/// cells may hold twice as many each time.
const FIRST_CELL: usize = 32;

/// Share of its clusters that a cell keeps in a round, at least: fewer, and what should be fused
/// across a cut is fused with the second best before.
const KEPT: f64 = 0.6;

/// A round that leaves more than this share of the clusters is the last one.
const STALLED: f64 = 0.99;

/// A round's work on a cluster, as a share of a sweep's work on its edges; and a tear's, in sweeps.
const WORK_OF_ROUND: f64 = 1.0;
const WORK_OF_TEAR: f64 = 8.0;

/// How hard to search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Most clusters in a cell.
    pub(crate) cell: usize,
    /// How many likely partners of a cluster are looked at closely.
    pub(crate) looks: usize,
    pub(crate) sweeps: usize,
    /// How often all clusters are torn.
    pub(crate) tears: usize,
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
    let mut grown = Grown::default();
    for cluster in search.run()? {
        let mut list: Vec<EdgeId> = cluster.items.iter().map(|&n| edges[n as usize]).collect();
        list.sort_unstable();
        // Otherwise it is no dearer to test all its edges from everywhere.
        if cluster.bound.cost < cluster.edges() {
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
        let rounds = WORK_OF_ROUND / (1.0 - KEPT);
        let work = rounds + effort.sweeps as f64 + WORK_OF_TEAR * effort.tears as f64;
        Self { table, model, effort, counter, step: 2.0 / work }
    }

    fn run(&self) -> Result<Vec<Cluster>, Cancelled> {
        let mut clusters = self.first_round()?;
        let mut rounds = 1;
        loop {
            let before = clusters.len() as f64;
            let cell = FIRST_CELL.saturating_mul(1 << rounds.min(20)).min(self.effort.cell);
            clusters = self.in_cells(clusters, cell, rounds, |part| {
                self.count(WORK_OF_ROUND * part.len() as f64)?;
                Ok(self.fuse(part))
            })?;
            rounds += 1;
            if clusters.len() as f64 >= STALLED * before {
                break;
            }
        }
        let looks = self.effort.looks;
        for sweep in 0..self.effort.sweeps + self.effort.tears {
            let is_tear = sweep >= self.effort.sweeps;
            clusters = self.in_cells(clusters, self.effort.cell, rounds + sweep, |part| {
                let edges: f32 = part.iter().map(Cluster::edges).sum();
                let mut cell = Cell::new(self.table, &self.model, part);
                cell.refine(looks);
                if is_tear {
                    cell.tear(sweep, looks, self.counter)?;
                    self.count((WORK_OF_TEAR - 1.0) * f64::from(edges))?;
                }
                self.count(f64::from(edges))?;
                Ok(cell.into_clusters())
            })?;
        }
        Ok(clusters)
    }

    /// Edges become clusters only in the cell that is worked on, and four in ten of those are gone
    /// before the next, so that there is never a cluster for each edge.
    fn first_round(&self) -> Result<Vec<Cluster>, Cancelled> {
        let (table, model) = (self.table, &self.model);
        let places: Vec<_> =
            table.items.par_iter().map(|item| table.place_of_item(item, model)).collect();
        let (order, ranges) = cells::split(&places, FIRST_CELL.min(self.effort.cell), CUTS[0]);
        drop(places);
        let fused = ranges.into_par_iter().map(|range| {
            self.count(WORK_OF_ROUND * range.len() as f64)?;
            let numbers = order[range].iter();
            Ok(self.fuse(numbers.map(|&n| Cluster::of_item(table, n, model)).collect()))
        });
        Ok(fused.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    fn fuse(&self, part: Vec<Cluster>) -> Vec<Cluster> {
        fuse_cell(self.table, &self.model, part, self.effort.looks)
    }

    fn in_cells(
        &self,
        clusters: Vec<Cluster>,
        cell: usize,
        round: usize,
        work: impl Fn(Vec<Cluster>) -> Result<Vec<Cluster>, Cancelled> + Sync + Send,
    ) -> Result<Vec<Cluster>, Cancelled> {
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
fn fuse_cell(table: &Table, model: &Model, part: Vec<Cluster>, looks: usize) -> Vec<Cluster> {
    let least = (KEPT * part.len() as f64) as usize;
    let mut cell = Cell::new(table, model, part);
    cell.fuse_best(least, looks);
    cell.into_clusters()
}

/// Clusters by cell.
fn in_parts(clusters: Vec<Cluster>, model: &Model, cell: usize, cut: f64) -> Vec<Vec<Cluster>> {
    let places: Vec<_> = clusters.par_iter().map(|cluster| cluster.place(model)).collect();
    let (order, ranges) = cells::split(&places, cell, cut);
    let mut clusters: Vec<Option<Cluster>> = clusters.into_iter().map(Some).collect();
    let mut part = |range: std::ops::Range<usize>| {
        order[range].iter().filter_map(|&number| clusters[number as usize].take()).collect()
    };
    ranges.into_iter().map(&mut part).collect()
}
