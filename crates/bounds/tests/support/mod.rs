//! Patches of real edges, with every bound that can be put around them.

use std::fmt;

use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, is_contour, shapes};
use glam::{DVec3, Vec3};
use proptest::test_runner::TestCaseError;

/// A mesh, and patches on it.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    mesh: Mesh,
    adjacency: MeshAdjacency,
    pub(crate) patches: Vec<Patch>,
}

/// Bounds of a patch that are made of a cone and a sphere.
pub(crate) const SPATIALIZED: usize = 6;

/// Neighbouring edges, and every bound around their planes.
pub(crate) struct Patch {
    edges: Vec<EdgeId>,
    /// Corners and unit normal of the faces on both sides of its edges.
    pub(crate) faces: Vec<([DVec3; 3], DVec3)>,
    /// Mean and minimal cone, each with the Mean, the Reduced and the minimal sphere.
    pub(crate) bounds: [SpatializedNormalCone; SPATIALIZED],
    /// Their run-time form, and last the tight bound.
    pub(crate) double_cones: [DoubleCone; SPATIALIZED + 1],
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
    /// A mesh, and the patches that `choose` makes of its edges.
    fn new(
        name: &'static str,
        mesh: Mesh,
        choose: impl Fn(&Self, Vec<EdgeId>) -> Vec<Vec<EdgeId>>,
    ) -> Self {
        let adjacency = MeshAdjacency::new(&mesh);
        let mut subject = Self { name, mesh, adjacency, patches: Vec::new() };
        let edges = subject
            .adjacency
            .edges(EdgeFilter::All)
            .filter(|&edge| !subject.adjacency.is_beside_face_without_area(edge))
            .collect();
        let patches = choose(&subject, edges);
        subject.patches = patches.into_iter().map(|edges| subject.patch(edges)).collect();
        subject
    }

    /// A mesh moved and scaled, with patches of all sizes spread evenly over its edges.
    fn placed(name: &'static str, mesh: &Mesh, scale: DVec3, offset: DVec3) -> Self {
        let place = |p: &Vec3| (p.as_dvec3() * scale + offset).as_vec3();
        let positions = mesh.positions().iter().map(place).collect();
        let mesh = Mesh::new(positions, mesh.triangles().to_vec()).unwrap();
        Self::new(name, mesh, |subject, edges| {
            let seeds = edges.iter().step_by(edges.len() / 60);
            let sizes = PATCH_SIZES.into_iter().cycle();
            seeds.zip(sizes).map(|(&seed, size)| nearest(subject, &edges, seed, size)).collect()
        })
    }

    /// A ring of faces around +Z whose normals all make the angle `tilt` with it, as one patch. All
    /// its planes touch the Reduced Sphere from the same side, and all normals are on the rim of the
    /// cone, so that no bound made of these two could be smaller.
    fn collar(name: &'static str, tilt: f64) -> Self {
        const SIDES: u32 = 32;
        let corner = |i: u32| {
            // Not from 0: coordinates of 1e-17 would make the exact predicates slow.
            let turn = std::f64::consts::TAU * (f64::from(i / 2) + 0.4) / f64::from(SIDES);
            let (sin, cos) = turn.sin_cos();
            let out = if i.is_multiple_of(2) { 0.8 } else { 1.2 };
            DVec3::new(out * cos, out * sin, (1.0 - out) * tilt.tan()).as_vec3()
        };
        let next = |i: u32| i % (2 * SIDES);
        let faces = (0..2 * SIDES)
            .step_by(2)
            .flat_map(|i| [[i, i + 1, next(i + 3)], [i, next(i + 3), next(i + 2)]]);
        let mesh = Mesh::new((0..2 * SIDES).map(corner).collect(), faces.collect()).unwrap();
        Self::new(name, mesh, |_, edges| vec![edges])
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
        let spheres = [mean_sphere, Sphere::reduced(lines.clone()), Sphere::minimal(lines)];
        let bounds: [_; SPATIALIZED] = std::array::from_fn(|i| SpatializedNormalCone {
            cone: cones[i / 3],
            sphere: spheres[i % 3],
        });
        let planes = faces
            .iter()
            .enumerate()
            .map(|(i, &(_, normal))| Plane { normal, point: self.midpoint(edges[i / 2]) });
        let tight = DoubleCone::tight(planes);
        let double_cones =
            std::array::from_fn(|i| bounds.get(i).map_or(tight, |&bound| bound.into()));
        Patch { edges, faces, bounds, double_cones, size: mean_sphere.radius }
    }

    /// Whether the patch holds a contour edge, exactly.
    pub(crate) fn holds_contour(&self, patch: &Patch, viewpoint: Viewpoint) -> bool {
        patch
            .edges
            .iter()
            .any(|&e| is_contour(self.mesh.positions(), &self.adjacency.wing(e), viewpoint))
    }

    /// Fails if a bound culls a patch that holds a contour edge.
    pub(crate) fn check(&self, patch: &Patch, viewpoint: Viewpoint) -> Result<(), TestCaseError> {
        let spatialized = patch.bounds.iter().filter(|bound| !bound.may_hold_contour(viewpoint));
        let double = patch.double_cones.iter().filter(|cone| !cone.may_hold_contour(viewpoint));
        let culled_by = (spatialized.collect::<Vec<_>>(), double.collect::<Vec<_>>());
        // The exact answer is the expensive one.
        let is_culled = !culled_by.0.is_empty() || !culled_by.1.is_empty();
        if is_culled && self.holds_contour(patch, viewpoint) {
            let message = format!("{self:?} is culled from {viewpoint:?} by {culled_by:?}");
            return Err(TestCaseError::fail(message));
        }
        Ok(())
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
        Subject::placed("bumpy", &bumpy, even(1.0), DVec3::ZERO),
        Subject::placed("smooth", &smooth, even(1.0), DVec3::ZERO),
        Subject::collar("flat collar", 0.1),
        Subject::collar("collar", 0.7),
        Subject::collar("steep collar", 1.3),
        // Normals as close together as f32 positions can have them.
        Subject::placed("flat", &bumpy, DVec3::new(1.0, 1e-4, 1.0), DVec3::ZERO),
        Subject::placed("far", &bumpy, even(1.0), 300.0 * aside),
        Subject::placed("very far", &bumpy, even(1.0), 1e5 * aside),
        Subject::placed("small", &bumpy, even(1e-9), DVec3::ZERO),
        Subject::placed("tiny", &bumpy, even(1e-20), 1e-19 * aside),
        Subject::placed("large", &bumpy, even(1e9), DVec3::ZERO),
        Subject::placed("huge", &bumpy, even(1e20), 1e21 * aside),
    ]
}
