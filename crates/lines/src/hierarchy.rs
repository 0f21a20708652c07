//! A hierarchy of boxes that no input makes slow to build.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};

/// The size of the largest coordinate of what is in a hierarchy. Boxes keep their shape where coordinates are up
/// to 2^176 times as small.
pub(crate) const LARGEST: f64 = (1u64 << 50) as f64;

/// Places along an axis where boxes may be parted.
const BINS: usize = 16;

/// Of so many boxes one at least goes to either side.
const LEAST_SHARE: usize = 8;

/// Boxes above which the sides are built by two threads.
const SHARED: usize = 1 << 12;

/// A hierarchy with a leaf for each box.
///
/// From above, where the surface area heuristic says, as estimated from bins of the boxes' centers: Wald, On Fast
/// Construction of SAH-based Bounding Volume Hierarchies, RT 2007. Where that would part few from many, or tells
/// nothing, boxes are halved by their order along the axis: so it takes n log n steps for n boxes of any kind, in
/// rows, in nests, on top of each other, or all but one in a point. The builders of `obvhs` join neighbours from
/// below, one pair at a time where each is a better neighbour than the one before.
///
/// On all threads; the same on any number of them.
pub(crate) fn hierarchy(boxes: &[Aabb]) -> Bvh2 {
    let count = u32::try_from(boxes.len()).expect("a mesh has fewer triangles");
    let mut bvh = Bvh2 { primitive_indices: (0..count).collect(), ..Bvh2::default() };
    if boxes.is_empty() {
        return bvh;
    }
    bvh.nodes = vec![Bvh2Node::default(); 2 * boxes.len() - 1];
    let (root, below) = bvh.nodes.split_at_mut(1);
    let part = Part { items: &mut bvh.primitive_indices, first_item: 0, below, first_below: 1 };
    let depth = part.build(boxes, &mut root[0]);
    bvh.max_depth = depth.max(DEFAULT_MAX_STACK_DEPTH);
    bvh
}

/// Boxes that go below one node.
struct Part<'a> {
    items: &'a mut [u32],
    /// Where they are in the list of all.
    first_item: u32,
    /// The nodes below it: its children, all below the first one, all below the second one.
    below: &'a mut [Bvh2Node],
    first_below: u32,
}

impl Part<'_> {
    /// Makes `node` and what is below it; its height.
    fn build(self, boxes: &[Aabb], node: &mut Bvh2Node) -> usize {
        let Self { items, first_item, below, first_below } = self;
        let of_item = |&item: &u32| boxes[item as usize];
        let bounds = items.iter().map(of_item).reduce(|a, b| a.union(&b)).unwrap_or(Aabb::INVALID);
        if items.len() == 1 {
            *node = Bvh2Node::new(bounds, 1, first_item);
            return 1;
        }
        *node = Bvh2Node::new(bounds, 0, first_below);
        let middle = part(items, boxes);
        let [in_first, below_first] =
            [middle, 2 * middle - 2].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        let is_shared = items.len() > SHARED;
        let (first, second) = items.split_at_mut(middle);
        let (children, below) = below.split_at_mut(2);
        let (below_of_first, below_of_second) = below.split_at_mut(2 * middle - 2);
        let first =
            Part { items: first, first_item, below: below_of_first, first_below: first_below + 2 };
        let second = Part {
            items: second,
            first_item: first_item + in_first,
            below: below_of_second,
            first_below: first_below + 2 + below_first,
        };
        let (left, right) = children.split_at_mut(1);
        let (left, right) =
            (|| first.build(boxes, &mut left[0]), || second.build(boxes, &mut right[0]));
        let (left, right) = if is_shared { rayon::join(left, right) } else { (left(), right()) };
        1 + left.max(right)
    }
}

/// Puts those first that go to the first side, and says how many these are.
fn part(items: &mut [u32], boxes: &[Aabb]) -> usize {
    let center = |item: u32| {
        let Aabb { min, max } = boxes[item as usize];
        0.5 * min + 0.5 * max
    };
    let (low, high) = items.iter().fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(a, b), &item| {
        let center = center(item);
        (a.min(center), b.max(center))
    });
    let axis = (high - low).max_position();
    let count = items.len();
    let bin = |item: u32| bin(center(item)[axis], [low[axis], high[axis]]);
    if count > 2
        && let Some(border) = best_border(items, boxes, bin)
    {
        let mut middle = 0;
        for i in 0..count {
            if bin(items[i]) < border {
                items.swap(i, middle);
                middle += 1;
            }
        }
        if middle.min(count - middle) * LEAST_SHARE >= count {
            return middle;
        }
    }
    let place = |item: u32| (center(item)[axis], item);
    items.select_nth_unstable_by(count / 2, |&a, &b| {
        let (a, b) = (place(a), place(b));
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
    });
    count / 2
}

/// Which of the [`BINS`] between two ends a place is in.
fn bin(place: f32, [low, high]: [f32; 2]) -> usize {
    let fraction = (place - low) / (high - low);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let bin = (fraction * BINS as f32) as usize;
    bin.min(BINS - 1)
}

