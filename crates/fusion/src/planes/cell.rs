//! A few dozen clusters that lie close together, and how they become fewer.

use super::cluster::{Bound, Cluster};
use super::model::Model;
use super::outlines::{Gains, Outline, Outlines};
use super::table::Table;

/// What a change must gain at least, so that rounding alone changes nothing.
pub(crate) const LEAST_GAIN: f32 = 1e-3;

/// Clusters that are worked on together.
pub(crate) struct Cell<'a> {
    pub(crate) table: &'a Table,
    pub(crate) model: &'a Model,
    pub(crate) clusters: Vec<Option<Cluster>>,
    pub(crate) outlines: Outlines,
    pub(crate) gains: Gains,
}

/// The best that a cluster can be fused with, as far as it was looked at.
#[derive(Clone, Copy)]
struct Partner {
    number: usize,
    /// Of the partner, when it was looked at.
    age: u32,
    bound: Bound,
}

impl<'a> Cell<'a> {
    pub(crate) fn new(table: &'a Table, model: &'a Model, clusters: Vec<Cluster>) -> Self {
        let mut outlines = Outlines::default();
        for cluster in &clusters {
            outlines.push(&Outline::of(cluster, model));
        }
        let clusters = clusters.into_iter().map(Some).collect();
        Self { table, model, clusters, outlines, gains: Gains::default() }
    }

    pub(crate) fn into_clusters(self) -> Vec<Cluster> {
        self.clusters.into_iter().flatten().collect()
    }

    pub(crate) fn replace(&mut self, number: usize, cluster: Cluster) {
        self.outlines.set(number, &Outline::of(&cluster, self.model));
        self.clusters[number] = Some(cluster);
    }

    pub(crate) fn remove(&mut self, number: usize) -> Option<Cluster> {
        self.outlines.remove(number);
        self.clusters[number].take()
    }

    /// Fuses the two clusters that gain most, again and again, until `least` are left or none
    /// gains. For each cluster, the `looks` likeliest partners are looked at closely.
    pub(crate) fn fuse_best(&mut self, least: usize, looks: usize) {
        let count = self.clusters.len();
        let mut ages = vec![0u32; count];
        let mut best_gains = Gains::none(count);
        let mut partners: Vec<Option<Partner>> = vec![None; count];
        for (number, best) in partners.iter_mut().enumerate() {
            let (gain, partner) = self.best_partner(number, &ages, looks);
            best_gains.set(number, gain);
            *best = partner;
        }
        let mut left = self.clusters.iter().flatten().count();
        while left > least {
            let best = best_gains.most().and_then(|(n, _)| Some((n, partners[n]?)));
            let Some((number, partner)) = best else {
                break;
            };
            let other = partner.number;
            if self.clusters[other].is_some() && ages[other] == partner.age {
                if let (Some(a), Some(b)) = (self.remove(number), self.remove(other)) {
                    self.replace(number, Cluster::fused(self.table, a, b, partner.bound));
                }
                best_gains.set(other, f32::NEG_INFINITY);
                ages[number] += 1;
                left -= 1;
            }
            let (gain, partner) = self.best_partner(number, &ages, looks);
            best_gains.set(number, gain);
            partners[number] = partner;
        }
    }

    fn best_partner(
        &mut self,
        number: usize,
        ages: &[u32],
        looks: usize,
    ) -> (f32, Option<Partner>) {
        let nothing = (f32::NEG_INFINITY, None);
        let Some(cluster) = &self.clusters[number] else { return nothing };
        let outline = Outline::of(cluster, self.model);
        self.outlines.gains(&outline, self.model, &mut self.gains);
        self.gains.set(number, f32::NEG_INFINITY);
        let (mut best_gain, mut best) = (LEAST_GAIN, None);
        for _ in 0..looks {
            let Some((other, _)) = self.gains.most() else { break };
            self.gains.set(other, f32::NEG_INFINITY);
            let Some(candidate) = &self.clusters[other] else { continue };
            let apart = cluster.bound.cost + candidate.bound.cost;
            let bound = cluster.union(candidate, self.table, self.model, apart - best_gain);
            if apart - bound.cost > best_gain {
                best_gain = apart - bound.cost;
                best = Some(Partner { number: other, age: ages[other], bound });
            }
        }
        if best.is_some() { (best_gain, best) } else { nothing }
    }
}
