//! What is found: on every shape, by task and mesh shaders and by compute shaders.
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]

mod support;

use drypoint_ash::{
    Capacity, Contours, Counting, Counts, Error, Extractor, Gpu, Limits, MeshContours, MeshOptions,
    MeshPass, MeshStatistics, Method, Model, Placement, Queries, Segment, Statistics,
};
use drypoint_fusion::{Levels, PatchSet};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
use drypoint_shaders::{BLOCK_PATCHES, Content, Group};
use glam::{DAffine3, DVec3, Mat4};
use support::{Expected, expect_primitives, gpu, patches, placements};

/// What one way found, sorted.
struct Found {
    segments: Vec<Segment>,
    counts: Counts,
}

fn by_mesh(
    gpu: &Gpu,
    pass: &MeshPass,
    contours: &mut MeshContours,
    placements: &[Placement],
    method: Method,
) -> (Found, MeshStatistics) {
    let mut queries = Queries::new(gpu.device(), Counting::MeshShaders).expect("it can count");
    let (found, executed) = gpu
        .run(|commands| {
            contours.prepare(commands, placements, method)?;
            pass.prepare(commands, Mat4::IDENTITY, &Default::default())?;
            queries.begin(commands)?;
            pass.extract(commands, contours)?;
            queries.end(commands)?;
            contours.download(commands)
        })
        .expect("it is drawn");
    let mut segments = found.segments(&executed).expect("they fit");
    segments.sort_unstable();
    let counts = queries.read(&executed).expect("it was counted");
    (Found { segments, counts }, found.statistics(&executed).expect("it was counted"))
}

fn by_compute(
    gpu: &Gpu,
    extractor: &Extractor,
    contours: &mut Contours,
    placements: &[Placement],
    method: Method,
) -> (Found, Statistics) {
    let mut queries = Queries::new(gpu.device(), Counting::Compute).expect("it can count");
    let (found, executed) = gpu
        .run(|commands| {
            contours.prepare(commands, placements, method)?;
            queries.begin(commands)?;
            extractor.record(commands, contours)?;
            queries.end(commands)?;
            contours.download(commands)
        })
        .expect("it is found");
    let mut segments = found.segments(&executed).expect("they fit");
    segments.sort_unstable();
    let counts = queries.read(&executed).expect("it was counted");
    (Found { segments, counts }, found.statistics(&executed).expect("it was counted"))
}

/// Extracts with both methods, both ways, and compares all.
#[track_caller]
fn check(
    gpu: &Gpu,
    (pass, extractor): (&MeshPass, &Extractor),
    set: &PatchSet,
    placements: &[Placement],
    what: &str,
) -> bool {
    let mut is_exact = false;
    let (model, _) = gpu.run(|commands| Model::new(commands, &[set])).expect("there is memory");
    let expected = Expected::new(set, placements);
    let [sure, doubtful] = expected.counts();
    let capacity =
        Capacity { placements: placements.len() as u32, segments: (sure + doubtful + 1) as u32 };
    let mut meshed = MeshContours::new(pass, &model, capacity).expect("there is memory");
    let mut computed = Contours::new(extractor, &model, capacity).expect("there is memory");
    for method in [Method::BruteForce, Method::Patches] {
        let what = format!("{what}, {method:?}");
        let (mesh, drawn) = by_mesh(gpu, pass, &mut meshed, placements, method);
        expected.compare(&mesh.segments, &what);
        let (compute, found) = by_compute(gpu, extractor, &mut computed, placements, method);
        assert_eq!(mesh.segments, compute.segments, "{what}");
        let all = (set.wings().len() * placements.len()) as u64;
        assert_eq!(compute.counts.compute_invocations > 0, all > 0, "{what}");
        check_launched((gpu, pass), method, (&mesh.counts, &drawn), all, &what);
        if method == Method::Patches {
            let [needed, borderline] = needed(pass, set, placements);
            let launched = drawn.mesh_workgroups;
            is_exact = borderline == 0;
            let differ = needed.abs_diff(launched);
            assert!(differ <= borderline, "{what}: {needed} are needed, not {launched}");
        }
        assert_eq!(drawn.found, found, "{what}");
    }
    is_exact
}

