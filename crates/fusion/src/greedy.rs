//! Greedy best-first fusion: Tsiapkolis and Bénard, CGF 2024, Algorithm 1.
//!
//! Every edge starts as a cluster; while any pair gains by being fused, the best one is. Each
//! cluster remembers its best partners, and looks through all of them again once none of those that
//! it remembers is left.
//!
//! Two departures, neither of which changes the result. A pair is remembered only by the one of the
//! two that looked last, not by both; so what a cluster remembers only ever shrinks, and the first
//! of it stays its best. And a pair is compared exactly only if a quick look cannot rule it out.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use crate::Cancelled;
use crate::cluster::Cluster;
use crate::extent::Extent;
use crate::geometry::EdgeShape;
use crate::screen::Screen;

/// Pairs that are looked at between two reports: a few milliseconds.
const PAIRS_PER_REPORT: usize = 1 << 18;

/// The part of the cost model that the published method knows: t_P + H ξ, from one distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GreedyModel {
    /// In edge tests.
    pub(crate) patch_test: f64,
    /// In half the longest side of the mesh's box.
    pub(crate) view_distance: f64,
}

impl GreedyModel {
    #[cfg(test)]
    pub(crate) const PAPER: Self = Self { patch_test: 1.363, view_distance: 10.0 };

    pub(crate) fn patch(&self, acceptance: f64, edges: usize) -> f64 {
        self.patch_test + acceptance * edges as f64
    }
}

/// What [`fuse_greedily`] minimises, and how many partners a cluster remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    pub(crate) model: GreedyModel,
    pub(crate) cache_size: usize,
}

/// Told every few milliseconds how many steps were done since the last time. A step is an edge that
/// became a cluster, or two clusters that were fused.
pub(crate) type Report<'a> = dyn Fn(usize) -> Result<(), Cancelled> + 'a;

/// The clusters that are left when no pair gains by being fused. Quadratic in the edges.
pub(crate) fn fuse_greedily<E: Extent>(
    edges: &[EdgeShape],
    settings: Settings,
    report: &Report,
) -> Result<Vec<Cluster<E>>, Cancelled> {
    let mut fusion = Fusion::<E>::new(settings);
    let mut clock = Clock { report, pairs: 0, steps: 0 };
    for (number, edge) in (0..).zip(edges) {
        fusion.insert(Cluster::of_edge(number, edge, &settings.model));
        clock.step(fusion.screen.len())?;
    }
    while let Some(Best { pair, owner }) = fusion.best.pop() {
        if pair.clusters.iter().all(|&number| fusion.cluster(number).is_some()) {
            fusion.fuse(pair);
            clock.step(fusion.screen.len())?;
        } else if fusion.cluster(owner).is_some() {
            fusion.recall(owner);
        }
    }
    clock.finish()?;
    Ok(fusion.clusters.into_iter().flatten().collect())
}

/// A pair that is worth fusing. The greatest is fused first: most gain, then lowest numbers.
#[derive(Clone, Copy, Debug)]
struct Pair {
    gain: f64,
    /// Numbers of the clusters, lower first.
    clusters: [u32; 2],
}

impl Pair {
    fn partner_of(&self, number: u32) -> u32 {
        let [a, b] = self.clusters;
        if a == number { b } else { a }
    }
}

impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_gain = self.gain.total_cmp(&other.gain);
        by_gain.then_with(|| Reverse(self.clusters).cmp(&Reverse(other.clusters)))
    }
}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Pair {}

/// The best pair that a cluster remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Best {
    pair: Pair,
    owner: u32,
}

/// The best pairs of one cluster, among those that lived when it looked.
#[derive(Debug, Default)]
struct Memory {
    /// Greatest last.
    pairs: Vec<Pair>,
    /// There were more than it could remember.
    is_cut: bool,
}

/// The state of Algorithm 1.
struct Fusion<E> {
    settings: Settings,
    /// By number, in the order in which they were made; `None` once fused.
    clusters: Vec<Option<Cluster<E>>>,
    memories: Vec<Memory>,
    screen: Screen<E>,
    /// One entry for each live cluster that remembers any pair. Entries of fused clusters are
    /// dropped when they come up.
    best: BinaryHeap<Best>,
    /// Room for [`Fusion::look`].
    most_gains: Vec<f64>,
    likely: Vec<(f64, u32)>,
}

