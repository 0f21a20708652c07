//! `drypoint patches`: build the asset and save it.

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{FusionParams, PatchSet, Progress, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency};
use serde::Serialize;

use crate::args::{FusionArgs, PatchesArgs, SphereKind};
use crate::output::{Output, print_json};
use crate::progress::Stage;
use crate::source::Source;

/// What was built, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Built {
    edges: usize,
    patches: usize,
    /// In degrees.
    mean_half_angle: f64,
    /// In degrees.
    max_half_angle: f64,
    /// In the file's unit.
    mean_t: f64,
    /// In edge tests a view.
    expected_cost: f64,
    build_seconds: f64,
    /// In bytes; `null` where the system does not tell.
    peak_memory: Option<u64>,
}

pub(crate) fn run(args: &PatchesArgs) -> Result<(), String> {
    let output = Output::open(&args.output)?;
    let source = Source::load(&args.model)?;
    let start = Instant::now();
    let adjacency = source.adjacency();
    let patches = build(&source, &adjacency, args.edges.into(), &args.fusion)?;
    let build_seconds = start.elapsed().as_secs_f64();
    output.write(&patches.to_bytes())?;

    let summary = patches.summary();
    let built = Built {
        edges: patches.wings().len(),
        patches: patches.patches().len(),
        mean_half_angle: summary.mean_half_angle.to_degrees(),
        max_half_angle: summary.max_half_angle.to_degrees(),
        mean_t: summary.mean_apex_distance,
        expected_cost: patches.expected_cost(),
        build_seconds,
        peak_memory: peak_memory(),
    };
    if args.json {
        return print_json(&built);
    }
    eprintln!(
        "{}: {} edges in {} patches, {:.1}° wide on average, {:.1} s",
        args.output.display(),
        built.edges,
        built.patches,
        built.mean_half_angle,
        built.build_seconds
    );
    Ok(())
}

/// Fuses the edges of a mesh, with progress. Ctrl-C ends the program, not only the fusion.
pub(crate) fn build(
    source: &Source,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    args: &FusionArgs,
) -> Result<PatchSet, String> {
    let params = FusionParams {
        sphere: match args.sphere {
            SphereKind::Mean => drypoint_fusion::SphereKind::Mean,
            SphereKind::Reduced => drypoint_fusion::SphereKind::Reduced,
        },
        max_partition: args.partition.0,
        ..FusionParams::PAPER
    };
    let stage = Stage::with_length("building patches", adjacency.edges(filter).count() as u64);
    let progress = |progress: Progress| {
        stage.set(progress.edges_done as u64);
        ControlFlow::Continue(())
    };
    fuse(source.mesh(), adjacency, filter, &params, &progress)
        .map_err(|error| format!("{}: {error}", source.name))
}

/// Most memory that the process has held at once, in bytes, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}
