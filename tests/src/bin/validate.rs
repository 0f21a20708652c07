//! `cargo xtask validate`: every extractor against the definition, on every shape and model.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Instant;

use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, io, shapes};
use drypoint_tests::compare::{Agreement, Disagreement, compare};
use drypoint_tests::{models, viewpoints};

const HELP: &str = "\
Usage: cargo xtask validate [--only TEXT] [--partition EDGES]

Compares every extractor with the definition of a contour edge, on every built-in shape (with Mean
and Reduced spheres, fused in parts of 128 edges, of 4096 and whole) and every
mesh file in the folder that DRYPOINT_MODELS names, with both filters, from the 252 viewpoints of
the protocol, orthographic views, viewpoints near the surface, and viewpoints on vertices, edges and
planes of faces. Ends at the first disagreement with status 1.

  --only TEXT        only meshes whose name holds TEXT
  --partition EDGES  of mesh files, most edges fused as one group, from 2 (default 512; the paper's is 4096, and
                     takes minutes on a large mesh)";

/// Viewpoints of the near set, and triangles that hostile viewpoints are built on.
const NEAR_VIEWPOINTS: usize = 100;
const HOSTILE_TRIANGLES: usize = 25;

struct Options {
    only: String,
    partition: u32,
}

fn main() -> ExitCode {
    match options().and_then(|options| options.map_or(Ok(()), |options| run(&options))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("validate: {why}");
            ExitCode::FAILURE
        }
    }
}

/// `None` if help was asked for and given.
fn options() -> Result<Option<Options>, String> {
    let mut options = Options { only: String::new(), partition: 512 };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} wants a value\n\n{HELP}"));
        match arg.as_str() {
            "--only" => options.only = value()?,
            "--partition" => {
                let edges = value()?.parse().ok().filter(|&edges: &u32| edges >= 2);
                options.partition = edges.ok_or("--partition wants a number from 2")?;
            }
            "--help" | "-h" => {
                println!("{HELP}");
                return Ok(None);
            }
            other => return Err(format!("no option {other:?}\n\n{HELP}")),
        }
    }
    Ok(Some(options))
}

fn run(options: &Options) -> Result<(), String> {
    println!(
        "{:<24}{:>9} {:>7}{:>10}{:>9}{:>7}{:>12}{:>8}{:>7}",
        "mesh", "faces", "filter", "edges", "patches", "views", "contours", "tested", "s"
    );
    let mut total = Agreement::default();
    for shape in shapes::all().into_iter().filter(|shape| shape.name.contains(&options.only)) {
        for params in presets() {
            validate((shape.name, &shape.mesh), &params, &mut total)?;
        }
    }
    for path in models::files()? {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if name.contains(&options.only) {
            let model = io::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            let params = FusionParams::PAPER.with_max_partition(Some(options.partition));
            validate((&name, &model.mesh), &params, &mut total)?;
        }
    }
    println!(
        "every extractor agrees with the definition: {} views, {} contour edges",
        total.viewpoints, total.contour_edges
    );
    Ok(())
}

/// On shapes, which are small: both spheres, and parts of space from small to whole.
fn presets() -> [FusionParams; 4] {
    let reduced = FusionParams::PAPER;
    let mean = FusionParams::PAPER_MEAN;
    [reduced, mean, reduced.with_max_partition(Some(128)), mean.with_max_partition(None)]
}

fn validate(
    (name, mesh): (&str, &Mesh),
    params: &FusionParams,
    total: &mut Agreement,
) -> Result<(), String> {
    let adjacency = MeshAdjacency::new(mesh);
    let viewpoints: Vec<_> = viewpoints::protocol(mesh)
        .into_iter()
        .chain(viewpoints::orthographic())
        .chain(viewpoints::near(mesh, NEAR_VIEWPOINTS))
        .chain(viewpoints::hostile(mesh, HOSTILE_TRIANGLES))
        .collect();
    for (filter, filter_name) in [(EdgeFilter::Convex, "convex"), (EdgeFilter::All, "all")] {
        let start = Instant::now();
        let patches = fuse(mesh, &adjacency, filter, params, &|_| ControlFlow::Continue(()))
            .map_err(|error| format!("{name}: {error}"))?;
        patches.validate().map_err(|error| format!("{name}: {error}"))?;
        let agreement = compare(mesh, &adjacency, &patches, &viewpoints)
            .map_err(|wrong| explain(name, filter_name, &adjacency, &wrong))?;
        let edges = patches.wings().len();
        let tested = agreement.edges_tested as f64 / (edges * agreement.viewpoints).max(1) as f64;
        println!(
            "{name:<24}{:>9} {filter_name:>7}{edges:>10}{:>9}{:>7}{:>12}{:>7.1}%{:>7.1}",
            mesh.triangles().len(),
            patches.patches().len(),
            agreement.viewpoints,
            agreement.contour_edges,
            100.0 * tested,
            start.elapsed().as_secs_f64()
        );
        total.viewpoints += agreement.viewpoints;
        total.contour_edges += agreement.contour_edges;
    }
    Ok(())
}

/// Mesh, viewpoint and edges: what is needed to see the disagreement again.
fn explain(name: &str, filter: &str, adjacency: &MeshAdjacency, wrong: &Disagreement) -> String {
    let pairs = |edges: &[drypoint_mesh::EdgeId]| {
        let ends =
            edges.iter().take(20).map(|&e| format!("{}:{:?}", e.0, adjacency.wing(e).ends()));
        ends.collect::<Vec<_>>().join(" ")
    };
    let kind = if wrong.viewpoint.is_point() { "eye" } else { "direction" };
    format!(
        "{name} ({filter} edges): {} disagrees with the definition from {kind} {:?}\n  \
         lost {}: {}\n  invented {}: {}",
        wrong.extractor,
        wrong.viewpoint.xyz().to_array(),
        wrong.lost.len(),
        pairs(&wrong.lost),
        wrong.invented.len(),
        pairs(&wrong.invented)
    )
}
