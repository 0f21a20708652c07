//! Clusters torn into edges, and fused anew.

use super::cell::{Care, Cell, LEAST_GAIN};
use super::cluster::Cluster;
use super::outlines::Outline;
use crate::Cancelled;
use crate::progress::Counter;

/// How many clusters are torn apart together. More are seldom fused to anything better, and take much
/// longer.
const TORN: [usize; 2] = [2, 3];

/// What tearing may lose at first, in patch tests.
const MOST_LOST: f32 = 0.3;

/// Most edges that are torn apart at once: each is compared with all the others.
const MOST_EDGES: usize = 1024;

impl Cell<'_> {
    /// Tears a cluster and some that lie beside it into edges, and fuses these again. The better
    /// one stays, or the new one if it is little worse.
    pub(crate) fn tear(&mut self, sweep: usize, counter: &Counter) -> Result<(), Cancelled> {
        for number in 0..self.clusters.len() {
            counter.check()?;
            // Every other time not with the nearest one.
            let skipped = (sweep + number / TORN.len()) % 2;
            self.tear_one(number, TORN[(sweep + number) % TORN.len()], skipped);
        }
        Ok(())
    }

    fn tear_one(&mut self, number: usize, count: usize, skipped: usize) {
        let (table, model) = (self.table, self.model);
        let Some(cluster) = &self.clusters[number] else { return };
        self.outlines.gains(&Outline::of(cluster, model), model, &mut self.gains);
        self.gains.set(number, f32::NEG_INFINITY);
        let mut torn = vec![number];
        for rank in 0..skipped + count - 1 {
            let Some((other, _)) = self.gains.most() else { break };
            self.gains.set(other, f32::NEG_INFINITY);
            if rank >= skipped {
                torn.push(other);
            }
        }
        let before: f32 =
            torn.iter().filter_map(|&n| Some(self.clusters[n].as_ref()?.bound.cost)).sum();
        let edges: usize =
            torn.iter().filter_map(|&n| Some(self.clusters[n].as_ref()?.items.len())).sum();
        if edges > MOST_EDGES {
            return;
        }
        let items = torn.iter().filter_map(|&n| self.clusters[n].as_ref()).flat_map(|c| &c.items);
        let pieces = items.map(|&item| Box::new(Cluster::of_item(table, item, model))).collect();
        let care = Care { is_hasty: true, heat: 0.0, ..self.care };
        let mut inner = Cell::new(table, model, pieces, care);
        inner.fuse_best(1);
        inner.move_edges();
        inner.fuse_best(1);
        let after = inner.cost();
        let most = before - LEAST_GAIN + self.care.heat * MOST_LOST * model.patch_test();
        let is_good_enough = after <= most;
        if !is_good_enough {
            return;
        }
        for &number in &torn {
            self.remove(number);
        }
        for cluster in inner.into_clusters() {
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
