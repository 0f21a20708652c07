//! Contours of rigs, against the definition on posed vertices.
#![allow(
    clippy::print_stdout,
    reason = "what is left to f32 is to be seen, as `--nocapture` shows it"
)]
#![allow(clippy::cast_possible_truncation, reason = "rigs of tests are small")]

#[path = "../../../shaders/tests/support/rigs.rs"]
mod rigs;
mod support;

use drypoint_fusion::Levels;
use drypoint_mesh::rig::Pose;
use drypoint_mesh::{EdgeFilter, Viewpoint};
use drypoint_wgpu::{
    Capacity, Contours, DepthOrder, Error, Extractor, ExtractorOptions, Gpu, LineStyle, Lines,
    Method, Model, Picture, PlacedContours, Placement, RigCapacity, RigContours, RigInstance,
    RigModel, Subject as Drawn, Surface, View,
};
use fastrand::Rng;
use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};
use glam::{DAffine3, DVec3};
use rigs::{Expected, Subject, assembly, is_flat, placements, poses, subjects, tube, viewpoints};
use support::{expect_silence, extract_rig, gpu, gpu_with, patches};

fn capacity(subject: &Subject, instances: usize) -> RigCapacity {
    let edges = subject.skin.adjacency().wings().len();
    RigCapacity { instances: instances as u32, segments: (edges * instances) as u32 }
}

/// Extracts all poses from some viewpoints with both methods and compares both. Returns edges within the margin
/// that differ.
#[track_caller]
fn check(
    gpu: &Gpu,
    extractor: &Extractor,
    subject: &Subject,
    poses: &[Pose],
    rng: &mut Rng,
) -> usize {
    let Subject { name, rig, skin, patches } = subject;
    let model = RigModel::new(extractor, rig, skin, patches).expect("there is memory");
    let edges = skin.edges(EdgeFilter::All).count();
    assert_eq!(model.edge_count(), edges as u64, "{name}");
    // Room for one more than there are, since placements are laid out by room.
    let room = capacity(subject, 2 * poses.len() + 1);
    let mut contours = RigContours::new(extractor, &model, room).expect("there is memory");
    let mut differing = 0;
    for viewpoint in viewpoints(rng) {
        let instances: Vec<_> = poses
            .iter()
            .flat_map(|pose| placements(viewpoint).map(|placement| RigInstance { pose, placement }))
            .collect();
        let expected: Vec<_> = instances
            .iter()
            .map(|instance| Expected::new(subject, model.layout(), instance))
            .collect();
        for method in [Method::BruteForce, Method::Patches] {
            let found = extract_rig(gpu, extractor, (&mut contours, skin), &instances, method);
            for (index, (expected, found)) in
                expected.iter().zip(found.expect("it fits")).enumerate()
            {
                let what = format!("{name}, pose {}, {viewpoint:?}, {method:?}", index / 2);
                differing += expected.compare(&found, &what);
            }
            let statistics = contours.read_statistics(&gpu.queue).expect("the device is there");
            let all = (edges * instances.len()) as u64;
            match method {
                Method::BruteForce => assert_eq!(statistics.edges_tested, all, "{name}"),
                Method::Patches => assert!(statistics.edges_tested <= all, "{name}"),
            }
        }
    }
    differing
}

#[test]
fn every_rig_is_as_the_definition_says() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mut rng = Rng::with_seed(21);
    for subject in subjects() {
        let (flat, usual): (Vec<Pose>, Vec<Pose>) =
            poses(&subject.rig, &mut rng).into_iter().partition(is_flat);
        let differing =
            [usual, flat].map(|poses| check(&gpu, &extractor, &subject, &poses, &mut rng));
        println!(
            "{}: {} edges within the margin differ, {} more of flattened poses",
            subject.name, differing[0], differing[1]
        );
    }
    expect_silence();
}

/// Rows of 3 workgroups: tiles of vertices, faces, edges and instances.
#[test]
fn work_beyond_the_limits_is_split() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu_with(&|limits| limits.max_compute_workgroups_per_dimension = 3);
    let options = ExtractorOptions { width: 32 };
    let extractor = Extractor::with_options(&gpu.device, &options).expect("shaders compile");
    let mut rng = Rng::with_seed(22);
    for (name, rig) in [("tube", tube(24, 40, 1.0)), ("assembly", assembly())] {
        let subject = Subject::new(name, rig);
        let mut poses = poses(&subject.rig, &mut rng);
        poses.retain(|pose| !is_flat(pose));
        check(&gpu, &extractor, &subject, &poses, &mut rng);
    }
    expect_silence();
}

