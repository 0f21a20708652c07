//! Every extractor against the definition, whole sets of edges.

use std::fs;
use std::time::Instant;

use drypoint_baselines::{AnchoredCones, Meshlets, Snch, SnchParams};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_tests::compare::{Agreement, Expected};
use drypoint_tests::judges::Judge;
use drypoint_tests::{meshes, viewpoints};
use serde::Serialize;

use crate::{FILTERS, Options, explain, patches, selected};

/// Viewpoints of the near set, and triangles that hostile viewpoints are built on.
const NEAR_VIEWPOINTS: usize = 100;
const HOSTILE_TRIANGLES: usize = 25;

/// What was compared.
#[derive(Debug, Default, Serialize)]
struct Outcome {
    agreements: Vec<Row>,
    views: usize,
    contour_edges: usize,
    /// The disagreement that ended it: where, from where, and which edges.
    disagreement: Option<String>,
}

/// One way to group the edges of one mesh; all extractors that go through it agreed.
#[derive(Debug, Serialize)]
struct Row {
    mesh: String,
    filter: &'static str,
    grouped_by: &'static str,
    edges: usize,
    bounds: usize,
    super_patches: usize,
    views: usize,
    contour_edges: usize,
    edges_tested: usize,
    seconds: f64,
}

pub(crate) fn run(options: &Options) -> Result<(), String> {
    println!(
        "{:<24} {:<7}{:<16}{:>9}{:>8}{:>7}{:>7}{:>11}{:>8}{:>7}",
        "mesh",
        "filter",
        "grouped by",
        "edges",
        "bounds",
        "super",
        "views",
        "contours",
        "tested",
        "s"
    );
    let mut outcome = Outcome::default();
    let result =
        meshes::for_each(&options.only, |name, mesh| validate(name, mesh, options, &mut outcome));
    outcome.disagreement = result.as_ref().err().cloned();
    let written = options.json.as_ref().map_or(Ok(()), |path| {
        let json = serde_json::to_string_pretty(&outcome).map_err(std::io::Error::from);
        let written = json.and_then(|json| fs::write(path, json + "\n"));
        written.map_err(|error| format!("{}: {error}", path.display()))
    });
    // That something is wrong comes before that it could not be written.
    result.and(written)?;
    if outcome.agreements.is_empty() {
        return Err(format!("no preset or baseline has {:?} in its name", options.preset));
    }
    let mut meshes: Vec<&str> = outcome.agreements.iter().map(|row| row.mesh.as_str()).collect();
    meshes.dedup();
    println!(
        "every extractor agrees with the definition: {} meshes, {} views, {} contour edges",
        meshes.len(),
        outcome.views,
        outcome.contour_edges
    );
    Ok(())
}

fn validate(
    name: &str,
    mesh: &Mesh,
    options: &Options,
    outcome: &mut Outcome,
) -> Result<(), String> {
    let adjacency = MeshAdjacency::new(mesh);
    let viewpoints: Vec<_> = viewpoints::protocol(mesh)
        .into_iter()
        .chain(viewpoints::orthographic())
        .chain(viewpoints::near(mesh, NEAR_VIEWPOINTS))
        .chain(viewpoints::hostile(mesh, HOSTILE_TRIANGLES))
        .collect();
    for (filter, filter_name) in FILTERS {
        let edges = adjacency.edges(filter).count();
        let expected = Expected::new(mesh, &adjacency, filter, &viewpoints)
            .map_err(|wrong| format!("{name} ({filter_name}): {}", explain(&adjacency, &wrong)))?;
        let row = |grouped_by| Row {
            mesh: name.to_owned(),
            filter: filter_name,
            grouped_by,
            edges,
            bounds: 0,
            super_patches: 0,
            views: 0,
            contour_edges: 0,
            edges_tested: 0,
            seconds: 0.0,
        };
        for (preset, params) in selected(options, edges) {
            let fail = |why: String| format!("{name} ({filter_name}, {preset}): {why}");
            let start = Instant::now();
            let set = patches(mesh, &adjacency, filter, &params).map_err(fail)?;
            let agreement =
                expected.compare(&set).map_err(|wrong| fail(explain(&adjacency, &wrong)))?;
            let [bounds, super_patches] = [set.patches().len(), set.super_patches().len()];
            outcome.push(Row { bounds, super_patches, ..row(preset) }, agreement, start);
        }
        for kind in BASELINES.into_iter().filter(|kind| kind.contains(&options.preset)) {
            let start = Instant::now();
            let (judge, bounds) = baseline(kind, mesh, &adjacency, filter);
            let agreement = expected.agreement(kind, judge.as_ref()).map_err(|wrong| {
                format!("{name} ({filter_name}): {}", explain(&adjacency, &wrong))
            })?;
            outcome.push(Row { bounds, ..row(kind) }, agreement, start);
        }
    }
    Ok(())
}

const BASELINES: [&str; 4] = ["snch", "snch-single", "anchored-cones", "meshlets"];

/// One of [`BASELINES`], and how many bounds it has.
fn baseline<'a>(
    kind: &str,
    mesh: &'a Mesh,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
) -> (Box<dyn Judge + 'a>, usize) {
    match kind {
        "anchored-cones" => {
            let cones = AnchoredCones::new(mesh, adjacency, filter, &Default::default());
            let nodes = cones.nodes();
            (Box::new(cones), nodes)
        }
        "meshlets" => {
            let meshlets = Meshlets::new(mesh, adjacency, filter, &Default::default());
            let count = meshlets.len();
            (Box::new(meshlets), count)
        }
        kind => {
            let mut params = SnchParams::default();
            if kind == "snch-single" {
                params.edges_per_leaf = 1;
            }
            let snch = Snch::new(mesh, adjacency, filter, &params);
            let nodes = snch.nodes();
            (Box::new(snch), nodes)
        }
    }
}

impl Outcome {
    /// Prints it, too.
    fn push(&mut self, row: Row, agreement: Agreement, start: Instant) {
        let Agreement { viewpoints: views, contour_edges, edges_tested, .. } = agreement;
        let seconds = start.elapsed().as_secs_f64();
        let row = Row { views, contour_edges, edges_tested, seconds, ..row };
        println!(
            "{:<24} {:<7}{:<16}{:>9}{:>8}{:>7}{views:>7}{contour_edges:>11}{:>7.1}%{seconds:>7.1}",
            row.mesh,
            row.filter,
            row.grouped_by,
            row.edges,
            row.bounds,
            row.super_patches,
            100.0 * edges_tested as f64 / (row.edges * views).max(1) as f64,
        );
        self.views += views;
        self.contour_edges += contour_edges;
        self.agreements.push(row);
    }
}
