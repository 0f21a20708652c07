//! What is drawn: the same by mesh shaders as by compute shaders, with the id and the class of each edge.
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]
#![allow(unsafe_code, reason = "a renderer's own image is made of raw handles")]

#[path = "support/raw.rs"]
mod raw;
mod support;

use std::collections::BTreeMap;

use ash::vk;
use drypoint_ash::{
    Attached, Canvas, Capacity, Commands, Contours, Counting, DepthOrder, Error, Extractor, Gpu,
    LinePass, LineStyle, MeshContours, MeshOptions, MeshOutput, MeshPass, Method, Model, Offscreen,
    Picture, Placement, Queries, Subject, Surface, View,
};
use drypoint_fusion::{Levels, PatchSet};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, contour_edges, shapes};
use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};
use glam::{DAffine3, DVec3, Mat4};
use support::{gpu, patches};

const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;
const SIZE: [u32; 2] = [300, 200];

const ATTACHED: Attached = Attached { color: FORMAT, depth: None };

/// Three instances beside one another, and the matrix to clip space.
fn scene() -> (Vec<Placement>, Mat4) {
    let eye = DVec3::new(1.0, 2.0, 9.0);
    let place = |x: f64| Placement {
        to_scene: DAffine3::from_translation(DVec3::new(x, 0.0, 0.2 * x)),
        viewpoint: Viewpoint::at(eye),
    };
    let lens = perspective(0.8, f64::from(SIZE[0]) / f64::from(SIZE[1]), 1.0, 30.0);
    let scene_to_clip = (lens * look_at_mat4(eye, DVec3::ZERO, DVec3::Y)).as_mat4();
    ([-2.5, 0.0, 2.5].map(place).to_vec(), scene_to_clip)
}

fn model(gpu: &Gpu, set: &PatchSet) -> Model {
    gpu.run(|commands| Model::new(commands, &[set])).expect("there is memory").0
}

const CAPACITY: Capacity = Capacity { placements: 3, segments: 20_000 };

/// Lines of one pixel by compute shaders and an indirect draw: pixels, and how many lines.
fn lines_in_two_passes(gpu: &Gpu, model: &Model, method: Method) -> (Vec<[u8; 4]>, u64) {
    let (placements, scene_to_clip) = scene();
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let pass = LinePass::new(gpu.device(), &ATTACHED).expect("shaders compile");
    let mut queries = Queries::new(gpu.device(), Counting::Compute).expect("it can count");
    let mut contours = Contours::new(&extractor, model, CAPACITY).expect("there is memory");
    let (pixels, (mut contours, found), executed) = raw::render(
        gpu,
        (FORMAT, SIZE),
        |commands| {
            contours.prepare(commands, &placements, method)?;
            extractor.record(commands, &contours)?;
            pass.prepare(commands, scene_to_clip, &LineStyle::default())?;
            let found = contours.download(commands)?;
            Ok((contours, found))
        },
        |rendering, (contours, _)| pass.record(rendering, contours),
    );
    let lines = found.segments(&executed).expect("they fit").len() as u64;
    // Counted outside of rendering: once more, drawing nothing.
    let (_, executed) = gpu
        .run(|commands| {
            contours.prepare(commands, &placements, method)?;
            queries.begin(commands)?;
            extractor.record(commands, &contours)?;
            queries.end(commands)
        })
        .expect("it is found");
    let counts = queries.read(&executed).expect("it was counted");
    assert!(counts.compute_invocations > 0 && counts.vertex_invocations == 0);
    assert!(counts.seconds.is_none_or(|seconds| seconds > 0.0));
    (pixels, lines)
}

/// The same by mesh shaders.
fn lines_in_one_pass(
    gpu: &Gpu,
    model: &Model,
    method: Method,
    output: MeshOutput<'_>,
) -> (Vec<[u8; 4]>, u64) {
    let (placements, scene_to_clip) = scene();
    let options = MeshOptions { output, records: false, ..MeshOptions::default() };
    let pass = MeshPass::new(gpu.device(), &options).expect("shaders compile");
    let mut contours = MeshContours::new(&pass, model, CAPACITY).expect("there is memory");
    let (pixels, contours, _) = raw::render(
        gpu,
        (FORMAT, SIZE),
        |commands| {
            contours.prepare(commands, &placements, method)?;
            pass.prepare(commands, scene_to_clip, &LineStyle::default())?;
            Ok(contours)
        },
        |rendering, contours| pass.record(rendering, contours),
    );
    let (found, executed) = gpu.run(|commands| contours.download(commands)).expect("it is copied");
    let statistics = found.statistics(&executed).expect("it was counted");
    (pixels, statistics.found.segments)
}

