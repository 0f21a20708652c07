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

#[path = "support/mean.rs"]
mod mean;
mod support;

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, io};
use mean::{MeanView, mean_view};
use support::far_viewpoints;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("usage: paper_table MESH [MOST_EDGES_IN_A_PART|all]...")?;
    let mut sizes: Vec<String> = args.collect();
    if sizes.is_empty() {
        sizes = ["512", "1024", "2048", "4096"].map(String::from).to_vec();
    }
    let mesh =
        io::read(path.as_ref()).map_err(|error| format!("{path}: {error}"))?.mesh.normalized();
    let adjacency = MeshAdjacency::new(&mesh);
    let viewpoints = far_viewpoints();
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
            let MeanView { survivors, tested } =
                mean_view(set.patches(), set.always_tested().len(), &viewpoints);
            println!(
                "{:<8}{size:>7}{:>9}{:>8}{:>8.2}{:>9.2}{:>8.4}{survivors:>10.1}{tested:>9.1}{:>9.1}{seconds:>9.2}",
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
