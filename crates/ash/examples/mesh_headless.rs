//! Draws the contours of a model to a PNG in one pass of mesh shaders: `mesh_headless [MODEL.obj] [OUT.png]`.
#![allow(clippy::print_stdout, reason = "the counts are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;

use drypoint_ash::{
    Capacity, DepthOrder, Gpu, LineStyle, MeshContours, Method, Model, Picture, Placement, Subject,
    Surface, View,
};
use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, io, shapes};
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
    let ((picture, mut contours, surface), _) = gpu.run(|commands| {
        let picture = Picture::new(commands, [1000, 1000], DepthOrder::Standard)?;
        let model = Model::new(commands, &[&patches])?;
        let capacity = Capacity { placements: 1, segments: 0 };
        let contours = MeshContours::new(picture.mesh_pass(), &model, capacity)?;
        let surface = Surface::new(commands, &contours, &[&mesh])?;
        Ok((picture, contours, surface))
    })?;

    // Each frame: where to look from, and what the GPU is to do.
    let bounds = mesh.bounds().ok_or("the mesh is empty")?;
    let (center, size) = (bounds.center(), (bounds.max - bounds.min).as_dvec3().length());
    let eye = center + size * DVec3::new(0.8, 0.6, 1.5);
    let lens = perspective(30f64.to_radians(), 1.0, 0.1 * size, 10.0 * size);
    let scene_to_clip = (lens * look_at_mat4(eye, center, DVec3::Y)).as_mat4();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let placement = Placement::at_origin(Viewpoint::at(eye));
    let ((pixels, found), executed) = gpu.run(|commands| {
        contours.prepare(commands, &[placement], Method::Patches)?;
        let subject = Subject { contours: (&contours).into(), surface: &surface };
        let pixels = picture.draw(commands, &view, &[subject])?;
        Ok((pixels, contours.download(commands)?))
    })?;

    println!("{}: {:#?}", gpu.device().name(), found.statistics(&executed)?);
    let mut png = png::Encoder::new(std::fs::File::create(path)?, 1000, 1000);
    png.set_color(png::ColorType::Rgba);
    png.write_header()?.write_image_data(&pixels.read(&executed)?)?;
    Ok(())
}
