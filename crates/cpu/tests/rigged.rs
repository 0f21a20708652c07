//! Models that move: what is found through patches is the definition's.

use std::ops::ControlFlow;
use std::path::PathBuf;

use drypoint_cpu::{RigContours, RigExtractor, Statistics};
use drypoint_fusion::{CostModel, FusionParams, fuse_shapes};
use drypoint_mesh::io::read;
use drypoint_mesh::rig::{Influence, Pose, Rig, RigBuilder, Skin};
use drypoint_mesh::{EdgeFilter, Viewpoint, shapes};
use glam::{DAffine3, DQuat, DVec3};

/// A viewpoint at a few distances in a few directions, and from infinity.
fn viewpoints(size: f64) -> Vec<Viewpoint> {
    let directions =
        [DVec3::new(0.3, 0.2, 1.0), DVec3::new(-1.0, 0.7, 0.4), DVec3::new(0.5, -0.9, -0.6)];
    let at = |distance: f64| directions.map(|d| Viewpoint::at(distance * size * d.normalize()));
    [at(0.5), at(3.0), at(40.0), directions.map(Viewpoint::from_direction)].concat()
}

/// Compares in all poses, with both filters, and adds up how many edges were tested and how many there are.
#[track_caller]
fn check(rig: &Rig, poses: &[Pose], size: f64) -> [usize; 2] {
    let skin = Skin::new(rig).unwrap();
    let params = FusionParams { cost: CostModel::PAPER, ..FusionParams::FAST };
    let mut tested = [0; 2];
    let (mut found, mut expected) = (RigContours::default(), Vec::new());
    for filter in [EdgeFilter::All, EdgeFilter::Convex] {
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse_shapes(&skin, filter, &params, &go_on).unwrap();
        let extractor = RigExtractor::new(rig, &skin, &patches);
        for pose in poses {
            for viewpoint in viewpoints(size) {
                let statistics: Statistics = extractor.edges(pose, viewpoint, &mut found);
                skin.contour_edges(rig, pose, viewpoint, filter, &mut expected);
                let mut edges = found.edges().to_vec();
                edges.sort_unstable();
                assert_eq!(edges, expected, "{filter:?} from {viewpoint:?}");
                assert_eq!(statistics.contour_edges, expected.len());
                let every = extractor.all_edges(pose, viewpoint, &mut found);
                assert_eq!(every.edges_tested, extractor.edge_count());
                let mut edges = found.edges().to_vec();
                edges.sort_unstable();
                assert_eq!(edges, expected, "{filter:?} from {viewpoint:?}, all edges");
                tested[0] += statistics.edges_tested;
                tested[1] += extractor.edge_count();
            }
        }
    }
    tested
}

#[test]
fn models_are_found_at_all_times() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else { return };
    // Edges that are tested, in per cent of all, at most: the loose ones, and some of the rigid.
    for (name, most) in [("RobotExpressive.glb", 62), ("BrainStem.glb", 35), ("Fox.glb", 96)] {
        let model = read(&folder.join(name)).unwrap();
        let rig = model.rig.unwrap();
        let mut poses = vec![rig.rest()];
        for (index, animation) in rig.animations().iter().enumerate() {
            let times = [0.13, 0.5, 0.91].map(|part| part * animation.duration());
            poses.extend(times.map(|seconds| rig.pose_at(index, seconds)));
        }
        let size = model.mesh.bounds().unwrap().half_longest_side();
        let [tested, all] = check(&rig, &poses, size);
        assert!(100 * tested < most * all, "{name}: {tested} of {all}");
    }
}

/// A ball at several places, two of which are welded to each other by vertices that follow both.
fn balls() -> Rig {
    let mesh = shapes::icosphere(2_000);
    let mut builder = RigBuilder::default();
    for place in 0..4 {
        let carriers = [place, (place + 1) % 4].map(|place| builder.carrier(None, Some(place)));
        let follows = |carrier, weight, position| Influence { carrier, weight, position };
        let vertices: Vec<u32> = mesh
            .positions()
            .iter()
            .map(|&position| {
                let is_soft = place > 1 && position.z > 0.8;
                let soft = carriers.map(|carrier| follows(carrier, 0.5, position));
                let stiff = [follows(carriers[0], 1.0, position)];
                builder.vertex(if is_soft { &soft } else { &stiff }, &[])
            })
            .collect();
        for triangle in mesh.triangles() {
            builder.triangle(triangle.map(|vertex| vertices[vertex as usize]));
        }
    }
    builder.finish()
}

#[test]
fn parts_that_are_mirrored_sheared_far_or_flat_are_found() {
    let rig = balls();
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
    let place =
        |scale: DVec3, at: DVec3| DAffine3::from_scale_rotation_translation(scale, turn, at);
    let sheared = place(DVec3::new(1.0, 3.0, 0.2), DVec3::ONE) * place(DVec3::ONE, DVec3::Z);
    let places = [
        [place(DVec3::ONE, DVec3::ZERO); 4],
        [
            place(DVec3::new(-1.0, 1.0, 1.0), 3.0 * DVec3::X),
            sheared,
            place(-DVec3::splat(0.01), 2.0 * DVec3::Y),
            place(DVec3::new(5.0, -0.3, 1.0), 1e4 * DVec3::Z),
        ],
        [
            DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)),
            DAffine3::from_scale(DVec3::ZERO),
            place(DVec3::splat(1e-9), 0.1 * DVec3::ONE),
            DAffine3::from_scale(DVec3::new(1.0, 1e-70, 1.0)),
        ],
    ];
    let poses = places.map(|places| {
        // Carriers are in the order in which they were asked for: 0, 1, 2, 3.
        Pose { to_scene: places.to_vec(), weights: Vec::new() }
    });
    let [tested, all] = check(&rig, &poses[..2], 2.0);
    assert!(2 * tested < all, "{tested} of {all}");
    check(&rig, &poses[2..], 2.0);
}

#[test]
fn a_rig_of_nothing_has_no_contours() {
    let rig = RigBuilder::default().finish();
    let skin = Skin::new(&rig).unwrap();
    let extractor = RigExtractor::new(&rig, &skin, &[]);
    let mut contours = RigContours::default();
    let statistics = extractor.edges(&rig.rest(), Viewpoint::at(DVec3::ONE), &mut contours);
    assert_eq!((statistics, contours.edges()), (Statistics::default(), &[][..]));
}
