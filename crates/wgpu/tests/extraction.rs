//! What is found: on every shape, by every pipeline, and where work has to be split.
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]

mod support;

use drypoint_fusion::{Levels, PatchSet};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, shapes};
use drypoint_shaders::{Content, Plan, PlanLimits};
use drypoint_wgpu::{
    Capacity, Contours, Error, Extractor, ExtractorOptions, Gpu, Method, Model, PlacedContours,
    Placement,
};
use glam::{DAffine3, DVec3};
use support::{Expected, extract, gpu, gpu_with, patches, placements};

/// Extracts with both methods and compares both.
#[track_caller]
fn check(gpu: &Gpu, extractor: &Extractor, set: &PatchSet, placements: &[Placement], what: &str) {
    let model = Model::new(extractor, &[set]).expect("there is memory");
    let expected = Expected::new(set, placements);
    let [sure, doubtful] = expected.counts();
    let capacity =
        Capacity { placements: placements.len() as u32, segments: (sure + doubtful + 1) as u32 };
    let mut contours = Contours::new(extractor, &model, capacity).expect("there is memory");
    for method in [Method::BruteForce, Method::Patches] {
        let found = extract(gpu, extractor, &mut contours, placements, method).expect("it fits");
        expected.compare(&found, &format!("{what}, {method:?}"));
        let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
        assert_eq!(statistics.segments, found.len() as u64);
        let all = (set.wings().len() * placements.len()) as u64;
        match method {
            Method::BruteForce => assert_eq!(statistics.edges_tested, all, "{what}"),
            Method::Patches => assert!(statistics.edges_tested <= all, "{what}"),
        }
        if method == Method::Patches && set.super_patches().is_empty() {
            let patches = (set.patches().len() * placements.len()) as u64;
            assert_eq!(statistics.patches_tested, patches, "{what}");
        }
    }
}

#[test]
fn every_shape_is_as_brute_force_with_exact_predicates_says() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    for shape in shapes::all() {
        for levels in [Levels::One, Levels::Two] {
            let set = patches(&shape.mesh, levels);
            let what = format!("{}, {levels:?}", shape.name);
            check(&gpu, &extractor, &set, &placements(&shape.mesh), &what);
        }
    }
    support::expect_silence();
}

#[test]
fn every_width_finds_the_same() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    for width in [32, 64, 256] {
        let options = ExtractorOptions { width };
        let extractor = Extractor::with_options(&gpu.device, &options).expect("shaders compile");
        assert_eq!(extractor.width(), width);
        for levels in [Levels::One, Levels::Two] {
            let what = format!("{options:?}, {levels:?}");
            check(&gpu, &extractor, &patches(&mesh, levels), &placements(&mesh), &what);
        }
    }
    support::expect_silence();
}

/// Work is cut for the extractor that contours were made with; another may be narrower or wider.
#[test]
fn any_extractor_of_the_device_records() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let extractors = [32, 256].map(|width| {
        let options = ExtractorOptions { width };
        Extractor::with_options(&gpu.device, &options).expect("shaders compile")
    });
    // So many that a workgroup gets more patches than the narrower one has lanes.
    let placements = vec![placements(&mesh)[0]; 550];
    let chunks = Content::new(&[&patches(&mesh, Levels::One)]).chunks(u32::MAX, u32::MAX);
    let plan = Plan {
        chunks: &chunks,
        part_count: 1,
        method: Method::Patches,
        instances: 550,
        segment_capacity: 0,
        limits: PlanLimits { width: 256, row: 65_535, edges: 1 << 28 },
    };
    plan.dispatches(&mut |dispatch| assert!(dispatch.work.items_per_workgroup > 32));
    for levels in [Levels::One, Levels::Two] {
        let set = patches(&mesh, levels);
        let expected = Expected::new(&set, &placements);
        for [maker, recorder] in [[0, 1], [1, 0]] {
            let model = Model::new(&extractors[maker], &[&set]).expect("there is memory");
            let capacity = Capacity { placements: 550, segments: 1_000_000 };
            let contours = Contours::new(&extractors[maker], &model, capacity);
            let mut contours = contours.expect("there is memory");
            let recorder = &extractors[recorder];
            let found = extract(&gpu, recorder, &mut contours, &placements, Method::Patches);
            expected.compare(&found.expect("it fits"), &format!("{levels:?}, by another"));
        }
    }
    support::expect_silence();
}

