//! `cargo xtask bench`: what patches cost and gain, and what a drawing takes. Runs alone, too.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

mod calibrate;
mod cpu;
mod floor;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Parser, value_parser};
use drypoint_cpu::{BruteForce, extract_patches};
use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_lines::{
    Camera, Drawing, LineOptions, Occluders, Page, Segments, Style, VisibilityParams,
    filter_for_drawing, to_svg,
};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, contour_edges, io, shapes};
use drypoint_tests::compare::compare;
use drypoint_tests::{models, viewpoints};
use glam::DVec3;

/// Times fusion, extraction and drawing on mesh files, or on those of the folder that DRYPOINT_MODELS
/// names, or on built-in shapes. Every answer is compared with the definition before it is timed.
#[derive(Parser)]
#[command(name = "cargo xtask bench")]
struct Options {
    /// Of the published method, most edges fused as one group (4096 in the paper)
    #[arg(long, value_name = "EDGES", default_value_t = 4096, value_parser = value_parser!(u32).range(2..))]
    partition: u32,
    /// Interleaved rounds of what is compared
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = value_parser!(u32).range(1..))]
    rounds: u32,
    /// Instead, measure what the cost model is made of: the times of an edge test, a patch test and a
    /// survivor
    #[arg(long)]
    calibrate: bool,
    /// Instead, time extraction on the CPU alone: every brute force and every kernel
    #[arg(long, conflicts_with = "calibrate")]
    cpu: bool,
    /// Mesh files
    #[arg(value_name = "MESH FILE")]
    files: Vec<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("bench: {why}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let files = if options.files.is_empty() { models::files()? } else { options.files.clone() };
    for path in &files {
        let start = Instant::now();
        let model = io::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let read = start.elapsed().as_secs_f64();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        println!("{name}: {} faces, read in {read:.3} s", model.mesh.triangles().len());
        measure(&model.mesh, options)?;
    }
    if files.is_empty() {
        for name in ["bumpy-sphere", "torus-knot", "cad-part"] {
            let mesh = shapes::by_name(name, 20_000).ok_or(format!("no shape {name}"))?;
            println!("{name}: {} faces", mesh.triangles().len());
            measure(&mesh, options)?;
        }
    }
    Ok(())
}

fn measure(mesh: &Mesh, options: &Options) -> Result<(), String> {
    if options.calibrate {
        return calibrate::run(mesh, options.rounds);
    }
    if options.cpu {
        return cpu::run(mesh, options.rounds);
    }
    let start = Instant::now();
    let adjacency = MeshAdjacency::new(mesh);
    println!("  adjacency {:.3} s", start.elapsed().as_secs_f64());
    draw(mesh, &adjacency)?;
    for (name, params) in [("reduced", FusionParams::PAPER), ("mean", FusionParams::PAPER_MEAN)] {
        let params = params.with_max_partition(Some(options.partition));
        let start = Instant::now();
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse(mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)
            .map_err(|error| error.to_string())?;
        print!("  {name:<8} fused in {:.2} s: ", start.elapsed().as_secs_f64());
        extract(mesh, &adjacency, &patches, options.rounds)?;
    }
    Ok(())
}

/// Brute force and patches in turn over the 252 viewpoints of the protocol.
fn extract(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    patches: &PatchSet,
    rounds: u32,
) -> Result<(), String> {
    let viewpoints = viewpoints::protocol(mesh);
    let agreement = compare(mesh, adjacency, patches, &viewpoints)
        .map_err(|wrong| format!("{} disagrees with the definition", wrong.extractor))?;
    let views = viewpoints.len().max(1) as f64;
    let mut brute_force = BruteForce::new(mesh, adjacency, EdgeFilter::Convex);
    let mut contours = Vec::new();
    let (mut by_force, mut by_patches, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..rounds {
        let start = Instant::now();
        for &viewpoint in &viewpoints {
            std::hint::black_box(brute_force.extract(viewpoint, &mut contours));
        }
        let force = start.elapsed().as_secs_f64();
        let start = Instant::now();
        for &viewpoint in &viewpoints {
            std::hint::black_box(extract_patches(patches, viewpoint, &mut contours));
        }
        let culled = start.elapsed().as_secs_f64();
        by_force.push(1e6 * force / views);
        by_patches.push(1e6 * culled / views);
        ratios.push(force / culled);
    }
    let [low, ratio, high] = quartiles(ratios);
    println!(
        "{} patches, {:.0} of {} edges tested, {:.0} contour edges; brute force {:.0} µs, \
         patches {:.0} µs, ratio {ratio:.1} [{low:.1}, {high:.1}]",
        patches.patches().len(),
        agreement.edges_tested as f64 / views,
        patches.wings().len(),
        agreement.contour_edges as f64 / views,
        quartiles(by_force)[1],
        quartiles(by_patches)[1],
    );
    Ok(())
}

/// One drawing as `drypoint draw` makes it, stage by stage.
fn draw(mesh: &Mesh, adjacency: &MeshAdjacency) -> Result<(), String> {
    let page = Page { width: 1000, height: 1000, margin: 40.0 };
    let points = mesh.positions().iter().map(|p| p.as_dvec3());
    let camera = Camera::fit_perspective(points, DVec3::ONE, None, 30.0, page)
        .map_err(|error| error.to_string())?;
    let mut lap = Instant::now();
    let mut seconds = || std::mem::replace(&mut lap, Instant::now()).elapsed().as_secs_f64();
    let mut contours = Vec::new();
    let filter = filter_for_drawing(mesh, adjacency, camera.viewpoint());
    contour_edges(mesh, adjacency, camera.viewpoint(), filter, &mut contours);
    let options = LineOptions { boundary: true, crease_angle: None };
    let segments = Segments::new(mesh, adjacency, &contours, &options);
    let extracted = seconds();
    let occluders = Occluders::new(mesh, adjacency);
    let sorted = seconds();
    let drawing = Drawing::new(&occluders, &segments, &camera, &VisibilityParams::default());
    let traced = seconds();
    let bytes = to_svg(&drawing, &Style::default(), "bench").len();
    println!(
        "  drawing: edges {extracted:.3} s, tree of faces {sorted:.3} s, visibility {traced:.3} s, \
         {bytes} bytes of SVG {:.3} s",
        seconds()
    );
    Ok(())
}

/// Lower quartile, median and upper quartile.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_unstable_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
}