impl<E: Extent> Fusion<E> {
    fn new(settings: Settings) -> Self {
        Self {
            settings,
            clusters: Vec::new(),
            memories: Vec::new(),
            screen: Screen::new(),
            best: BinaryHeap::new(),
            most_gains: Vec::new(),
            likely: Vec::new(),
        }
    }

    fn cluster(&self, number: u32) -> Option<&Cluster<E>> {
        self.clusters[number as usize].as_ref()
    }

    /// Adds a cluster under the next number and lets it look at all others.
    fn insert(&mut self, cluster: Cluster<E>) {
        let number = self.screen.insert(&cluster.outline());
        self.clusters.push(Some(cluster));
        let memory = self.look(number);
        self.memories.push(memory);
        self.recall(number);
    }

    fn fuse(&mut self, pair: Pair) {
        let parts = pair.clusters.map(|number| {
            self.screen.remove(number);
            self.memories[number as usize] = Memory::default();
            self.clusters[number as usize].take()
        });
        if let [Some(a), Some(b)] = parts {
            self.insert(Cluster::fused(&a, &b, &self.settings.model));
        }
    }

    /// Puts the best pair of a live cluster up for fusion; looks again if all that it remembers are
    /// gone and there may be more.
    fn recall(&mut self, owner: u32) {
        if let Some(pair) = self.next_pair(owner) {
            self.best.push(Best { pair, owner });
        } else if self.memories[owner as usize].is_cut {
            self.memories[owner as usize] = self.look(owner);
            if let Some(pair) = self.next_pair(owner) {
                self.best.push(Best { pair, owner });
            }
        }
    }

    /// Takes the best pair whose partner lives from what a cluster remembers.
    fn next_pair(&mut self, owner: u32) -> Option<Pair> {
        while let Some(pair) = self.memories[owner as usize].pairs.pop() {
            if self.cluster(pair.partner_of(owner)).is_some() {
                return Some(pair);
            }
        }
        None
    }

    /// The best pairs of a live cluster with any other, of those that gain.
    fn look(&mut self, owner: u32) -> Memory {
        let mut likely = std::mem::take(&mut self.likely);
        self.quick_look(owner, &mut likely);
        let room = self.settings.cache_size;
        let mut memory = Memory::default();
        // The gain below which a pair is of no interest.
        let mut least = 0.0;
        let remember = |memory: &mut Memory, least: &mut f64, other: u32| {
            let gain = self.gain(owner, other, *least);
            if gain > 0.0 && gain >= *least {
                let clusters = [owner.min(other), owner.max(other)];
                memory.pairs.push(Pair { gain, clusters });
            }
            if memory.pairs.len() >= 2 * room {
                memory.keep_best(room);
                *least = memory.pairs[room - 1].gain;
            }
        };
        // The likeliest first: they raise the bar for the others.
        if likely.len() > 2 * room {
            likely.select_nth_unstable_by(2 * room, |a, b| b.0.total_cmp(&a.0));
        }
        for &(most, other) in &likely {
            if most >= least {
                remember(&mut memory, &mut least, other);
            } else {
                memory.is_cut = true;
            }
        }
        memory.keep_best(room);
        memory.pairs.reverse();
        self.likely = likely;
        memory
    }

    /// Replaces `likely` by the clusters that may gain by being fused with `owner`, with the most
    /// that they may gain.
    fn quick_look(&mut self, owner: u32, likely: &mut Vec<(f64, u32)>) {
        self.screen.most_gains(owner, &self.settings.model, &mut self.most_gains);
        likely.clear();
        for (place, &most) in self.most_gains.iter().enumerate() {
            if most > 0.0 {
                likely.push((most, self.screen.number(place)));
            }
        }
        likely.retain(|&(_, number)| number != owner);
    }

    fn gain(&self, owner: u32, other: u32, least: f64) -> f64 {
        match (self.cluster(owner), self.cluster(other)) {
            (Some(a), Some(b)) => Cluster::gain(a, b, &self.settings.model, least),
            _ => f64::NEG_INFINITY,
        }
    }
}

impl Memory {
    /// Forgets all but the best `room` pairs; leaves them greatest first.
    fn keep_best(&mut self, room: usize) {
        self.pairs.sort_unstable_by(|a, b| b.cmp(a));
        if self.pairs.len() > room {
            self.pairs.truncate(room);
            self.is_cut = true;
        }
    }
}

/// Counts work, and reports it now and then.
struct Clock<'a> {
    report: &'a Report<'a>,
    pairs: usize,
    steps: usize,
}

