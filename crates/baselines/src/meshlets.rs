//! Meshlets, as renderers cut meshes, with bounds for contour edges.
//!
//! Tsiapkolis and Bénard, Patch Decomposition for Efficient Mesh Contours Extraction, CGF 2024,
//! compare with meshlets of 16 faces from meshoptimizer (crate `meshopt`, by its `build_meshlets`:
//! clusters grow from neighbour to neighbour, weighing how compact they are against how alike the
//! normals). The cones that meshoptimizer computes are for culling faces that look away; here each
//! meshlet has a cone over the faces on both sides of its edges, beyond its own border too, and a
//! sphere that meets the lines through the edges.

use std::ops::Range;

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use glam::Vec3;
use meshopt::{VertexDataAdapter, build_meshlets, typed_to_bytes};

use crate::Statistics;
use crate::edges::Edges;
use crate::shape::{Shaped, bound, count, unit_positions};

/// How meshlets are cut. Values outside a range count as the nearest inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshletParams {
    /// Most faces in a meshlet, 1 ..= 512.
    pub max_faces: usize,
    /// Most vertices, 3 ..= 256. 16 faces have 48 at most, so that with more it is the faces that
    /// fill a meshlet.
    pub max_vertices: usize,
    /// From 0, for compact meshlets, to 1, for faces that look the same way: on the Stanford bunny
    /// 1 tests 9 % fewer edges than 0. NaN counts as 0.
    pub cone_weight: f32,
}

impl Default for MeshletParams {
    fn default() -> Self {
        Self { max_faces: 16, max_vertices: 64, cone_weight: 1.0 }
    }
}

/// Edges by meshlet.
#[derive(Clone, Debug)]
pub struct Meshlets<'mesh> {
    /// By meshlet; then those that no bound holds.
    edges: Edges<'mesh>,
    meshlets: Vec<Meshlet>,
    always_tested: Range<u32>,
}

#[derive(Clone, Debug)]
struct Meshlet {
    bound: DoubleCone,
    edges: Range<u32>,
}

