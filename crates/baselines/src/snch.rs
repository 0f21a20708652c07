//! A hierarchy of spatialized normal cones.
//!
//! Johnson and Cohen, Spatialized Normal Cone Hierarchies, I3D 2001, as Tsiapkolis and Bénard
//! compare with it (Patch Decomposition for Efficient Mesh Contours Extraction, CGF 2024): a binary
//! hierarchy of boxes over the edges, built for space alone, and in each of its nodes a cone around
//! the normals of the faces beside its edges and a sphere. A node is culled with all that is below.
//!
//! Departures, all in its favour: the boxes come from PLOC with parallel reinsertion (Meister and
//! Bittner, 2018 and 2020, crate `obvhs`), which costs less to traverse than a median split; cones
//! are the narrowest ones and spheres meet the lines through the edges, both measured over all
//! edges of a node rather than merged; and nodes lie in the order of the traversal, each with the
//! number of the one that follows if it is culled, so that no stack is needed.

use std::ops::Range;

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::Statistics;
use crate::edges::Edges;
use crate::shape::{Shape, Shaped, bound, count, unit_positions};

/// What a step down costs, in edges, where leaves are joined. On the Stanford bunny, at 1.363 edge
/// tests a node, 6 costs 4 % less than the 3 of `obvhs`, and 12 the same.
const STEP_COST: f32 = 6.0;

/// How a [`Snch`] is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SnchParams {
    /// Most edges in a leaf, 1 ..= 255; values outside count as the nearest of these. With 1, every
    /// edge has a bound of its own: fewest edges are tested, and most nodes. With more, leaves are
    /// joined where the surface area heuristic says that it pays.
    pub edges_per_leaf: u32,
}

impl Default for SnchParams {
    fn default() -> Self {
        Self { edges_per_leaf: 8 }
    }
}

/// Edges in a hierarchy of spatialized normal cones.
#[derive(Clone, Debug)]
pub struct Snch<'mesh> {
    /// In the order of the leaves; then those that no bound holds.
    edges: Edges<'mesh>,
    /// Parents before their children, and these one subtree after the other.
    nodes: Vec<Node>,
    /// Of each node.
    bounds: Vec<DoubleCone>,
    always_tested: Range<u32>,
}

/// A node: the edges of its subtree lie together.
#[derive(Clone, Debug)]
struct Node {
    /// The node after its subtree. That of a leaf is the next one.
    next: u32,
    edges: Range<u32>,
}

impl<'mesh> Snch<'mesh> {
    /// Builds the hierarchy of the edges that `filter` keeps. Some 10 µs an edge,
    /// single-threaded: every node measures all its edges, up to where the normals spread too far
    /// to be bounded. Quadratic in the number of edges that share one box, or one edge of thousands
    /// of faces, where the search of `obvhs` joins about one pair a round.
    ///
    /// Edges beside a face without area, or without a plane that can be trusted, are in no node
    /// and always tested.
    pub fn new(
        mesh: &'mesh Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
        params: &SnchParams,
    ) -> Self {
        let kept = Edges::new(mesh, adjacency, filter);
        let shaped = Shaped::new(&kept);
        let (nodes, order) = flattened(&hierarchy(mesh, &kept, &shaped.places, params));
        let (edges, shapes, always_tested) = shaped.arranged(&kept, &order);
        let bounds = bounds(&nodes, &shapes);
        Self { edges, nodes, bounds, always_tested }
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, in an order that depends on
    /// the mesh alone. Does not allocate once `contours` is large enough.
    pub fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Statistics {
        contours.clear();
        let mut statistics = Statistics::default();
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            statistics.nodes_tested += 1;
            if !self.bounds[index].may_hold_contour(viewpoint) {
                index = node.next as usize;
                continue;
            }
            index += 1;
            if index == node.next as usize {
                self.edges.test(node.edges.clone(), viewpoint, contours, &mut statistics);
            }
        }
        self.edges.test(self.always_tested.clone(), viewpoint, contours, &mut statistics);
        statistics
    }

