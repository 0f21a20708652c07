//! Patches of real edges, with every bound that can be put around them.

use std::fmt;

use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, is_contour, shapes};
use glam::{DVec3, Vec3};
use proptest::test_runner::{Config, RngSeed};

/// The same cases in every run, so that the table of mutants can be compared.
pub(crate) fn cases(count: u32) -> Config {
    Config {
        cases: count,
        rng_seed: RngSeed::Fixed(20),
        failure_persistence: None,
        // Enough to read a case by, and little enough for broken bounds to fail within seconds.
        max_shrink_iters: 1_000,
        ..Config::default()
    }
}

/// A mesh, and patches on it.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    mesh: Mesh,
    adjacency: MeshAdjacency,
    pub(crate) patches: Vec<Patch>,
}

/// Neighbouring edges, and four bounds around their planes.
pub(crate) struct Patch {
    edges: Vec<EdgeId>,
    /// Corners and unit normal of the faces on both sides of its edges.
    pub(crate) faces: Vec<([DVec3; 3], DVec3)>,
    /// Mean and minimal cone, each with the Mean and the Reduced Sphere.
    pub(crate) bounds: [SpatializedNormalCone; 4],
    /// Their run-time form.
    pub(crate) double_cones: [DoubleCone; 4],
    /// A length about as large as the patch.
    pub(crate) size: f64,
}

/// So that a failing case names its patch and does not print its mesh.
impl fmt::Debug for Subject {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl fmt::Debug for Patch {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:?}", self.edges)
    }
}

/// Edges in a patch: one, whose two planes are a bound's tightest test, up to more than a patch for
/// a GPU holds.
const PATCH_SIZES: [usize; 5] = [1, 2, 6, 25, 80];

impl Subject {
    /// A mesh moved and scaled, with patches of all sizes spread evenly over its edges.
    fn new(name: &'static str, mesh: &Mesh, scale: DVec3, offset: DVec3) -> Self {
        let place = |p: &Vec3| (p.as_dvec3() * scale + offset).as_vec3();
        let positions = mesh.positions().iter().map(place).collect();
        let mesh = Mesh::new(positions, mesh.triangles().to_vec()).unwrap();
        let adjacency = MeshAdjacency::new(&mesh);
        let mut subject = Self { name, mesh, adjacency, patches: Vec::new() };
        let edges: Vec<EdgeId> = subject
            .adjacency
            .edges(EdgeFilter::All)
            .filter(|&edge| !subject.adjacency.is_beside_face_without_area(edge))
            .collect();
        let seeds = edges.iter().step_by(edges.len() / 60).zip(PATCH_SIZES.into_iter().cycle());
        subject.patches = seeds
            .map(|(&seed, size)| subject.patch(nearest(&subject, &edges, seed, size)))
            .collect();
        subject
    }

    fn ends(&self, edge: EdgeId) -> [DVec3; 2] {
        let wing = self.adjacency.wing(edge);
        [wing.tail, wing.head].map(|v| self.mesh.position(v).as_dvec3())
    }

    fn midpoint(&self, edge: EdgeId) -> DVec3 {
        let [tail, head] = self.ends(edge);
        0.5 * (tail + head)
    }

    fn patch(&self, edges: Vec<EdgeId>) -> Patch {
        let faces: Vec<_> = edges
            .iter()
            .map(|&edge| self.adjacency.wing(edge))
            .flat_map(|wing| [wing.left_face(), wing.right_face()])
            .map(|face| {
                let [a, b, c] = face.map(|v| self.mesh.position(v).as_dvec3());
                ([a, b, c], (b - a).cross(c - a).normalize())
            })
            .collect();
        let normals = faces.iter().map(|(_, normal)| *normal);
        let lines = edges.iter().map(|&edge| self.ends(edge));
        let mut vertices: Vec<u32> =
            edges.iter().flat_map(|&edge| self.adjacency.wing(edge).ends()).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mean_sphere =
            Sphere::mean(vertices.into_iter().map(|v| self.mesh.position(v).as_dvec3()));
        let cones = [NormalCone::mean(normals.clone()), NormalCone::minimal(normals)];
        let spheres = [mean_sphere, Sphere::reduced(lines)];
        let bounds: [_; 4] = std::array::from_fn(|i| SpatializedNormalCone {
            cone: cones[i / 2],
            sphere: spheres[i % 2],
        });
        let double_cones = bounds.map(DoubleCone::from);
        Patch { edges, faces, bounds, double_cones, size: mean_sphere.radius }
    }

    /// Whether the patch holds a contour edge, exactly.
    pub(crate) fn holds_contour(&self, patch: &Patch, viewpoint: Viewpoint) -> bool {
        patch
            .edges
            .iter()
            .any(|&e| is_contour(self.mesh.positions(), &self.adjacency.wing(e), viewpoint))
    }

    /// Panics if a bound culls a patch that holds a contour edge.
    #[track_caller]
    pub(crate) fn check(&self, patch: &Patch, viewpoint: Viewpoint) {
        let culled: Vec<String> = patch
            .bounds
            .iter()
            .zip(&patch.double_cones)
            .flat_map(|(bound, cone)| {
                let wrong = [
                    (!bound.may_hold_contour(viewpoint)).then(|| format!("{bound:?}")),
                    (!cone.may_hold_contour(viewpoint)).then(|| format!("{cone:?}")),
                ];
                wrong.into_iter().flatten()
            })
            .collect();
        // The exact answer is the expensive one.
        if !culled.is_empty() && self.holds_contour(patch, viewpoint) {
            let (name, edges) = (self.name, patch.edges.len());
            panic!("{name}, {edges} edges, from {viewpoint:?}: culled by\n{}", culled.join("\n"));
        }
    }
}

/// The `count` edges whose midpoints are nearest to that of `seed`, itself among them.
fn nearest(subject: &Subject, edges: &[EdgeId], seed: EdgeId, count: usize) -> Vec<EdgeId> {
    let center = subject.midpoint(seed);
    let mut edges = edges.to_vec();
    let distance = |&edge: &EdgeId| subject.midpoint(edge).distance_squared(center);
    let order = |a: &EdgeId, b: &EdgeId| distance(a).total_cmp(&distance(b)).then(a.cmp(b));
    edges.select_nth_unstable_by(count, order);
    edges.truncate(count);
    edges.sort_unstable();
    edges
}

/// Meshes with all the trouble that f32 can have.
pub(crate) fn subjects() -> Vec<Subject> {
    let (bumpy, smooth) = (shapes::bumpy_sphere(5_000), shapes::icosphere(5_000));
    let (even, aside) = (DVec3::splat, DVec3::new(0.6, -0.7, 0.4));
    vec![
        Subject::new("bumpy", &bumpy, even(1.0), DVec3::ZERO),
        Subject::new("smooth", &smooth, even(1.0), DVec3::ZERO),
        // Normals as close together as f32 positions can have them.
        Subject::new("flat", &bumpy, DVec3::new(1.0, 1e-4, 1.0), DVec3::ZERO),
        Subject::new("far", &bumpy, even(1.0), 300.0 * aside),
        Subject::new("very far", &bumpy, even(1.0), 1e5 * aside),
        Subject::new("small", &bumpy, even(1e-9), DVec3::ZERO),
        Subject::new("tiny", &bumpy, even(1e-20), 1e-19 * aside),
        Subject::new("large", &bumpy, even(1e9), DVec3::ZERO),
        Subject::new("huge", &bumpy, even(1e20), 1e21 * aside),
    ]
}