/// Mesh workgroups that the survivors of each task workgroup fill, and patches of which rounding decides whether
/// they are such: culling done again on the processor, in f32.
fn needed(pass: &MeshPass, set: &PatchSet, placements: &[Placement]) -> [u64; 2] {
    let content = Content::new(&[set]);
    let frame = content.frames[0];
    let viewpoints: Vec<_> = placements
        .iter()
        .map(|placement| frame.viewpoint(placement.viewpoint_of_part().expect("it has an inverse")))
        .collect();
    let mut borderline = 0;
    let mut survives = |group: &Group, instance: usize| {
        let seen = viewpoints[instance];
        let grown = |growth: f32| {
            let mut bound = group.bound;
            bound.apex_distance = bound.apex_distance * (1.0 + growth) + growth;
            bound.tan_squared *= 1.0 + growth;
            bound.may_hold_contour_towards(seen.truncate() - seen.w * bound.center, seen.w)
        };
        borderline += u64::from(grown(4e-6) != grown(-4e-6));
        grown(0.0)
    };
    let lanes = u64::from(pass.edges_per_workgroup());
    let workgroups = |edges: u64| edges.div_ceil(lanes);
    let chunk = &content.chunks(u32::MAX, u32::MAX)[..];
    let Some(chunk) = chunk.first() else { return [0, 0] };
    let mut all = 0;
    if chunk.super_patches.is_empty() {
        // Lanes are numbered through, from instance to instance.
        let instances = 0..placements.len();
        let items = instances.flat_map(|i| chunk.patches.iter().map(move |patch| (i, patch)));
        let items: Vec<_> = items.collect();
        for of_workgroup in items.chunks(pass.task_width() as usize) {
            let edges = of_workgroup.iter().map(|(instance, patch)| {
                if survives(patch, *instance) { u64::from(patch.count) } else { 0 }
            });
            all += workgroups(edges.sum());
        }
        return [all, borderline];
    }
    let blocks = chunk.blocks(BLOCK_PATCHES);
    for instance in 0..placements.len() {
        for block in blocks.windows(2) {
            let mut edges = 0;
            for group in &chunk.super_patches[block[0] as usize..block[1] as usize] {
                if survives(group, instance) {
                    let patches = group.first as usize..(group.first + group.count) as usize;
                    let patches = &chunk.patches[patches];
                    let surviving = patches.iter().filter(|patch| survives(patch, instance));
                    edges += surviving.map(|patch| u64::from(patch.count)).sum::<u64>();
                }
            }
            all += workgroups(edges);
        }
    }
    [all, borderline]
}

/// As many mesh workgroups as survivors' edges fill, as many primitives as contour edges.
#[track_caller]
fn check_launched(
    (gpu, pass): (&Gpu, &MeshPass),
    method: Method,
    (counts, drawn): (&Counts, &MeshStatistics),
    all_edges: u64,
    what: &str,
) {
    let lanes = u64::from(pass.mesh_width());
    let launched = counts.mesh_invocations / lanes;
    assert_eq!(counts.mesh_invocations % lanes, 0, "{what}");
    expect_primitives(gpu, counts.primitives, drawn.found.segments, what);
    assert_eq!(launched, drawn.mesh_workgroups, "{what}");
    let edges = u64::from(pass.edges_per_workgroup());
    assert!(launched * edges >= drawn.found.edges_tested, "{what}");
    if method == Method::BruteForce {
        assert_eq!(launched, all_edges.div_ceil(edges), "{what}");
    }
}

