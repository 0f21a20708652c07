//! Draws an animated glTF model at a time, in seconds, and a moment later, to a PNG, without a window: `rigged
//! [MODEL.glb SECONDS] [OUT.png]`. Without a model, two knots that bend.
#![allow(clippy::print_stdout, reason = "the counts are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, fuse_shapes};
use drypoint_mesh::rig::{Influence, Pose, Rig, RigBuilder, Skin};
use drypoint_mesh::{EdgeFilter, Viewpoint, io, shapes};
use drypoint_wgpu::{
    DepthOrder, Extractor, Gpu, LineStyle, Lines, Method, Picture, Placement, RigCapacity,
    RigContours, RigInstance, RigModel, Subject, Surface, View,
};
use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};
use glam::{DAffine3, DVec3, Vec3};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (model, path) = match args.split_last() {
        Some((last, model)) if last.ends_with(".png") => (model, last.as_str()),
        _ => (&args[..], "contours.png"),
    };
    let (rig, seconds) = match model {
        [] => (knot(), 0.3),
        [model, seconds] => {
            let rig = io::read(model.as_ref())
                .map_err(|error| format!("{model}: {error}"))?
                .rig
                .ok_or("nothing in the model moves")?;
            (rig, seconds.parse()?)
        }
        _ => return Err("rigged [MODEL.glb SECONDS] [OUT.png]".into()),
    };

    // Once for each rig: its rigid parts, and patches of what keeps its shape.
    let skin = Skin::new(&rig)?;
    let go_on = |_| ControlFlow::Continue(());
    let patches = fuse_shapes(&skin, EdgeFilter::All, &FusionParams::FAST, &go_on)?;

    // Once: pipelines, memory, a picture.
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = RigModel::new(&extractor, &rig, &skin, &patches)?;
    let capacity = RigCapacity { instances: 2, segments: 200_000 };
    let mut contours = RigContours::new(&extractor, &model, capacity)?;
    let mut picture = Picture::new(&gpu.device, [1000, 1000], DepthOrder::Standard)?;
    let surface = Surface::of_rig(picture.depth_pass(), &contours, &skin)?;
    let lines = Lines::new(picture.line_pass(), &contours)?;

    // Each frame: poses, where to look from, and what the GPU is to do. The second comes a moment later.
    let poses = [seconds, seconds + 0.25].map(|seconds| pose(&rig, seconds));
    let mesh = rig.mesh(&poses[0])?;
    let bounds = mesh.bounds().ok_or("the model is empty")?;
    let (center, size) = (bounds.center(), (bounds.max - bounds.min).as_dvec3().length());
    let eye = center + size * DVec3::new(0.8, 0.6, 2.5);
    let lens = perspective(30f64.to_radians(), 1.0, 0.1 * size, 10.0 * size);
    let scene_to_clip = (lens * look_at_mat4(eye, center, DVec3::Y)).as_mat4();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let viewpoint = Viewpoint::at(eye);
    let instances = [(&poses[0], -0.3), (&poses[1], 0.3)].map(|(pose, x)| {
        let to_scene = DAffine3::from_translation(DVec3::new(x * size, 0.0, 0.0));
        RigInstance { pose, placement: Placement { to_scene, viewpoint } }
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    contours.prepare(&mut encoder, &instances, Method::Patches)?;
    extractor.record_rig(&mut encoder.begin_compute_pass(&Default::default()), &contours);
    let subject = Subject { contours: (&contours).into(), surface: &surface, lines: &lines };
    picture.draw(&mut encoder, &view, &[subject])?;
    gpu.queue.submit([encoder.finish()]);

    println!("{}: {:?}", gpu.name(), contours.read_statistics(&gpu.queue)?);
    let mut png = png::Encoder::new(std::fs::File::create(path)?, 1000, 1000);
    png.set_color(png::ColorType::Rgba);
    png.write_header()?.write_image_data(&picture.read(&gpu.queue)?)?;
    Ok(())
}

/// By the first animation, or with every other carrier turned.
fn pose(rig: &Rig, seconds: f64) -> Pose {
    if !rig.animations().is_empty() {
        return rig.pose_at(0, seconds);
    }
    let mut pose = rig.rest();
    for to_scene in pose.to_scene.iter_mut().skip(1).step_by(2) {
        *to_scene *= DAffine3::from_rotation_z(2.0 * seconds);
    }
    pose
}

/// A knot whose upper part follows one carrier and whose lower part another, with a bend between them.
fn knot() -> Rig {
    let mut builder = RigBuilder::default();
    let carriers = [0, 1].map(|mesh| builder.carrier(None, Some(mesh)));
    let mesh = shapes::torus_knot(20_000);
    let mut vertex = |&position: &Vec3| {
        let share = f64::from(position.y + 0.5).clamp(0.0, 1.0);
        let influences = [(carriers[0], 1.0 - share), (carriers[1], share)];
        let influences =
            influences.map(|(carrier, weight)| Influence { carrier, weight, position });
        let used: Vec<_> = influences.into_iter().filter(|i| i.weight > 0.0).collect();
        builder.vertex(&used, &[])
    };
    let vertices: Vec<u32> = mesh.positions().iter().map(&mut vertex).collect();
    for triangle in mesh.triangles() {
        builder.triangle(triangle.map(|corner| vertices[corner as usize]));
    }
    builder.finish()
}
