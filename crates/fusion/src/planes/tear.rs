//! Clusters torn into edges, and fused anew.

use super::cell::{Cell, LEAST_GAIN};
use super::cluster::Cluster;
use super::outlines::Outline;
use crate::Cancelled;
use crate::progress::Counter;

/// How many clusters are torn apart together.
const TORN: [usize; 4] = [2, 3, 4, 6];

/// Most edges that are torn apart at once: each is compared with all the others.
const MOST_EDGES: usize = 1024;

impl Cell<'_> {
    /// Tears a cluster and some that lie beside it into edges, and fuses these again. The better
    /// one stays.
    pub(crate) fn tear(
        &mut self,
        sweep: usize,
        looks: usize,
        counter: &Counter,
    ) -> Result<(), Cancelled> {
        for number in 0..self.clusters.len() {
            counter.check()?;
            self.tear_one(number, TORN[(sweep + number) % TORN.len()], looks);
        }
        Ok(())
    }

    fn tear_one(&mut self, number: usize, count: usize, looks: usize) {
        let (table, model) = (self.table, self.model);
        let Some(cluster) = &self.clusters[number] else { return };
        self.outlines.gains(&Outline::of(cluster, model), model, &mut self.gains);
        self.gains.set(number, f32::NEG_INFINITY);
        let mut torn = vec![number];
        while torn.len() < count {
            let Some((other, _)) = self.gains.most() else { break };
            self.gains.set(other, f32::NEG_INFINITY);
            torn.push(other);
        }
        let before: f32 =
            torn.iter().filter_map(|&n| Some(self.clusters[n].as_ref()?.bound.cost)).sum();
        let edges: usize =
            torn.iter().filter_map(|&n| Some(self.clusters[n].as_ref()?.items.len())).sum();
        if edges > MOST_EDGES {
            return;
        }
        let items = torn.iter().filter_map(|&n| self.clusters[n].as_ref()).flat_map(|c| &c.items);
        let pieces = items.map(|&item| Cluster::of_item(table, item, model)).collect();
        let mut inner = Cell::new(table, model, pieces);
        inner.fuse_best(1, looks);
        inner.move_edges(looks);
        inner.fuse_best(1, looks);
        let clusters = inner.into_clusters();
        let after: f32 = clusters.iter().map(|cluster| cluster.bound.cost).sum();
        if after > before - LEAST_GAIN {
            return;
        }
        for &number in &torn {
            self.remove(number);
        }
        for cluster in clusters {
            match torn.pop() {
                Some(number) => self.replace(number, cluster),
                None => {
                    self.outlines.push(&Outline::of(&cluster, model));
                    self.clusters.push(Some(cluster));
                }
            }
        }
    }
}
