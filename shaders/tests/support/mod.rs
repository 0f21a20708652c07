//! What tests of all GPU runtimes need: included by path.
#![allow(dead_code, reason = "each test program uses what it needs")]
#![allow(clippy::cast_possible_truncation, reason = "meshes of tests are small")]

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;

use drypoint_fusion::{FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, is_contour};
use drypoint_shaders::{EdgePlanes, Frame, Placement, Segment};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Whether the machine says that it has no GPU, not even software: tests are passed over then. Without
/// that, having none is a failure.
pub(crate) fn is_without_gpu() -> bool {
    std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1")
}

/// An example, which cargo builds beside the tests.
pub(crate) fn example(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("this runs from a file");
    let folder = test.parent().and_then(|deps| deps.parent()).expect("tests are in target/*/deps");
    let example = folder.join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(example.exists(), "build it first: cargo build --example {name}");
    example
}

/// Patches of all edges.
pub(crate) fn patches(mesh: &Mesh, levels: Levels) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    let params = FusionParams { levels, ..FusionParams::FAST };
    fuse(mesh, &adjacency, EdgeFilter::All, &params, &|_| ControlFlow::Continue(()))
        .expect("nothing stops it")
}

/// Placements that are moved, turned, mirrored and stretched, seen from afar, from close by, from inside and
/// from a direction.
pub(crate) fn placements(mesh: &Mesh) -> Vec<Placement> {
    let unit = mesh.bounds().map_or(1.0, |bounds| bounds.half_longest_side().max(1e-30));
    let center = mesh.bounds().map_or(DVec3::ZERO, |bounds| bounds.center());
    let moved = DAffine3::from_translation(-center);
    let turned = DAffine3::from_quat(DQuat::from_rotation_x(0.7)) * moved;
    let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * turned;
    let stretched = DAffine3::from_mat3(DMat3::from_cols(
        DVec3::new(2.0, 0.3, 0.0),
        DVec3::new(0.0, 0.5, 0.1),
        DVec3::new(-0.2, 0.0, -3.0),
    )) * moved;
    let mut all = Vec::new();
    for to_scene in [moved, turned, mirrored, stretched] {
        for from in
            [DVec3::new(7.0, 3.0, 1.0), DVec3::new(0.4, 0.9, 0.7), DVec3::new(0.05, 0.01, 0.02)]
        {
            all.push(Placement { to_scene, viewpoint: Viewpoint::at(from * unit) });
        }
        let viewpoint = Viewpoint::from_direction(DVec3::new(0.3, -0.8, 0.55));
        all.push(Placement { to_scene, viewpoint });
    }
    all
}

/// What brute force with exact predicates says about placements of a patch set's edges.
pub(crate) struct Expected {
    /// Contour edges that f32 must find too.
    sure: BTreeSet<Segment>,
    /// Edges with a face within the margin: found or not, as it comes.
    doubtful: BTreeSet<Segment>,
}

impl Expected {
    pub(crate) fn new(set: &PatchSet, placements: &[Placement]) -> Self {
        let (mut sure, mut doubtful) = (BTreeSet::new(), BTreeSet::new());
        let edges = || set.wings().iter().zip(set.edge_ids());
        let frame = Frame::new(
            edges()
                .flat_map(|(w, _)| [w.tail, w.head, w.left, w.right])
                .map(|vertex| set.positions()[vertex as usize]),
        );
        let planes: Vec<_> =
            edges().map(|(wing, _)| EdgePlanes::in_f64(set.positions(), wing, &frame)).collect();
        for (index, placement) in (0..).zip(placements) {
            let viewpoint = placement.viewpoint_of_part().expect("it has an inverse");
            let seen = frame.viewpoint(viewpoint);
            for ((wing, &edge), planes) in edges().zip(&planes) {
                let [from_vertex, to_vertex] = wing.ends();
                let segment = Segment { from_vertex, to_vertex, placement: index, edge };
                if EdgePlanes::is_doubtful(planes, seen) {
                    doubtful.insert(segment);
                } else if is_contour(set.positions(), wing, viewpoint) {
                    sure.insert(segment);
                }
            }
        }
        Self { sure, doubtful }
    }

    /// Number of contour edges that are sure, and of doubtful edges.
    pub(crate) fn counts(&self) -> [usize; 2] {
        [self.sure.len(), self.doubtful.len()]
    }

    /// Compares sorted segments.
    #[track_caller]
    pub(crate) fn compare(&self, found: &[Segment], what: &str) {
        assert!(found.is_sorted_by(|a, b| a < b), "{what}: a segment is there twice");
        let missing = self.sure.iter().find(|segment| found.binary_search(segment).is_err());
        assert_eq!(missing, None, "{what}: it is missing");
        let extra = found.iter().find(|s| !self.sure.contains(s) && !self.doubtful.contains(s));
        assert_eq!(extra, None, "{what}: it is no contour edge");
    }
}
