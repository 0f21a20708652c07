//! Edges that move to where they cost less, and clusters that are given up.

use super::cell::{Cell, LEAST_GAIN};
use super::cluster::{Bound, Cluster};
use super::outlines::Outline;

/// Most edges of a cluster that are moved or given up: in larger ones, which flat parts make, an edge
/// costs next to nothing, and to look for a better place takes time in proportion to their size.
const MOST_EDGES: usize = 512;

/// What a move may lose at first, in patch tests.
const MOST_LOST: f32 = 0.0075;

/// How far a rough gain may be from a true one, as a share of what a move releases.
const ROUGHNESS: f32 = 1.5;

/// What an edge of a cluster that is given up costs elsewhere at least, very likely, as a share of what
/// it cost there. With 0, half the time goes into clusters that stay.
const LIKELY_COST: f32 = 0.8;

impl Cell<'_> {
    /// Moves edges, gives up clusters and fuses what is left, where that gains.
    pub(crate) fn refine(&mut self) {
        self.move_edges();
        self.dissolve();
        self.fuse_best(1);
    }

    /// Moves edges, alone or with those that share a plane on the rim, to the cluster of this cell
    /// where they cost less, if any.
    pub(crate) fn move_edges(&mut self) {
        for number in 0..self.clusters.len() {
            let Some(cluster) = &self.clusters[number] else { continue };
            if cluster.items.len() > MOST_EDGES {
                continue;
            }
            for (unit, may_shrink) in cluster.units(self.table) {
                self.move_unit(number, &unit, may_shrink);
            }
        }
    }

    /// Moves some edges out of a cluster, if that gains anything, or loses little while there is heat.
    fn move_unit(&mut self, from: usize, unit: &[u32], may_shrink: bool) {
        let (table, model) = (self.table, self.model);
        let Some(cluster) = &self.clusters[from] else { return };
        // Edges may have gone with an earlier unit.
        let is_here = unit.iter().all(|item| cluster.items.contains(item));
        if cluster.items.len() <= unit.len() || !is_here {
            return;
        }
        let edges = unit.len() as f32;
        // Most edges stay where they are, and are seen to by their outlines alone.
        let (bound, mut moved) = match unit {
            [item] => (Bound::of_item(table, table.item(*item), model), None),
            _ => {
                let moved = Cluster::of_items(table, unit.into(), model);
                (moved.bound, Some(moved))
            }
        };
        let mut rest = None;
        let left_cost = if may_shrink {
            let moved = moved.get_or_insert_with(|| Cluster::of_items(table, unit.into(), model));
            rest.insert(cluster.without(table, moved, model)).bound.cost
        } else {
            model.patch(cluster.bound.acceptance, cluster.edges() - edges)
        };
        let release = cluster.bound.cost - left_cost;
        let outline = Outline::of_bound(&bound, edges, model);
        self.outlines.gains(&outline, model, &mut self.gains);
        self.gains.set(from, f32::NEG_INFINITY);
        let least_gain = LEAST_GAIN - self.care.heat * MOST_LOST * model.patch_test();
        let (mut best_gain, mut best) = (least_gain, None);
        for _ in 0..self.care.looks {
            let Some((to, rough)) = self.gains.most() else { break };
            let rough = rough - outline.cost + release;
            if rough < best_gain - ROUGHNESS * release {
                break;
            }
            self.gains.set(to, f32::NEG_INFINITY);
            let Some(target) = &self.clusters[to] else { continue };
            let moved = moved.get_or_insert_with(|| Cluster::of_items(table, unit.into(), model));
            let bound = target.union(moved, table, model, target.bound.cost + release - best_gain);
            let gain = release - (bound.cost - target.bound.cost);
            if gain > best_gain {
                best_gain = gain;
                best = Some((to, bound));
            }
        }
        let (Some((to, bound)), Some(moved)) = (best, moved) else { return };
        let rest = rest.unwrap_or_else(|| cluster.without(table, &moved, model));
        self.absorb(to, &moved, bound);
        self.replace(from, Box::new(rest));
    }

    /// Gives up clusters whose edges cost less in others.
    fn dissolve(&mut self) {
        for number in 0..self.clusters.len() {
            self.dissolve_one(number);
        }
    }

    fn dissolve_one(&mut self, number: usize) {
        let (table, model) = (self.table, self.model);
        if self.clusters[number].as_ref().is_none_or(|cluster| cluster.items.len() > MOST_EDGES) {
            return;
        }
        let Some(cluster) = self.clusters[number].take() else { return };
        self.outlines.remove(number);
        // What its edges may still cost elsewhere.
        let mut left = cluster.bound.cost - LEAST_GAIN;
        // Old clusters, to put back if it comes to nothing.
        let mut changed: Vec<(usize, Box<Cluster>)> = Vec::new();
        for (done, &item) in cluster.items.iter().enumerate() {
            let moved = Cluster::of_item(table, item, model);
            self.outlines.gains(&Outline::of(&moved, model), model, &mut self.gains);
            let best =
                self.gains.most().and_then(|(to, _)| Some((to, self.clusters[to].as_ref()?)));
            let Some((to, target)) = best else {
                left = f32::NEG_INFINITY;
                break;
            };
            let bound = target.union(&moved, table, model, target.bound.cost + left);
            left -= bound.cost - target.bound.cost;
            let still_to_go = (cluster.items.len() - done - 1) as f32;
            if left <= LIKELY_COST * cluster.bound.acceptance * still_to_go {
                left = f32::NEG_INFINITY;
                break;
            }
            if changed.iter().all(|(number, _)| *number != to) {
                changed.push((to, target.clone()));
            }
            self.absorb(to, &moved, bound);
        }
        if left > 0.0 {
            return;
        }
        for (to, target) in changed {
            self.replace(to, target);
        }
        self.replace(number, cluster);
    }
}