    /// Number of nodes, inner ones and leaves.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Number of edges, those that are always tested among them.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Number of edges that are in no node.
    pub fn always_tested(&self) -> usize {
        self.always_tested.len()
    }

    /// The bound of every node, parents before their children. [`DoubleCone::ALWAYS`] where the
    /// normals spread too far to be bounded, as they do at the root of a closed mesh.
    pub fn bounds(&self) -> &[DoubleCone] {
        &self.bounds
    }
}

/// The hierarchy of boxes around the edges at `places`, which are numbered in that order.
fn hierarchy(mesh: &Mesh, edges: &Edges<'_>, places: &[u32], params: &SnchParams) -> Bvh2 {
    let positions = unit_positions(mesh);
    let position = |vertex: u32| Vec3A::from(positions[vertex as usize]);
    let boxes: Vec<Aabb> = places
        .iter()
        .map(|&place| edges.wings()[place as usize].ends().map(position))
        .map(|[a, b]| Aabb::new(a.min(b), a.max(b)))
        .collect();
    // What its best preset does, with nothing split and the widest search.
    let mut bvh = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::VeryHigh,
        &boxes,
        (0..count(boxes.len())).collect(),
        SortPrecision::U128,
        0,
    );
    // Reinsertion looks for places with a stack of twice this, and forgets some where the tree is
    // deeper, as among boxes that coincide; a deeper stack would panic if the tree grew beyond it.
    bvh.max_depth = DEFAULT_MAX_STACK_DEPTH;
    let mut reinsertion = ReinsertionOptimizer::default();
    reinsertion.run(&mut bvh, 1.0, None);
    collapse(&mut bvh, params.edges_per_leaf.clamp(1, 255), STEP_COST);
    reinsertion.run(&mut bvh, 1.0, None);
    bvh
}

/// The nodes of `bvh` in the order of the traversal, and its primitives in that of the leaves.
fn flattened(bvh: &Bvh2) -> (Vec<Node>, Vec<u32>) {
    enum Step {
        Enter(u32),
        Leave(usize),
    }
    let mut nodes: Vec<Node> = Vec::with_capacity(bvh.nodes.len());
    let mut order = Vec::with_capacity(bvh.primitive_indices.len());
    let mut steps = if bvh.nodes.is_empty() { Vec::new() } else { vec![Step::Enter(0)] };
    while let Some(step) = steps.pop() {
        match step {
            Step::Enter(index) => {
                let node = &bvh.nodes[index as usize];
                let first = node.first_index;
                steps.push(Step::Leave(nodes.len()));
                let first_edge = count(order.len());
                nodes.push(Node { next: 0, edges: first_edge..first_edge });
                if node.is_leaf() {
                    let primitives = first as usize..(first + node.prim_count) as usize;
                    order.extend_from_slice(&bvh.primitive_indices[primitives]);
                } else {
                    steps.extend([Step::Enter(first + 1), Step::Enter(first)]);
                }
            }
            Step::Leave(index) => {
                nodes[index].next = count(nodes.len());
                nodes[index].edges.end = count(order.len());
            }
        }
    }
    (nodes, order)
}

