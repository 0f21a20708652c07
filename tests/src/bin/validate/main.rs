//! `cargo xtask validate`: every extractor against the definition, on every shape and model.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

mod boundary;
mod matrix;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::compare::Disagreement;
use drypoint_tests::presets;

/// Compares every extractor with the definition of a contour edge, on every built-in shape and every
/// mesh file in the folder that DRYPOINT_MODELS names, with both filters and all presets, bounds and
/// levels, and the baselines, from the 252 viewpoints of the protocol, orthographic views, viewpoints near the surface,
/// and viewpoints on vertices, edges and planes of faces. Ends at the first disagreement with
/// status 1.
#[derive(Parser)]
#[command(name = "cargo xtask validate")]
struct Options {
    /// Only meshes whose name holds TEXT
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    only: String,
    /// Only presets and baselines whose name holds TEXT
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    preset: String,
    /// Also write what agreed, and what did not, to FILE
    #[arg(long, value_name = "FILE", conflicts_with = "boundary")]
    json: Option<PathBuf>,
    /// Instead, look at each patch and super-patch from its own cull boundary, a few roundings to
    /// either side, and at small meshes from 100,000 viewpoints near them
    #[arg(long)]
    boundary: bool,
    /// With --boundary: viewpoints on cull boundaries for each mesh, filter and preset, spread over
    /// its patches, 16 each at least
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    viewpoints: usize,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let result = if options.boundary { boundary::run(&options) } else { matrix::run(&options) };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("validate: {why}");
            ExitCode::FAILURE
        }
    }
}

const FILTERS: [(EdgeFilter, &str); 2] = [(EdgeFilter::Convex, "convex"), (EdgeFilter::All, "all")];

/// The presets for a mesh of that many edges, of those that were asked for.
fn selected(options: &Options, edges: usize) -> Vec<(&'static str, FusionParams)> {
    let mut presets = presets::for_edges(edges);
    presets.retain(|(name, _)| name.contains(&options.preset));
    presets
}

/// Fuses, and checks what can be checked without a viewpoint.
fn patches(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    params: &FusionParams,
) -> Result<PatchSet, String> {
    let set = fuse(mesh, adjacency, filter, params, &|_| ControlFlow::Continue(()))
        .map_err(|error| error.to_string())?;
    set.validate().map_err(|error| error.to_string())?;
    set.validate_against(mesh, adjacency).map_err(|error| error.to_string())?;
    Ok(set)
}

/// Viewpoint and edges: what is needed to see the disagreement again.
fn explain(adjacency: &MeshAdjacency, wrong: &Disagreement) -> String {
    let edges = |edges: &[EdgeId]| {
        let edges = edges.iter().take(20).map(|&edge| name_edge(adjacency, edge));
        edges.collect::<Vec<_>>().join(" ")
    };
    format!(
        "{} disagrees with the definition from {}\n  lost {}: {}\n  invented {}: {}",
        wrong.extractor,
        name_viewpoint(wrong.viewpoint),
        wrong.lost.len(),
        edges(&wrong.lost),
        wrong.invented.len(),
        edges(&wrong.invented)
    )
}

/// Its id, and the vertices at its ends.
fn name_edge(adjacency: &MeshAdjacency, edge: EdgeId) -> String {
    format!("{}:{:?}", edge.0, adjacency.wing(edge).ends())
}

/// To the last bit.
fn name_viewpoint(viewpoint: Viewpoint) -> String {
    let kind = if viewpoint.is_point() { "eye" } else { "direction" };
    format!("{kind} {:?}", viewpoint.xyz().to_array())
}
