//! Extraction with wgpu, and with Vulkan's task and mesh shaders, on every shape and model: the 252 views,
//! directions and viewpoints near the mesh, of instances that are turned, mirrored and stretched.
#![allow(
    clippy::print_stdout,
    reason = "what is left to f32 is to be seen, as `--nocapture` shows it"
)]
#![allow(clippy::cast_possible_truncation, reason = "instances and segments are few")]
#![allow(clippy::duplicate_mod, reason = "supports of either runtime include what both need")]

#[path = "../../crates/ash/tests/support/mod.rs"]
mod mesh_support;
#[path = "../../crates/wgpu/tests/support/mod.rs"]
mod support;

use std::ops::ControlFlow;

use drypoint_ash::{Counting, MeshContours, MeshOptions, MeshPass, MeshStatistics, Queries};
use drypoint_cpu::extract_patches;
use drypoint_fusion::{FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges};
use drypoint_shaders::{BLOCK_PATCHES, Content, EdgePlanes};
use drypoint_tests::{meshes, viewpoints};
use drypoint_wgpu::{Capacity, Contours, Extractor, Gpu, Method, Model, Placement, Segment};
use glam::{DAffine3, DMat3, DVec3, DVec4};
use rayon::prelude::*;

/// Instances in one go. All views at once are more segments than one binding holds.
const INSTANCES: usize = 50;

/// The 252 views and the directions.
const FAR: usize = 300;

/// Viewpoints on, in and beside the surface.
const NEAR: usize = 100;

/// A part that is seen from `viewpoint`, up to rounding, and lies in the scene as it is, turned, as a mirror
/// image, or stretched and slanted.
fn placed((index, viewpoint): (usize, Viewpoint)) -> Placement {
    let turned = DMat3::from_rotation_x(0.3 + index as f64);
    let slanted = DMat3::from_cols_array(&[2.0, 0.3, 0.0, 0.0, 0.5, 0.1, -0.2, 0.0, 3.0]);
    let to_scene = match index % 4 {
        0 => DAffine3::IDENTITY,
        1 => DAffine3::from_mat3(turned),
        2 => DAffine3::from_mat3(turned * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0))),
        _ => DAffine3::from_mat3(slanted),
    };
    let viewpoint = if viewpoint.is_point() {
        Viewpoint::at(to_scene.transform_point3(viewpoint.xyz()))
    } else {
        Viewpoint::from_direction(to_scene.transform_vector3(viewpoint.xyz()))
    };
    Placement { to_scene, viewpoint }
}

/// What the definition says about one view.
struct View {
    placement: Placement,
    /// In the space of the mesh.
    viewpoint: Viewpoint,
    /// Ascending.
    contours: Vec<EdgeId>,
    /// Edges with a face within the margin of f32, ascending.
    doubtful: Vec<EdgeId>,
}

struct Subject<'a> {
    name: &'a str,
    mesh: &'a Mesh,
    adjacency: &'a MeshAdjacency,
    views: Vec<View>,
}

impl<'a> Subject<'a> {
    fn new(name: &'a str, mesh: &'a Mesh, adjacency: &'a MeshAdjacency) -> Self {
        let content = Content::without_patches(mesh, adjacency, EdgeFilter::Convex);
        let edges: Vec<EdgeId> = content.ends.iter().map(|ends| ends.edge).collect();
        let frame = content.frames[0];
        let in_f64 =
            |&edge: &EdgeId| EdgePlanes::in_f64(mesh.positions(), &adjacency.wing(edge), &frame);
        let planes: Vec<[DVec4; 2]> = edges.par_iter().map(in_f64).collect();
        let view = |placement: Placement| {
            let viewpoint = placement.viewpoint_of_part().expect("it has an inverse");
            let seen = frame.viewpoint(viewpoint);
            let is_doubtful = |planes: &[DVec4; 2]| EdgePlanes::is_doubtful(planes, seen);
            let doubtful = edges.iter().zip(&planes).filter(|(_, planes)| is_doubtful(planes));
            let doubtful = doubtful.map(|(edge, _)| *edge).collect();
            let mut contours = Vec::new();
            contour_edges(mesh, adjacency, viewpoint, EdgeFilter::Convex, &mut contours);
            contours.sort_unstable();
            View { placement, viewpoint, contours, doubtful }
        };
        let near = viewpoints::near(mesh, NEAR);
        let viewpoints = [viewpoints::protocol(mesh), viewpoints::orthographic(), near].concat();
        let placements: Vec<_> = viewpoints.into_iter().enumerate().map(placed).collect();
        let views = placements.into_par_iter().map(view).collect();
        Self { name, mesh, adjacency, views }
    }

