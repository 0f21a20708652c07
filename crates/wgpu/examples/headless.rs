//! Draws the contours of a model to a PNG, without a window: `headless [MODEL.obj] [OUT.png]`.
#![allow(clippy::print_stdout, reason = "the counts are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, io, shapes};
use drypoint_wgpu::{
    Capacity, Contours, DepthOrder, Extractor, Gpu, LineStyle, Lines, Method, Model, Picture,
    Placement, Subject, Surface, View,
};
use glam::DVec3;
use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let mesh = match args.next() {
        Some(path) => io::read(path.as_ref()).map_err(|error| format!("{path}: {error}"))?.mesh,
        None => shapes::torus_knot(20_000),
    };
    let path = args.next().unwrap_or("contours.png".to_owned());

    // Once for each mesh, or loaded from a patch file.
    let adjacency = MeshAdjacency::new(&mesh);
    let go_on = |_| ControlFlow::Continue(());
    let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on)?;

    // Once: pipelines, memory, a picture.
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = Model::new(&extractor, &[&patches])?;
    let capacity = Capacity { placements: 1, segments: 100_000 };
    let mut contours = Contours::new(&extractor, &model, capacity)?;
    let mut picture = Picture::new(&gpu.device, [1000, 1000], DepthOrder::Standard)?;
    let surface = Surface::new(picture.depth_pass(), &contours, &[&mesh])?;
    let lines = Lines::new(picture.line_pass(), &contours)?;

    // Each frame: where to look from, and what the GPU is to do.
    let bounds = mesh.bounds().ok_or("the mesh is empty")?;
    let (center, size) = (bounds.center(), (bounds.max - bounds.min).as_dvec3().length());
    let eye = center + size * DVec3::new(0.8, 0.6, 1.5);
    let lens = perspective(30f64.to_radians(), 1.0, 0.1 * size, 10.0 * size);
    let scene_to_clip = (lens * look_at_mat4(eye, center, DVec3::Y)).as_mat4();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    contours.prepare(&mut encoder, &[Placement::at_origin(Viewpoint::at(eye))], Method::Patches)?;
    extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
    let subject = Subject { contours: (&contours).into(), surface: &surface, lines: &lines };
    picture.draw(&mut encoder, &view, &[subject])?;
    gpu.queue.submit([encoder.finish()]);

    println!("{}: {:?}", gpu.name(), contours.read_statistics(&gpu.queue)?);
    let mut png = png::Encoder::new(std::fs::File::create(path)?, 1000, 1000);
    png.set_color(png::ColorType::Rgba);
    png.write_header()?.write_image_data(&picture.read(&gpu.queue)?)?;
    Ok(())
}