#[test]
fn every_shape_is_as_brute_force_with_exact_predicates_says() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let (mut all, mut exact) = (0, 0);
    for shape in shapes::all() {
        for levels in [Levels::One, Levels::Two] {
            let set = patches(&shape.mesh, levels);
            let what = format!("{}, {levels:?}", shape.name);
            let passes = (&pass, &extractor);
            let is_exact = check(&gpu, passes, &set, &placements(&shape.mesh), &what);
            (all, exact) = (all + 1, exact + usize::from(is_exact));
        }
    }
    // In the others some patch is on the border, where rounding decides.
    assert!(4 * exact > all, "workgroups were counted to the last one in {exact} cases of {all}");
    support::expect_silence();
}

#[test]
fn every_width_finds_the_same() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let mesh = shapes::torus_knot(3_000);
    for [task_width, mesh_width, edges] in
        [[32, 32, 128], [128, 32, 32], [64, 16, 64], [5, 7, 21], [1, 1, 2], [32, 128, 128]]
    {
        let options = MeshOptions {
            task_width: Some(task_width),
            mesh_width: Some(mesh_width),
            edges_per_workgroup: Some(edges),
            ..MeshOptions::default()
        };
        let pass = MeshPass::new(gpu.device(), &options).expect("shaders compile");
        let got = [pass.task_width(), pass.mesh_width(), pass.edges_per_workgroup()];
        assert_eq!(got, [task_width, mesh_width, edges]);
        for levels in [Levels::One, Levels::Two] {
            let what = format!("{task_width} and {mesh_width} lanes, {edges} edges, {levels:?}");
            let few = &placements(&mesh)[..6];
            check(&gpu, (&pass, &extractor), &patches(&mesh, levels), few, &what);
        }
    }
    let usual = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    assert!((33..=64).contains(&usual.edges_per_workgroup()), "about 64");
    for [task_width, mesh_width, edges] in
        [[0, 32, 64], [129, 32, 64], [32, 0, 64], [32, 129, 129], [32, 32, 129], [32, 32, 48]]
    {
        let options = MeshOptions {
            task_width: Some(task_width),
            mesh_width: Some(mesh_width),
            edges_per_workgroup: Some(edges),
            ..MeshOptions::default()
        };
        let error = MeshPass::new(gpu.device(), &options).expect_err("it has no such lanes");
        assert!(matches!(error, Error::Lanes { .. } | Error::UnevenLanes { .. }), "{error}");
    }
    support::expect_silence();
}

/// Few workgroups in a row and in all, and bindings of 64 KiB: chunks, tiles of items and tiles of instances, as
/// 10 million edges and 252 instances need on devices with common limits.
#[test]
fn work_beyond_the_limits_is_split() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu_with(Some(|limits: &mut Limits| {
        limits.storage_range = 1 << 16;
        limits.compute_row = 3;
        limits.task_grid = [3, 8];
        limits.mesh_grid = [5, 25];
    }));
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let mesh = shapes::torus_knot(8_000);
    for levels in [Levels::One, Levels::Two] {
        let set = patches(&mesh, levels);
        assert!(set.wings().len() * 32 > 4 << 16, "it takes several bindings");
        for few in [1, 5] {
            let placements = &placements(&mesh)[..few];
            let what = format!("{few} instances, {levels:?}");
            let (model, _) =
                gpu.run(|commands| Model::new(commands, &[&set])).expect("there is memory");
            let expected = Expected::new(&set, placements);
            let capacity = Capacity { placements: few as u32, segments: 4_000 };
            let mut meshed = MeshContours::new(&pass, &model, capacity).expect("there is memory");
            let mut computed =
                Contours::new(&extractor, &model, capacity).expect("there is memory");
            for method in [Method::BruteForce, Method::Patches] {
                let (mesh, drawn) = by_mesh(&gpu, &pass, &mut meshed, placements, method);
                expected.compare(&mesh.segments, &what);
                let lanes = u64::from(pass.mesh_width());
                assert_eq!(mesh.counts.mesh_invocations, drawn.mesh_workgroups * lanes, "{what}");
                let contour_edges = drawn.found.segments;
                expect_primitives(&gpu, mesh.counts.primitives, contour_edges, &what);
                let (compute, found) =
                    by_compute(&gpu, &extractor, &mut computed, placements, method);
                assert_eq!(mesh.segments, compute.segments, "{what}");
                assert_eq!(drawn.found, found, "{what}");
            }
        }
    }
    let large = patches(&shapes::icosphere(20_000), Levels::One);
    let error = gpu.run(|commands| Model::new(commands, &[&large]));
    let error = error.expect_err("vertices are not split");
    assert!(matches!(error, Error::TooLarge { limit: 65_536, .. }), "{error}");
    support::expect_silence();
}

