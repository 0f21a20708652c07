//! Fusing real and hostile meshes: nothing is lost, nothing depends on threads.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use drypoint_fusion::{
    Cancelled, CostModel, FuseError, FusionParams, InvalidPatches, Levels, Method, PatchSet,
    Progress, SphereKind, ViewProfile, fuse,
};
use drypoint_mesh::{
    EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges, is_contour, shapes,
};
use glam::{DVec3, Vec3};

/// Every preset, and settings that nobody should choose.
const ALL_PARAMS: [FusionParams; 16] = [
    FusionParams::FAST,
    FusionParams::DEFAULT,
    FusionParams::BEST,
    FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT },
    FusionParams { views: ViewProfile::NEAR, ..FusionParams::FAST },
    FusionParams { cost: CostModel::CPU_SIMD, ..FusionParams::DEFAULT },
    FusionParams { cost: CostModel::MESH_SHADER, ..FusionParams::DEFAULT },
    FusionParams { cost: CostModel::GPU, ..FusionParams::DEFAULT },
    FusionParams {
        method: Method::Planes { cell: 0, looks: 0, sweeps: 2, tears: 1 },
        ..FusionParams::FAST
    },
    FusionParams::PAPER,
    FusionParams::PAPER_MEAN,
    FusionParams::PAPER.with_max_partition(None),
    greedy(SphereKind::Mean, 3, Some(64)),
    greedy(SphereKind::Reduced, 0, Some(0)),
    with_cost(0.5, 1.0),
    with_cost(20.0, 1000.0),
];

const fn with_cost(patch_test: f64, view_distance: f64) -> FusionParams {
    FusionParams {
        cost: CostModel { patch_test, ..CostModel::PAPER },
        views: ViewProfile::at(view_distance),
        ..FusionParams::PAPER
    }
}

const fn greedy(sphere: SphereKind, cache_size: u32, max_partition: Option<u32>) -> FusionParams {
    let method = Method::Greedy { sphere, cache_size, max_partition };
    FusionParams { method, ..FusionParams::PAPER }
}

const FILTERS: [EdgeFilter; 2] = [EdgeFilter::Convex, EdgeFilter::All];

fn fuse_silently(mesh: &Mesh, filter: EdgeFilter, params: &FusionParams) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    fuse(mesh, &adjacency, filter, params, &|_| ControlFlow::Continue(())).unwrap()
}

/// Viewpoints near and far, in planes of faces, on vertices, and orthographic ones.
fn viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return vec![Viewpoint::at(DVec3::ONE)] };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let directions = (0..20).map(|i| {
        // A spiral from pole to pole.
        let (z, turn) = (f64::from(i) / 9.5 - 1.0, 2.4 * f64::from(i));
        DVec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
    });
    let mut viewpoints = Vec::new();
    for direction in directions {
        viewpoints.extend(
            [0.3, 1.01, 2.0, 10.0, 1000.0].map(|d| Viewpoint::at(center + unit * d * direction)),
        );
        viewpoints.push(Viewpoint::from_direction(direction));
    }
    for (i, &triangle) in
        mesh.triangles().iter().enumerate().step_by(1 + mesh.triangles().len() / 12)
    {
        let [a, b, c] = triangle.map(|v| mesh.position(v).as_dvec3());
        let slide = 3.0 + i as f64 % 5.0;
        viewpoints.extend([a, a + slide * (b - a), b - slide * (c - b)].map(Viewpoint::at));
    }
    viewpoints
}

/// Fuses, and compares with the definition what is left after culling.
#[track_caller]
fn check(name: &str, mesh: &Mesh, filter: EdgeFilter, params: &FusionParams) {
    let adjacency = MeshAdjacency::new(mesh);
    let set = fuse(mesh, &adjacency, filter, params, &|_| ControlFlow::Continue(())).unwrap();
    let context = format!("{name}, {filter:?}, {params:?}");
    assert_eq!(set.validate(), Ok(()), "{context}");
    assert_eq!(set.validate_against(mesh, &adjacency), Ok(()), "{context}");

    let mut expected = Vec::new();
    for viewpoint in viewpoints(mesh) {
        contour_edges(mesh, &adjacency, viewpoint, filter, &mut expected);
        let survivors = set.patches().iter().filter(|p| p.bound.may_hold_contour(viewpoint));
        let places = survivors.flat_map(|patch| patch.edges()).chain(set.always_tested());
        let mut found: Vec<EdgeId> = places
            .map(|place| place as usize)
            .filter(|&place| is_contour(set.positions(), &set.wings()[place], viewpoint))
            .map(|place| set.edge_ids()[place])
            .collect();
        found.sort_unstable();
        assert_eq!(found, expected, "{context}, from {viewpoint:?}");
    }
}

