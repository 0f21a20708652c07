//! A forest of anchored cones.
//!
//! Sander, Gu, Gortler, Hoppe and Snyder, Silhouette Clipping, SIGGRAPH 2000, §5: every node has a
//! cone of viewpoints that see all faces beside its edges from the front, and one of those that see
//! all of them from the back, with one axis and half-angle, but with an anchor of its own each. From
//! inside either, no edge of the node or below is a contour edge. The nodes are joined from single
//! edges by what a search is expected to cost (`anchored_cones/forest.rs`).
//!
//! Departures, all in its favour: roots that cost more than what they hold are dissolved, so that
//! edges that are seldom culled are tested without a node; anchors stay near the mesh, where the
//! linear programs leave them free to lie anywhere; and all is made safe for rounding, so that the
//! edges found are exactly the contour edges.

mod bound;
mod cone;
mod forest;
mod gilbert;
mod linear_program;
mod pairs;

use std::ops::Range;

use drypoint_bounds::Plane;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, unit_normal};
use glam::DVec3;

use crate::Statistics;
use crate::edges::Edges;
use bound::{Ball, Bounder};
use cone::ConePair;
use forest::{Forest, Leaf};

/// How [`AnchoredCones`] are built; the defaults follow the paper. No value loses an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnchoredConeParams {
    /// What the test of a node costs in edge tests, k_a / k_e: 4/3 as measured there. A larger one
    /// makes fewer, larger nodes. 0 or more; NaN makes none.
    pub node_cost: f64,
    /// Viewpoints are expected anywhere in a ball of this radius around the mesh, with equal chances;
    /// in half the longest side of the mesh's box. From 5 on the angles of the cones decide, and
    /// hardly their anchors: up to 1000 the node tests of the bunny change by 1 %. Above 0.
    pub view_radius: f64,
    /// With how many others, of those that face nearly the same way, an edge may be joined at
    /// first, besides those that it shares a vertex with. 0 as published; with 8, the forest of the
    /// bunny takes 3.5 times as long to build, and from far away 43 % fewer node tests and 8 %
    /// fewer edge tests, but from near more than twice as many edge tests.
    pub similar_normals: u32,
}

impl Default for AnchoredConeParams {
    fn default() -> Self {
        Self { node_cost: 4.0 / 3.0, view_radius: 50.0, similar_normals: 0 }
    }
}

/// Edges in a forest of anchored cones.
#[derive(Clone, Debug)]
pub struct AnchoredCones<'mesh> {
    /// In the order of the nodes; then those that are in none.
    edges: Edges<'mesh>,
    /// Parents before their children, and these one subtree after the other.
    nodes: Vec<Node>,
    roots: usize,
    always_tested: Range<u32>,
}

#[derive(Clone, Debug)]
struct Node {
    cones: ConePair,
    /// Its own, without those of its children.
    edges: Range<u32>,
    /// The node after its subtree.
    next: u32,
}

impl<'mesh> AnchoredCones<'mesh> {
    /// Builds the forest of the edges that `filter` keeps, single-threaded: some 60 to 110 µs and 1 kB
    /// an edge.
    ///
    /// Edges beside a face without area, or without a plane that can be trusted, are in no node
    /// and always tested, as are those that no node is worth its test for.
    pub fn new(
        mesh: &'mesh Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
        params: &AnchoredConeParams,
    ) -> Self {
        let kept = Edges::new(mesh, adjacency, filter);
        let planes = Planes::new(mesh);
        let (places, leaves): (Vec<u32>, Vec<Leaf>) = (0..)
            .zip(kept.ids())
            .filter_map(|(place, &edge)| Some((place, planes.leaf(adjacency, edge)?)))
            .unzip();
        let mut leaves = leaves;
        pairs::by_vertices(&mut leaves, |leaf| kept.wings()[places[leaf] as usize].ends());
        pairs::by_normals(&mut leaves, &planes.planes, params.similar_normals as usize);
        let (center, unit) = mesh
            .bounds()
            .map_or((DVec3::ZERO, 0.0), |bounds| (bounds.center(), bounds.half_longest_side()));
        let ball = Ball { center, radius: params.view_radius * unit };
        let mut bounder = Bounder::new(&planes.planes, ball, unit);
        let forest = forest::grow(leaves, &mut bounder, params.node_cost);
        let laid_out = LaidOut::new(&forest);
        let is_in_no_node = |place: &u32| places.binary_search(place).is_err();
        let mut order: Vec<u32> =
            laid_out.edges.iter().map(|&leaf| places[leaf as usize]).collect();
        order.extend((0..number(kept.len())).filter(is_in_no_node));
        Self {
            edges: kept.arranged(&order),
            nodes: laid_out.nodes,
            roots: forest.roots.len(),
            always_tested: laid_out.always_tested..number(order.len()),
        }
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, in an order that depends on
    /// the mesh and the parameters alone. Does not allocate once `contours` is large enough.
    pub fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Statistics {
        contours.clear();
        let mut statistics = Statistics::default();
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            statistics.nodes_tested += 1;
            if node.cones.may_hold_contour(viewpoint) {
                self.edges.test(node.edges.clone(), viewpoint, contours, &mut statistics);
                index += 1;
            } else {
                index = node.next as usize;
            }
        }
        self.edges.test(self.always_tested.clone(), viewpoint, contours, &mut statistics);
        statistics
    }

