//! No contour edge is lost from where a patch is only just culled.
//!
//! `cargo xtask validate --boundary` does the same from many more viewpoints, on every mesh.

use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, PatchSet, SuperPatch, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, shapes};
use drypoint_tests::boundary::{LEAST, look};
use drypoint_tests::presets;

fn patches(mesh: &Mesh, params: &FusionParams) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    fuse(mesh, &adjacency, EdgeFilter::All, params, &|_| ControlFlow::Continue(())).unwrap()
}

#[track_caller]
fn check(name: &str, set: &PatchSet) {
    let looked = look(set, 3_000).unwrap_or_else(|lost| panic!("{name}: {lost:?}"));
    let bounds = (set.patches().len() + set.super_patches().len()) as u64;
    assert!(looked.viewpoints >= bounds * LEAST as u64, "{name}: {looked:?}");
    // Culling nothing would lose nothing; but of a mesh whose squares f32 does not hold nothing need be.
    let is_held = (1e-13..1e17).contains(&set.provenance().unit);
    let culls = looked.culled * 4 > looked.viewpoints;
    assert!(culls || bounds == 0 || !is_held, "{name}: {looked:?}");
}

#[test]
fn all_shapes_from_their_cull_boundaries() {
    for shape in shapes::all() {
        check(shape.name, &patches(&shape.mesh, &FusionParams::FAST));
    }
}

#[test]
fn all_presets_from_their_cull_boundaries() {
    for mesh in [shapes::bumpy_sphere(1_000), shapes::cad_part(672), shapes::moved_sphere(500)] {
        for (name, params) in presets::for_edges(mesh.triangles().len()) {
            check(name, &patches(&mesh, &params));
        }
    }
}

/// The viewpoints are where it hurts: a bound smaller by a hair is caught.
#[test]
fn a_bound_smaller_by_a_hair_is_caught() {
    let set = patches(&shapes::bumpy_sphere(1_000), &FusionParams::FAST);
    let smaller = |by: f32| {
        let mut bound = set.patches()[0].bound;
        bound.apex_distance *= 1.0 - by;
        bound.tan_squared *= 1.0 - by;
        let group = SuperPatch { bound, first_patch: 0, patch_count: 1 };
        look(&set.clone().with_super_patches(vec![group]).unwrap(), 200_000)
    };
    assert!(smaller(0.0).is_ok());
    let lost = smaller(1e-4).unwrap_err();
    assert!(lost.is_super && lost.patch == 0);
    assert!(set.edge_ids()[..set.patches()[0].edge_count as usize].contains(&lost.edge));
}