#[test]
fn no_contour_edge_is_culled_on_any_shape() {
    for shape in shapes::all() {
        for filter in FILTERS {
            check(shape.name, &shape.mesh, filter, &FusionParams::PAPER);
            check(shape.name, &shape.mesh, filter, &FusionParams::PAPER_MEAN);
            check(shape.name, &shape.mesh, filter, &FusionParams::DEFAULT);
        }
    }
}

/// Ours is cheaper than the published method, and looking harder makes it cheaper still.
#[test]
fn presets_keep_their_order() {
    for name in ["bumpy-sphere", "torus-knot", "cad-part"] {
        let mesh = shapes::by_name(name, 4_000).unwrap();
        let cost = |params: &FusionParams| {
            fuse_silently(&mesh, EdgeFilter::Convex, params).expected_cost()
        };
        let costs = [
            FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT },
            FusionParams::BEST,
            FusionParams::DEFAULT,
            FusionParams::FAST,
            FusionParams::PAPER,
        ]
        .map(|params| cost(&params));
        // Where little is to be gained, luck decides the last percent.
        let is_in_order = costs.windows(2).all(|pair| pair[0] < 1.01 * pair[1]);
        assert!(is_in_order && costs[0] < 0.95 * costs[4], "{name}: {costs:?}");
    }
}

/// Whatever the method, no patch holds more than a mesh shader's workgroup can emit.
#[test]
fn limits_are_kept() {
    let mesh = shapes::by_name("bumpy-sphere", 4_000).unwrap();
    let dear = CostModel { patch_test: 20.0, ..CostModel::MESH_SHADER };
    let paper = FusionParams { cost: dear, ..FusionParams::PAPER };
    let ours = FusionParams { cost: dear, ..FusionParams::DEFAULT };
    for (params, filter) in [(paper, EdgeFilter::All), (ours, EdgeFilter::All)] {
        let set = fuse_silently(&mesh, filter, &params);
        let most_edges = set.patches().iter().map(|patch| patch.edge_count).max().unwrap();
        let vertices = set.patches().iter().map(|patch| {
            let edges = patch.edges().start as usize..patch.edges().end as usize;
            let mut ends: Vec<u32> = set.wings()[edges].iter().flat_map(|w| w.ends()).collect();
            ends.sort_unstable();
            ends.dedup();
            ends.len()
        });
        let most_vertices = vertices.max().unwrap();
        assert!(most_edges <= 126 && most_vertices <= 64, "{most_edges} {most_vertices}");
        assert!(most_edges > 40, "the limits are not what keeps them small");
    }
}

/// Super-patches follow one another without a gap, and cull what their patches cull together.
#[test]
fn super_patches_save_patch_tests() {
    let mesh = shapes::by_name("bumpy-sphere", 20_000).unwrap();
    let params = FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT };
    let set = fuse_silently(&mesh, EdgeFilter::Convex, &params);
    let viewpoint = Viewpoint::at(DVec3::new(3.0, 8.0, 5.0));
    let held: u32 = set.super_patches().iter().map(|group| group.patch_count).sum();
    assert_eq!(held, set.always_tested_patches().start);
    let mut tested = set.always_tested_patches().len() + set.super_patches().len();
    for group in set.super_patches() {
        let patches = &set.patches()[group.first_patch as usize..][..group.patch_count as usize];
        if group.bound.may_hold_contour(viewpoint) {
            tested += patches.len();
        } else {
            assert!(patches.iter().all(|patch| {
                let edges = patch.edges().start as usize..patch.edges().end as usize;
                set.wings()[edges].iter().all(|w| !is_contour(set.positions(), w, viewpoint))
            }));
        }
    }
    assert!(2 * tested < set.patches().len(), "{tested} of {}", set.patches().len());
}

#[test]
fn no_settings_lose_an_edge() {
    for name in ["icosphere", "cad-part", "open-grid", "book", "zero-area-fan", "one-triangle"] {
        let mesh = shapes::by_name(name, 60).unwrap();
        for params in &ALL_PARAMS {
            for filter in FILTERS {
                check(name, &mesh, filter, params);
            }
        }
    }
}

/// Two slivers on either side of an edge, which is a patch of its own: their planes pass through the
/// middle of the bound, and what their normals are off by, times the edge, is all that there is.
#[test]
fn slivers_are_within_their_bounds() {
    let cost = CostModel { patch_test: 0.1, ..CostModel::PAPER };
    let params = FusionParams { cost, ..FusionParams::FAST };
    let mut patches = 0;
    for i in 1..2_000u16 {
        let share = |step: f32| (step * f32::from(i)).fract();
        let head = Vec3::new(1.0 + share(0.618), share(0.755), share(0.57));
        // Beside the edge by what they are rounded by.
        let positions = vec![Vec3::ZERO, head, 0.3 * head, 0.7 * head];
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [1, 0, 3]]).unwrap();
        let set = fuse_silently(&mesh, EdgeFilter::All, &params);
        assert_eq!(set.validate(), Ok(()), "{head}");
        patches += set.patches().len();
    }
    assert!(patches > 100, "{patches}");
}

