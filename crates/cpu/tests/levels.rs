//! A second level of patches changes which bounds are tested, and nothing else.

use std::ops::ControlFlow;

use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_cpu::{Statistics, extract_patches};
use drypoint_fusion::{FusionParams, PatchSet, SuperPatch, fuse};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, shapes};
use glam::DVec3;

fn patches(mesh: &Mesh) -> PatchSet {
    let params = FusionParams::PAPER.with_max_partition(Some(256));
    let go_on = |_| ControlFlow::Continue(());
    fuse(mesh, &MeshAdjacency::new(mesh), EdgeFilter::All, &params, &go_on).unwrap()
}

/// One bound around the patches from `first` on.
fn bound(set: &PatchSet, first: u32, count: u32) -> DoubleCone {
    let position = |vertex: u32| set.positions()[vertex as usize].as_dvec3();
    let normal = |face: [u32; 3]| {
        let [a, b, c] = face.map(position);
        (b - a).cross(c - a).normalize()
    };
    let patches = &set.patches()[first as usize..(first + count) as usize];
    let places = patches.iter().flat_map(|patch| patch.edges());
    let wings: Vec<_> = places.map(|place| set.wings()[place as usize]).collect();
    let faces = wings.iter().flat_map(|wing| [wing.left_face(), wing.right_face()]);
    let ends = wings.iter().map(|wing| [wing.tail, wing.head].map(position));
    let cone = NormalCone::minimal(faces.map(normal));
    DoubleCone::from(SpatializedNormalCone { cone, sphere: Sphere::reduced(ends) })
}

/// Super-patches of `count` patches each; those that are left over are in none.
fn grouped(set: PatchSet, count: u32) -> PatchSet {
    let firsts = (0..set.always_tested_patches().end / count).map(|group| group * count);
    let group = |first_patch| {
        let bound = bound(&set, first_patch, count);
        SuperPatch { bound, first_patch, patch_count: count }
    };
    let groups = firsts.map(group).collect();
    let set = set.with_super_patches(groups).unwrap();
    assert_eq!(set.validate(), Ok(()));
    set
}

fn viewpoints() -> impl Iterator<Item = Viewpoint> {
    let directions = [DVec3::new(1.0, 2.0, 3.0), DVec3::NEG_X, DVec3::new(-2.0, 0.1, -1.0)];
    let distances = [0.1, 0.5, 1.1, 4.0, 40.0];
    let point = move |d: DVec3| distances.map(|distance| Viewpoint::at(distance * d.normalize()));
    directions.into_iter().flat_map(move |d| {
        point(d).into_iter().chain(std::iter::once(Viewpoint::from_direction(d)))
    })
}

#[test]
fn contours_are_the_same_in_the_same_order() {
    for mesh in [shapes::icosphere(3_000), shapes::bumpy_sphere(3_000), shapes::torus_knot(3_000)] {
        let one = patches(&mesh);
        let two = grouped(one.clone(), 3);
        assert!(two.super_patches().len() > 10);
        let (mut expected, mut found): (Vec<EdgeId>, Vec<EdgeId>) = (Vec::new(), Vec::new());
        for viewpoint in viewpoints() {
            let plain = extract_patches(&one, viewpoint, &mut expected);
            let statistics = extract_patches(&two, viewpoint, &mut found);
            assert_eq!(found, expected);
            assert_eq!(statistics.contour_edges, plain.contour_edges);
            // A patch of a culled super-patch may itself not be culled: its bound is another.
            assert!(statistics.patches_accepted <= plain.patches_accepted);
            assert!(statistics.edges_tested <= plain.edges_tested);
            assert_eq!([plain.super_patches_tested, plain.super_patches_accepted], [0, 0]);
        }
    }
}

#[test]
fn patches_of_culled_super_patches_are_not_tested() {
    let mesh = shapes::icosphere(5_000);
    let set = grouped(patches(&mesh), 4);
    let left_over = set.always_tested_patches().len();
    let mut total = Statistics::default();
    let mut views = 0;
    for viewpoint in viewpoints() {
        let statistics = extract_patches(&set, viewpoint, &mut Vec::new());
        assert_eq!(statistics.super_patches_tested, set.super_patches().len());
        let expected = 4 * statistics.super_patches_accepted + left_over;
        assert_eq!(statistics.patches_tested, expected);
        total.super_patches_accepted += statistics.super_patches_accepted;
        views += 1;
    }
    // From within the ball nothing is culled by much; from outside most is.
    let share = total.super_patches_accepted as f64 / (views * set.super_patches().len()) as f64;
    assert!(share < 0.8, "{share} of the super-patches survive");
}

#[test]
fn patches_without_a_super_patch_are_tested_from_everywhere() {
    let mesh = shapes::icosphere(2_000);
    let one = patches(&mesh);
    // Of the first two patches only.
    let groups = vec![SuperPatch { bound: bound(&one, 0, 2), first_patch: 0, patch_count: 2 }];
    let count = one.patches().len();
    let set = one.with_super_patches(groups).unwrap();
    assert_eq!(set.always_tested_patches().len(), count - 2);
    let viewpoint = Viewpoint::from_direction(set.super_patches()[0].bound.axis.as_dvec3());
    let statistics = extract_patches(&set, viewpoint, &mut Vec::new());
    assert_eq!((statistics.super_patches_tested, statistics.super_patches_accepted), (1, 0));
    assert_eq!(statistics.patches_tested, count - 2);
}
