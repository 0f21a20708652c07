//! `--method wgpu`: contours found and drawn by a GPU.

use std::fmt::Display;

use drypoint_cpu::Statistics;
use drypoint_fusion::PatchSet;
use drypoint_lines::{Camera, Color, Style, filter_for_drawing};
use drypoint_mesh::{EdgeId, Mesh, MeshAdjacency, Viewpoint};
use drypoint_wgpu::{
    Capacity, Contours, DepthOrder, Error, Extractor, Gpu, LineStyle, Lines, Method, Model,
    Picture, Placement, Subject, Surface, View,
};
use glam::{DAffine3, DMat4, DVec3};

use crate::args::{Class, DrawArgs, Hidden, Show};
use crate::output::tell;
use crate::source::Source;

/// Segments that there is room for at first. If there are more, they are found a second time.
const FIRST_CAPACITY: u32 = 1 << 16;

/// The nearest plane that is seen, if the model comes nearer: a fraction of the distance to the farthest.
const NEAREST: f64 = 1e-5;

/// Refuses what the GPU's way of drawing does not know.
pub(crate) fn check(args: &DrawArgs) -> Result<(), String> {
    let only_contours = |lines: &Vec<Class>| lines.iter().all(|class| *class == Class::Contour);
    let lines = &args.lines;
    let refused = [
        (args.show != Show::Lines, "--show: --method wgpu draws lines alone"),
        (args.json, "--json: --method wgpu counts no chains and measures no lengths"),
        (
            !lines.lines.as_ref().is_none_or(only_contours),
            "--lines: --method wgpu draws contours alone",
        ),
        (!matches!(lines.hidden, Hidden::None), "--hidden: --method wgpu leaves hidden lines out"),
        (
            lines.specks.is_some_and(|specks| specks > 0.0),
            "--specks: --method wgpu draws short pieces too",
        ),
    ];
    let first = refused.into_iter().find(|(is_asked_for, _)| *is_asked_for);
    first.map_or(Ok(()), |(_, why)| Err(why.to_owned()))
}