#[test]
fn what_has_no_plane_is_always_tested() {
    let collinear = (0..9u8).map(|i| Vec3::splat(f32::from(i))).collect();
    let all_degenerate = Mesh::new(collinear, (0..7).map(|i| [i, i + 1, i + 2]).collect()).unwrap();
    let one_point = Mesh::new(vec![Vec3::ONE; 3], vec![[0, 1, 2]]).unwrap();
    for mesh in [all_degenerate, one_point, shapes::empty(), shapes::one_triangle()] {
        for filter in FILTERS {
            check("degenerate", &mesh, filter, &FusionParams::PAPER);
            let set = fuse_silently(&mesh, filter, &FusionParams::PAPER);
            assert!(set.patches().is_empty());
            assert!(set.expected_cost().is_finite() && set.summary().mean_half_angle == 0.0);
        }
    }
}

/// Neither the unit of a mesh nor its place changes its patches.
#[test]
fn scale_and_place_change_nothing() {
    let mesh = shapes::bumpy_sphere(2_000);
    let set = fuse_silently(&mesh, EdgeFilter::Convex, &FusionParams::PAPER);
    let larger = mesh.positions().iter().map(|p| *p * 1024.0).collect();
    let larger = Mesh::new(larger, mesh.triangles().to_vec()).unwrap();
    let larger = fuse_silently(&larger, EdgeFilter::Convex, &FusionParams::PAPER);
    assert_eq!(larger.edge_ids(), set.edge_ids());
    let sizes = |set: &PatchSet| set.patches().iter().map(|p| p.edge_count).collect::<Vec<_>>();
    assert_eq!(sizes(&larger), sizes(&set));
    assert!((larger.expected_cost() - set.expected_cost()).abs() < 1e-3);
}

/// Culling nothing would pass every other test.
#[test]
fn a_ball_is_mostly_culled() {
    let mesh = shapes::icosphere(20_000);
    for params in [FusionParams::PAPER, FusionParams::PAPER_MEAN] {
        let set = fuse_silently(&mesh, EdgeFilter::Convex, &params);
        let edges = set.wings().len() as f64;
        assert!(set.patches().len() as f64 > 0.01 * edges && set.always_tested().len() < 20);
        assert!(set.expected_cost() < 0.35 * edges, "{} of {edges}", set.expected_cost());
        let survivors = |viewpoint: Viewpoint| {
            let survive = |p: &&drypoint_fusion::Patch| p.bound.may_hold_contour(viewpoint);
            set.patches().iter().filter(survive).map(|p| p.edge_count).sum::<u32>()
        };
        let tested = survivors(Viewpoint::at(DVec3::new(3.0, 4.0, 9.0)));
        assert!(f64::from(tested) < 0.3 * edges, "{tested} of {edges}");
    }
}

/// A patch that is dearer than its edges is none: they are always tested.
#[test]
fn no_patch_is_in_vain() {
    let paper = FusionParams::PAPER.with_max_partition(Some(40));
    // Pieces that are cut off, and costs that the published method knows nothing of.
    let short = CostModel { max_edges: 7, max_vertices: 5, ..CostModel::PAPER };
    let blocks = CostModel { accepted_patch: 4.0, block: 32, ..CostModel::PAPER };
    let in_blocks = FusionParams { cost: blocks, ..FusionParams::PAPER };
    for params in [
        paper,
        FusionParams { cost: short, ..FusionParams::PAPER },
        in_blocks,
        FusionParams { levels: Levels::Two, ..in_blocks },
        FusionParams { cost: CostModel::MESH_SHADER, ..FusionParams::DEFAULT },
    ] {
        let set = fuse_silently(&shapes::bumpy_sphere(3_000), EdgeFilter::Convex, &params);
        // Below a super-patch, three in ten are tested.
        let tested = if params.levels == Levels::Two { 0.3 } else { 1.0 };
        let cost = CostModel { patch_test: tested * params.cost.patch_test, ..params.cost };
        for patch in set.patches() {
            let acceptance = params.views.acceptance(&patch.bound, set.provenance().unit);
            let expected = cost.patch(acceptance, patch.edges().len());
            assert!(expected < f64::from(patch.edge_count), "{params:?}: {expected}, {patch:?}");
        }
        assert!(!set.patches().is_empty() && !set.always_tested().is_empty(), "{params:?}");
    }
}