    fn patches(&self, levels: Levels) -> PatchSet {
        let params = FusionParams { levels, ..FusionParams::FAST };
        let go_on = |_| ControlFlow::Continue(());
        fuse(self.mesh, self.adjacency, EdgeFilter::Convex, &params, &go_on)
            .expect("nothing stops it")
    }

    /// Most segments of the views that are looked at in one go.
    fn most_segments(&self) -> u32 {
        let most = |views: &[View]| views.iter().map(|v| v.contours.len() + v.doubtful.len()).sum();
        let all = self.views.chunks(INSTANCES).map(most);
        all.max().unwrap_or(0usize) as u32
    }

    fn capacity(&self) -> Capacity {
        Capacity { placements: INSTANCES as u32, segments: self.most_segments() }
    }

    /// Compares what wgpu finds by each of `methods`. The number of edges that patches had tested, and of edges
    /// that were found otherwise than the definition has them.
    fn check(
        &self,
        gpu: &Gpu,
        extractor: &Extractor,
        set: &PatchSet,
        methods: &[Method],
    ) -> [u64; 2] {
        let model = Model::new(extractor, &[set]).expect("there is memory");
        let contours = Contours::new(extractor, &model, self.capacity());
        let mut contours = contours.expect("there is memory");
        let (mut edges_tested, mut differing) = (0, 0);
        for views in self.views.chunks(INSTANCES) {
            let placements: Vec<_> = views.iter().map(|view| view.placement).collect();
            for &method in methods {
                let found = support::extract(gpu, extractor, &mut contours, &placements, method);
                differing += self.compare(views, &found.expect("it fits"), &format!("{method:?}"));
            }
            let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
            edges_tested += statistics.edges_tested;
        }
        [edges_tested, differing]
    }

    /// The same of mesh shaders, and that nothing empty is launched or emitted. What was counted.
    fn check_mesh(
        &self,
        gpu: &drypoint_ash::Gpu,
        pass: &MeshPass,
        set: &PatchSet,
        methods: &[Method],
    ) -> MeshStatistics {
        let capacity = self.capacity();
        let (placements, segments) = (capacity.placements, capacity.segments);
        let capacity = drypoint_ash::Capacity { placements, segments };
        let model = gpu.run(|commands| drypoint_ash::Model::new(commands, &[set]));
        let contours = MeshContours::new(pass, &model.expect("there is memory").0, capacity);
        let mut contours = contours.expect("there is memory");
        let mut queries = Queries::new(gpu.device(), Counting::MeshShaders).expect("it can count");
        let mut all = MeshStatistics::default();
        for views in self.views.chunks(INSTANCES) {
            let placements: Vec<_> = views.iter().map(|view| view.placement).collect();
            for &method in methods {
                let extracted = gpu.run(|commands| {
                    contours.prepare(commands, &placements, method)?;
                    queries.begin(commands)?;
                    pass.extract(commands, &contours)?;
                    queries.end(commands)?;
                    contours.download(commands)
                });
                let (found, executed) = extracted.expect("it is drawn");
                let mut segments = found.segments(&executed).expect("it fits");
                segments.sort_unstable();
                self.compare(views, &segments, &format!("mesh shaders, {method:?}"));
                let drawn = found.statistics(&executed).expect("it was counted");
                let counts = queries.read(&executed).expect("it was counted");
                let lanes = u64::from(pass.mesh_width());
                // As many workgroups as were needed, and as many lines as there are contour edges.
                assert_eq!(counts.mesh_invocations, drawn.mesh_workgroups * lanes, "{}", self.name);
                assert_eq!(drawn.found.segments, segments.len() as u64, "{}", self.name);
                // NVIDIA's driver 580 counts no primitives where nothing is drawn.
                if gpu.device().is_software() || counts.primitives > 0 {
                    assert_eq!(counts.primitives, drawn.found.segments, "{}", self.name);
                }
                if method == Method::Patches {
                    self.check_launched(pass, set, &drawn, placements.len());
                    all.found.edges_tested += drawn.found.edges_tested;
                    all.survivors += drawn.survivors;
                    all.mesh_workgroups += drawn.mesh_workgroups;
                    all.idle_mesh_workgroups += drawn.idle_mesh_workgroups;
                }
            }
        }
        all
    }

