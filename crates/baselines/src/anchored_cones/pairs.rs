//! Which edges may be joined at first.

use drypoint_bounds::Plane;

use super::forest::Leaf;

/// At a vertex of very many edges each is paired with this many others, so that hostile input costs
/// linear memory. Up to 32 edges that is every pair.
const MOST_PAIRED: usize = 31;

/// Cells along each coordinate of a normal.
const CELLS: f64 = 1024.0;

/// Pairs edges that share a vertex; `ends` are those of a leaf, by its index.
pub(super) fn by_vertices(leaves: &mut [Leaf], ends: impl Fn(usize) -> [u32; 2]) {
    let around = |(index, leaf): (usize, u32)| ends(index).map(|vertex| (vertex, leaf));
    let mut corners: Vec<(u32, u32)> = (0..leaves.len()).zip(0..).flat_map(around).collect();
    corners.sort_unstable();
    for corner in corners.chunk_by(|a, b| a.0 == b.0) {
        let edges: Vec<u32> = corner.iter().map(|&(_, leaf)| leaf).collect();
        pair_with_next(leaves, &edges, MOST_PAIRED);
    }
}

/// Pairs each edge with the next `count` along a curve through the space of normals, which are
/// those that face nearly the same way, or some of them.
pub(super) fn by_normals(leaves: &mut [Leaf], planes: &[Plane], count: usize) {
    if count == 0 {
        return;
    }
    let normal = |leaf: &Leaf| {
        leaf.planes
            .iter()
            .map(|&p| planes[p as usize].normal)
            .sum::<glam::DVec3>()
            .normalize_or_zero()
    };
    let mut order: Vec<(u32, u32)> =
        leaves.iter().map(|leaf| morton(normal(leaf))).zip(0..).collect();
    order.sort_unstable();
    let order: Vec<u32> = order.into_iter().map(|(_, leaf)| leaf).collect();
    pair_with_next(leaves, &order, count);
}

fn pair_with_next(leaves: &mut [Leaf], order: &[u32], count: usize) {
    for (index, &a) in order.iter().enumerate() {
        for &b in order[index + 1..].iter().take(count) {
            leaves[a as usize].neighbours.push(b);
            leaves[b as usize].neighbours.push(a);
        }
    }
}

/// The cell of a unit vector along Morton's curve through a cube of 1024 cells a side.
fn morton(unit: glam::DVec3) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 ..= 1023")]
    let cells = unit.to_array().map(|x| (0.5 * (x + 1.0) * CELLS).clamp(0.0, CELLS - 1.0) as u32);
    let bit = |place: u32| {
        cells
            .iter()
            .zip(0..)
            .map(|(cell, axis)| ((cell >> place) & 1) << (3 * place + axis))
            .sum::<u32>()
    };
    (0..10).map(bit).sum()
}
