//! What the cost model is made of, measured on the runtime of this machine (Tsiapkolis and Bénard,
//! CGF 2024, §4.2).

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_cpu::{Statistics, extract_all_wings, extract_patches};
use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::viewpoints;

use crate::quartiles;

/// One viewpoint of the protocol in so many: all of them tell no more, and take minutes.
const VIEWPOINTS_EVERY: usize = 5;

/// Seconds from one viewpoint.
struct Sample {
    /// t_e: one edge, tested with no patches in between.
    edge: f64,
    /// t_P: the bound of one patch.
    patch_test: f64,
    /// t_A: what a view through patches takes longer than its patch tests and edge tests, for each
    /// survivor.
    accepted_patch: f64,
}

/// Measures from each viewpoint in turn, `rounds` times, and prints medians and quartiles.
pub(crate) fn run(mesh: &Mesh, rounds: u32) -> Result<(), String> {
    let params = FusionParams::FAST;
    let adjacency = MeshAdjacency::new(mesh);
    let go_on = |_| ControlFlow::Continue(());
    let set = fuse(mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)
        .map_err(|error| error.to_string())?;
    if set.patches().is_empty() {
        return Err("has no patches to measure".to_owned());
    }
    let views: Vec<Viewpoint> =
        viewpoints::protocol(mesh).into_iter().step_by(VIEWPOINTS_EVERY).collect();
    println!(
        "  {} edges in {} patches, {} views, {rounds} rounds",
        set.wings().len(),
        set.patches().len(),
        views.len()
    );
    // One after the other from each viewpoint, so that what disturbs the machine meets few of them.
    let look = |_| views.iter().map(|&viewpoint| sample(&set, viewpoint)).collect::<Vec<_>>();
    let samples: Vec<Sample> = (0..rounds).flat_map(look).collect();
    let print = |what: &str, unit: &str, value: &dyn Fn(&Sample) -> f64| {
        let [low, median, high] = quartiles(samples.iter().map(value).collect());
        println!("  {what:<10} {median:>8.3} {unit:<3} [{low:.3}, {high:.3}]");
    };
    print("t_e", "ns", &|s| 1e9 * s.edge);
    print("t_P", "ns", &|s| 1e9 * s.patch_test);
    print("t_A", "ns", &|s| 1e9 * s.accepted_patch);
    print("t_P / t_e", "", &|s| s.patch_test / s.edge);
    print("t_A / t_e", "", &|s| s.accepted_patch / s.edge);
    Ok(())
}

fn sample(set: &PatchSet, viewpoint: Viewpoint) -> Sample {
    let mut contours = Vec::with_capacity(set.wings().len());
    let start = Instant::now();
    black_box(extract_all_wings(set, viewpoint, &mut contours));
    let edge = start.elapsed().as_secs_f64() / set.wings().len() as f64;
    let start = Instant::now();
    black_box(set.patches().iter().filter(|p| p.bound.may_hold_contour(viewpoint)).count());
    let patch_test = start.elapsed().as_secs_f64() / set.patches().len() as f64;
    let start = Instant::now();
    let tested: Statistics = black_box(extract_patches(set, viewpoint, &mut contours));
    let rest = start.elapsed().as_secs_f64()
        - tested.patches_tested as f64 * patch_test
        - tested.edges_tested as f64 * edge;
    Sample { edge, patch_test, accepted_patch: rest / tested.patches_accepted.max(1) as f64 }
}