/// Rows of 3 workgroups and bindings of 64 KiB: chunks, tiles of items and tiles of instances, as 10 million
/// edges and 252 instances need on devices with common limits.
#[test]
fn work_beyond_the_limits_is_split() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu_with(&|limits| {
        limits.max_compute_workgroups_per_dimension = 3;
        limits.max_storage_buffer_binding_size = 1 << 16;
    });
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mesh = shapes::torus_knot(8_000);
    for levels in [Levels::One, Levels::Two] {
        let set = patches(&mesh, levels);
        assert!(set.wings().len() * 32 > 4 << 16, "it takes several bindings");
        for few in [1, 5] {
            let placements = &placements(&mesh)[..few];
            check(&gpu, &extractor, &set, placements, &format!("{few} instances, {levels:?}"));
        }
    }
    let vertices = mesh.positions().len();
    assert!(vertices * 12 < 1 << 16);
    let large = patches(&shapes::icosphere(20_000), Levels::One);
    let error = Model::new(&extractor, &[&large]).expect_err("vertices are not split");
    assert!(matches!(error, Error::TooLarge { limit: 65_536, .. }), "{error}");
    support::expect_silence();
}

#[test]
fn parts_are_placed_one_by_one() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let meshes = [shapes::icosphere(500), shapes::torus_knot(2_000), shapes::icosphere(80)];
    for levels in [[Levels::One; 3], [Levels::One, Levels::Two, Levels::One]] {
        let sets: Vec<_> =
            meshes.iter().zip(levels).map(|(mesh, levels)| patches(mesh, levels)).collect();
        let model =
            Model::new(&extractor, &sets.iter().collect::<Vec<_>>()).expect("there is memory");
        assert_eq!(model.part_count(), 3);
        let capacity = Capacity { placements: 12, segments: 20_000 };
        let mut contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
        let all = placements(&meshes[0]);
        for method in [Method::BruteForce, Method::Patches] {
            let mut found =
                extract(&gpu, &extractor, &mut contours, &all[..12], method).expect("it fits");
            let mut first_vertex = 0;
            for (part, set) in (0..).zip(&sets) {
                let of_part: Vec<_> = all[..12].iter().copied().skip(part).step_by(3).collect();
                let is_of_part = |placement: u32| placement % 3 == part as u32;
                let mut segments: Vec<_> =
                    found.extract_if(.., |segment| is_of_part(segment.placement)).collect();
                for segment in &mut segments {
                    segment.from_vertex -= first_vertex;
                    segment.to_vertex -= first_vertex;
                    segment.placement /= 3;
                }
                segments.sort_unstable();
                Expected::new(set, &of_part)
                    .compare(&segments, &format!("part {part}, {method:?}"));
                first_vertex += set.positions().len() as u32;
            }
            assert!(found.is_empty());
        }
        let uneven = extract(&gpu, &extractor, &mut contours, &all[..4], Method::Patches);
        assert_eq!(uneven, Err(Error::UnevenPlacements { given: 4, parts: 3 }));
    }
    support::expect_silence();
}

#[test]
fn what_does_not_fit_is_counted_and_not_written() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let set = patches(&mesh, Levels::One);
    let all = &placements(&mesh)[..6];
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let model = Model::new(&extractor, &[&set]).expect("there is memory");
    let roomy = Capacity { placements: 6, segments: 50_000 };
    let mut contours = Contours::new(&extractor, &model, roomy).expect("there is memory");
    let found = extract(&gpu, &extractor, &mut contours, all, Method::Patches).expect("it fits");
    for capacity in [0, 1, found.len() as u32 - 1] {
        let tight = Capacity { segments: capacity, ..roomy };
        let mut contours = Contours::new(&extractor, &model, tight).expect("there is memory");
        let error = extract(&gpu, &extractor, &mut contours, all, Method::Patches);
        assert_eq!(error, Err(Error::Overflow { needed: found.len() as u64, capacity }));
        let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
        assert_eq!(statistics.overflow(), Some(found.len() as u64));
    }
    let exact = Capacity { segments: found.len() as u32, ..roomy };
    let mut contours = Contours::new(&extractor, &model, exact).expect("there is memory");
    let again = extract(&gpu, &extractor, &mut contours, all, Method::Patches).expect("it fits");
    assert_eq!(again, found);
    let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
    assert_eq!(statistics.overflow(), None);
    support::expect_silence();
}

