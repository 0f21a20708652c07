//! What each preset costs to build, and what a view costs then.
//!
//! ```sh
//! cargo run --release -p drypoint-fusion --example preset_table -- bunny.obj fast default two-levels paper
//! ```
//!
//! `shape:NAME:TRIANGLES` in place of a file is a built-in shape. The mesh is scaled to \[−1, 1\]. Viewpoints are the 42 vertices of an icosahedron subdivided once,
//! at distances 5, 10, 25, 50, 75 and 100; the near ones are on, in and beside the surface. A view
//! costs 1.363 for each test of a patch or a super-patch, and 1 for each edge that is tested.
//! `RAYON_NUM_THREADS` says how many threads build.
#![allow(clippy::print_stdout, reason = "the table is what this program is for")]

#[path = "support/near.rs"]
mod near;
mod support;

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{FusionParams, Levels, PatchSet, ViewProfile, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, io, shapes};
use near::near_viewpoints;
use support::far_viewpoints;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("usage: preset_table MESH [PRESET]...")?;
    let mesh = mesh(&path)?.normalized();
    let adjacency = MeshAdjacency::new(&mesh);
    println!(
        "preset           edges  groups  patches  always  patches tested    tested      cost  near tested  seconds"
    );
    let viewpoints = [far_viewpoints(), near_viewpoints(&mesh)];
    for name in args {
        let params = params(&name).ok_or_else(|| format!("no preset {name:?}"))?;
        let start = Instant::now();
        let go_on = |_| ControlFlow::Continue(());
        let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;
        let seconds = start.elapsed().as_secs_f64();
        let [(patches, edges), (_, near_edges)] = [0, 1].map(|i| mean_tests(&set, &viewpoints[i]));
        println!(
            "{name:<14}{:>9}{:>7}{:>9}{:>8}{patches:>16.1}{edges:>10.1}{:>10.1}{near_edges:>13.1}{seconds:>9.3}",
            set.wings().len(),
            set.super_patches().len(),
            set.patches().len(),
            set.always_tested().len(),
            edges + params.cost.patch_test * patches,
        );
    }
    Ok(())
}

fn mesh(path: &str) -> Result<Mesh, Box<dyn std::error::Error>> {
    let Some(shape) = path.strip_prefix("shape:") else {
        return Ok(io::read(path.as_ref()).map_err(|error| format!("{path}: {error}"))?.mesh);
    };
    let (name, triangles) = shape.split_once(':').ok_or("shape:NAME:TRIANGLES is wanted")?;
    Ok(shapes::by_name(name, triangles.parse()?).ok_or("no such shape")?)
}

fn params(name: &str) -> Option<FusionParams> {
    let params = match name {
        "fast" => FusionParams::FAST,
        "default" => FusionParams::DEFAULT,
        "best" => FusionParams::BEST,
        "two-levels" => FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT },
        "best-two-levels" => FusionParams { levels: Levels::Two, ..FusionParams::BEST },
        "near" => FusionParams { views: ViewProfile::NEAR, ..FusionParams::DEFAULT },
        "paper" => FusionParams::PAPER,
        _ => return None,
    };
    Some(params)
}

/// Patches and super-patches tested, and edges, on the mean of all viewpoints.
fn mean_tests(set: &PatchSet, viewpoints: &[Viewpoint]) -> (f64, f64) {
    let (mut patches_tested, mut edges_tested) = (0, 0);
    for &viewpoint in viewpoints {
        let survivors =
            set.super_patches().iter().filter(|group| group.bound.may_hold_contour(viewpoint));
        let ranges = survivors.map(|group| group.patches()).chain([set.always_tested_patches()]);
        patches_tested += set.super_patches().len();
        edges_tested += set.always_tested().len();
        for patch in
            ranges.flat_map(|range| &set.patches()[range.start as usize..range.end as usize])
        {
            patches_tested += 1;
            if patch.bound.may_hold_contour(viewpoint) {
                edges_tested += patch.edge_count as usize;
            }
        }
    }
    let mean = |count: usize| count as f64 / viewpoints.len() as f64;
    (mean(patches_tested), mean(edges_tested))
}
