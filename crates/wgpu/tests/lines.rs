//! Lines on the screen: depth either way, instances and parts, width, and pictures of several samples.

mod support;

use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, shapes};
use drypoint_wgpu::{
    Capacity, Contours, DepthOrder, DepthPass, Error, Extractor, Gpu, LinePass, LineStyle,
    LineTarget, Lines, Method, Model, Picture, Placement, Subject, Surface, View,
};
use glam::dcamera::rh::proj::directx::{orthographic, perspective};
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DAffine3, DMat4, DVec3, Vec3};

const SIDE: u32 = 256;

/// From where and how the scene is seen. Models are about as large as 1.
#[derive(Clone, Copy, Debug)]
struct Look {
    is_orthographic: bool,
    order: DepthOrder,
    style: LineStyle,
}

const LOOK: Look = Look {
    is_orthographic: false,
    order: DepthOrder::Standard,
    style: LineStyle { width: 1.5, color: [0.0, 0.0, 0.0, 1.0] },
};

const EYE: DVec3 = DVec3::new(1.4, 1.1, 2.7);

impl Look {
    fn viewpoint(&self) -> Viewpoint {
        if self.is_orthographic { Viewpoint::from_direction(EYE) } else { Viewpoint::at(EYE) }
    }

    fn scene_to_clip(&self) -> DMat4 {
        let lens = if self.is_orthographic {
            orthographic(-1.3, 1.3, -1.3, 1.3, 0.5, 10.0)
        } else {
            perspective(45f64.to_radians(), 1.0, 0.5, 10.0)
        };
        // z becomes w - z.
        let mut turn = DMat4::IDENTITY;
        if self.order == DepthOrder::Reversed {
            turn.z_axis.z = -1.0;
            turn.w_axis.z = 1.0;
        }
        turn * lens * look_at_mat4(EYE, DVec3::ZERO, DVec3::Y)
    }

    fn view(&self) -> View {
        let scene_to_clip = self.scene_to_clip().as_mat4();
        View { scene_to_clip, background: [1.0; 4], lines: self.style }
    }
}

/// The contours of a mesh, placed wherever `placements` say, found by the time of return.
fn found(gpu: &Gpu, mesh: &Mesh, placements: &[DAffine3], look: &Look) -> Contours {
    let extractor = Extractor::new(&gpu.device).unwrap();
    let adjacency = MeshAdjacency::new(mesh);
    let model = Model::without_patches(&extractor, mesh, &adjacency, EdgeFilter::All).unwrap();
    let capacity = Capacity { placements: 4, segments: 20_000 };
    let mut contours = Contours::new(&extractor, &model, capacity).unwrap();
    let place = |&to_scene: &DAffine3| Placement { to_scene, viewpoint: look.viewpoint() };
    let placements: Vec<_> = placements.iter().map(place).collect();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    contours.prepare(&mut encoder, &placements, Method::BruteForce).unwrap();
    extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
    gpu.queue.submit([encoder.finish()]);
    assert_eq!(contours.read_statistics(&gpu.queue).unwrap().overflow(), None);
    contours
}

/// A picture of meshes, each placed wherever its placements say.
fn draw(gpu: &Gpu, scene: &[(&Mesh, &[DAffine3])], look: &Look) -> Vec<u8> {
    let mut picture = Picture::new(&gpu.device, [SIDE; 2], look.order).unwrap();
    let contours: Vec<_> =
        scene.iter().map(|(mesh, placements)| found(gpu, mesh, placements, look)).collect();
    let surface = |(contours, (mesh, _)): (_, &(&Mesh, _))| {
        Surface::new(picture.depth_pass(), contours, &[*mesh]).unwrap()
    };
    let surfaces: Vec<_> = contours.iter().zip(scene).map(surface).collect();
    let lines = |contours| Lines::new(picture.line_pass(), contours).unwrap();
    let lines: Vec<_> = contours.iter().map(lines).collect();
    let parts = contours.iter().zip(&surfaces).zip(&lines);
    let subjects: Vec<_> = parts
        .map(|((contours, surface), lines)| Subject { contours: contours.into(), surface, lines })
        .collect();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    picture.draw(&mut encoder, &look.view(), &subjects).unwrap();
    gpu.queue.submit([encoder.finish()]);
    picture.read(&gpu.queue).unwrap()
}