#[test]
fn both_pipelines_draw_the_same_lines() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    for levels in [Levels::One, Levels::Two] {
        let model = model(&gpu, &patches(&shapes::torus_knot(3_000), levels));
        let mut all = Vec::new();
        for method in [Method::BruteForce, Method::Patches] {
            all.push(lines_in_two_passes(&gpu, &model, method));
            all.push(lines_in_one_pass(&gpu, &model, method, MeshOutput::Lines(ATTACHED)));
        }
        let (pixels, lines) = &all[0];
        let inked = pixels.iter().filter(|pixel| pixel[3] > 0).count();
        assert!(inked > 500 && inked < 20_000, "{inked} pixels, {lines} lines");
        for (index, other) in all.iter().enumerate() {
            assert_eq!(other.1, *lines, "{index}");
            assert!(other.0 == *pixels, "{index}: other pixels");
        }
    }
    support::expect_silence();
}

/// Writes the id of an edge and its class.
const NUMBERS: &str = "enable wgpu_mesh_shader;

struct Line {
    @per_primitive @location(0) @interpolate(flat) edge: u32,
    @per_primitive @location(1) @interpolate(flat) edge_class: u32,
}

@fragment
fn fragment(line: Line) -> @location(0) vec4f {
    let edge = line.edge + 1u;
    return vec4f(f32(edge & 255u), f32((edge >> 8u) & 255u), f32(edge >> 16u), f32(line.edge_class + 1u)) / 255.0;
}
";

#[test]
fn primitives_carry_the_id_and_the_class_of_their_edge() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let adjacency = MeshAdjacency::new(&mesh);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let mut seen = BTreeMap::new();
    for placement in scene().0 {
        let mut edges = Vec::new();
        let viewpoint = placement.viewpoint_of_part().expect("it has an inverse");
        contour_edges(&mesh, &adjacency, viewpoint, EdgeFilter::All, &mut edges);
        seen.extend(edges.into_iter().map(|edge| (edge.0, adjacency.class(edge) as u32)));
    }
    for method in [Method::BruteForce, Method::Patches] {
        let output = MeshOutput::Custom(ATTACHED, NUMBERS);
        let (pixels, _) = lines_in_one_pass(&gpu, &model, method, output);
        let mut drawn = BTreeMap::new();
        for [red, green, blue, alpha] in pixels.into_iter().filter(|pixel| *pixel != [0; 4]) {
            let edge = u32::from_le_bytes([red, green, blue, 0]) - 1;
            drawn.insert(edge, u32::from(alpha) - 1);
        }
        assert!(drawn.len() > 100, "{} edges are seen", drawn.len());
        let classes: std::collections::BTreeSet<_> = drawn.values().collect();
        assert!(classes.len() > 1, "there are several classes");
        for (edge, class) in drawn {
            assert_eq!(seen.get(&edge), Some(&class), "edge {edge}");
        }
    }
    support::expect_silence();
}

#[test]
fn fragment_shaders_that_bind_or_are_not_there_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let binding = "@group(0) @binding(0) var<uniform> color: vec4f;
        @fragment fn fragment() -> @location(0) vec4f { return color; }";
    let other = "@fragment fn other() -> @location(0) vec4f { return vec4f(); }";
    let far =
        "@fragment fn fragment(@location(7) x: f32) -> @location(0) vec4f { return vec4f(x); }";
    let whole = "@fragment fn fragment() -> @location(0) vec4u { return vec4u(); }";
    for (source, why) in [
        (binding, "binds"),
        (other, "no fragment entry point"),
        ("fn", "expected"),
        (far, "reads something else"),
        (whole, "gives something else"),
    ] {
        let output = MeshOutput::Custom(ATTACHED, source);
        let options = MeshOptions { output, ..MeshOptions::default() };
        let error = MeshPass::new(gpu.device(), &options).expect_err("it is refused");
        assert!(error.to_string().contains(why), "{error}");
    }
    support::expect_silence();
}

