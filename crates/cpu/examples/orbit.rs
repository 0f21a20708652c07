//! Extracts contours frame by frame along an orbit, and says how long that takes.
//!
//! ```sh
//! cargo run --release -p drypoint-cpu --example orbit -- bunny.obj
//! ```
//!
//! A number in place of the file is that of the faces of a built-in shape; without any, it is 70,000. One
//! turn of 720 frames, half a degree each, at three times the size of the mesh and a little above its
//! middle.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_cpu::{Contours, Extractor, Instructions};
use drypoint_fusion::{CostModel, FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, io, shapes};
use glam::DVec3;

const FRAMES: usize = 720;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument = std::env::args().nth(1).unwrap_or("70000".into());
    let mesh = match argument.parse() {
        Ok(faces) => shapes::bumpy_sphere(faces),
        Err(_) => io::read(argument.as_ref()).map_err(|error| format!("{argument}: {error}"))?.mesh,
    };

    // Once for each mesh, or loaded from a patch file.
    let adjacency = MeshAdjacency::new(&mesh);
    let params = FusionParams { cost: CostModel::CPU_SIMD, ..FusionParams::FAST };
    let go_on = |_| ControlFlow::Continue(());
    let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;
    let extractor = Extractor::new(&patches);

    let bounds = mesh.bounds().ok_or("there is nothing to look at: the mesh has no faces")?;
    let (center, distance) = (bounds.center(), 3.0 * bounds.half_longest_side());
    let viewpoint = |frame: usize| {
        let angle = TAU * frame as f64 / FRAMES as f64;
        let towards = DVec3::new(angle.cos(), 0.3, angle.sin());
        // In f32, as cameras have it: kernels need not round then.
        Viewpoint::at((center + distance * towards).as_vec3().as_dvec3())
    };

    // Once for each frame. The memory is that of the frame before.
    let mut contours = Contours::default();
    let mut edges = 0;
    let times = timed(|frame| {
        extractor.vertex_pairs(viewpoint(frame), &mut contours);
        edges += contours.len();
    });
    println!(
        "{} of {} edges are contours on average; {:?}",
        edges / FRAMES,
        patches.wings().len(),
        Instructions::newest()
    );
    report("one thread", &times);

    // Not worth it but for meshes of millions of edges.
    let times = timed(|frame| {
        extractor.vertex_pairs_on_threads(viewpoint(frame), &mut contours);
    });
    report("all threads", &times);
    Ok(())
}

/// Microseconds for each frame.
fn timed(mut extract: impl FnMut(usize)) -> Vec<f64> {
    let time = |frame| {
        let start = Instant::now();
        extract(frame);
        1e6 * start.elapsed().as_secs_f64()
    };
    (0..FRAMES).map(time).collect()
}

fn report(name: &str, times: &[f64]) {
    let mut sorted = times.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    println!(
        "{name}: µs per view, median {:.1}, nine in ten below {:.1}, first {:.1}",
        sorted[FRAMES / 2],
        sorted[FRAMES * 9 / 10],
        times[0]
    );
}