    /// No more mesh workgroups than survivors, unless patches have more edges than a workgroup; and no more than
    /// are full, but for the last one of each task workgroup.
    fn check_launched(
        &self,
        pass: &MeshPass,
        set: &PatchSet,
        drawn: &MeshStatistics,
        instances: usize,
    ) {
        let share = u64::from(pass.edges_per_workgroup());
        let (launched, edges) = (drawn.mesh_workgroups, drawn.found.edges_tested);
        let content = Content::new(&[set]);
        let largest = content.patches.iter().map(|patch| patch.count).max().unwrap_or(0);
        // Of the procedural books, of hundreds of leaves, one piece fills several workgroups; and so do edges that
        // no patch holds, if there are many.
        let is_full = self.name.starts_with("book") || set.always_tested().len() as u64 > share;
        if u64::from(largest) <= share || !is_full {
            assert!(launched <= drawn.survivors, "{}: {launched} mesh workgroups", self.name);
        }
        let blocks = content.chunks(u32::MAX, u32::MAX);
        let blocks = blocks.first().map_or(0, |chunk| chunk.blocks(BLOCK_PATCHES).len());
        let task_workgroups = match blocks.checked_sub(1) {
            Some(blocks) => (blocks * instances) as u64,
            None => {
                let patches = (content.patches.len() * instances) as u64;
                patches.div_ceil(u64::from(pass.task_width()))
            }
        };
        assert!(launched >= edges.div_ceil(share), "{}", self.name);
        assert!(launched <= edges / share + task_workgroups, "{}", self.name);
    }

    /// Number of edges within the margin that differ, which are listed.
    fn compare(&self, views: &[View], found: &[Segment], what: &str) -> u64 {
        let mut differing = 0;
        let mut by_view = vec![Vec::new(); views.len()];
        for segment in found {
            by_view[segment.placement as usize].push(segment.edge);
        }
        for (view, mut found) in views.iter().zip(by_view) {
            let what = format!("{}, {:?}, {what}", self.name, view.viewpoint);
            found.sort_unstable();
            assert!(found.is_sorted_by(|a, b| a < b), "{what}: an edge is there twice");
            let is_in = |edges: &[EdgeId], edge: &EdgeId| edges.binary_search(edge).is_ok();
            let wrong = |ours: &[EdgeId], others: &[EdgeId]| {
                let lacks = |edge: &&EdgeId| !is_in(others, edge) && !is_in(&view.doubtful, edge);
                ours.iter().find(lacks).copied()
            };
            assert_eq!(wrong(&view.contours, &found), None, "{what}: it is missing");
            assert_eq!(wrong(&found, &view.contours), None, "{what}: it is no contour edge");
            for edge in &view.doubtful {
                if is_in(&found, edge) != is_in(&view.contours, edge) {
                    differing += 1;
                    println!("{what}: edge {} is within the margin and differs", edge.0);
                }
            }
        }
        differing
    }