    /// Number of nodes, roots among them.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Of each node the half-angle α of the normals, in radians; 90° for one that is never culled.
    pub fn half_angles(&self) -> impl Iterator<Item = f64> + '_ {
        self.nodes.iter().map(|node| node.cones.sin_squared.min(1.0).sqrt().asin())
    }

    /// Number of nodes that are below no other.
    pub fn roots(&self) -> usize {
        self.roots
    }

    /// Number of edges, those that are always tested among them.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Number of edges that are in no node.
    pub fn always_tested(&self) -> usize {
        self.always_tested.len()
    }
}

/// The planes of all faces: as they are, and then again, turned over.
struct Planes {
    planes: Vec<Plane>,
    /// Of each triangle, whether its plane can be trusted.
    is_sure: Vec<bool>,
}

impl Planes {
    fn new(mesh: &Mesh) -> Self {
        let (mut planes, mut is_sure) = (Vec::new(), Vec::new());
        for triangle in mesh.triangles() {
            let corners = triangle.map(|vertex| mesh.position(vertex));
            let normal = unit_normal(corners);
            is_sure.push(normal.is_some());
            let point = corners[0].as_dvec3();
            planes.push(Plane { normal: normal.unwrap_or(DVec3::NAN), point });
        }
        planes.extend_from_within(..);
        planes[is_sure.len()..].iter_mut().for_each(|plane| plane.normal = -plane.normal);
        Self { planes, is_sure }
    }

    /// The planes of an edge's faces, the right one as its wing reads it; `None` if one is not
    /// sure.
    fn leaf(&self, adjacency: &MeshAdjacency, edge: EdgeId) -> Option<Leaf> {
        let faces = adjacency.sides(edge).map(|side| side.triangle());
        let is_sure = faces.iter().all(|&face| self.is_sure[face as usize]);
        let turn = if adjacency.is_right_turned(edge) { number(self.is_sure.len()) } else { 0 };
        let planes = [faces[0], faces[1] + turn];
        is_sure.then(|| Leaf { planes, neighbours: Vec::new() })
    }
}

/// A forest in the order of the search, and its edges with it.
struct LaidOut {
    nodes: Vec<Node>,
    /// In the order of the nodes, and then those in none, from `always_tested` on.
    edges: Vec<u32>,
    always_tested: u32,
}

impl LaidOut {
    fn new(forest: &Forest) -> Self {
        enum Step {
            Enter(u32),
            Leave(usize),
        }
        let mut laid_out = Self { nodes: Vec::new(), edges: Vec::new(), always_tested: 0 };
        let Self { nodes, edges, always_tested } = &mut laid_out;
        let mut steps: Vec<Step> = forest.roots.iter().rev().copied().map(Step::Enter).collect();
        while let Some(step) = steps.pop() {
            match step {
                Step::Enter(index) => {
                    let node = &forest.nodes[index as usize];
                    steps.push(Step::Leave(nodes.len()));
                    steps.extend(node.children.iter().rev().copied().map(Step::Enter));
                    let first = number(edges.len());
                    edges.extend(&node.edges);
                    let edges = first..number(edges.len());
                    nodes.push(Node { cones: node.cones, edges, next: 0 });
                }
                Step::Leave(index) => nodes[index].next = number(nodes.len()),
            }
        }
        *always_tested = number(edges.len());
        edges.extend(&forest.always_tested);
        laid_out
    }
}

/// A number of edges, or of nodes, which are fewer.
fn number(len: usize) -> u32 {
    u32::try_from(len).expect("half-edges fit a u32")
}

#[cfg(test)]
mod tests {
    use super::*;
    use drypoint_mesh::{Wing, contour_edges, is_contour, shapes};

    const FILTERS: [EdgeFilter; 2] = [EdgeFilter::All, EdgeFilter::Convex];

    /// Points spread evenly over a cube of ±1, the same each time.
    fn spread(count: u32) -> impl Iterator<Item = DVec3> {
        let step = DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
        (1..=count).map(move |i| 2.0 * (f64::from(i) * step).fract() - 1.0)
    }

