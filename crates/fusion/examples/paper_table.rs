//! Table 1 of Tsiapkolis and Bénard, CGF 2024: the edges that are tested per view, by sphere and by
//! the size of the parts of space.
//!
//! ```sh
//! cargo run --release -p drypoint-fusion --example paper_table -- bunny.obj 512 4096 all
//! ```
//!
//! The mesh is scaled to \[−1, 1\]. Viewpoints are the 42 vertices of an icosahedron subdivided once,
//! at distances 5, 10, 25, 50, 75 and 100.
#![allow(clippy::print_stdout, reason = "the table is what this program is for")]

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, io};
use glam::DVec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("usage: paper_table MESH [MOST_EDGES_IN_A_PART|all]...")?;
    let mut sizes: Vec<String> = args.collect();
    if sizes.is_empty() {
        sizes = ["512", "1024", "2048", "4096"].map(String::from).to_vec();
    }
    let mesh = io::read(path.as_ref())?.mesh.normalized();
    let adjacency = MeshAdjacency::new(&mesh);
    println!(
        "sphere    c_max  patches  always  max α°  mean α°  mean t  accepted   tested     cost  seconds"
    );
    for preset in [FusionParams::PAPER_MEAN, FusionParams::PAPER] {
        for size in &sizes {
            let max_partition = if size == "all" { None } else { Some(size.parse()?) };
            let params = preset.with_max_partition(max_partition);
            let start = Instant::now();
            let go_on = |_| ControlFlow::Continue(());
            let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;
            let seconds = start.elapsed().as_secs_f64();
            let summary = set.summary();
            let (accepted, tested) = mean_view(&set);
            println!(
                "{:<8}{size:>7}{:>9}{:>8}{:>8.2}{:>9.2}{:>8.4}{accepted:>10.1}{tested:>9.1}{:>9.1}{seconds:>9.2}",
                format!("{:?}", params.bound),
                set.patches().len(),
                set.always_tested().len(),
                summary.max_half_angle.to_degrees(),
                summary.mean_half_angle.to_degrees(),
                summary.mean_apex_distance,
                tested + params.cost.patch_test * set.patches().len() as f64,
            );
        }
    }
    Ok(())
}

/// Patches that survive and edges that are tested, on the mean of all viewpoints.
fn mean_view(set: &PatchSet) -> (f64, f64) {
    let (mut accepted, mut tested, mut views) = (0, 0, 0);
    for direction in directions() {
        for distance in [5.0, 10.0, 25.0, 50.0, 75.0, 100.0] {
            let viewpoint = Viewpoint::at(distance * direction);
            let survivors = set.patches().iter().filter(|p| p.bound.may_hold_contour(viewpoint));
            let (patches, edges) =
                survivors.fold((0, 0), |(n, edges), patch| (n + 1, edges + patch.edge_count));
            accepted += patches;
            tested += edges as usize + set.always_tested().len();
            views += 1;
        }
    }
    (f64::from(accepted) / f64::from(views), tested as f64 / f64::from(views))
}

/// Vertices of an icosahedron subdivided once: its own, and the middles of its edges.
fn directions() -> Vec<DVec3> {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for one in [-1.0, 1.0] {
        for long in [-golden, golden] {
            let (a, b, c) = (0.0, one, long);
            vertices.extend([DVec3::new(a, b, c), DVec3::new(b, c, a), DVec3::new(c, a, b)]);
        }
    }
    let mut directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize()).collect();
    for (i, a) in vertices.iter().enumerate() {
        let neighbours = vertices[..i].iter().filter(|b| a.distance(**b) < 2.1);
        directions.extend(neighbours.map(|b| (a + b).normalize()));
    }
    directions
}
