//! Every extractor finds the edges of the definition, on every shape and every real mesh.
//!
//! What belongs here: comparisons with the definition that need more than one crate. A crate's own
//! properties are tested in the crate. `cargo xtask validate` does the same from more viewpoints.

use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, io, shapes};
use drypoint_tests::compare::compare;
use drypoint_tests::{models, viewpoints};

/// Small groups keep a debug build quick; the answer may not depend on them.
const PARAMS: FusionParams = FusionParams::PAPER.with_max_partition(Some(128));

fn patches(mesh: &Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> PatchSet {
    fuse(mesh, adjacency, filter, &PARAMS, &|_| ControlFlow::Continue(())).unwrap()
}

/// The one place that compares: the tests below only state meshes and viewpoints.
#[track_caller]
fn check(name: &str, mesh: &Mesh, viewpoints: &[Viewpoint]) {
    let adjacency = MeshAdjacency::new(mesh);
    for filter in [EdgeFilter::Convex, EdgeFilter::All] {
        let patches = patches(mesh, &adjacency, filter);
        let result = compare(mesh, &adjacency, &patches, viewpoints);
        assert!(result.is_ok(), "{name}, {filter:?}: {:?}", result.unwrap_err());
    }
}

#[test]
fn all_shapes_from_everywhere() {
    for shape in shapes::all() {
        let mesh = &shape.mesh;
        let mut from = viewpoints::protocol(mesh);
        from.extend(viewpoints::orthographic());
        from.extend(viewpoints::near(mesh, 50));
        from.extend(viewpoints::hostile(mesh, 25));
        check(shape.name, mesh, &from);
    }
}

#[test]
fn all_models_from_every_direction() {
    for path in models::files().unwrap() {
        let mesh = io::read(&path).unwrap().mesh;
        // One distance in turn for each direction: all would take minutes on the largest.
        let mut from: Vec<_> = viewpoints::protocol(&mesh).into_iter().step_by(17).collect();
        from.extend(viewpoints::orthographic().into_iter().step_by(5));
        from.extend(viewpoints::near(&mesh, 5));
        from.extend(viewpoints::hostile(&mesh, 3));
        check(&path.display().to_string(), &mesh, &from);
    }
}

/// Culling nothing would pass every comparison.
#[test]
fn patches_of_a_smooth_shape_are_mostly_culled() {
    let mesh = shapes::icosphere(5_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let patches = patches(&mesh, &adjacency, EdgeFilter::All);
    let from = viewpoints::protocol(&mesh);
    let agreement = compare(&mesh, &adjacency, &patches, &from).unwrap();
    let tested = agreement.edges_tested as f64 / (patches.wings().len() * from.len()) as f64;
    assert!(tested < 0.25, "{:.0} % of the edges are tested", 100.0 * tested);
}
