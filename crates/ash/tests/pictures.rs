//! What is drawn: the same by mesh shaders as by compute shaders, with the id and the class of each edge.
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]
#![allow(unsafe_code, reason = "a renderer's own image is made of raw handles")]

#[path = "support/raw.rs"]
mod raw;
#[path = "support/scene.rs"]
mod scene;
mod support;

use std::collections::BTreeMap;

use drypoint_ash::{
    Canvas, Contours, Counting, DepthOrder, Error, Extractor, Gpu, LinePass, LineStyle,
    MeshContours, MeshOptions, MeshOutput, MeshPass, Method, Model, Offscreen, Picture, Queries,
    Subject, Surface, View,
};
use drypoint_fusion::Levels;
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, contour_edges, shapes};
use scene::{ATTACHED, CAPACITY, FORMAT, SIZE, model, scene};
use support::{gpu, patches};

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
