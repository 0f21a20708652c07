//! `drypoint info`: what a mesh is made of.

use drypoint_mesh::Aabb;
use glam::Vec3;
use serde::Serialize;

use crate::args::InfoArgs;
use crate::output::{print, print_json};
use crate::source::Source;

/// The topology report, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Report<'a> {
    faces: usize,
    vertices: usize,
    welded_vertices: usize,
    interior: usize,
    boundary: usize,
    non_manifold: usize,
    inconsistent: usize,
    degenerate: usize,
    convex: usize,
    flat: usize,
    concave: usize,
    bounds: Bounds,
    parts: Vec<Part<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    positions: Option<Vec<[f32; 3]>>,
}

#[derive(Debug, Serialize)]
struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
}

#[derive(Debug, Serialize)]
struct Part<'a> {
    name: &'a str,
    faces: usize,
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), String> {
    let source = Source::load(&args.model)?;
    let adjacency = source.adjacency();
    let found = adjacency.report();
    let none = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
    let Aabb { min, max } = source.mesh().bounds().unwrap_or(none);
    let parts = source.model.parts.iter();
    let report = Report {
        faces: found.faces,
        vertices: found.vertices,
        welded_vertices: found.welded_vertices,
        interior: found.interior,
        boundary: found.boundary,
        non_manifold: found.non_manifold,
        inconsistent: found.inconsistent,
        degenerate: found.degenerate,
        convex: found.convex,
        flat: found.flat,
        concave: found.concave,
        bounds: Bounds { min: min.to_array(), max: max.to_array() },
        parts: parts.map(|p| Part { name: &p.name, faces: p.triangles.len() }).collect(),
        positions: args
            .vertices
            .then(|| source.mesh().positions().iter().map(Vec3::to_array).collect()),
    };
    if args.json { print_json(&report) } else { print(describe(&source.name, &report).as_bytes()) }
}

/// The report for people to read.
fn describe(name: &str, report: &Report) -> String {
    let Bounds { min, max } = &report.bounds;
    let rows = [
        ("faces", report.faces, ""),
        ("  degenerate", report.degenerate, "no area"),
        ("vertices", report.vertices, ""),
        ("  welded", report.welded_vertices, "at distinct positions"),
        ("interior edges", report.interior, "two faces"),
        ("  convex", report.convex, ""),
        ("  flat", report.flat, ""),
        ("  concave", report.concave, ""),
        ("  inconsistent", report.inconsistent, "faces wound against each other"),
        ("boundary edges", report.boundary, "one face"),
        ("non-manifold edges", report.non_manifold, "three faces or more"),
    ];
    let mut text = format!("{name}\n");
    for (label, count, note) in rows {
        text += format!("  {label:<20}{count:>10}  {note}").trim_end();
        text += "\n";
    }
    text += &format!("  bounds              {min:?} to {max:?}\n");
    for part in &report.parts {
        text += &format!("  part                {} ({} faces)\n", part.name, part.faces);
    }
    for (index, [x, y, z]) in report.positions.iter().flatten().enumerate() {
        text += &format!("  vertex {index}: {x} {y} {z}\n");
    }
    text
}