impl Clock<'_> {
    /// A step that looked at this many pairs.
    fn step(&mut self, pairs: usize) -> Result<(), Cancelled> {
        self.steps += 1;
        self.pairs += pairs;
        if self.pairs >= PAIRS_PER_REPORT { self.finish() } else { Ok(()) }
    }

    fn finish(&mut self) -> Result<(), Cancelled> {
        (self.report)(self.steps)?;
        (self.pairs, self.steps) = (0, 0);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extent::{MeanExtent, ReducedExtent};
    use crate::geometry::Frame;
    use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, shapes};

    fn shapes_of_edges(mesh: &Mesh) -> Vec<EdgeShape> {
        let adjacency = MeshAdjacency::new(mesh);
        let frame = Frame::new(mesh, &adjacency).unwrap();
        let edges: Vec<EdgeId> = adjacency.edges(EdgeFilter::All).collect();
        edges.iter().filter_map(|&edge| frame.shape(edge)).collect()
    }

    /// Algorithm 1 without memory and without a quick look: each pair is compared exactly, and at
    /// every step the best of all is fused.
    fn fuse_plainly<E: Extent>(edges: &[EdgeShape], model: &GreedyModel) -> Vec<Cluster<E>> {
        let mut clusters: Vec<Option<Cluster<E>>> = Vec::new();
        let mut pairs: Vec<Pair> = Vec::new();
        let add = |cluster: Cluster<E>, clusters: &mut Vec<Option<_>>, pairs: &mut Vec<Pair>| {
            let number = u32::try_from(clusters.len()).unwrap();
            for (other, live) in (0..).zip(&*clusters) {
                if let Some(live) = live {
                    let gain = Cluster::gain(live, &cluster, model, f64::NEG_INFINITY);
                    pairs.push(Pair { gain, clusters: [other, number] });
                }
            }
            clusters.push(Some(cluster));
        };
        for (number, edge) in (0..).zip(edges) {
            add(Cluster::of_edge(number, edge, model), &mut clusters, &mut pairs);
        }
        while let Some(best) = pairs.iter().filter(|pair| pair.gain > 0.0).max().copied() {
            let [a, b] = best.clusters.map(|number| clusters[number as usize].take().unwrap());
            pairs.retain(|pair| !pair.clusters.iter().any(|n| best.clusters.contains(n)));
            add(Cluster::fused(&a, &b, model), &mut clusters, &mut pairs);
        }
        clusters.into_iter().flatten().collect()
    }

    #[track_caller]
    fn check<E: Extent>(mesh: &Mesh, model: GreedyModel, cache_size: usize) {
        let mut edges = shapes_of_edges(mesh);
        edges.truncate(200);
        let settings = Settings { model, cache_size };
        let fast = fuse_greedily::<E>(&edges, settings, &|_| Ok(())).unwrap();
        let plain = fuse_plainly::<E>(&edges, &model);
        let lists = |clusters: &[Cluster<E>]| -> Vec<(Vec<u32>, f64)> {
            clusters.iter().map(|cluster| (cluster.edges.clone(), cluster.cost)).collect()
        };
        assert_eq!(lists(&fast), lists(&plain));
        assert!(fast.len() < edges.len() / 2, "{} of {}", fast.len(), edges.len());
    }

    #[test]
    fn shortcuts_change_nothing() {
        for name in ["bumpy-sphere", "torus-knot", "cad-part", "sliver-sphere", "book"] {
            let mesh = shapes::by_name(name, 90).unwrap();
            check::<ReducedExtent>(&mesh, GreedyModel::PAPER, 50);
            check::<MeanExtent>(&mesh, GreedyModel::PAPER, 50);
            check::<ReducedExtent>(&mesh, GreedyModel::PAPER, 1);
            let near = GreedyModel { patch_test: 3.0, view_distance: 1.5 };
            check::<ReducedExtent>(&mesh, near, 4);
            check::<MeanExtent>(&mesh, near, 4);
        }
    }

    /// Of equal gains the pair of lowest numbers goes first.
    #[test]
    fn pairs_have_a_strict_order() {
        let pair = |gain, clusters| Pair { gain, clusters };
        let mut pairs =
            [pair(1.0, [0, 3]), pair(2.0, [1, 2]), pair(1.0, [0, 2]), pair(2.0, [0, 9])];
        pairs.sort_unstable_by(|a, b| b.cmp(a));
        assert_eq!(pairs.map(|pair| pair.clusters), [[0, 9], [1, 2], [0, 2], [0, 3]]);
    }
}