/// Strokes in a picture, by either pipeline.
fn strokes(gpu: &Gpu, model: &Model, mesh: &Mesh, by_mesh: bool, method: Method) -> Vec<u8> {
    let (placements, scene_to_clip) = scene();
    let style = LineStyle { width: 3.0, color: [0.8, 0.1, 0.2, 0.7] };
    let view = View { scene_to_clip, background: [0.9, 0.95, 1.0, 1.0], lines: style };
    let (pixels, executed) = gpu
        .run(|commands| {
            let picture = Picture::new(commands, SIZE, DepthOrder::Standard)?;
            if by_mesh {
                let pass = picture.mesh_pass();
                let mut contours = MeshContours::new(pass, model, CAPACITY)?;
                let surface = Surface::new(commands, &contours, &[mesh])?;
                contours.prepare(commands, &placements, method)?;
                let subject = Subject { contours: (&contours).into(), surface: &surface };
                picture.draw(commands, &view, &[subject])
            } else {
                let extractor = Extractor::new(gpu.device())?;
                let mut contours = Contours::new(&extractor, model, CAPACITY)?;
                let surface = Surface::new(commands, &contours, &[mesh])?;
                contours.prepare(commands, &placements, method)?;
                extractor.record(commands, &contours)?;
                let subject = Subject { contours: (&contours).into(), surface: &surface };
                picture.draw(commands, &view, &[subject])
            }
        })
        .expect("it is drawn");
    pixels.read(&executed).expect("it was drawn by these")
}

#[test]
fn both_pipelines_draw_the_same_strokes() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let model = model(&gpu, &patches(&mesh, Levels::Two));
    let reference = strokes(&gpu, &model, &mesh, false, Method::BruteForce);
    let inked = reference.chunks(4).filter(|pixel| pixel[2] < 200).count();
    assert!(inked > 1_000, "{inked} pixels");
    for (by_mesh, method) in
        [(false, Method::Patches), (true, Method::BruteForce), (true, Method::Patches)]
    {
        let other = strokes(&gpu, &model, &mesh, by_mesh, method);
        let differ = reference.iter().zip(&other).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(differ <= Some(2), "{by_mesh}, {method:?}: {differ:?}");
    }
    support::expect_silence();
}

#[test]
fn what_does_not_fit_together_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let lines = MeshOptions { output: MeshOutput::Lines(ATTACHED), ..MeshOptions::default() };
    let lines = MeshPass::new(gpu.device(), &lines).expect("shaders compile");
    let contours = MeshContours::new(&lines, &model, CAPACITY).expect("there is memory");
    // Nothing is drawn by it, but it is not for that.
    let (mut prepared, placement) = (contours, scene().0[0]);
    let error = gpu.run(|commands| {
        prepared.prepare(commands, &[placement], Method::Patches)?;
        lines.extract(commands, &prepared)
    });
    assert!(matches!(error.expect_err("it draws"), Error::OtherAttachments { .. }));
    let narrow = MeshOptions { mesh_width: Some(16), ..MeshOptions::default() };
    let narrow = MeshPass::new(gpu.device(), &narrow).expect("shaders compile");
    let error = gpu.run(|commands| {
        prepared.prepare(commands, &[placement], Method::Patches)?;
        narrow.extract(commands, &prepared)
    });
    assert_eq!(error.expect_err("other workgroups"), Error::OtherPass);
    let error = gpu.run(|commands| lines.extract(commands, &prepared));
    assert_eq!(error.expect_err("in other commands"), Error::Unprepared);
    let error = gpu.run(|commands| Surface::new(commands, &prepared, &[&shapes::icosphere(500)]));
    assert_eq!(error.expect_err("another mesh"), Error::OtherMeshes);
    let error = gpu.run(|commands| Picture::new(commands, [0, 5], DepthOrder::Standard));
    assert!(matches!(error.expect_err("no pixels"), Error::PictureSize { .. }));
    let other = support::gpu();
    let error = other.run(|commands| Surface::new(commands, &prepared, &[&mesh]));
    assert!(matches!(error.expect_err("another device"), Error::OtherDevice { .. }));
    let error = Contours::new(&Extractor::new(other.device()).unwrap(), &model, CAPACITY);
    assert!(matches!(error.expect_err("another device"), Error::OtherDevice { .. }));
    let ((), executed) = gpu.run(|_| Ok(())).expect("nothing is done");
    let (found, _) = gpu
        .run(|commands| {
            prepared.prepare(commands, &[placement], Method::Patches)?;
            prepared.download(commands)
        })
        .expect("it is copied");
    let error = found.statistics(&executed).expect_err("other commands");
    assert!(matches!(error, Error::OtherCommands { .. }));
    support::expect_silence();
}

