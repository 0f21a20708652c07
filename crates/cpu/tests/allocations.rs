//! Extraction allocates nothing once its output has been used.

use std::ops::ControlFlow;

use drypoint_cpu::{Batch, Contours, Extractor, FaceSigns, FaceStrips, Instructions, StoredPlanes};
use drypoint_fusion::{FusionParams, Levels, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
use glam::DVec3;

#[test]
fn nothing_is_allocated_after_the_first_view() {
    let mesh = shapes::icosphere(5_000);
    let params = FusionParams { levels: Levels::Two, ..FusionParams::FAST };
    let go_on = |_| ControlFlow::Continue(());
    let set = fuse(&mesh, &MeshAdjacency::new(&mesh), EdgeFilter::All, &params, &go_on).unwrap();
    let viewpoints = [
        Viewpoint::at(DVec3::new(3.0, 1.0, 2.0)),
        // Inside: nothing is a contour.
        Viewpoint::at(DVec3::ZERO),
        // On the surface and from the zero direction, where all is left to the exact predicate.
        Viewpoint::at(mesh.position(0).as_dvec3()),
        Viewpoint::from_direction(DVec3::ZERO),
        Viewpoint::from_direction(DVec3::X),
    ];
    for instructions in Instructions::ALL.into_iter().filter(|set| set.are_here()) {
        let extractor = Extractor::with(&set, instructions).unwrap();
        let (mut edges, mut pairs) = (Contours::default(), Contours::default());
        let first = allocation_counter::measure(|| {
            extractor.all_edges(viewpoints[0], &mut edges);
            extractor.vertex_pairs(viewpoints[0], &mut pairs);
        });
        assert!(first.count_total > 0, "the counter counts");
        let later = allocation_counter::measure(|| {
            for viewpoint in viewpoints {
                extractor.edges(viewpoint, &mut edges);
                extractor.all_edges(viewpoint, &mut edges);
                extractor.vertex_pairs(viewpoint, &mut pairs);
            }
        });
        assert_eq!(later.count_total, 0, "{instructions:?}");
    }
}

/// The counter counts for one thread, so the batch runs on the one that it is called from.
#[test]
fn neither_is_by_batches_and_brute_forces() {
    let mesh = shapes::icosphere(5_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let go_on = |_| ControlFlow::Continue(());
    let set = fuse(&mesh, &adjacency, EdgeFilter::All, &FusionParams::FAST, &go_on).unwrap();
    let extractor = Extractor::new(&set);
    let stored = StoredPlanes::new(&mesh, &adjacency, EdgeFilter::All);
    let strips = FaceStrips::new(&mesh, &adjacency, EdgeFilter::All);
    let mut signs = FaceSigns::new(&mesh, &adjacency, EdgeFilter::All);
    let viewpoints = [DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO].map(Viewpoint::at);
    let (mut edges, mut pairs) = (Batch::default(), Batch::default());
    let mut contours = Contours::default();
    let mut look = || {
        extractor.edges_of_batch(&viewpoints, &mut edges);
        extractor.vertex_pairs_of_batch(&viewpoints, &mut pairs);
        for viewpoint in viewpoints {
            stored.extract(viewpoint, &mut contours);
            strips.extract(viewpoint, &mut contours);
            signs.extract(viewpoint, &mut contours);
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let first = allocation_counter::measure(&mut look);
        assert!(first.count_total > 0, "the counter counts");
        let later = allocation_counter::measure(&mut look);
        assert_eq!(later.count_total, 0);
    });
}