#[test]
fn parts_are_placed_one_by_one() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let meshes = [shapes::icosphere(500), shapes::torus_knot(2_000), shapes::icosphere(80)];
    for levels in [[Levels::One; 3], [Levels::One, Levels::Two, Levels::One]] {
        let sets: Vec<_> =
            meshes.iter().zip(levels).map(|(mesh, levels)| patches(mesh, levels)).collect();
        let parts: Vec<_> = sets.iter().collect();
        let (model, _) = gpu.run(|commands| Model::new(commands, &parts)).expect("there is memory");
        assert_eq!(model.part_count(), 3);
        let capacity = Capacity { placements: 12, segments: 20_000 };
        let mut contours = MeshContours::new(&pass, &model, capacity).expect("there is memory");
        let all = placements(&meshes[0]);
        for method in [Method::BruteForce, Method::Patches] {
            let (found, _) = by_mesh(&gpu, &pass, &mut contours, &all[..12], method);
            let mut found = found.segments;
            let mut first_vertex = 0;
            for (part, set) in (0..).zip(&sets) {
                let of_part: Vec<_> = all[..12].iter().copied().skip(part).step_by(3).collect();
                let is_of_part = |segment: &mut Segment| segment.placement % 3 == part as u32;
                let mut segments: Vec<_> = found.extract_if(.., is_of_part).collect();
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
        let uneven = gpu.run(|commands| contours.prepare(commands, &all[..4], Method::Patches));
        assert_eq!(uneven.err(), Some(Error::UnevenPlacements { given: 4, parts: 3 }));
    }
    support::expect_silence();
}

#[test]
fn what_does_not_fit_is_counted_and_not_written() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let mesh = shapes::torus_knot(3_000);
    let set = patches(&mesh, Levels::One);
    let all = &placements(&mesh)[..6];
    let (model, _) = gpu.run(|commands| Model::new(commands, &[&set])).expect("there is memory");
    let roomy = Capacity { placements: 6, segments: 50_000 };
    let mut contours = MeshContours::new(&pass, &model, roomy).expect("there is memory");
    let (found, _) = by_mesh(&gpu, &pass, &mut contours, all, Method::Patches);
    let needed = found.segments.len() as u32;
    for capacity in [0, 1, needed - 1, needed] {
        let tight = Capacity { segments: capacity, ..roomy };
        let mut contours = MeshContours::new(&pass, &model, tight).expect("there is memory");
        let (again, executed) = gpu
            .run(|commands| {
                contours.prepare(commands, all, Method::Patches)?;
                pass.extract(commands, &contours)?;
                contours.download(commands)
            })
            .expect("it is drawn");
        let segments = again.segments(&executed);
        if capacity < needed {
            let needed = u64::from(needed);
            assert_eq!(segments, Err(Error::Overflow { needed, capacity }));
        } else {
            let mut segments = segments.expect("they fit");
            segments.sort_unstable();
            assert_eq!(segments, found.segments);
        }
        let statistics = again.statistics(&executed).expect("it was counted");
        assert_eq!(statistics.found.segments, u64::from(needed));
    }
    support::expect_silence();
}