#[test]
fn placed_segments_are_where_the_scene_has_them() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mesh = shapes::torus_knot(3_000);
    let model = Model::new(&extractor, &[&patches(&mesh, Levels::One)]).expect("there is memory");
    let all = placements(&mesh);
    let capacity = Capacity { placements: all.len() as u32, segments: 50_000 };
    let mut contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
    let placed = PlacedContours::new(&extractor, &contours).expect("there is memory");
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    contours.prepare(&mut encoder, &all, Method::Patches).expect("it fits");
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        extractor.record(&mut pass, &contours);
        placed.record(&extractor, &mut pass, &contours);
    }
    gpu.queue.submit([encoder.finish()]);
    let segments = contours.read_segments(&gpu.queue).expect("it fits");
    let found = placed.read(&gpu.queue, &contours).expect("it fits");
    assert_eq!(segments.len(), found.len());
    assert!(!found.is_empty());
    for (segment, placed) in segments.iter().zip(&found) {
        assert_eq!((segment.placement, segment.edge), (placed.placement, placed.edge));
        let to_scene = all[segment.placement as usize].to_scene;
        let ends =
            [(segment.from_vertex, placed.from_position), (segment.to_vertex, placed.to_position)];
        for (vertex, position) in ends {
            let expected = to_scene.transform_point3(mesh.position(vertex).as_dvec3());
            assert!(expected.distance(position.as_dvec3()) < 1e-4, "{expected} {position}");
        }
    }
    support::expect_silence();
}

#[test]
fn nothing_is_found_of_nothing() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let empty = Mesh::new(Vec::new(), Vec::new()).expect("it is a mesh");
    let mesh = shapes::icosphere(100);
    for mesh in [&empty, &mesh] {
        let model =
            Model::new(&extractor, &[&patches(mesh, Levels::One)]).expect("there is memory");
        let capacity = Capacity { placements: 2, segments: 0 };
        let mut contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
        let far = placements(mesh)[0];
        let placements = if mesh.positions().is_empty() { vec![far; 2] } else { Vec::new() };
        for method in [Method::BruteForce, Method::Patches] {
            let found = extract(&gpu, &extractor, &mut contours, &placements, method);
            assert_eq!(found, Ok(Vec::new()));
        }
    }
    support::expect_silence();
}

#[test]
fn a_mesh_without_patches_is_for_brute_force() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mesh = shapes::torus_knot(2_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let model = Model::without_patches(&extractor, &mesh, &adjacency, EdgeFilter::All);
    let model = model.expect("there is memory");
    let all = &placements(&mesh)[..3];
    let capacity = Capacity { placements: 3, segments: 50_000 };
    let mut contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
    let found = extract(&gpu, &extractor, &mut contours, all, Method::BruteForce).expect("it fits");
    Expected::new(&patches(&mesh, Levels::One), all).compare(&found, "a bare mesh");
    let error = extract(&gpu, &extractor, &mut contours, all, Method::Patches);
    assert_eq!(error, Err(Error::NoPatches));
    support::expect_silence();
}

#[test]
fn placements_that_cannot_be_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mesh = shapes::icosphere(100);
    let model = Model::new(&extractor, &[&patches(&mesh, Levels::One)]).expect("there is memory");
    let capacity = Capacity { placements: 2, segments: 1_000 };
    let mut contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
    let good = placements(&mesh)[0];
    let flat = Placement { to_scene: DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)), ..good };
    let nowhere = Placement { viewpoint: Viewpoint::at(DVec3::NAN), ..good };
    for (placements, error) in [
        (vec![good; 3], Error::TooManyPlacements { given: 3, capacity: 2 }),
        (vec![good, flat], Error::SingularPlacement { index: 1 }),
        (vec![nowhere], Error::SingularPlacement { index: 0 }),
    ] {
        let found = extract(&gpu, &extractor, &mut contours, &placements, Method::Patches);
        assert_eq!(found, Err(error));
        assert_eq!(contours.placement_count(), 0);
    }
    // What was refused left nothing of the frame before.
    let once = extract(&gpu, &extractor, &mut contours, &[good], Method::Patches).expect("it fits");
    assert!(!once.is_empty());
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let refused = contours.prepare(&mut encoder, &[good, flat], Method::Patches);
    assert_eq!(refused, Err(Error::SingularPlacement { index: 1 }));
    assert_eq!(contours.placement_count(), 0);
    extractor.record(
        &mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()),
        &contours,
    );
    gpu.queue.submit([encoder.finish()]);
    let mut still = contours.read_segments(&gpu.queue).expect("it fits");
    still.sort_unstable();
    assert_eq!(still, once);

    assert_eq!(Model::new(&extractor, &[]).err(), Some(Error::NoParts));
    let many = Capacity { placements: u32::MAX, segments: 1 };
    let error = Contours::new(&extractor, &model, many).expect_err("no binding holds it");
    assert!(matches!(error, Error::TooLarge { what: "the placements of a frame", .. }), "{error}");
    let huge = Capacity { placements: 1, segments: u32::MAX };
    let error = Contours::new(&extractor, &model, huge).expect_err("no binding holds it");
    assert!(matches!(error, Error::TooLarge { what: "segments", .. }), "{error}");
    support::expect_silence();
}
