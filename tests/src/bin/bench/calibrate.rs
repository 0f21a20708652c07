//! What the cost model is made of, measured on the runtime of this machine (Tsiapkolis and Bénard,
//! CGF 2024, §4.2).

use std::hint::black_box;
use std::time::Instant;

use drypoint_cpu::{Statistics, extract_all_wings, extract_patches};
use drypoint_fusion::{FusionParams, PatchSet};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::report::{Calibration, Quartiles};
use drypoint_tests::viewpoints;

use crate::decompositions::fused;

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

/// Measures from each viewpoint in turn, `rounds` times; none if there are no patches.
pub(crate) fn measure(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    rounds: u32,
) -> Result<Option<Calibration>, String> {
    let set = fused(mesh, adjacency, EdgeFilter::Convex, &FusionParams::FAST)?;
    if set.patches().is_empty() {
        return Ok(None);
    }
    let views: Vec<Viewpoint> =
        viewpoints::protocol(mesh).into_iter().step_by(VIEWPOINTS_EVERY).collect();
    // One after the other from each viewpoint, so that what disturbs the machine meets few of them.
    let look = |_| views.iter().map(|&viewpoint| sample(&set, viewpoint)).collect::<Vec<_>>();
    let samples: Vec<Sample> = (0..rounds).flat_map(look).collect();
    let quartiles = |value: fn(&Sample) -> f64| Quartiles::of(samples.iter().map(value));
    Ok(Some(Calibration {
        edge: quartiles(|s| 1e9 * s.edge),
        patch_test: quartiles(|s| s.patch_test / s.edge),
        accepted_patch: quartiles(|s| s.accepted_patch / s.edge),
    }))
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