/// The bound of each node, from the `shapes` of all its edges.
fn bounds(nodes: &[Node], shapes: &[Shape]) -> Vec<DoubleCone> {
    let mut bounds = vec![DoubleCone::ALWAYS; nodes.len()];
    for (index, node) in nodes.iter().enumerate().rev() {
        let mut children = Vec::with_capacity(2);
        let mut child = index + 1;
        while child < node.next as usize {
            children.push(bounds[child]);
            child = nodes[child].next as usize;
        }
        // No cone is narrower than those of its parts.
        if !children.contains(&DoubleCone::ALWAYS) {
            let edges = node.edges.start as usize..node.edges.end as usize;
            bounds[index] = bound(&shapes[edges]);
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{FILTERS, agrees, culls_no_contour, viewpoints};
    use drypoint_mesh::shapes;
    use glam::DVec3;
    use proptest::prelude::*;

    fn snch(mesh: &Mesh, filter: EdgeFilter, edges_per_leaf: u32) -> Snch<'_> {
        Snch::new(mesh, &MeshAdjacency::new(mesh), filter, &SnchParams { edges_per_leaf })
    }

    #[track_caller]
    fn check(mesh: &Mesh, filter: EdgeFilter, edges_per_leaf: u32) {
        let snch = snch(mesh, filter, edges_per_leaf);
        assert!(snch.nodes() < 2 * snch.edges().max(1));
        assert_eq!(snch.bounds().len(), snch.nodes());
        agrees(mesh, filter, viewpoints(mesh), |from, contours| snch.extract(from, contours));
    }

    #[test]
    fn all_shapes_from_everywhere() {
        for (shape, filter) in shapes::all().iter().flat_map(|s| FILTERS.map(|f| (s, f))) {
            for edges_per_leaf in [1, 8] {
                check(&shape.mesh, filter, edges_per_leaf);
            }
        }
    }

    #[test]
    fn leaves_of_any_size() {
        let mesh = shapes::bumpy_sphere(1_000);
        for edges_per_leaf in [0, 2, 3, 255, u32::MAX] {
            check(&mesh, EdgeFilter::Convex, edges_per_leaf);
        }
        let edges = snch(&mesh, EdgeFilter::All, 1).edges();
        assert_eq!(snch(&mesh, EdgeFilter::All, 1).nodes(), 2 * edges - 1);
        assert!(snch(&mesh, EdgeFilter::All, 8).nodes() < edges);
    }

    #[test]
    fn every_node_from_its_cull_boundary() {
        for mesh in [shapes::bumpy_sphere(500), shapes::cad_part(672), shapes::moved_sphere(500)] {
            let snch = snch(&mesh, EdgeFilter::All, 2);
            let unit = mesh.bounds().unwrap().half_longest_side();
            let culled = snch.nodes.iter().zip(snch.bounds()).map(|(node, bound)| {
                culls_no_contour(*bound, &snch.edges, node.edges.clone(), unit)
            });
            // Culling nothing would lose nothing.
            assert!(culled.sum::<usize>() > 20 * snch.nodes());
        }
    }

    #[test]
    fn most_of_a_smooth_sphere_is_culled() {
        let sphere = shapes::icosphere(20_000);
        for (edges_per_leaf, share) in [(1, 33), (8, 16)] {
            let snch = snch(&sphere, EdgeFilter::Convex, edges_per_leaf);
            let mut contours = Vec::new();
            let far = Viewpoint::at(DVec3::new(20.0, 30.0, 40.0));
            let statistics = snch.extract(far, &mut contours);
            assert!(statistics.edges_tested < snch.edges() / share, "{statistics:?}");
            assert!(statistics.nodes_tested < snch.nodes() / 4, "{statistics:?}");
        }
    }

    /// The hierarchy is deeper than that of any model, one edge a level.
    #[test]
    fn faces_that_lie_upon_each_other_by_the_dozen() {
        let mesh = shapes::stack(48);
        for filter in FILTERS {
            check(&mesh, filter, 1);
        }
    }

    #[test]
    fn edges_beside_faces_without_area_are_in_no_node() {
        let fan = shapes::zero_area_fan();
        let snch = snch(&fan, EdgeFilter::All, 8);
        assert_eq!((snch.nodes(), snch.always_tested()), (0, snch.edges()));
        assert!(snch.edges() > 0);
    }

    proptest! {
        #[test]
        fn from_anywhere(xyz in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0], scale in -1.0..4.0f64) {
            let mesh = shapes::bumpy_sphere(320);
            let snch = snch(&mesh, EdgeFilter::Convex, 4);
            let xyz = 10f64.powf(scale) * DVec3::from_array(xyz);
            let viewpoints = [Viewpoint::at(xyz), Viewpoint::from_direction(xyz)];
            agrees(&mesh, EdgeFilter::Convex, viewpoints, |from, out| snch.extract(from, out));
        }
    }
}
