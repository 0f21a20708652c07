//! Cuts the edges into parts small enough to compare every pair.

use drypoint_mesh::EdgeId;
use glam::DVec3;

/// An edge and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) edge: EdgeId,
    pub(crate) midpoint: DVec3,
}

/// Halves `edges` at the median of the longest side of their midpoints' box, and the halves again,
/// until none holds more than `most`. Each part is in order of ids; the parts are in space order.
///
/// Tsiapkolis and Bénard, CGF 2024, §3.2. O(n log n).
pub(crate) fn split_in_space(edges: &mut [Placed], most: usize) -> Vec<Vec<EdgeId>> {
    let mut parts = Vec::new();
    split(edges, most.max(1), &mut parts);
    parts
}

fn split(edges: &mut [Placed], most: usize, parts: &mut Vec<Vec<EdgeId>>) {
    if edges.len() <= most {
        let mut ids: Vec<EdgeId> = edges.iter().map(|placed| placed.edge).collect();
        ids.sort_unstable();
        if !ids.is_empty() {
            parts.push(ids);
        }
        return;
    }
    let side = longest_side(edges);
    let middle = edges.len() / 2;
    // With the id the order is strict, so equal coordinates cannot make the halves differ from run
    // to run.
    edges.select_nth_unstable_by(middle, |a, b| {
        a.midpoint[side].total_cmp(&b.midpoint[side]).then(a.edge.cmp(&b.edge))
    });
    let (low, high) = edges.split_at_mut(middle);
    split(low, most, parts);
    split(high, most, parts);
}

/// Axis of the longest side of the box around the midpoints; the first of equals.
fn longest_side(edges: &[Placed]) -> usize {
    let (min, max) = edges.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), e| {
        (min.min(e.midpoint), max.max(e.midpoint))
    });
    (max - min).max_position()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(count: u32, most: usize, at: impl Fn(f64) -> DVec3) {
        let placed = |i: u32| Placed { edge: EdgeId(i), midpoint: at(f64::from(i)) };
        let parts = split_in_space(&mut (0..count).map(placed).collect::<Vec<_>>(), most);
        assert!(parts.iter().all(|part| part.len() <= most.max(1) && part.is_sorted()));
        let mut all: Vec<u32> = parts.iter().flatten().map(|e| e.0).collect();
        all.sort_unstable();
        assert!(all.iter().copied().eq(0..count));
        if count as usize > most {
            let smallest = parts.iter().map(Vec::len).min().unwrap();
            assert!(2 * (smallest + 1) > most, "parts are halves: {smallest} of {most}");
        }
    }

    #[test]
    fn parts_are_small_sorted_and_hold_each_edge_once() {
        let spiral = |t: f64| DVec3::new(t * t.cos(), t * t.sin(), 0.1 * t);
        for (count, most) in [(0, 4), (1, 1), (4, 4), (5, 4), (1000, 64), (1000, 7), (5, 0)] {
            check(count, most, spiral);
            check(count, most, |_| DVec3::ONE);
        }
    }

    #[test]
    fn the_longest_side_is_cut() {
        let placed = |i: u32| Placed {
            edge: EdgeId(i),
            midpoint: DVec3::new(f64::from(i % 2), f64::from(i) * 10.0, 0.0),
        };
        let parts = split_in_space(&mut (0..8).map(placed).collect::<Vec<_>>(), 4);
        let ids: Vec<Vec<u32>> =
            parts.iter().map(|part| part.iter().map(|e| e.0).collect()).collect();
        assert_eq!(ids, [[0, 1, 2, 3], [4, 5, 6, 7]]);
    }
}