/// Both ends of each segment are where the definition poses them, in the scene.
#[test]
fn segments_are_where_the_scene_has_them() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mut rng = Rng::with_seed(23);
    for subject in subjects().iter().filter(|subject| subject.name != "far tube") {
        let Subject { name, rig, skin, patches } = subject;
        let model = RigModel::new(&extractor, rig, skin, patches).expect("there is memory");
        let room = capacity(subject, 9);
        let mut contours = RigContours::new(&extractor, &model, room).expect("there is memory");
        let placed = PlacedContours::new(&extractor, &contours).expect("there is memory");
        let viewpoint = Viewpoint::at(DVec3::new(7.0, 3.0, 1.0));
        let poses = poses(rig, &mut rng);
        let [_, moved] = placements(viewpoint);
        let instances: Vec<_> =
            poses.iter().map(|pose| RigInstance { pose, placement: moved }).collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        contours.prepare(&mut encoder, &instances, Method::Patches).expect("it fits");
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            extractor.record_rig(&mut pass, &contours);
            placed.record(&extractor, &mut pass, &contours);
        }
        gpu.queue.submit([encoder.finish()]);
        let segments = contours.read_segments(&gpu.queue).expect("it fits");
        let placed = placed.read(&gpu.queue, &contours).expect("it fits");
        assert_eq!(segments.is_empty(), name == "nothing");
        for (segment, placed) in segments.iter().zip(&placed) {
            let found = contours.edge(skin, segment);
            let pose = &poses[found.instance as usize];
            let ends = skin.adjacency().wing(found.edge).ends();
            let ends =
                ends.map(|end| moved.to_scene.transform_point3(rig.position(end, pose)).as_vec3());
            let ours = [placed.from_position, placed.to_position];
            let is_there = |ends: [glam::Vec3; 2]| {
                let size = ends[0].length() + ends[1].length() + 1.0;
                ours[0].distance(ends[0]).max(ours[1].distance(ends[1])) < 1e-5 * size
            };
            // Shapes and rigs may name the ends of an edge in either order.
            assert!(is_there(ends) || is_there([ends[1], ends[0]]), "{name}: {ends:?} {ours:?}");
        }
    }
    expect_silence();
}

#[test]
fn poses_that_cannot_be_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let subject = Subject::new("tube", tube(12, 10, 0.0));
    let Subject { rig, skin, patches, .. } = &subject;
    let model = RigModel::new(&extractor, rig, skin, patches).expect("there is memory");
    let other = Subject::new("assembly", assembly());
    for patches in [&patches[..1], &other.patches] {
        let error = RigModel::new(&extractor, rig, skin, patches).expect_err("they are others");
        assert_eq!(error, Error::OtherPatches);
    }
    let room = capacity(&subject, 2);
    let mut contours = RigContours::new(&extractor, &model, room).expect("there is memory");
    let good = rig.rest();
    let fewer = Pose { to_scene: good.to_scene[..1].to_vec(), ..good.clone() };
    let mut infinite = good.clone();
    infinite.to_scene[1].translation.y = f64::INFINITY;
    let placement = Placement::at_origin(Viewpoint::at(DVec3::new(3.0, 4.0, 5.0)));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let seen = |pose| RigInstance { pose, placement };
    let flattened =
        RigInstance { pose: &good, placement: Placement { to_scene: flat, ..placement } };
    let once =
        extract_rig(&gpu, &extractor, (&mut contours, skin), &[seen(&good)], Method::Patches);
    let once = once.expect("it fits");
    assert!(!once[0].is_empty());
    for (instances, error) in [
        (vec![seen(&good); 3], Error::TooManyInstances { given: 3, capacity: 2 }),
        (vec![seen(&good), flattened], Error::SingularInstance { instance: 1 }),
        (vec![seen(&good), seen(&fewer)], Error::OtherPose { instance: 1 }),
        (vec![seen(&infinite)], Error::InfinitePose { instance: 0 }),
    ] {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        assert_eq!(contours.prepare(&mut encoder, &instances, Method::Patches), Err(error));
        assert_eq!(contours.instance_count(), 0);
        // There is nothing to record: what was found stays.
        extractor.record_rig(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        gpu.queue.submit([encoder.finish()]);
        let still = contours.read_segments(&gpu.queue).expect("it fits");
        assert_eq!(still.len(), once[0].len());
    }
    let many = RigCapacity { instances: u32::MAX, ..room };
    let error = RigContours::new(&extractor, &model, many).expect_err("no binding holds it");
    assert!(matches!(error, Error::TooLarge { .. }), "{error}");
    let tight = RigCapacity { segments: once[0].len() as u32 - 1, ..room };
    let mut contours = RigContours::new(&extractor, &model, tight).expect("there is memory");
    let found =
        extract_rig(&gpu, &extractor, (&mut contours, skin), &[seen(&good)], Method::Patches);
    let (needed, capacity) = (once[0].len() as u64, tight.segments);
    assert_eq!(found, Err(Error::Overflow { needed, capacity }));
    expect_silence();
}

