//! Every extractor against the definition, whole sets of edges.

use std::time::Instant;

use drypoint_mesh::{Mesh, MeshAdjacency};
use drypoint_tests::compare::{Agreement, Expected};
use drypoint_tests::{meshes, viewpoints};

use crate::{FILTERS, Options, explain, patches, selected};

/// Viewpoints of the near set, and triangles that hostile viewpoints are built on.
const NEAR_VIEWPOINTS: usize = 100;
const HOSTILE_TRIANGLES: usize = 25;

pub(crate) fn run(options: &Options) -> Result<(), String> {
    println!(
        "{:<24} {:<7}{:<16}{:>9}{:>8}{:>7}{:>7}{:>11}{:>8}{:>7}",
        "mesh", "filter", "preset", "edges", "patches", "super", "views", "contours", "tested", "s"
    );
    let mut total = Agreement::default();
    meshes::for_each(&options.only, |name, mesh| {
        total = total + validate(name, mesh, options)?;
        Ok(())
    })?;
    println!(
        "every extractor agrees with the definition: {} views, {} contour edges",
        total.viewpoints, total.contour_edges
    );
    Ok(())
}

fn validate(name: &str, mesh: &Mesh, options: &Options) -> Result<Agreement, String> {
    let adjacency = MeshAdjacency::new(mesh);
    let viewpoints: Vec<_> = viewpoints::protocol(mesh)
        .into_iter()
        .chain(viewpoints::orthographic())
        .chain(viewpoints::near(mesh, NEAR_VIEWPOINTS))
        .chain(viewpoints::hostile(mesh, HOSTILE_TRIANGLES))
        .collect();
    let mut total = Agreement::default();
    for (filter, filter_name) in FILTERS {
        let expected = Expected::new(mesh, &adjacency, filter, &viewpoints)
            .map_err(|wrong| format!("{name} ({filter_name}): {}", explain(&adjacency, &wrong)))?;
        for (preset, params) in selected(options, adjacency.edges(filter).count()) {
            let fail = |why: String| format!("{name} ({filter_name}, {preset}): {why}");
            let start = Instant::now();
            let set = patches(mesh, &adjacency, filter, &params).map_err(fail)?;
            let agreement =
                expected.compare(&set).map_err(|wrong| fail(explain(&adjacency, &wrong)))?;
            let edges = set.wings().len();
            let all = (edges * agreement.viewpoints).max(1) as f64;
            println!(
                "{name:<24} {filter_name:<7}{preset:<16}{edges:>9}{:>8}{:>7}{:>7}{:>11}{:>7.1}%{:>7.1}",
                set.patches().len(),
                set.super_patches().len(),
                agreement.viewpoints,
                agreement.contour_edges,
                100.0 * agreement.edges_tested as f64 / all,
                start.elapsed().as_secs_f64()
            );
            total = total + agreement;
        }
    }
    Ok(total)
}