    /// From near and far, on and beside vertices and planes of faces, and from infinity.
    fn viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
        let Some(bounds) = mesh.bounds() else { return vec![Viewpoint::at(DVec3::ONE)] };
        let (center, unit) = (bounds.center(), bounds.half_longest_side());
        let mut viewpoints: Vec<Viewpoint> = spread(24).map(Viewpoint::from_direction).collect();
        for scale in [0.3, 1.0, 3.0, 100.0, 1e6] {
            viewpoints.extend(spread(12).map(|p| Viewpoint::at(center + scale * unit * p)));
        }
        for triangle in mesh.triangles().iter().step_by(mesh.triangles().len() / 12 + 1) {
            let [a, b, c] = triangle.map(|v| mesh.position(v).as_dvec3());
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let beside = a + 7.0 * (b - a) - 5.0 * (c - a);
            let hair = 1e-7 * (a.length() + unit) * normal;
            let near = [a, 0.5 * (a + b), beside, beside + hair, beside - hair];
            viewpoints.extend(near.map(Viewpoint::at));
            viewpoints.extend([(b - a) / unit, normal].map(Viewpoint::from_direction));
        }
        viewpoints
    }

    #[track_caller]
    fn check_with(mesh: &Mesh, name: &str, filter: EdgeFilter, params: &AnchoredConeParams) {
        let adjacency = MeshAdjacency::new(mesh);
        let cones = AnchoredCones::new(mesh, &adjacency, filter, params);
        let (mut found, mut expected) = (vec![EdgeId(7)], Vec::new());
        for viewpoint in viewpoints(mesh) {
            let statistics = cones.extract(viewpoint, &mut found);
            found.sort_unstable();
            contour_edges(mesh, &adjacency, viewpoint, filter, &mut expected);
            assert_eq!(found, expected, "{name}, {filter:?}, {viewpoint:?}");
            assert_eq!(statistics.contour_edges, expected.len());
            assert!(statistics.nodes_tested <= cones.nodes());
            assert!(statistics.edges_tested <= cones.edges());
        }
    }

    #[test]
    fn contours_are_those_of_the_definition() {
        for shapes::NamedMesh { name, mesh } in shapes::all() {
            for filter in FILTERS {
                check_with(&mesh, name, filter, &AnchoredConeParams::default());
            }
        }
    }

    #[test]
    fn any_parameters_find_the_same() {
        let default = AnchoredConeParams::default();
        for params in [
            AnchoredConeParams { node_cost: 0.0, ..default },
            AnchoredConeParams { node_cost: 20.0, ..default },
            AnchoredConeParams { node_cost: f64::NAN, ..default },
            AnchoredConeParams { view_radius: 0.5, ..default },
            AnchoredConeParams { view_radius: 0.0, ..default },
            AnchoredConeParams { view_radius: -1.0, ..default },
            AnchoredConeParams { view_radius: f64::INFINITY, ..default },
            AnchoredConeParams { similar_normals: 6, ..default },
        ] {
            check_with(&shapes::bumpy_sphere(500), "bumpy-sphere", EdgeFilter::All, &params);
            check_with(&shapes::sliver_sphere(500), "sliver-sphere", EdgeFilter::All, &params);
        }
    }

    /// Views from a hair inside the sides of a node's cones, where the plane of one of its faces is
    /// nearest.
    fn rim(node: &Node, plane: Plane, unit: f64) -> Vec<Viewpoint> {
        let ConePair { front, back, axis, sin_squared } = node.cones;
        let across = plane.normal - plane.normal.dot(axis) * axis;
        let across = across.normalize_or(axis.any_orthonormal_vector());
        let side = sin_squared.sqrt() * axis - (1.0 - sin_squared).sqrt() * across;
        let mut viewpoints = Vec::new();
        for (anchor, sign) in [(front, 1.0), (back, -1.0)] {
            for (distance, inward) in [(1e-6, 1e-3), (1e-3, 1e-6), (1.0, 1e-9), (1e3, 1e-12)] {
                let direction = sign * (side + inward * axis);
                viewpoints.push(Viewpoint::at(anchor + distance * unit * direction));
                viewpoints.push(Viewpoint::from_direction(direction));
            }
        }
        viewpoints
    }

    /// From a node's rim, no edge of it or below may be a contour edge. How many views were culled,
    /// of how many.
    fn check_rim(cones: &AnchoredCones<'_>, node: &Node, unit: f64) -> [usize; 2] {
        let last = &cones.nodes[node.next as usize - 1];
        let places = node.edges.start as usize..last.edges.end as usize;
        let (wings, positions) = (&cones.edges.wings()[places], cones.edges.positions());
        let mut counts = [0; 2];
        for wing in wings.iter().step_by(wings.len() / 24 + 1) {
            for face in [wing.left_face(), wing.right_face()] {
                let corners = face.map(|v| positions[v as usize]);
                let normal = unit_normal(corners).unwrap();
                let plane = Plane { normal, point: corners[0].as_dvec3() };
                let mut viewpoints = rim(node, plane, unit);
                counts[1] += viewpoints.len();
                viewpoints.retain(|viewpoint| !node.cones.may_hold_contour(*viewpoint));
                counts[0] += viewpoints.len();
                for viewpoint in viewpoints {
                    let is_lost = |wing: &&Wing| is_contour(positions, wing, viewpoint);
                    let lost = wings.iter().find(is_lost);
                    assert_eq!(lost, None, "{:?} from {viewpoint:?}", node.cones);
                }
            }
        }
        counts
    }

    #[test]
    fn nothing_is_lost_on_the_rim_of_a_node() {
        for shapes::NamedMesh { name, mesh } in shapes::all() {
            let Some(bounds) = mesh.bounds() else { continue };
            let adjacency = MeshAdjacency::new(&mesh);
            let params = AnchoredConeParams { node_cost: 0.3, ..Default::default() };
            let cones = AnchoredCones::new(&mesh, &adjacency, EdgeFilter::All, &params);
            let counts =
                cones.nodes.iter().map(|n| check_rim(&cones, n, bounds.half_longest_side()));
            let [culled, all] = counts.fold([0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            assert!(culled * 10 >= all * 9, "{name}: {culled} of {all} are inside");
        }
    }

    #[test]
    fn every_edge_is_in_one_place() {
        for shapes::NamedMesh { name, mesh } in shapes::all() {
            let adjacency = MeshAdjacency::new(&mesh);
            for filter in FILTERS {
                let cones = AnchoredCones::new(&mesh, &adjacency, filter, &Default::default());
                let mut ids = cones.edges.ids().to_vec();
                ids.sort_unstable();
                assert!(ids.iter().copied().eq(adjacency.edges(filter)), "{name}");
                let mut next = 0;
                for place in
                    cones.nodes.iter().map(|node| &node.edges).chain([&cones.always_tested])
                {
                    assert_eq!(place.start, next, "{name}");
                    next = place.end;
                }
                assert_eq!(next as usize, cones.edges(), "{name}");
                let (mut root, mut roots) = (0, 0);
                while let Some(node) = cones.nodes.get(root) {
                    (root, roots) = (node.next as usize, roots + 1);
                }
                assert_eq!((root, roots), (cones.nodes(), cones.roots()), "{name}");
            }
        }
    }

    #[test]
    fn edges_beside_faces_without_area_are_always_tested() {
        let mesh = shapes::sliver_sphere(1000);
        let adjacency = MeshAdjacency::new(&mesh);
        let cones = AnchoredCones::new(&mesh, &adjacency, EdgeFilter::All, &Default::default());
        let (held, always) = cones.edges.ids().split_at(cones.always_tested.start as usize);
        assert!(held.iter().all(|&edge| !adjacency.is_beside_face_without_area(edge)));
        assert!(always.iter().filter(|&&e| adjacency.is_beside_face_without_area(e)).count() > 50);
    }

    #[test]
    fn most_of_a_smooth_sphere_is_culled() {
        let mesh = shapes::icosphere(20_000);
        let adjacency = MeshAdjacency::new(&mesh);
        let cones = AnchoredCones::new(&mesh, &adjacency, EdgeFilter::All, &Default::default());
        let mut contours = Vec::new();
        for direction in spread(20).map(DVec3::normalize) {
            for viewpoint in [Viewpoint::at(10.0 * direction), Viewpoint::from_direction(direction)]
            {
                let Statistics { nodes_tested, edges_tested, contour_edges } =
                    cones.extract(viewpoint, &mut contours);
                assert!(edges_tested < 8 * contour_edges, "{edges_tested} for {contour_edges}");
                assert!(nodes_tested < 5 * contour_edges, "{nodes_tested} for {contour_edges}");
            }
        }
        assert!(cones.always_tested() < 300, "{}", cones.always_tested());
    }

    #[test]
    fn the_same_mesh_makes_the_same_forest() {
        let mesh = shapes::torus_knot(2000);
        let adjacency = MeshAdjacency::new(&mesh);
        let build = || AnchoredCones::new(&mesh, &adjacency, EdgeFilter::All, &Default::default());
        let (a, b) = (build(), build());
        assert_eq!(a.edges.ids(), b.edges.ids());
        assert!(a.nodes.iter().map(|n| n.cones).eq(b.nodes.iter().map(|n| n.cones)));
    }
}