/// How much ink is on the page, in pixels of black.
fn ink(pixels: &[u8]) -> f64 {
    pixels.chunks(4).map(|pixel| 1.0 - f64::from(pixel[0]) / 255.0).sum()
}

/// The share of the ink that differs.
#[track_caller]
fn expect_alike(found: &[u8], expected: &[u8], most: f64) {
    let apart = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b)) / 255.0;
    let difference: f64 = found.iter().zip(expected).step_by(4).map(apart).sum();
    assert!(ink(expected) > 100.0, "the page is nearly empty");
    let share = difference / ink(expected);
    assert!(share <= most, "{share} of the ink is elsewhere");
}

/// The mesh that `placements` of `mesh` look like. Mirrors turn faces over, as they do for a viewer.
fn placed(mesh: &Mesh, placements: &[DAffine3]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::<Vec3>::new(), Vec::new());
    for placement in placements {
        let first = u32::try_from(positions.len()).unwrap();
        let place = |p: &Vec3| placement.transform_point3(p.as_dvec3()).as_vec3();
        positions.extend(mesh.positions().iter().map(place));
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|vertex| first + vertex)));
    }
    Mesh::new(positions, triangles).unwrap()
}

fn knot() -> Mesh {
    let scale = DAffine3::from_scale(DVec3::splat(0.25));
    placed(&shapes::torus_knot(6_000), &[scale])
}

#[test]
fn depth_may_run_either_way() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let knot = knot();
    for is_orthographic in [false, true] {
        let [standard, reversed] = [DepthOrder::Standard, DepthOrder::Reversed].map(|order| {
            let look = Look { is_orthographic, order, ..LOOK };
            draw(&gpu, &[(&knot, &[DAffine3::IDENTITY])], &look)
        });
        expect_alike(&standard, &reversed, 0.002);
    }
    support::expect_silence();
}

/// Instances, mirrored and unevenly scaled, that hide one another, and a second model among them.
#[test]
fn instances_are_where_they_are_placed() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let (knot, ball) = (knot(), shapes::icosphere(2_000));
    let turned = DAffine3::from_rotation_y(1.0) * DAffine3::from_scale(DVec3::new(0.8, -0.5, 0.6));
    let of_knot = [DAffine3::from_translation(DVec3::new(-0.4, 0.0, -0.5)), turned];
    let of_ball = [DAffine3::from_scale(DVec3::new(0.3, 0.6, 0.3))];
    let found = draw(&gpu, &[(&knot, &of_knot), (&ball, &of_ball)], &LOOK);
    let (knots, balls) = (placed(&knot, &of_knot), placed(&ball, &of_ball));
    let here = [DAffine3::IDENTITY];
    expect_alike(&found, &draw(&gpu, &[(&knots, &here), (&balls, &here)], &LOOK), 0.005);
    support::expect_silence();
}

/// The outline of a cube seen along its diagonal is a hexagon of known length.
#[test]
fn ink_is_length_times_width() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let cube = placed(&shapes::cube(), &[DAffine3::from_scale(DVec3::splat(0.5))]);
    let mut contours_length = 0.0;
    let look = Look { is_orthographic: true, ..LOOK };
    let adjacency = MeshAdjacency::new(&cube);
    let mut contours = Vec::new();
    drypoint_mesh::contour_edges(
        &cube,
        &adjacency,
        look.viewpoint(),
        EdgeFilter::All,
        &mut contours,
    );
    for edge in &contours {
        let [from, to] = adjacency.wing(*edge).ends().map(|vertex| {
            let position = cube.position(vertex).as_dvec3();
            look.scene_to_clip().project_point3(position).truncate()
        });
        contours_length += 0.5 * f64::from(SIDE) * from.distance(to);
    }
    for width in [0.25f32, 0.5, 1.0, 1.5, 2.0, 4.0] {
        let look = Look { style: LineStyle { width, ..LOOK.style }, ..look };
        let pixels = draw(&gpu, &[(&cube, &[DAffine3::IDENTITY])], &look);
        let expected = contours_length * f64::from(width);
        let share = ink(&pixels) / expected;
        assert!((0.96..1.04).contains(&share), "{width}: {share} of what is expected");
    }
    support::expect_silence();
}