    /// Edges that the CPU runtime tests, and those of patches that are so close to being culled, or not, that
    /// rounding decides.
    fn tested_on_the_cpu(&self, set: &PatchSet) -> [u64; 2] {
        let content = Content::new(&[set]);
        let mut counts = [0; 2];
        for view in &self.views {
            let statistics = extract_patches(set, view.viewpoint, &mut Vec::new());
            counts[0] += statistics.edges_tested as u64;
            let seen = content.frames[0].viewpoint(view.viewpoint);
            for patch in &content.patches {
                let survives = |growth: f32| {
                    let mut bound = patch.bound;
                    bound.apex_distance = bound.apex_distance * (1.0 + growth) + growth;
                    bound.tan_squared *= 1.0 + growth;
                    bound.may_hold_contour_towards(seen.truncate() - seen.w * bound.center, seen.w)
                };
                if survives(4e-6) != survives(-4e-6) {
                    counts[1] += u64::from(patch.count);
                }
            }
        }
        counts
    }
}

/// Prints what is left to f32, as `cargo test --test gpu -- --nocapture` shows.
#[test]
fn every_shape_and_model_is_as_the_definition_says() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let vulkan = mesh_support::gpu();
    let pass = MeshPass::new(vulkan.device(), &MeshOptions::default()).expect("shaders compile");
    let both = [Method::BruteForce, Method::Patches];
    let result = meshes::for_each("", |name, mesh| {
        let adjacency = MeshAdjacency::new(mesh);
        let subject = Subject::new(name, mesh, &adjacency);
        let contours: usize = subject.views.iter().map(|view| view.contours.len()).sum();
        let doubtful: usize = subject.views.iter().map(|view| view.doubtful.len()).sum();
        let set = subject.patches(Levels::One);
        let [edges_tested, differing] = subject.check(&gpu, &extractor, &set, &both);
        let drawn = subject.check_mesh(&vulkan, &pass, &set, &both);
        let [on_the_cpu, borderline] = subject.tested_on_the_cpu(&set);
        println!(
            "{name}: {contours} contour edges, {doubtful} edges within the margin, {differing} differ; \
             {edges_tested} edges tested, {on_the_cpu} on the CPU, {borderline} of patches on the border; \
             {} mesh workgroups of {} survivors, {} idle",
            drawn.mesh_workgroups, drawn.survivors, drawn.idle_mesh_workgroups
        );
        assert_eq!(drawn.found.edges_tested, edges_tested, "{name}");
        // How wide the margin may be is tested where it is defined. Near viewpoints lie on the surface, and
        // parts with planes are seen along these.
        let far = &subject.views[..FAR.min(subject.views.len())];
        let doubtful: usize = far.iter().map(|view| view.doubtful.len()).sum();
        let edges = set.wings().len() * far.len();
        // Nor of a face that lies upon itself many times, or of parts whose sizes differ by powers of ten.
        let is_wide = ["stack", "mixed-units"].contains(&name);
        assert!(
            edges < 100_000 || is_wide || doubtful * 10 < edges,
            "{name}: {doubtful} of {edges} are doubtful"
        );
        // On the CPU, nothing is culled of a mesh whose squares f32 does not hold: it is not scaled there.
        let is_scaled = !(1e-13..1e17).contains(&set.provenance().unit);
        let more = if is_scaled { 0 } else { on_the_cpu.saturating_sub(edges_tested) };
        // In one frame with a part a billion times its size, a bound is wider than its part.
        let is_one_unit = name != "mixed-units";
        let most = edges_tested.saturating_sub(on_the_cpu).max(more);
        assert!(!is_one_unit || most <= borderline, "{name}");
        // The edges are the same: brute force would do again what it has done.
        let set = subject.patches(Levels::Two);
        subject.check(&gpu, &extractor, &set, &[Method::Patches]);
        subject.check_mesh(&vulkan, &pass, &set, &[Method::Patches]);
        Ok(())
    });
    result.expect("every mesh can be read");
    support::expect_silence();
    mesh_support::expect_silence();
}
