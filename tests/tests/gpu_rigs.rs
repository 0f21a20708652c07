//! Extraction of rigs with wgpu, of every model that moves: at sampled times of every animation, and at rest.
#![allow(
    clippy::print_stdout,
    reason = "what is left to f32 is to be seen, as `--nocapture` shows it"
)]
#![allow(clippy::cast_possible_truncation, reason = "instances and segments are few")]
#![allow(clippy::duplicate_mod, reason = "supports include what all need")]

#[path = "../../shaders/tests/support/rigs.rs"]
mod rigs;
#[path = "../../crates/wgpu/tests/support/mod.rs"]
mod support;

use drypoint_cpu::extract_patches;
use drypoint_mesh::io;
use drypoint_mesh::rig::Pose;
use drypoint_mesh::{EdgeFilter, Viewpoint};
use drypoint_tests::models;
use drypoint_wgpu::{
    Extractor, Gpu, Method, Placement, RigCapacity, RigContours, RigInstance, RigModel,
};
use glam::DVec3;
use rayon::prelude::*;
use rigs::{Expected, Subject};

/// Times of each animation.
const TIMES: u32 = 9;

/// Instances in one go.
const INSTANCES: usize = 16;

/// At rest, and at times from the first key of each animation to its last.
fn poses(subject: &Subject) -> Vec<Pose> {
    let rig = &subject.rig;
    let mut poses = vec![rig.rest()];
    for (index, animation) in rig.animations().iter().enumerate() {
        for time in 0..TIMES {
            let share = f64::from(time) / f64::from(TIMES - 1);
            poses.push(rig.pose_at(index, share * animation.duration()));
        }
    }
    poses
}

/// From afar, from close by, from inside, and a direction.
fn viewpoints(subject: &Subject, pose: &Pose, turn: usize) -> Vec<Viewpoint> {
    let mesh = subject.rig.mesh(pose).expect("it is somewhere");
    let bounds = mesh.bounds().expect("it is not empty");
    let (center, size) = (bounds.center(), bounds.half_longest_side());
    let angle = 0.7 * turn as f64;
    let direction = DVec3::new(angle.cos(), 0.3 * angle.sin(), angle.sin());
    vec![
        Viewpoint::at(center + 4.0 * size * direction),
        Viewpoint::at(center + 0.3 * size * direction),
        Viewpoint::from_direction(direction),
    ]
}

/// Edges that patches have tested on a processor, and those that rounding decides.
fn tested_on_the_cpu(subject: &Subject, instance: &RigInstance<'_>) -> [u64; 2] {
    let mut counts = [subject.skin.loose().len() as u64, 0];
    for part in subject.skin.parts() {
        let set = &subject.patches[part.shape as usize];
        let to_scene = &instance.pose.to_scene[part.carrier as usize];
        let carried = instance.placement.viewpoint.carried_into(to_scene);
        let Some(viewpoint) = carried else {
            // Of a part that is flattened, the GPU culls nothing or next to nothing: rounding decides.
            counts[1] += set.wings().len() as u64;
            continue;
        };
        counts[0] += extract_patches(set, viewpoint, &mut Vec::new()).edges_tested as u64;
        let frame = drypoint_shaders::Frame::new(set.positions().iter().copied());
        let seen = frame.viewpoint(viewpoint);
        for patch in set.patches() {
            let survives = |growth: f32| {
                let mut bound = frame.bound(&patch.bound);
                bound.apex_distance = bound.apex_distance * (1.0 + growth) + growth;
                bound.tan_squared *= 1.0 + growth;
                bound.may_hold_contour_towards(seen.truncate() - seen.w * bound.center, seen.w)
            };
            if survives(4e-6) != survives(-4e-6) {
                counts[1] += u64::from(patch.edge_count);
            }
        }
    }
    counts
}

/// Compares what is found with the definition, and prints what is left to f32.
fn check(gpu: &Gpu, extractor: &Extractor, subject: &Subject) {
    let Subject { name, rig, skin, patches } = subject;
    let model = RigModel::new(extractor, rig, skin, patches).expect("there is memory");
    let segments = (skin.adjacency().wings().len() * INSTANCES) as u32;
    let room = RigCapacity { instances: INSTANCES as u32, segments };
    let mut contours = RigContours::new(extractor, &model, room).expect("there is memory");
    let poses = poses(subject);
    let instances: Vec<RigInstance<'_>> = poses
        .iter()
        .enumerate()
        .flat_map(|(turn, pose)| {
            let see = |viewpoint| RigInstance { pose, placement: Placement::at_origin(viewpoint) };
            viewpoints(subject, pose, turn).into_iter().map(see)
        })
        .collect();
    let [mut sure, mut doubtful, mut differing, mut all] = [0; 4];
    let [mut tested, mut on_the_cpu, mut borderline] = [0; 3];
    for instances in instances.chunks(INSTANCES) {
        let expected: Vec<Expected> = instances
            .par_iter()
            .map(|instance| Expected::new(subject, model.layout(), instance))
            .collect();
        for method in [Method::BruteForce, Method::Patches] {
            let of = (&mut contours, skin);
            let found =
                support::extract_rig(gpu, extractor, of, instances, method).expect("it fits");
            for (expected, (found, instance)) in expected.iter().zip(found.iter().zip(instances)) {
                let what = format!("{name}, {:?}, {method:?}", instance.placement.viewpoint);
                let here = expected.compare(found, &what);
                if here > 0 {
                    println!("{what}: {here} edges are within the margin and differ");
                }
                differing += here;
                sure += expected.sure.len();
                doubtful += expected.doubtful_count();
                all += skin.edges(EdgeFilter::All).count();
            }
        }
        let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
        tested += statistics.edges_tested;
        for instance in instances {
            let [sure, unsure] = tested_on_the_cpu(subject, instance);
            on_the_cpu += sure;
            borderline += unsure;
        }
    }
    println!(
        "{name}: {} parts of {} shapes, {} loose edges, {:.3} rigid; {} poses; {sure} contour edges are sure, \
         {doubtful} of {all} edges within the margin, {differing} differ; {tested} edges tested, {on_the_cpu} \
         on the CPU, {borderline} on the border",
        skin.parts().len(),
        skin.shapes().len(),
        skin.loose().len(),
        skin.rigid_share(),
        poses.len(),
    );
    assert!(tested.abs_diff(on_the_cpu) <= borderline, "{name}");
    assert!(doubtful * 20 < all, "{name}: the margin would hide anything");
}

#[test]
fn every_model_that_moves_is_as_the_definition_says() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    for path in &models::files().expect("the folder of models is there") {
        if path.extension().is_none_or(|extension| extension != "glb") {
            continue;
        }
        let model = io::read(path).expect("it can be read");
        if let Some(rig) = model.rig {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            check(&gpu, &extractor, &Subject::new(&name, rig));
        }
    }
    support::expect_silence();
}
