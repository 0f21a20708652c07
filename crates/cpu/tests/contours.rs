//! Memory that is used again holds the last answer and nothing of those before.

use std::ops::ControlFlow;

use drypoint_cpu::{Contours, Extractor, Instructions, extract_patches};
use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, shapes};
use glam::DVec3;

fn patches(mesh: &Mesh) -> PatchSet {
    let go_on = |_| ControlFlow::Continue(());
    let adjacency = MeshAdjacency::new(mesh);
    fuse(mesh, &adjacency, EdgeFilter::All, &FusionParams::FAST, &go_on).unwrap()
}

fn sorted(edges: &[EdgeId]) -> Vec<EdgeId> {
    let mut edges = edges.to_vec();
    edges.sort_unstable();
    edges
}

#[test]
fn contours_go_from_view_to_view_and_from_mesh_to_mesh() {
    let sets = [
        shapes::icosphere(500),
        shapes::torus_knot(8_000),
        shapes::empty(),
        shapes::one_triangle(),
        shapes::icosphere(2_000),
    ]
    .map(|mesh| patches(&mesh));
    let viewpoints = [
        Viewpoint::at(DVec3::new(3.0, 1.0, 2.0)),
        Viewpoint::at(DVec3::new(0.1, 0.0, 0.0)),
        Viewpoint::from_direction(DVec3::Z),
        Viewpoint::from_direction(DVec3::ZERO),
    ];
    for instructions in Instructions::ALL.into_iter().filter(|set| set.are_here()) {
        let (mut edges, mut pairs) = (Contours::default(), Contours::default());
        let mut expected = Vec::new();
        for set in &sets {
            let extractor = Extractor::with(set, instructions).unwrap();
            for viewpoint in viewpoints {
                let counts = extract_patches(set, viewpoint, &mut expected);
                expected.sort_unstable();
                assert_eq!(extractor.edges(viewpoint, &mut edges), counts);
                assert_eq!(sorted(&edges), expected, "{instructions:?} from {viewpoint:?}");
                extractor.vertex_pairs(viewpoint, &mut pairs);
                assert_eq!(pairs.len(), expected.len());
                extractor.all_edges(viewpoint, &mut edges);
                assert_eq!(sorted(&edges), expected, "{instructions:?} from {viewpoint:?}, all");
            }
        }
    }
}