fn texture(
    gpu: &Gpu,
    format: wgpu::TextureFormat,
    sample_count: u32,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

/// What a texture of bytes holds when all that is in `encoder` is done.
fn read(gpu: &Gpu, mut encoder: wgpu::CommandEncoder, texture: &wgpu::Texture) -> Vec<u8> {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * SIDE * SIDE),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * SIDE),
        rows_per_image: None,
    };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| result.unwrap());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    buffer.slice(..).get_mapped_range().unwrap().to_vec()
}

/// A pass that clears and draws depth.
fn begin_depth<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    depth: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    let attachment = wgpu::RenderPassDepthStencilAttachment {
        view: depth,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(LOOK.order.cleared()),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(attachment),
        ..Default::default()
    })
}

/// A pass that clears to white, draws with several samples and resolves them.
fn begin_color<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    samples: &wgpu::TextureView,
    resolved: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    let attachment = wgpu::RenderPassColorAttachment {
        view: samples,
        depth_slice: None,
        resolve_target: Some(resolved),
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
            store: wgpu::StoreOp::Store,
        },
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment)],
        ..Default::default()
    })
}

/// Into a picture of the caller's, with four samples a pixel, and the caller's own depth.
#[test]
fn lines_go_into_pictures_of_several_samples() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let mesh = knot();
    let (color, depth_format) = (wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Depth24Plus);
    let depth = texture(&gpu, depth_format, 1, wgpu::TextureUsages::TEXTURE_BINDING);
    let samples = texture(&gpu, color, 4, wgpu::TextureUsages::empty());
    let resolved = texture(&gpu, color, 1, wgpu::TextureUsages::COPY_SRC);
    let [depth, samples, resolved_view] =
        [&depth, &samples, &resolved].map(|texture| texture.create_view(&Default::default()));

    let contours = found(&gpu, &mesh, &[DAffine3::IDENTITY], &LOOK);
    let mut depth_pass = DepthPass::new(&gpu.device, depth_format, LOOK.order).unwrap();
    let surface = Surface::new(&depth_pass, &contours, &[&mesh]).unwrap();
    let mut line_pass = LinePass::new(&gpu.device, color, 4).unwrap();
    let lines = Lines::new(&line_pass, &contours).unwrap();
    let target = LineTarget::new(&line_pass, &depth, LOOK.order).unwrap();

    let scene_to_clip = LOOK.scene_to_clip().as_mat4();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    depth_pass.prepare(&mut encoder, scene_to_clip).unwrap();
    line_pass.prepare(&mut encoder, scene_to_clip, &LOOK.style).unwrap();
    depth_pass.record(&mut begin_depth(&mut encoder, &depth), &surface, &contours);
    line_pass.cover(&mut encoder, &target, &[&lines]);
    line_pass.ink(&mut begin_color(&mut encoder, &samples, &resolved_view), &target);
    let found = read(&gpu, encoder, &resolved);
    expect_alike(&found, &draw(&gpu, &[(&mesh, &[DAffine3::IDENTITY])], &LOOK), 0.01);
    support::expect_silence();
}

#[test]
fn what_does_not_fit_is_an_error() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu_with(&|limits| limits.max_texture_dimension_2d = 2048);
    let size = Picture::new(&gpu.device, [2049, 1], LOOK.order).unwrap_err();
    assert_eq!(size, Error::PictureSize { width: 2049, height: 1, limit: 2048 });
    assert!(Picture::new(&gpu.device, [0, 9], LOOK.order).is_err());
    let picture = Picture::new(&gpu.device, [9, 9], LOOK.order).unwrap();
    let contours = found(&gpu, &shapes::cube(), &[DAffine3::IDENTITY], &LOOK);
    let of = |meshes: &[&Mesh]| Surface::new(picture.depth_pass(), &contours, meshes);
    assert_eq!(of(&[&shapes::icosphere(100)]).unwrap_err(), Error::OtherMeshes);
    assert_eq!(of(&[]).unwrap_err(), Error::OtherMeshes);
    let formats = [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba32Uint];
    let [color, numbers] = formats.map(|format| LinePass::new(&gpu.device, format, 1));
    color.unwrap();
    assert!(matches!(numbers.unwrap_err(), Error::Refused { .. }));
    support::expect_silence();
}