/// The first bin of the second side where boxes are parted best; `None` if all are in one.
fn best_border(items: &[u32], boxes: &[Aabb], bin: impl Fn(u32) -> usize) -> Option<usize> {
    let mut bins = [(Aabb::INVALID, 0usize); BINS];
    for &item in items {
        let (bounds, count) = &mut bins[bin(item)];
        *bounds = bounds.union(&boxes[item as usize]);
        *count += 1;
    }
    // What a side costs for each border: its area times the number of its boxes.
    let add = |sum: &mut (Aabb, usize), &(bounds, count): &(Aabb, usize)| {
        *sum = (sum.0.union(&bounds), sum.1 + count);
        Some(*sum)
    };
    let firsts = bins.iter().scan((Aabb::INVALID, 0), add);
    let mut seconds = bins;
    for border in (1..BINS).rev() {
        let after = seconds[border];
        add(&mut seconds[border - 1], &after);
    }
    let borders = firsts.zip(&seconds[1..]).zip(1..);
    let borders = borders.filter(|((first, second), _)| first.1 > 0 && second.1 > 0);
    let cost = |(bounds, count): &(Aabb, usize)| half_area(bounds) * *count as f64;
    let costs = borders.map(|((first, second), border)| (cost(&first) + cost(second), border));
    costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, border)| border)
}

/// Half the area of a box, in f64, in which that of a small one is not 0.
fn half_area(bounds: &Aabb) -> f64 {
    let [x, y, z] = (bounds.max - bounds.min).to_array().map(f64::from);
    x * y + y * z + z * x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(min: [f32; 3], size: f32) -> Aabb {
        let min = Vec3A::from(min);
        Aabb::new(min, min + size)
    }

    /// Every box is in one leaf, every node holds what is below it, and no way down is long.
    #[track_caller]
    fn check(boxes: &[Aabb]) -> usize {
        let bvh = hierarchy(boxes);
        let mut found = vec![0; boxes.len()];
        let mut height = 0;
        let mut stack = vec![(0, 1)];
        while let Some((index, depth)) = stack.pop() {
            let node = &bvh.nodes[index as usize];
            height = height.max(depth);
            let holds = |inner: &Aabb| {
                node.aabb().min.cmple(inner.min).all() && node.aabb().max.cmpge(inner.max).all()
            };
            if node.is_leaf() {
                assert_eq!(node.prim_count, 1);
                let item = bvh.primitive_indices[node.first_index as usize] as usize;
                found[item] += 1;
                assert!(holds(&boxes[item]));
            } else {
                for child in [node.first_index, node.first_index + 1] {
                    assert!(holds(bvh.nodes[child as usize].aabb()));
                    stack.push((child, depth + 1));
                }
            }
        }
        assert!(found.iter().all(|&times| times == 1));
        assert!(height <= bvh.max_depth);
        // Each step down leaves 7 of 8 boxes at most.
        let most = (boxes.len() as f64).log(8.0 / 7.0).ceil() + 2.0;
        assert!(height as f64 <= most, "{height}");
        height
    }

    /// Builders that join neighbours from below take as many rounds as there are boxes for some of these.
    #[test]
    fn boxes_of_any_kind_make_no_chain() {
        let numbers = || (0..20_000u16).map(f32::from);
        let row: Vec<Aabb> = numbers().map(|x| at([x, 0.0, 0.0], 1.0)).collect();
        assert!(check(&row) < 20);
        let back: Vec<Aabb> = numbers().map(|x| at([-x, -1.0, -1.0], 1.0)).collect();
        assert!(check(&back) < 20);
        let nest: Vec<Aabb> = numbers().map(|x| at([-x; 3], 2.0 * x)).collect();
        assert!(check(&nest) < 20);
        let powers: Vec<Aabb> =
            (-120..120i8).map(|e| at([f32::from(e).exp2(), 0.0, 0.0], 1e-38)).collect();
        assert!(check(&powers) < 20);
        assert!(check(&vec![at([1.0; 3], 0.0); 20_000]) < 20);
        for far in [1e12, 1e15] {
            let mut stray = row.clone();
            stray[77] = at([far, far, far], 1.0);
            assert!(check(&stray) < 30);
        }
        check(&[at([0.0; 3], 1.0)]);
        assert!(hierarchy(&[]).nodes.is_empty());
    }

    #[test]
    fn any_number_of_threads_builds_the_same() {
        let mut random = random_numbers(7);
        let boxes: Vec<Aabb> =
            (0..30_000).map(|_| at([random(), random(), random()], 0.1 * random())).collect();
        check(&boxes);
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let bvh = pool.install(|| hierarchy(&boxes));
            let nodes = bvh.nodes.iter().map(|node| (node.first_index, node.prim_count));
            (bvh.primitive_indices, nodes.collect::<Vec<_>>())
        };
        assert_eq!(with(1), with(3));
    }

    #[test]
    fn boxes_are_parted_where_there_is_a_gap() {
        let near = (0..100u8).map(|x| at([f32::from(x), 0.0, 0.0], 1.0));
        let far = (0..30u8).map(|x| at([1000.0 + f32::from(x), 0.0, 0.0], 1.0));
        let bvh = hierarchy(&near.chain(far).collect::<Vec<_>>());
        let [first, second] = [1, 2].map(|node: usize| *bvh.nodes[node].aabb());
        assert!(first.max.x <= 100.0 && second.min.x >= 1000.0, "{first:?} {second:?}");
    }

    /// Numbers from 0 to 1.
    fn random_numbers(mut state: u32) -> impl FnMut() -> f32 {
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let [_, _, a, b] = state.to_le_bytes();
            f32::from(u16::from_le_bytes([a, b])) / 65_535.0
        }
    }
}