/// A rig is drawn in two poses as its meshes in these are.
// Long because one picture is drawn in two ways, with all that either needs.
#[test]
fn pictures_of_rigs_are_those_of_their_meshes() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let mut rng = Rng::with_seed(24);
    let eye = DVec3::new(1.0, 3.0, 9.0);
    let lens = perspective(60f64.to_radians(), 1.0, 0.5, 50.0);
    let scene_to_clip = (lens * look_at_mat4(eye, DVec3::ZERO, DVec3::Y)).as_mat4();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let order = DepthOrder::Standard;
    let mut picture = Picture::new(&gpu.device, [400; 2], order).expect("there is memory");
    for subject in subjects().iter().filter(|subject| !subject.name.contains("far")) {
        let Subject { name, rig, skin, patches: shapes } = subject;
        if name == "nothing" {
            continue;
        }
        let all = poses(rig, &mut rng);
        let [pose, other] = [&all[1], &all[2]];
        let placement = |x: f64| Placement {
            to_scene: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
            viewpoint: Viewpoint::at(eye),
        };
        let instances = [(pose, -2.0), (other, 2.0)];
        let rigged: Vec<_> =
            instances.map(|(pose, x)| RigInstance { pose, placement: placement(x) }).to_vec();
        let model = RigModel::new(&extractor, rig, skin, shapes).expect("there is memory");
        let room = capacity(subject, 3);
        let mut contours = RigContours::new(&extractor, &model, room).expect("there is memory");
        let surface =
            Surface::of_rig(picture.depth_pass(), &contours, skin).expect("it is its own");
        let lines = Lines::new(picture.line_pass(), &contours).expect("the device is there");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        contours.prepare(&mut encoder, &rigged, Method::Patches).expect("it fits");
        extractor.record_rig(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        let drawn = Drawn { contours: (&contours).into(), surface: &surface, lines: &lines };
        picture.draw(&mut encoder, &view, &[drawn]).expect("the device is there");
        gpu.queue.submit([encoder.finish()]);
        let ours = picture.read(&gpu.queue).expect("the device is there");

        let meshes = instances.map(|(pose, _)| rig.mesh(pose).expect("it is a mesh"));
        let mut parts = Vec::new();
        for (mesh, (_, x)) in meshes.iter().zip(instances) {
            let set = patches(mesh, Levels::One);
            let model = Model::new(&extractor, &[&set]).expect("there is memory");
            let capacity = Capacity { placements: 1, segments: room.segments };
            let mut contours = Contours::new(&extractor, &model, capacity).expect("it fits");
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            contours.prepare(&mut encoder, &[placement(x)], Method::Patches).expect("it fits");
            extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
            gpu.queue.submit([encoder.finish()]);
            let surface = Surface::new(picture.depth_pass(), &contours, &[mesh]).expect("it is");
            let lines = Lines::new(picture.line_pass(), &contours).expect("the device is there");
            parts.push((contours, surface, lines));
        }
        let drawn: Vec<_> = parts
            .iter()
            .map(|(contours, surface, lines)| Drawn { contours: contours.into(), surface, lines })
            .collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        picture.draw(&mut encoder, &view, &drawn).expect("the device is there");
        gpu.queue.submit([encoder.finish()]);
        let theirs = picture.read(&gpu.queue).expect("the device is there");

        let dark = |pixels: &[u8]| pixels.chunks(4).filter(|pixel| pixel[0] < 128).count();
        let differing = ours.chunks(4).zip(theirs.chunks(4));
        let differing = differing.filter(|(a, b)| a[0].abs_diff(b[0]) > 40).count();
        let ink = dark(&theirs);
        println!("{name}: {ink} dark pixels, {differing} differ");
        assert!(ink > 200 && differing * 50 < ink, "{name}: {differing} of {ink} pixels differ");
    }
    // Of another rig.
    let [one, other] =
        [Subject::new("tube", tube(12, 10, 0.0)), Subject::new("assembly", assembly())];
    let model = RigModel::new(&extractor, &one.rig, &one.skin, &one.patches).expect("it fits");
    let contours = RigContours::new(&extractor, &model, capacity(&one, 1)).expect("it fits");
    let error = Surface::of_rig(picture.depth_pass(), &contours, &other.skin).err();
    assert_eq!(error, Some(Error::OtherMeshes));
    expect_silence();
}
