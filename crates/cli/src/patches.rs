//! `drypoint patches`: build the asset and save it.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use drypoint_fusion::{Levels, PatchSet, Progress, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency};
use serde::Serialize;

use crate::args::PatchesArgs;
use crate::fusion::{FusionArgs, bound_name, profile_name, runtime_name};
use crate::memory::Work;
use crate::output::{Output, print_json, tell};
use crate::progress::Stage;
use crate::source::{PATCHES_EXTENSION, Source, is_named_patches};

/// What was built, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Built {
    edges: usize,
    patches: usize,
    super_patches: usize,
    /// Edges in no patch.
    always_tested: usize,
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
    preset: String,
    profile: String,
    bound: String,
    levels: u8,
    runtime: String,
}

pub(crate) fn run(args: &PatchesArgs) -> Result<(), String> {
    let name = args.output.display();
    if args.json && args.output == Path::new("-") {
        return Err("--json: standard output takes the patches or the JSON, not both".to_owned());
    }
    // What contradicts itself is told before the mesh is read.
    args.fusion.params()?;
    let output = Output::open(&args.output)?;
    // So that no mesh is overwritten by its own patches.
    if matches!(output, Output::File(_)) && !is_named_patches(&args.output) {
        return Err(format!("{name}: a patch file's name ends in .{PATCHES_EXTENSION}"));
    }
    let source = Source::load(&args.model, args.read, Work::Patches)?;
    let start = Instant::now();
    let adjacency = source.adjacency();
    let patches = build(&source, &adjacency, args.edges.into(), &args.fusion)?;
    let build_seconds = start.elapsed().as_secs_f64();
    let built = describe(&patches, &args.fusion, build_seconds);
    // First what may fail, so that no file is left behind by a run that did.
    if args.json {
        print_json(&built)?;
    }
    output.write(&patches.to_bytes())?;
    if !args.json {
        tell(&format!(
            "{name}: {} edges in {} patches, half-angle {:.1}° on average, a view costs {:.0} edge \
             tests, {:.1} s",
            built.edges,
            built.patches,
            built.mean_half_angle,
            built.expected_cost,
            built.build_seconds
        ));
    }
    Ok(())
}

fn describe(patches: &PatchSet, args: &FusionArgs, build_seconds: f64) -> Built {
    let summary = patches.summary();
    let (params, preset) = (patches.provenance().params, args.preset_name());
    Built {
        edges: patches.wings().len(),
        patches: patches.patches().len(),
        super_patches: patches.super_patches().len(),
        always_tested: patches.always_tested().len(),
        mean_half_angle: summary.mean_half_angle.to_degrees(),
        max_half_angle: summary.max_half_angle.to_degrees(),
        mean_t: summary.mean_apex_distance,
        expected_cost: patches.expected_cost(),
        build_seconds,
        peak_memory: peak_memory(),
        profile: profile_name(&preset, &params.views),
        preset,
        bound: bound_name(params.bound),
        levels: match params.levels {
            Levels::One => 1,
            Levels::Two => 2,
        },
        runtime: runtime_name(&params.cost),
    }
}

/// Fuses the edges of a mesh, with progress. Ctrl-C ends the program, not only the fusion.
pub(crate) fn build(
    source: &Source,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    args: &FusionArgs,
) -> Result<PatchSet, String> {
    let params = args.params()?;
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
