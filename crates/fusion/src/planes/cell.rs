//! Some hundred clusters that lie close together, and how they become fewer.

use super::cluster::{Bound, Cluster, Clusters};
use super::model::Model;
use super::outlines::{Gains, Outline, Outlines};
use super::table::Table;

/// What a change must gain at least, so that rounding alone changes nothing.
pub(crate) const LEAST_GAIN: f32 = 1e-3;

/// Most partners of a cluster that are looked at closely.
pub(crate) const MOST_LOOKS: u32 = 4;

/// Clusters that are worked on together.
pub(crate) struct Cell<'a> {
    pub(crate) table: &'a Table,
    pub(crate) model: &'a Model,
    pub(crate) clusters: Vec<Option<Box<Cluster>>>,
    pub(crate) outlines: Outlines,
    pub(crate) gains: Gains,
    pub(crate) care: Care,
}

/// How carefully clusters are looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Care {
    /// How many likely partners are looked at closely, 1 ..= [`MOST_LOOKS`].
    pub(crate) looks: usize,
    /// Whether these are looked at only when it is a cluster's turn by what it would gain at a glance,
    /// and not all before the first are fused: quicker, for patches that cost a little more.
    pub(crate) is_hasty: bool,
    /// How much may be lost by a change, as a share of what may be at most: below 1, and 0 at last.
    pub(crate) heat: f32,
}

/// A cluster that another may be fused with, as it was when it was looked at.
#[derive(Clone, Copy, Default)]
struct Candidate {
    number: usize,
    age: u32,
}

/// What is known of the best that a cluster can be fused with.
#[derive(Clone, Copy)]
enum Partner {
    /// Nothing gains.
    Nobody,
    /// The first few of these are the likeliest, at a glance.
    Likely([Candidate; MOST_LOOKS as usize], usize),
    /// The best of them, and the bound of both.
    Sure(Candidate, Bound),
}

impl<'a> Cell<'a> {
    pub(crate) fn new(table: &'a Table, model: &'a Model, clusters: Clusters, care: Care) -> Self {
        let mut outlines = Outlines::with_room_for(clusters.len());
        for cluster in &clusters {
            outlines.push(&Outline::of(cluster, model));
        }
        let clusters = clusters.into_iter().map(Some).collect();
        Self { table, model, clusters, outlines, gains: Gains::default(), care }
    }

    pub(crate) fn into_clusters(self) -> Clusters {
        self.clusters.into_iter().flatten().collect()
    }

    /// Of all clusters together.
    pub(crate) fn cost(&self) -> f32 {
        self.clusters.iter().flatten().map(|cluster| cluster.bound.cost).sum()
    }

    pub(crate) fn replace(&mut self, number: usize, cluster: Box<Cluster>) {
        self.outlines.set(number, &Outline::of(&cluster, self.model));
        self.clusters[number] = Some(cluster);
    }

    pub(crate) fn remove(&mut self, number: usize) -> Option<Box<Cluster>> {
        self.outlines.remove(number);
        self.clusters[number].take()
    }

    /// Fuses the two clusters that gain most, again and again, until `least` are left or none
    /// gains.
    pub(crate) fn fuse_best(&mut self, least: usize) {
        let count = self.clusters.len();
        let mut ages = vec![0u32; count];
        let mut best_gains = Gains::none(count);
        let mut partners = vec![Partner::Nobody; count];
        for (number, best) in partners.iter_mut().enumerate() {
            let (mut gain, mut partner) = self.likely_partners(number, &ages);
            if let Partner::Likely(likely, count) = partner
                && !self.care.is_hasty
            {
                (gain, partner) = self.best_partner(number, &likely[..count]);
            }
            best_gains.set(number, gain);
            *best = partner;
        }
        let mut left = self.clusters.iter().flatten().count();
        while left > least {
            let Some((number, _)) = best_gains.most() else { break };
            let is_as_seen = |seen: &Candidate| {
                self.clusters[seen.number].is_some() && ages[seen.number] == seen.age
            };
            let (gain, partner) = match partners[number] {
                Partner::Likely(likely, count) if likely[..count].iter().all(is_as_seen) => {
                    self.best_partner(number, &likely[..count])
                }
                Partner::Sure(other, bound) if is_as_seen(&other) => {
                    if let Some(other) = self.remove(other.number) {
                        self.absorb(number, &other, bound);
                    }
                    best_gains.set(other.number, f32::NEG_INFINITY);
                    ages[number] += 1;
                    left -= 1;
                    self.likely_partners(number, &ages)
                }
                _ => self.likely_partners(number, &ages),
            };
            best_gains.set(number, gain);
            partners[number] = partner;
        }
    }

    /// Puts the edges of another cluster into one, and the bound that [`Cluster::union`] found.
    pub(crate) fn absorb(&mut self, number: usize, other: &Cluster, bound: Bound) {
        if let Some(cluster) = &mut self.clusters[number] {
            cluster.absorb(self.table, other, bound);
            self.outlines.set(number, &Outline::of(cluster, self.model));
        }
    }

    /// The likeliest partners, and what the first of them gains.
    fn likely_partners(&mut self, number: usize, ages: &[u32]) -> (f32, Partner) {
        let nobody = (f32::NEG_INFINITY, Partner::Nobody);
        let Some(cluster) = &self.clusters[number] else { return nobody };
        let outline = Outline::of(cluster, self.model);
        self.outlines.gains(&outline, self.model, &mut self.gains);
        self.gains.set(number, f32::NEG_INFINITY);
        let mut likely = [Candidate::default(); MOST_LOOKS as usize];
        let (mut count, mut most) = (0, f32::NEG_INFINITY);
        while count < self.care.looks {
            let Some((other, gain)) = self.gains.most() else { break };
            self.gains.set(other, f32::NEG_INFINITY);
            likely[count] = Candidate { number: other, age: ages[other] };
            most = most.max(gain);
            count += 1;
        }
        if count == 0 { nobody } else { (most, Partner::Likely(likely, count)) }
    }

    /// The partner that gains most, and how much that is.
    fn best_partner(&self, number: usize, candidates: &[Candidate]) -> (f32, Partner) {
        let (mut best_gain, mut best) = (LEAST_GAIN, None);
        let Some(cluster) = &self.clusters[number] else { return (best_gain, Partner::Nobody) };
        for &candidate in candidates {
            let Some(other) = &self.clusters[candidate.number] else { continue };
            let apart = cluster.bound.cost + other.bound.cost;
            let bound = cluster.union(other, self.table, self.model, apart - best_gain);
            if apart - bound.cost > best_gain {
                best_gain = apart - bound.cost;
                best = Some(Partner::Sure(candidate, bound));
            }
        }
        best.map_or((f32::NEG_INFINITY, Partner::Nobody), |partner| (best_gain, partner))
    }
}
