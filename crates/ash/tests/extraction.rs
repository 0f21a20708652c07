//! What is found: on every shape, by task and mesh shaders and by compute shaders.
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]

mod support;

use drypoint_ash::{
    Capacity, Contours, Counting, Counts, Extractor, Gpu, MeshContours, MeshOptions, MeshPass,
    MeshStatistics, Method, Model, Placement, Queries, Segment, Statistics,
};
use drypoint_fusion::{Levels, PatchSet};
use drypoint_mesh::shapes;
use glam::Mat4;
use support::{Expected, gpu, patches, placements};

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
            contours.prepare(pass, commands, placements, method)?;
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
            contours.prepare(extractor, commands, placements, method)?;
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
) {
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
        check_launched(pass, method, (&mesh.counts, &drawn), all, &what);
        assert_eq!(drawn.found, found, "{what}");
    }
}

/// As many mesh workgroups as survivors' edges fill, as many primitives as contour edges.
#[track_caller]
fn check_launched(
    pass: &MeshPass,
    method: Method,
    (counts, drawn): (&Counts, &MeshStatistics),
    all_edges: u64,
    what: &str,
) {
    let lanes = u64::from(pass.edges_per_workgroup());
    let launched = counts.mesh_invocations / lanes;
    assert_eq!(counts.mesh_invocations % lanes, 0, "{what}");
    assert_eq!(counts.primitives, drawn.found.segments, "{what}");
    assert_eq!(launched, drawn.mesh_workgroups, "{what}");
    assert!(launched * lanes >= drawn.found.edges_tested, "{what}");
    if method == Method::BruteForce {
        assert_eq!(launched, all_edges.div_ceil(lanes), "{what}");
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
    for shape in shapes::all() {
        for levels in [Levels::One, Levels::Two] {
            let set = patches(&shape.mesh, levels);
            let what = format!("{}, {levels:?}", shape.name);
            check(&gpu, (&pass, &extractor), &set, &placements(&shape.mesh), &what);
        }
    }
    support::expect_silence();
}