/// What safe code can get wrong, and the GPU must not hear of.
#[test]
fn what_was_never_executed_or_made_for_others_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let set = patches(&mesh, Levels::One);
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let (placements, scene_to_clip) = scene();
    let style = LineStyle::default();
    let view = View { scene_to_clip, background: [1.0; 4], lines: style };
    let mut leaked = None;
    let stop = gpu.run(|commands| {
        leaked = Some((Model::new(commands, &[&set])?, Offscreen::new(commands, SIZE)?));
        Err::<(), _>(Error::NoPatches)
    });
    assert_eq!(stop.err(), Some(Error::NoPatches));
    let (never, offscreen) = leaked.expect("it was made");
    let error = Contours::new(&extractor, &never, CAPACITY).expect_err("it is empty");
    assert_eq!(error, Error::Abandoned { what: "the model" });
    let error = gpu.run(|commands| offscreen.download(commands)).expect_err("it is nothing");
    assert_eq!(error, Error::Abandoned { what: "the picture" });

    let model = model(&gpu, &set);
    let mut contours = Contours::new(&extractor, &model, CAPACITY).expect("there is memory");
    let mut others = Contours::new(&extractor, &model, CAPACITY).expect("there is memory");
    let ((picture, surface), _) = gpu
        .run(|commands| {
            let picture = Picture::new(commands, SIZE, DepthOrder::Standard)?;
            Ok((picture, Surface::new(commands, &contours, &[&mesh])?))
        })
        .expect("there is memory");
    let draw = |contours: &Contours, commands: &mut Commands| {
        let subject = Subject { contours: contours.into(), surface: &surface };
        picture.draw(commands, &view, &[subject]).map(|_| ())
    };
    let error = gpu.run(|commands| draw(&contours, commands)).expect_err("nothing is prepared");
    assert_eq!(error, Error::Unprepared);
    let error = gpu.run(|commands| extractor.record(commands, &contours));
    assert_eq!(error.expect_err("nothing is prepared"), Error::Unprepared);
    let error = gpu.run(|commands| {
        others.prepare(commands, &placements, Method::Patches)?;
        draw(&others, commands)
    });
    assert_eq!(error.expect_err("the surface is of others"), Error::OtherContours);
    // Nothing has been extracted: nothing is drawn.
    let drawn = gpu.run(|commands| {
        contours.prepare(commands, &placements, Method::Patches)?;
        draw(&contours, commands)
    });
    drawn.expect("it is drawn");
    support::expect_silence();
}

/// A canvas that is inked into something larger reads no pixel that it does not have.
#[test]
fn a_canvas_takes_other_sizes() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let (placements, scene_to_clip) = scene();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let draw = |canvas: &Canvas, size: [u32; 2]| {
        let (pixels, executed) = gpu
            .run(|commands| {
                let mut contours = MeshContours::new(canvas.mesh_pass(), &model, CAPACITY)?;
                let surface = Surface::new(commands, &contours, &[&mesh])?;
                contours.prepare(commands, &placements, Method::Patches)?;
                let subject = Subject { contours: (&contours).into(), surface: &surface };
                canvas.cover(commands, &view, &[subject])?;
                let offscreen = Offscreen::new(commands, size)?;
                canvas.ink(&mut offscreen.render(commands, [1.0; 4])?)?;
                offscreen.download(commands)
            })
            .expect("it is drawn");
        pixels.read(&executed).expect("it was drawn by these")
    };
    let make = |size| {
        let made = gpu
            .run(|commands| Canvas::new(commands, size, DepthOrder::Standard, Offscreen::FORMAT));
        made.expect("there is memory").0
    };
    let fresh = draw(&make(SIZE), SIZE);
    assert!(fresh.chunks(4).filter(|pixel| pixel[0] < 100).count() > 500);
    let mut canvas = make([64, 64]);
    draw(&canvas, SIZE);
    gpu.run(|commands| canvas.resize(commands, SIZE)).expect("there is memory");
    assert!(draw(&canvas, SIZE) == fresh, "a canvas of that size from the beginning");
    let error = gpu.run(|commands| canvas.resize(commands, [0, 1])).expect_err("no pixels");
    assert!(matches!(error, Error::PictureSize { .. }));
    assert!(draw(&canvas, SIZE) == fresh, "it stays as it was");
    support::expect_silence();
}

