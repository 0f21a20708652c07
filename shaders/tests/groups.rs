//! Groups that others have made, and what they cost.

use drypoint_bounds::DoubleCone;
use drypoint_fusion::CostModel;
use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};
use drypoint_shaders::{Content, ContentEdge, EdgePlanes, Group, MAX_PIECE};

#[test]
fn the_cost_model_for_gpus_is_what_shaders_read() {
    let bytes = size_of::<Group>() as f64 / size_of::<EdgePlanes>() as f64;
    assert_eq!(CostModel::GPU.patch_test, bytes);
    assert_eq!(CostModel::GPU.patch(0.5, 20), bytes + 10.0);
}

#[test]
fn groups_follow_one_another_and_the_rest_is_always_tested() {
    let mesh = shapes::bumpy_sphere(2_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let mut edges: Vec<_> = adjacency.edges(EdgeFilter::Convex).collect();
    edges.reverse();
    let wings = edges.iter().map(|&edge| ContentEdge::new(&adjacency, edge));
    let bound = DoubleCone { apex_distance: 0.25, tan_squared: 0.5, ..DoubleCone::ALWAYS };
    let long = MAX_PIECE + 1;
    let content = Content::with_groups(mesh.positions(), wings, [(bound, 3), (bound, long)]);
    assert_eq!(content.ends.iter().map(|ends| ends.edge).collect::<Vec<_>>(), edges);
    let pieces = |count| content.patches.iter().take(count).map(|piece| [piece.first, piece.count]);
    assert_eq!(pieces(3).collect::<Vec<_>>(), [[0, 3], [3, MAX_PIECE], [3 + MAX_PIECE, 1]]);
    assert_eq!(content.patches.iter().map(|piece| piece.weight).sum::<u32>(), 2);
    let rest = &content.patches[3..];
    assert!(!rest.is_empty() && rest.iter().all(|piece| piece.bound == DoubleCone::ALWAYS));
    let last = content.patches.last().unwrap();
    assert_eq!(last.first + last.count, content.edge_count());
}

#[test]
#[should_panic(expected = "groups have more edges than there are")]
fn groups_of_too_many_edges_are_refused() {
    let mesh = shapes::bumpy_sphere(500);
    let adjacency = MeshAdjacency::new(&mesh);
    let edges = adjacency.edges(EdgeFilter::Convex).take(5);
    let wings: Vec<_> = edges.map(|edge| ContentEdge::new(&adjacency, edge)).collect();
    Content::with_groups(mesh.positions(), wings.into_iter(), [(DoubleCone::ALWAYS, 6)]);
}