#[test]
fn any_number_of_threads_makes_the_same_bytes() {
    let mesh = shapes::bumpy_sphere(4_000);
    let two_levels = FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT };
    let few_tears = Method::Planes { cell: 32, looks: 2, sweeps: 1, tears: 3 };
    for params in [
        greedy(SphereKind::Mean, 50, Some(256)),
        greedy(SphereKind::Reduced, 50, Some(256)),
        FusionParams::FAST,
        two_levels,
        FusionParams { method: few_tears, ..FusionParams::BEST },
    ] {
        let with_threads = |count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            pool.install(|| fuse_silently(&mesh, EdgeFilter::Convex, &params).to_bytes())
        };
        assert_eq!(with_threads(1), with_threads(8));
    }
}

#[test]
fn the_memory_of_partners_changes_nothing() {
    let mesh = shapes::torus_knot(1_500);
    let with_cache = |cache_size| {
        let params = greedy(SphereKind::Reduced, cache_size, Some(4096));
        let set = fuse_silently(&mesh, EdgeFilter::All, &params);
        (set.patches().to_vec(), set.edge_ids().to_vec())
    };
    let plain = with_cache(u32::MAX / 4);
    for cache_size in [1, 2, 7, 50] {
        assert_eq!(with_cache(cache_size), plain);
    }
}

#[test]
fn progress_comes_to_an_end() {
    let mesh = shapes::bumpy_sphere(3_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let two_levels = FusionParams { levels: Levels::Two, ..FusionParams::BEST };
    for params in
        [FusionParams::PAPER.with_max_partition(Some(500)), FusionParams::FAST, two_levels]
    {
        check_progress(&mesh, &adjacency, &params);
    }
}

#[track_caller]
fn check_progress(mesh: &Mesh, adjacency: &MeshAdjacency, params: &FusionParams) {
    let (calls, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let before_last = AtomicUsize::new(0);
    let edges = adjacency.edges(EdgeFilter::Convex).count();
    let on_progress = |progress: Progress| {
        calls.fetch_add(1, Ordering::Relaxed);
        let before = most.fetch_max(progress.edges_done, Ordering::Relaxed);
        before_last.fetch_max(before, Ordering::Relaxed);
        assert!(progress.edges == edges && progress.edges_done <= edges);
        assert!((0.0..=1.0).contains(&progress.fraction()));
        ControlFlow::Continue(())
    };
    fuse(mesh, adjacency, EdgeFilter::Convex, params, &on_progress).unwrap();
    assert_eq!(most.into_inner(), edges);
    assert!(calls.into_inner() > 5);
    // The last call but one: what is left to the end is little.
    assert!(before_last.into_inner() * 10 > edges * 8);
}

#[test]
fn a_break_ends_it_at_once() {
    let mesh = shapes::bumpy_sphere(60_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let whole = FusionParams::PAPER.with_max_partition(None);
    for (last, params) in [
        (0, whole),
        (1, whole),
        (20, whole),
        (20, FusionParams::DEFAULT),
        (200, FusionParams::BEST),
    ] {
        let calls = AtomicUsize::new(0);
        let on_progress = |_| {
            if calls.fetch_add(1, Ordering::Relaxed) < last {
                return ControlFlow::Continue(());
            }
            ControlFlow::Break(())
        };
        let result = fuse(&mesh, &adjacency, EdgeFilter::All, &params, &on_progress);
        assert_eq!(result, Err(FuseError::Cancelled(Cancelled)));
        // Others may be about to call when one is told to stop.
        assert!(calls.into_inner() <= last + rayon::current_num_threads() + 1);
    }
}

#[test]
fn another_mesh_is_noticed() {
    let mesh = shapes::icosphere(300);
    let set = fuse_silently(&mesh, EdgeFilter::Convex, &FusionParams::PAPER);
    let other = shapes::icosphere(1_000);
    assert_eq!(
        set.validate_against(&other, &MeshAdjacency::new(&other)),
        Err(InvalidPatches::AnotherMesh)
    );
}

/// Needles that share a tip at which no normal can be trusted.
#[test]
fn needles_are_bounded_as_they_are_checked() {
    for inner in [1e-7f32, 1e-9, 1e-11, 1e-20] {
        let ring = |radius: f32| {
            (0..40u8).map(move |i| {
                let (sin, cos) = (f32::from(i) * std::f32::consts::TAU / 40.0).sin_cos();
                Vec3::new(radius * cos, radius * sin, 0.1 * radius * cos * cos)
            })
        };
        let triangles = (0..40u32).flat_map(|i| {
            let j = (i + 1) % 40;
            [[i, 40 + i, 40 + j], [i, 40 + j, j]]
        });
        let mesh = Mesh::new(ring(inner).chain(ring(1.0)).collect(), triangles.collect()).unwrap();
        for params in [FusionParams::FAST, FusionParams::DEFAULT, FusionParams::PAPER] {
            let set = fuse_silently(&mesh, EdgeFilter::All, &params);
            assert_eq!(set.validate(), Ok(()), "{inner}");
        }
    }
}