#[test]
fn formats_that_cannot_be_drawn_to_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let depth = (vk::Format::R8_UNORM, DepthOrder::Standard);
    for attached in [
        Attached { color: vk::Format::R32_UINT, depth: None },
        Attached { color: vk::Format::BC1_RGB_UNORM_BLOCK, depth: None },
        Attached { depth: Some(depth), ..ATTACHED },
    ] {
        let error = LinePass::new(gpu.device(), &attached).expect_err("it cannot be blended");
        assert!(matches!(error, Error::Format { .. }), "{error}");
        let options = MeshOptions { output: MeshOutput::Lines(attached), ..MeshOptions::default() };
        let error = MeshPass::new(gpu.device(), &options).expect_err("it cannot be blended");
        assert!(matches!(error, Error::Format { .. }), "{error}");
    }
    // Whole numbers are for shaders that give such.
    let whole = Attached { color: vk::Format::R32_UINT, depth: None };
    let source = "@fragment fn fragment() -> @location(0) vec4u { return vec4u(1u); }";
    let options =
        MeshOptions { output: MeshOutput::Custom(whole, source), ..MeshOptions::default() };
    MeshPass::new(gpu.device(), &options).expect("it is drawn to as it is");
    let format = vk::Format::R32_UINT;
    let error = gpu.run(|commands| Canvas::new(commands, SIZE, DepthOrder::Standard, format));
    assert!(matches!(error.expect_err("it cannot be blended"), Error::Format { .. }));
    support::expect_silence();
}

#[test]
fn what_failed_or_was_forgotten_leaves_images_as_they_have_to_be() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let (placements, scene_to_clip) = scene();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let narrow = MeshOptions { mesh_width: Some(16), ..MeshOptions::default() };
    let narrow = MeshPass::new(gpu.device(), &narrow).expect("shaders compile");
    let made = gpu.run(|commands| {
        let canvas = Canvas::new(commands, SIZE, DepthOrder::Standard, Offscreen::FORMAT)?;
        let offscreen = Offscreen::new(commands, SIZE)?;
        let mut meshed = MeshContours::new(&narrow, &model, CAPACITY)?;
        let surface = Surface::new(commands, &meshed, &[&mesh])?;
        meshed.prepare(commands, &placements, Method::Patches)?;
        let subject = Subject { contours: (&meshed).into(), surface: &surface };
        assert_eq!(canvas.cover(commands, &view, &[subject]), Err(Error::OtherPass));
        canvas.ink(&mut offscreen.render(commands, [1.0; 4])?)?;
        // Rendering that nobody ends.
        std::mem::forget(offscreen.render(commands, [1.0; 4])?);
        offscreen.download(commands)
    });
    made.expect("it is recorded");
    support::expect_silence();
}

/// A buffer has 16 bytes at least, a picture what it has.
#[test]
fn small_pictures_have_their_own_size() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    for size in [[1, 1], [3, 1], [1, 2], [5, 3]] {
        let (pixels, executed) = gpu
            .run(|commands| {
                let offscreen = Offscreen::new(commands, size)?;
                drop(offscreen.render(commands, [0.2, 0.4, 0.6, 1.0])?);
                offscreen.download(commands)
            })
            .expect("it is drawn");
        let pixels = pixels.read(&executed).expect("it was drawn by these");
        let count = size[0] as usize * size[1] as usize;
        assert_eq!(pixels, [51, 102, 153, 255].repeat(count), "{size:?}");
    }
    support::expect_silence();
}

#[test]
fn a_pass_without_a_look_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let model = model(&gpu, &patches(&shapes::icosphere(100), Levels::One));
    let options = MeshOptions { output: MeshOutput::Lines(ATTACHED), ..MeshOptions::default() };
    let pass = MeshPass::new(gpu.device(), &options).expect("shaders compile");
    let (placements, _) = scene();
    let error = gpu.run(|commands| {
        let mut contours = MeshContours::new(&pass, &model, CAPACITY)?;
        contours.prepare(commands, &placements, Method::Patches)?;
        let offscreen = Offscreen::new(commands, SIZE)?;
        pass.record(&mut offscreen.render(commands, [1.0; 4])?, &contours)
    });
    assert_eq!(error.expect_err("it has no matrix"), Error::NoStyle);
    support::expect_silence();
}