#[test]
fn nothing_is_found_of_nothing_and_what_cannot_be_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let mesh = shapes::icosphere(100);
    let set = patches(&mesh, Levels::One);
    let (model, _) = gpu.run(|commands| Model::new(commands, &[&set])).expect("there is memory");
    let capacity = Capacity { placements: 2, segments: 1_000 };
    let mut contours = MeshContours::new(&pass, &model, capacity).expect("there is memory");
    for method in [Method::BruteForce, Method::Patches] {
        let (found, statistics) = by_mesh(&gpu, &pass, &mut contours, &[], method);
        assert!(found.segments.is_empty());
        assert_eq!(statistics.mesh_workgroups, 0);
        assert_eq!([found.counts.task_invocations, found.counts.mesh_invocations], [0, 0]);
    }
    let good = placements(&mesh)[0];
    let flat = Placement { to_scene: DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)), ..good };
    let nowhere = Placement { viewpoint: Viewpoint::at(DVec3::NAN), ..good };
    for (placements, error) in [
        (vec![good; 3], Error::TooManyPlacements { given: 3, capacity: 2 }),
        (vec![good, flat], Error::SingularPlacement { index: 1 }),
        (vec![nowhere], Error::SingularPlacement { index: 0 }),
    ] {
        let refused = gpu.run(|commands| contours.prepare(commands, &placements, Method::Patches));
        assert_eq!(refused.err(), Some(error));
        // What was refused left nothing of the frame before.
        let stale = gpu.run(|commands| {
            let _ = contours.prepare(commands, &placements, Method::Patches);
            pass.extract(commands, &contours)
        });
        assert_eq!(stale.err(), Some(Error::Unprepared));
    }
    let adjacency = MeshAdjacency::new(&mesh);
    let (bare, _) = gpu
        .run(|commands| Model::without_patches(commands, &mesh, &adjacency, EdgeFilter::All))
        .expect("there is memory");
    let mut contours = MeshContours::new(&pass, &bare, capacity).expect("there is memory");
    let (found, _) = by_mesh(&gpu, &pass, &mut contours, &[good], Method::BruteForce);
    Expected::new(&set, &[good]).compare(&found.segments, "a bare mesh");
    let error = gpu.run(|commands| contours.prepare(commands, &[good], Method::Patches));
    assert_eq!(error.err(), Some(Error::NoPatches));
    let error = gpu.run(|commands| Model::new(commands, &[]));
    assert_eq!(error.err(), Some(Error::NoParts));
    let many = Capacity { placements: u32::MAX, segments: 1 };
    let error = MeshContours::new(&pass, &model, many).expect_err("no binding holds it");
    assert!(matches!(error, Error::TooLarge { .. }), "{error}");
    let error = gpu.run(|commands| {
        let mut content = Content::new(&[&set]);
        content.ends[3].from_vertex = 1 << 20;
        Model::upload(commands, &content)
    });
    assert_eq!(error.err(), Some(Error::Inconsistent { what: "vertices" }));
    support::expect_silence();
}

/// Mesh workgroups may be fewer than task workgroups, and the other way round.
#[test]
fn draws_of_either_kind_have_room() {
    if support::is_without_gpu() {
        return;
    }
    let lower: [fn(&mut Limits); 2] =
        [|limits| limits.mesh_grid = [2, 2], |limits| limits.task_grid = [2, 2]];
    let mesh = shapes::torus_knot(3_000);
    let set = patches(&mesh, Levels::One);
    let all = &placements(&mesh)[..3];
    for lower in lower {
        let gpu = support::gpu_with(Some(lower));
        let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
        let (model, _) =
            gpu.run(|commands| Model::new(commands, &[&set])).expect("there is memory");
        let capacity = Capacity { placements: 3, segments: 20_000 };
        let mut contours = MeshContours::new(&pass, &model, capacity).expect("there is memory");
        for method in [Method::BruteForce, Method::Patches] {
            let (found, _) = by_mesh(&gpu, &pass, &mut contours, all, method);
            Expected::new(&set, all).compare(&found.segments, &format!("{method:?}"));
        }
    }
    support::expect_silence();
}