/// Finds the contour edges of `patches` by their ids.
pub(crate) fn extract(
    patches: &PatchSet,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Result<Statistics, String> {
    let found = find(patches, viewpoint).map_err(plain)?;
    contours.clear();
    contours.extend(found.0);
    Ok(found.1)
}

fn find(
    patches: &PatchSet,
    viewpoint: Viewpoint,
) -> Result<(impl Iterator<Item = EdgeId>, Statistics), Error> {
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = Model::new(&extractor, &[patches])?;
    let placement = Placement::at_origin(viewpoint);
    let contours = contours(&gpu, &extractor, &model, &placement, Method::Patches)?;
    let counted = contours.read_statistics(&gpu.queue)?;
    let segments = contours.read_segments(&gpu.queue)?;
    // No more than there are edges.
    let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
    let statistics = Statistics {
        super_patches_tested: count(counted.super_patches_tested),
        super_patches_accepted: count(counted.super_patches_accepted),
        patches_tested: count(counted.patches_tested),
        patches_accepted: count(counted.patches_accepted),
        edges_tested: count(counted.edges_tested),
        contour_edges: count(counted.segments),
    };
    Ok((segments.into_iter().map(|segment| segment.edge), statistics))
}

/// Extracts, in memory that is made larger if not all fits.
fn contours(
    gpu: &Gpu,
    extractor: &Extractor,
    model: &Model,
    placement: &Placement,
    method: Method,
) -> Result<Contours, Error> {
    let mut segments = FIRST_CAPACITY;
    loop {
        let capacity = Capacity { placements: 1, segments };
        let mut contours = Contours::new(extractor, model, capacity)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        contours.prepare(&mut encoder, &[*placement], method)?;
        extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        gpu.queue.submit([encoder.finish()]);
        match contours.read_statistics(&gpu.queue)?.overflow() {
            None => return Ok(contours),
            Some(needed) => segments = u32::try_from(needed).unwrap_or(u32::MAX),
        }
    }
}

/// A PNG of the visible contours. From `patches`, if they are of the edges that a drawing needs.
pub(crate) fn draw(
    source: &Source,
    adjacency: &MeshAdjacency,
    patches: Option<&PatchSet>,
    camera: &Camera,
    style: &Style,
) -> Result<Vec<u8>, String> {
    let mesh = source.mesh();
    let filter = filter_for_drawing(mesh, adjacency, camera.viewpoint());
    let gpu = Gpu::request().map_err(plain)?;
    let upload = || -> Result<_, Error> {
        let extractor = Extractor::new(&gpu.device)?;
        let model = match patches.filter(|patches| patches.edge_filter() == filter) {
            Some(patches) => Model::new(&extractor, &[patches]),
            None => Model::without_patches(&extractor, mesh, adjacency, filter),
        }?;
        Ok((extractor, model))
    };
    let (extractor, model) = upload().map_err(plain)?;
    let pixels = render(&gpu, &extractor, &model, mesh, (camera, style)).map_err(plain)?;
    let (pixel, rest) = pixels.split_at(4);
    if rest.chunks_exact(4).all(|other| other == pixel) {
        tell(&format!("drypoint: no line of {} is visible on the page", source.name));
    }
    encode(&pixels, camera).map_err(plain)
}

/// One frame: red, green, blue and alpha of each pixel.
fn render(
    gpu: &Gpu,
    extractor: &Extractor,
    model: &Model,
    mesh: &Mesh,
    (camera, style): (&Camera, &Style),
) -> Result<Vec<u8>, Error> {
    let page = camera.page();
    let mut picture = Picture::new(&gpu.device, [page.width, page.height], DepthOrder::Reversed)?;
    let (placement, scene_to_clip) = scene(mesh, camera);
    let method = if model.has_patches() { Method::Patches } else { Method::BruteForce };
    let contours = contours(gpu, extractor, model, &placement, method)?;
    let surface = Surface::new(picture.depth_pass(), &contours, &[mesh])?;
    let lines = Lines::new(picture.line_pass(), &contours)?;
    #[expect(clippy::cast_possible_truncation, reason = "rounds")]
    let width = style.width as f32;
    let view = View {
        scene_to_clip: scene_to_clip.as_mat4(),
        background: shares(style.background.unwrap_or(Color::WHITE)),
        lines: LineStyle { width, color: shares(style.color) },
    };
    let subject = Subject { contours: &contours, surface: &surface, lines: &lines };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    picture.draw(&mut encoder, &view, &[subject])?;
    gpu.queue.submit([encoder.finish()]);
    picture.read(&gpu.queue)
}

/// The mesh around the origin and about as large as 1, where f32 is exact, and the matrix from there to
/// clip space.
fn scene(mesh: &Mesh, camera: &Camera) -> (Placement, DMat4) {
    let bounds = mesh.bounds();
    // Vertices are f32, and so is this: what is subtracted from them loses nothing.
    let center = bounds.map_or(DVec3::ZERO, |bounds| bounds.center().as_vec3().as_dvec3());
    let size = bounds.map_or(1.0, |bounds| (bounds.max - bounds.min).as_dvec3().max_element());
    let scale = if size > 0.0 { size.log2().round().clamp(-126.0, 126.0).exp2() } else { 1.0 };
    let to_scene =
        DAffine3::from_scale(DVec3::splat(1.0 / scale)) * DAffine3::from_translation(-center);
    let clip = camera.clip_matrix(depths(mesh, camera)) * DMat4::from(to_scene.inverse());
    let viewpoint = camera.viewpoint();
    if viewpoint.is_point() {
        let viewpoint = Viewpoint::at(to_scene.transform_point3(viewpoint.xyz()));
        // Clip space is homogeneous: distances of the scene rather than the model.
        (Placement { to_scene, viewpoint }, clip * (1.0 / scale))
    } else {
        (Placement { to_scene, viewpoint }, clip)
    }
}

/// The farthest and the nearest depth that are drawn.
fn depths(mesh: &Mesh, camera: &Camera) -> [f64; 2] {
    let depths = mesh.positions().iter().map(|position| camera.depth(position.as_dvec3()));
    let [near, far] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[near, far], depth| {
        [near.min(depth), far.max(depth)]
    });
    if !camera.viewpoint().is_point() {
        let margin = 0.01 * (far - near) + f64::MIN_POSITIVE.max(1e-9 * far.abs());
        return [far + margin, near - margin];
    }
    // If all is behind the eye nothing is seen, whatever they are.
    let far = if far > 0.0 { 1.01 * far } else { 1.0 };
    [far, (0.99 * near).max(NEAREST * far)]
}

fn shares(Color { red, green, blue, alpha }: Color) -> [f32; 4] {
    [red, green, blue, alpha].map(|share| f32::from(share) / 255.0)
}

fn encode(pixels: &[u8], camera: &Camera) -> Result<Vec<u8>, png::EncodingError> {
    let page = camera.page();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, page.width, page.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}

fn plain(error: impl Display) -> String {
    error.to_string()
}
