//! A mesh of several tiles, in batches and on threads.

use std::ops::ControlFlow;

use drypoint_cpu::{Batch, Contours, Extractor, extract_patches};
use drypoint_fusion::{FusionParams, Levels, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
use glam::DVec3;

/// In the same order and after as many tests as one view at a time finds them.
#[test]
fn tiles_and_threads_find_the_same() {
    // Some 90,000 edges, where a tile has no more than 24,576.
    let mesh = shapes::bumpy_sphere(60_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let viewpoints: Vec<Viewpoint> = [
        Viewpoint::at(DVec3::new(3.0, 1.0, 2.0)),
        Viewpoint::at(DVec3::ZERO),
        Viewpoint::at(mesh.position(0).as_dvec3()),
        Viewpoint::from_direction(DVec3::new(0.0, 0.3, -1.0)),
        Viewpoint::at(DVec3::new(-9.0, 0.5, 70.0)),
    ]
    .into();
    for levels in [Levels::One, Levels::Two] {
        let params = FusionParams { levels, ..FusionParams::FAST };
        let go_on = |_| ControlFlow::Continue(());
        let set = fuse(&mesh, &adjacency, EdgeFilter::All, &params, &go_on).unwrap();
        let extractor = Extractor::new(&set);
        let (mut one, mut on_threads) = (Contours::default(), Contours::default());
        let (mut batch, mut expected) = (Batch::default(), Vec::new());
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| extractor.edges_of_batch(&viewpoints, &mut batch));
            for (number, &viewpoint) in viewpoints.iter().enumerate() {
                let statistics = extract_patches(&set, viewpoint, &mut expected);
                assert_eq!(extractor.edges(viewpoint, &mut one), statistics);
                assert!(*one == *expected, "order of one view, {levels:?}, {viewpoint:?}");
                assert!(batch.view(number) == (&*expected, statistics), "{levels:?}, {threads}");
                let look = || extractor.edges_on_threads(viewpoint, &mut on_threads);
                assert_eq!(pool.install(look), statistics);
                assert!(*on_threads == *expected, "{levels:?}, {threads} threads, {viewpoint:?}");
            }
        }
    }
}
