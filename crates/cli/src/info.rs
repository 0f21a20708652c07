//! `drypoint info`: what a mesh is made of.

use std::collections::BTreeMap;

use drypoint_mesh::rig::{Animation, Rig, Skin};
use drypoint_mesh::{Aabb, io};
use glam::Vec3;
use serde::Serialize;

use crate::args::InfoArgs;
use crate::memory::Work;
use crate::output::{harmless, print, print_json};
use crate::source::Source;

/// The topology report, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Report<'a> {
    faces: usize,
    dropped_faces: usize,
    vertices: usize,
    dropped_vertices: usize,
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
    /// Those that have a name, sorted.
    materials: Vec<Part<'a>>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    motion: Option<Motion<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    positions: Option<Vec<[f32; 3]>>,
}

/// What of a model can move, and how.
#[derive(Debug, Serialize)]
struct Motion<'a> {
    animations: Vec<Moves<'a>>,
    /// Places of meshes that are placed more than once.
    instances: usize,
    rigid_parts: usize,
    /// Parts of one shape share it.
    rigid_shapes: usize,
    /// How much of the edges of two faces or more keeps its shape, 0 to 1.
    rigid_share: f64,
}

/// An animation.
#[derive(Debug, Serialize)]
struct Moves<'a> {
    name: &'a str,
    /// In seconds.
    duration: f64,
    channels: usize,
}

#[derive(Debug, Serialize)]
struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
}

/// A part or a material.
#[derive(Debug, Serialize)]
struct Part<'a> {
    name: &'a str,
    faces: usize,
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), String> {
    let source = Source::load(&args.model, args.read, Work::Edges)?;
    let adjacency = source.adjacency();
    let found = adjacency.report();
    let none = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
    let Aabb { min, max } = source.mesh().bounds().unwrap_or(none);
    let parts = source.model.parts.iter();
    let motion = source.model.rig.as_ref().map(|rig| motion(&source.name, rig)).transpose()?;
    let report = Report {
        motion,
        faces: found.faces,
        dropped_faces: source.model.dropped.faces,
        vertices: found.vertices,
        dropped_vertices: source.model.dropped.vertices,
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
        materials: materials(&source.model),
        positions: args
            .vertices
            .then(|| source.mesh().positions().iter().map(Vec3::to_array).collect()),
    };
    if args.json { print_json(&report) } else { print(describe(&source.name, &report).as_bytes()) }
}

/// A material may be that of several parts.
fn materials(model: &io::Model) -> Vec<Part<'_>> {
    let mut found: BTreeMap<&str, usize> = BTreeMap::new();
    for run in model.materials.iter().filter(|run| !run.name.is_empty()) {
        *found.entry(&run.name).or_default() += run.triangles.len();
    }
    found.into_iter().map(|(name, faces)| Part { name, faces }).collect()
}

fn motion<'a>(name: &str, rig: &'a Rig) -> Result<Motion<'a>, String> {
    let skin = Skin::new(rig).map_err(|error| format!("{name}: {error}"))?;
    let moves = |animation: &'a Animation| Moves {
        name: &animation.name,
        duration: animation.duration(),
        channels: animation.channels.len(),
    };
    Ok(Motion {
        animations: rig.animations().iter().map(moves).collect(),
        instances: rig.carriers().iter().filter(|carrier| carrier.mesh.is_some()).count(),
        rigid_parts: skin.parts().len(),
        rigid_shapes: skin.shapes().len(),
        rigid_share: skin.rigid_share(),
    })
}

/// The report for people to read.
fn describe(name: &str, report: &Report) -> String {
    let Bounds { min, max } = &report.bounds;
    let rows = [
        ("faces", report.faces, ""),
        ("  degenerate", report.degenerate, "no area"),
        ("faces left out", report.dropped_faces, "a vertex at no finite position"),
        ("vertices", report.vertices, ""),
        ("  not finite", report.dropped_vertices, "used by no face"),
        ("  welded", report.welded_vertices, "at distinct positions"),
        ("interior edges", report.interior, "two faces"),
        ("  convex", report.convex, ""),
        ("  flat", report.flat, ""),
        ("  concave", report.concave, ""),
        ("  inconsistent", report.inconsistent, "faces wound against each other"),
        ("boundary edges", report.boundary, "one face"),
        ("non-manifold edges", report.non_manifold, "three faces or more"),
    ];
    let mut text = format!("{}\n", harmless(name));
    for (label, count, note) in rows {
        text += format!("  {label:<20}{count:>10}  {note}").trim_end();
        text += "\n";
    }
    text += &format!("  bounds              {min:?} to {max:?}\n");
    if let Some(motion) = &report.motion {
        text += &describe_motion(motion);
    }
    for (label, all) in [("part", &report.parts), ("material", &report.materials)] {
        for Part { name, faces } in all {
            let name = if name.is_empty() { "(no name)".to_owned() } else { harmless(name) };
            text += &format!("  {label:<20}{name} ({faces} faces)\n");
        }
    }
    for (index, [x, y, z]) in report.positions.iter().flatten().enumerate() {
        text += &format!("  vertex {index}: {x} {y} {z}\n");
    }
    text
}

fn describe_motion(motion: &Motion) -> String {
    let mut text = String::new();
    for (label, count, note) in [
        ("rigid parts", motion.rigid_parts, "move as a whole"),
        ("  shapes", motion.rigid_shapes, "that they have"),
        ("instances", motion.instances, "of meshes that are placed more than once"),
    ] {
        text += &format!("  {label:<20}{count:>10}  {note}\n");
    }
    let percent = 100.0 * motion.rigid_share;
    text += &format!("  rigid edges         {percent:>8.1} %  between faces of one part\n");
    for (number, Moves { name, duration, channels }) in motion.animations.iter().enumerate() {
        let name = harmless(name);
        text += &format!("  animation {number:<10}{name} ({duration:.3} s, {channels} channels)\n");
    }
    text
}