impl<'mesh> Meshlets<'mesh> {
    /// Cuts `mesh`, its vertices welded, into meshlets, each with those edges that `filter` keeps
    /// and whose left face is in it: an edge between two meshlets belongs to one. Meshlets without
    /// such an edge are left out. About a µs a face, single-threaded; more where thousands of faces
    /// share a vertex.
    ///
    /// Edges beside a face without area, or without a plane that can be trusted, are in no meshlet
    /// and always tested.
    pub fn new(
        mesh: &'mesh Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
        params: &MeshletParams,
    ) -> Self {
        let kept = Edges::new(mesh, adjacency, filter);
        let shaped = Shaped::new(&kept);
        let meshlet_of_triangle = cut(mesh, adjacency, params);
        let meshlet = |index: &u32| {
            let edge = kept.ids()[shaped.places[*index as usize] as usize];
            let [left, _] = adjacency.sides(edge);
            meshlet_of_triangle[left.triangle() as usize]
        };
        let mut order: Vec<u32> = (0..count(shaped.places.len())).collect();
        order.sort_by_key(meshlet);
        let lengths: Vec<usize> =
            order.chunk_by(|a, b| meshlet(a) == meshlet(b)).map(<[u32]>::len).collect();
        let (edges, shapes, always_tested) = shaped.arranged(&kept, &order);
        let mut first = 0;
        let meshlets = lengths.into_iter().map(|length| {
            let own = first..first + length;
            first = own.end;
            Meshlet { bound: bound(&shapes[own.clone()]), edges: count(own.start)..count(own.end) }
        });
        Self { meshlets: meshlets.collect(), edges, always_tested }
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, in an order that depends on
    /// the mesh alone. Does not allocate once `contours` is large enough.
    pub fn extract(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Statistics {
        contours.clear();
        let mut statistics = Statistics { nodes_tested: self.meshlets.len(), ..Default::default() };
        for meshlet in &self.meshlets {
            if meshlet.bound.may_hold_contour(viewpoint) {
                self.edges.test(meshlet.edges.clone(), viewpoint, contours, &mut statistics);
            }
        }
        self.edges.test(self.always_tested.clone(), viewpoint, contours, &mut statistics);
        statistics
    }

    /// Number of meshlets.
    pub fn len(&self) -> usize {
        self.meshlets.len()
    }

    /// Whether there is no meshlet. There may be always-tested edges still.
    pub fn is_empty(&self) -> bool {
        self.meshlets.is_empty()
    }

    /// Number of edges, those that are always tested among them.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Number of edges that are in no meshlet.
    pub fn always_tested(&self) -> usize {
        self.always_tested.len()
    }

    /// Every edge, meshlet by meshlet, and behind them those that are in none.
    pub fn edge_ids(&self) -> &[EdgeId] {
        self.edges.ids()
    }

    /// Number of edges of every meshlet.
    pub fn edge_counts(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.meshlets.iter().map(|meshlet| meshlet.edges.end - meshlet.edges.start)
    }

    /// The bound of every meshlet. [`DoubleCone::ALWAYS`] where the normals spread too far to be
    /// bounded.
    pub fn bounds(&self) -> impl ExactSizeIterator<Item = DoubleCone> + '_ {
        self.meshlets.iter().map(|meshlet| meshlet.bound)
    }
}

/// The meshlet of every triangle. [`u32::MAX`] for collapsed ones, which have no edge.
fn cut(mesh: &Mesh, adjacency: &MeshAdjacency, params: &MeshletParams) -> Vec<u32> {
    let welded = |triangle: &[u32; 3]| triangle.map(|v| adjacency.representatives()[v as usize]);
    let is_collapsed = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let mut triangles: Vec<([u32; 3], u32)> =
        mesh.triangles().iter().map(welded).zip(0..).collect();
    triangles.retain(|(corners, _)| !is_collapsed(*corners));

    // Meshlets name the corners of their triangles, and not the triangles: both are sorted by
    // corners, and so the n-th is the same in both.
    let indices: Vec<u32> = triangles.iter().flat_map(|(corners, _)| *corners).collect();
    let mut members = members(mesh, &indices, params);
    let by_corners = |(corners, number): &([u32; 3], u32)| (sorted(*corners), *number);
    triangles.sort_unstable_by_key(by_corners);
    members.sort_unstable_by_key(by_corners);

    let mut meshlet_of_triangle = vec![u32::MAX; mesh.triangles().len()];
    for ((_, triangle), (_, meshlet)) in triangles.iter().zip(&members) {
        meshlet_of_triangle[*triangle as usize] = *meshlet;
    }
    meshlet_of_triangle
}

/// The corners of each triangle, and the meshlet that it is in.
fn members(mesh: &Mesh, indices: &[u32], params: &MeshletParams) -> Vec<([u32; 3], u32)> {
    let positions = unit_positions(mesh);
    let bytes = typed_to_bytes(&positions);
    // Never fails, as these are whole vertices.
    let Ok(vertices) = VertexDataAdapter::new(bytes, size_of::<Vec3>(), 0) else {
        return Vec::new();
    };
    let cone_weight = if params.cone_weight > 0.0 { params.cone_weight.min(1.0) } else { 0.0 };
    let meshlets = build_meshlets(
        indices,
        &vertices,
        params.max_vertices.clamp(3, 256),
        params.max_faces.clamp(1, 512),
        cone_weight,
    );
    let triangles = (0..).zip(meshlets.iter()).flat_map(|(number, meshlet)| {
        let local = meshlet.triangles.chunks_exact(3);
        local.map(move |local| {
            let corner = |i: usize| meshlet.vertices[local[i] as usize];
            ([corner(0), corner(1), corner(2)], number)
        })
    });
    triangles.collect()
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{FILTERS, agrees, culls_no_contour, viewpoints};
    use drypoint_mesh::shapes;
    use glam::DVec3;
    use proptest::prelude::*;

    fn meshlets<'mesh>(
        mesh: &'mesh Mesh,
        filter: EdgeFilter,
        params: &MeshletParams,
    ) -> Meshlets<'mesh> {
        Meshlets::new(mesh, &MeshAdjacency::new(mesh), filter, params)
    }

    #[track_caller]
    fn check(mesh: &Mesh, filter: EdgeFilter, params: &MeshletParams) {
        let meshlets = meshlets(mesh, filter, params);
        assert_eq!(meshlets.bounds().len(), meshlets.len());
        assert!(meshlets.meshlets.iter().all(|meshlet| !meshlet.edges.is_empty()));
        agrees(mesh, filter, viewpoints(mesh), |from, contours| meshlets.extract(from, contours));
    }

    #[test]
    fn all_shapes_from_everywhere() {
        for (shape, filter) in shapes::all().iter().flat_map(|s| FILTERS.map(|f| (s, f))) {
            check(&shape.mesh, filter, &MeshletParams::default());
        }
    }

    #[test]
    fn any_params() {
        let mesh = shapes::sliver_sphere(1_000);
        for (max_faces, max_vertices, cone_weight) in
            [(0, 0, -1.0), (1, 3, f32::NAN), (7, 5, 0.5), (usize::MAX, usize::MAX, f32::INFINITY)]
        {
            let params = MeshletParams { max_faces, max_vertices, cone_weight };
            check(&mesh, EdgeFilter::Convex, &params);
        }
    }

    #[test]
    fn every_meshlet_from_its_cull_boundary() {
        for mesh in [shapes::bumpy_sphere(500), shapes::cad_part(672), shapes::moved_sphere(500)] {
            let meshlets = meshlets(&mesh, EdgeFilter::All, &MeshletParams::default());
            let unit = mesh.bounds().unwrap().half_longest_side();
            let culled = meshlets.meshlets.iter().map(|meshlet| {
                culls_no_contour(meshlet.bound, &meshlets.edges, meshlet.edges.clone(), unit)
            });
            // Culling nothing would lose nothing.
            assert!(culled.sum::<usize>() > 20 * meshlets.len());
        }
    }

    #[test]
    fn most_of_a_smooth_sphere_is_culled() {
        let sphere = shapes::icosphere(20_000);
        let meshlets = meshlets(&sphere, EdgeFilter::Convex, &MeshletParams::default());
        let mut contours = Vec::new();
        let far = Viewpoint::at(DVec3::new(20.0, 30.0, 40.0));
        let statistics = meshlets.extract(far, &mut contours);
        assert!(statistics.edges_tested < meshlets.edges() / 10, "{statistics:?}");
    }

    #[test]
    fn welded_meshes_fill_their_meshlets() {
        // Every triangle with corners of its own; a fifth of them there twice.
        for mesh in [shapes::split_sphere(5_000), shapes::duplicated_sphere(5_000)] {
            let meshlets = meshlets(&mesh, EdgeFilter::All, &MeshletParams::default());
            let faces = mesh.triangles().len();
            assert!((faces / 16..faces / 12).contains(&meshlets.len()), "{}", meshlets.len());
        }
    }

    #[test]
    fn edges_lie_meshlet_by_meshlet() {
        let mesh = shapes::bumpy_sphere(500);
        let meshlets = meshlets(&mesh, EdgeFilter::Convex, &MeshletParams::default());
        let mut first = 0;
        for (meshlet, edge_count) in meshlets.meshlets.iter().zip(meshlets.edge_counts()) {
            assert_eq!(meshlet.edges, first..first + edge_count);
            first += edge_count;
        }
        assert_eq!(first as usize + meshlets.always_tested(), meshlets.edge_ids().len());
        let mut ids = meshlets.edge_ids().to_vec();
        ids.sort_unstable();
        let all = MeshAdjacency::new(&mesh).edges(EdgeFilter::Convex).collect::<Vec<_>>();
        assert_eq!(ids, all);
    }

    #[test]
    fn edges_beside_faces_without_area_are_in_no_meshlet() {
        let fan = shapes::zero_area_fan();
        let meshlets = meshlets(&fan, EdgeFilter::All, &MeshletParams::default());
        assert!(meshlets.is_empty() && meshlets.always_tested() == meshlets.edges());
        assert!(meshlets.edges() > 0);
    }

    proptest! {
        #[test]
        fn from_anywhere(xyz in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0], scale in -1.0..4.0f64) {
            let mesh = shapes::bumpy_sphere(320);
            let meshlets = meshlets(&mesh, EdgeFilter::Convex, &MeshletParams::default());
            let xyz = 10f64.powf(scale) * DVec3::from_array(xyz);
            let viewpoints = [Viewpoint::at(xyz), Viewpoint::from_direction(xyz)];
            agrees(&mesh, EdgeFilter::Convex, viewpoints, |from, out| meshlets.extract(from, out));
        }
    }
}
